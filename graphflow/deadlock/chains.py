"""Detection of hopeless calls at their server, without a snapshot.

A request carries the chain of calls that led to it, with a hop for each run that waits. If its server's group is full
of runs from that chain, the request waits for itself: it can never be answered, and the server knows at once. This is
the edge-chasing approach to deadlock detection, with the probe attached to the request.

Source: Chandy, Misra and Haas, "Distributed deadlock detection", ACM TOCS 1 (1983); docs/architecture.md, "The life of
a call".
"""

from __future__ import annotations

import asyncio

from graphflow.deadlock.asyncio_frames import waiter_of
from graphflow.executor.ledger import Ledger, PendingCall
from graphflow.executor.runner import Run, Runner
from graphflow.wire import attachment, chain


class Chains:
    """The chains of calls that pass through one process.

    Args:
        zid: The id of the process's session.
    """

    def __init__(self, ledger: Ledger, zid: str) -> None:
        self._ledger = ledger
        self._process = chain.process_of(zid)

    def of(self, call: PendingCall) -> bytes:
        """Return the chain for a new call; empty unless a handler makes the call in its own body.

        A task that a handler creates runs beside it, so its calls do not keep the handler from returning.
        """
        run = asyncio.current_task()
        if not isinstance(run, Run):
            return b""
        asked = getattr(run.item, "attachment", None) if run.runner.spec.kind == "service" else None
        hop = chain.Hop(self._process, run.number, call.gid, call.sequence)
        return chain.extended((asked or b"")[attachment.SIZE :], hop)

    def holders(self, runner: Runner, asked: bytes) -> list[Run]:
        """Return the runs that hold every slot a queued request needs, if all of them wait for that very request.

        Args:
            asked: The attachment of the request.
        """
        hops = {hop.run: hop for hop in chain.hops(asked[attachment.SIZE :]) if hop.process == self._process}
        if not hops:
            return []
        group = runner.group
        if group is None and runner.is_serial:
            holders, limit = list(runner.active), 1
        # Where newer work cancels a run, a full group is not hopeless.
        elif group is None or group.limit is None or group.when_full == "cancel_running":
            return []
        else:
            members = [m for m in group.members if isinstance(m, Runner)]
            holders, limit = [run for m in members for run in m.active if run.group is group], group.limit
        waits = all(run.number in hops and self._awaits(run, hops[run.number]) for run in holders)
        return holders if waits and len(holders) >= limit else []

    def between(self, holders: list[Run], asked: bytes) -> tuple[list[int], int]:
        """Return the runs on the chain of a request, without the holders.

        Returns:
            The numbers of this process's runs on the chain, and the number of other processes' runs between a holder
            and the request.
        """
        numbers = {run.number for run in holders}
        way = chain.hops(asked[attachment.SIZE :])
        here = [hop.process == self._process for hop in way]
        first = min((i for i, hop in enumerate(way) if here[i] and hop.run in numbers), default=0)
        own = [hop.run for hop, is_own in zip(way, here, strict=True) if is_own and hop.run not in numbers]
        return own, here[first:].count(False)

    def _awaits(self, run: Run, hop: chain.Hop) -> bool:
        """Whether a run still waits for the call of its hop: it may have given up since."""
        waiter = waiter_of(run)
        call = None if waiter is None else self._ledger.calls.get(waiter)
        return call is not None and (call.gid, call.sequence) == (hop.gid, hop.sequence)

"""Waits for a server that no node offers: reported after a while, with the nearest name on offer."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager

from graphflow.deadlock.startup_waits import place_of
from graphflow.machines.cache import GraphCache
from graphflow.names import is_hidden
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS, to_ns

WARN_AFTER = 3.0
"""Seconds for a server to appear."""
GAP = 2.0
"""Longest gap in seconds between two waits that count as one; a program that polls less often can do without the
server."""


class Unserved:
    """The waits of one client for its server, reported once until there is one.

    Args:
        nobody: Returns the report; "" if the deadlock search reports the wait.
    """

    def __init__(self, host: Host, nobody: Callable[[], Awaitable[str]]) -> None:
        self._host, self._nobody = host, nobody
        self._since: int | None = None
        """Start of the first wait since there was a server: a loop may wait again and again."""
        self._waits, self._ended_ns = 0, 0
        """Number of waits in progress, and the end of the last completed one in nanoseconds."""
        self._is_reported = False

    @contextmanager
    def waiting(self, *, raises: bool = False) -> Iterator[None]:
        """Track a wait for the length of the block; one that ends without an error has found a server.

        Args:
            raises: Whether the wait ends in an error that reports the missing server: such waits are not counted.
        """
        task, clock = asyncio.current_task(), self._host.context.clock
        since = clock.monotonic_ns() if raises else self._begin(clock.monotonic_ns())
        reports: list[asyncio.Task[None]] = []
        alarm = clock.call_at(
            max(clock.monotonic_ns(), since + to_ns(WARN_AFTER)),
            lambda: reports.append(asyncio.create_task(self._report(task, since))),
        )
        self._waits += 1
        try:
            yield
            self._since, self._is_reported = None, False
        finally:
            self._waits, self._ended_ns = self._waits - 1, clock.monotonic_ns()
            alarm.cancel()
            for report in reports:
                report.cancel()

    def _begin(self, now_ns: int) -> int:
        """Add a wait to the series; returns the start of its first wait in nanoseconds."""
        is_another = not self._waits and now_ns - self._ended_ns > to_ns(GAP)
        self._since = now_ns if self._since is None or is_another else self._since
        return self._since

    async def _report(self, task: asyncio.Task[None] | None, since: int) -> None:
        if self._is_reported or is_hidden(self._host.full_name):  # a command's node, whose command reports it
            return
        text, place = await self._nobody(), place_of(task)
        # Only now, after the wait above: another wait may have reported meanwhile, or this one have ended.
        is_reported, self._is_reported = self._is_reported, True
        if text and not is_reported:
            waited = (self._host.context.clock.monotonic_ns() - since) / NANOSECONDS
            self._host.log.warning("wait_ready has waited for %.0f s%s: %s", waited, place and f" {place}", text)


def nobody_acts(cache: GraphCache, name: str, type_name: str) -> str:
    """Return a sentence on an action that no node offers, with those of its type."""
    offered = [type_ for type_ in cache.actions().get(name, ()) if type_ != type_name]
    if offered:
        return f"action {name} is of type {offered[0]}, not {type_name}"
    return f"no node offers the action {name} [{type_name}]{cache.action_of_type(name, type_name)}"

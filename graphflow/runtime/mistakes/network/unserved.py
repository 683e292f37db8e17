"""Waits for a server that nobody offers: after a while they are told, with the nearest name on offer."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager

from graphflow.deadlock.startup_waits import place_of
from graphflow.machines.cache import GraphCache
from graphflow.names import did_you_mean, is_hidden
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS, to_ns

TELL_AFTER = 3.0
"""Seconds that a server may take to come."""
GAP = 2.0
"""Seconds between two waits up to which they are one: a program that asks now and then does without the server."""


class Unserved:
    """The waits of one client for its server; told once until there is one.

    Args:
        nobody: Says that there is no server, and what there is instead; empty where others tell.
    """

    def __init__(self, host: Host, nobody: Callable[[], Awaitable[str]]) -> None:
        self._host, self._nobody = host, nobody
        self._since: int | None = None
        """When the first of the waits began since there was a server: a loop may wait again and again."""
        self._waits, self._ended_ns = 0, 0
        """The number of waits that go on, and the time at which the last of the others ended, in nanoseconds."""
        self._is_told = False

    @contextmanager
    def waiting(self, *, raises: bool = False) -> Iterator[None]:
        """A wait; one that ends without an error has found a server.

        Args:
            raises: Whether the program gets an error if no server comes, which tells: such waits do not add up.
        """
        task, clock = asyncio.current_task(), self._host.context.clock
        since = clock.monotonic_ns() if raises else self._begin(clock.monotonic_ns())
        telling: list[asyncio.Task[None]] = []
        alarm = clock.call_at(
            max(clock.monotonic_ns(), since + to_ns(TELL_AFTER)),
            lambda: telling.append(asyncio.create_task(self._tell(task, since))),
        )
        self._waits += 1
        try:
            yield
            self._since, self._is_told = None, False
        finally:
            self._waits, self._ended_ns = self._waits - 1, clock.monotonic_ns()
            alarm.cancel()
            for begun in telling:
                begun.cancel()

    def _begin(self, now_ns: int) -> int:
        """Add a wait to a series; returns when the first of that began, in nanoseconds."""
        is_another = not self._waits and now_ns - self._ended_ns > to_ns(GAP)
        self._since = now_ns if self._since is None or is_another else self._since
        return self._since

    async def _tell(self, task: asyncio.Task[None] | None, since: int) -> None:
        if self._is_told or is_hidden(self._host.full_name):  # the node of a command, which tells it itself
            return
        text, place = await self._nobody(), place_of(task)
        is_told, self._is_told = self._is_told, True  # by another wait meanwhile; not before, as this one may end
        if text and not is_told:
            waited = (self._host.context.clock.monotonic_ns() - since) / NANOSECONDS
            self._host.log.warning("wait_ready has waited for %.0f s%s: %s", waited, place and f" {place}", text)


def nobody_acts(cache: GraphCache, name: str, type_name: str) -> str:
    """Say that no node offers an action of a name and type, and what there is instead."""
    actions = cache.actions()
    offered = [type_ for type_ in actions.get(name, ()) if type_ != type_name]
    if offered:
        return f"action {name} is of type {offered[0]}, not {type_name}"
    near = did_you_mean(name, [other for other in actions if other != name])
    return f"no node offers the action {name} [{type_name}]{near}"

"""Simulation of a whole graph in one process: virtual time, and a network with random delays and losses from a seed.

    async def story(world: World) -> None:
        await world.start(Talker(), listener := Listener())
        await asyncio.sleep(3600)          # an hour passes at once
        world.kill(talker)

    simulate(story, seed=7, delay=(0.0, 0.02), loss=0.1)

The same seed gives the same run. When the loop is idle, time jumps to the next due event; if there is none, the
simulation ends with an error instead of waiting.
"""

from __future__ import annotations

import asyncio
import selectors
from collections.abc import Callable, Coroutine
from contextlib import suppress
from random import Random
from typing import Any, TypeVar

from graphflow.executor.clock import Alarm, Clock
from graphflow.interface import DeadlockPolicy
from graphflow.runtime.context import Context
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.transport.memory import MemorySession, Network

T = TypeVar("T")

START_NS = 1_700_000_000_000_000_000
"""The time of day, in nanoseconds, at which every simulation starts."""


_MOMENT = 1e-9
"""Seconds between two arrivals on one link: asyncio runs timers of equal times in any order."""


class Standstill(RuntimeError):
    """No event is pending, and the story has not ended."""


class _Selector(selectors.SelectSelector):
    """A selector that never waits, since virtual time has already passed."""

    now = 0.0

    def select(self, timeout: float | None = None) -> Any:
        if timeout is None:
            raise Standstill("nothing is due, and nothing can arrive")
        self.now += max(0.0, timeout)
        return super().select(0)


class SimulatedLoop(asyncio.SelectorEventLoop):
    """An asyncio loop under virtual time, in seconds from 0."""

    def __init__(self) -> None:
        self._virtual = _Selector()
        super().__init__(self._virtual)

    def time(self) -> float:
        return self._virtual.now


class LoopClock(Clock):
    """The clock of a simulated loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop

    def time_ns(self) -> int:
        return START_NS + self.monotonic_ns()

    def monotonic_ns(self) -> int:
        return round(self._loop.time() * 1e9)

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Alarm:
        return self._loop.call_at(when_ns / 1e9, callback)


class Seeded:
    """A carrier with random delays and losses from a seed.

    Args:
        delay: Shortest and longest time in transit, in seconds.
        loss: The fraction of publications that never arrive, 0 to 1.
        reorders: Whether publications on one link may overtake each other.
    """

    def __init__(self, random: Random, delay: tuple[float, float], loss: float, *, reorders: bool = False) -> None:
        self._random, self._delay, self._loss, self._reorders = random, delay, loss, reorders
        self._arrives: dict[str, float] = {}
        self.lost = 0
        """Publications lost so far."""

    def carry(self, deliver: Callable[[], object], link: str, *, is_lossy: bool) -> None:
        loop = asyncio.get_running_loop()
        if is_lossy and self._random.random() < self._loss:
            self.lost += 1
            return
        when = loop.time() + self._random.uniform(*self._delay)
        if not self._reorders:
            when = self._arrives[link] = max(when, self._arrives.get(link, 0.0) + _MOMENT)
        loop.call_at(when, deliver)


class World:
    """The nodes of a simulation, each as if in a process of its own."""

    def __init__(self, network: Network, random: Random, deadlock: DeadlockPolicy) -> None:
        self.network, self.random = network, random
        self._deadlock: DeadlockPolicy = deadlock
        self._sessions: dict[Node, tuple[MemorySession, Context]] = {}

    async def start(self, *nodes: Node) -> None:
        """Start nodes."""
        loop = asyncio.get_running_loop()
        for node in nodes:
            session = self.network.session(loop)
            context = Context(session, clock=LoopClock(loop), deadlock=self._deadlock)
            self._sessions[node] = session, context
            await core_of(node).start(context)

    async def kill(self, node: Node) -> None:
        """End a node as `kill -9` does: nothing that it sends reaches another node from now on."""
        session, context = self._sessions.pop(node)
        session.die()
        await core_of(node).stop()
        await context.close()

    async def close(self) -> None:
        for node, (_, context) in reversed(self._sessions.items()):
            await core_of(node).stop()
            await context.close()


def simulate(
    story: Callable[[World], Coroutine[object, object, T]],
    seed: int = 0,
    *,
    delay: tuple[float, float] = (0.0, 0.0),
    loss: float = 0.0,
    reorders: bool = False,
    deadlock: DeadlockPolicy = "raise",
) -> T:
    """Run a story to its end; returns its result.

    Args:
        seed: The seed of all delays, losses and choices, and of `world.random`.
        delay, loss, reorders: Properties of the network, as for `Seeded`.

    Raises:
        Standstill: No event is pending, and the story has not ended.
    """
    random = Random(seed)  # noqa: S311 - to be the same every time is what it is for
    network = Network(Seeded(random, delay, loss, reorders=reorders))

    async def run() -> T:
        world = World(network, random, deadlock)
        try:
            return await story(world)
        finally:
            with suppress(Standstill):
                await world.close()

    with asyncio.Runner(loop_factory=SimulatedLoop) as runner:
        return runner.run(run())

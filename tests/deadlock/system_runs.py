"""Runs of systems under virtual time, until nothing moves."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from random import Random
from typing import NamedTuple

from graphflow.interface import DeadlockPolicy
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of
from graphflow.testing.simulation import LoopClock, World, simulate
from graphflow.transport.base import EARLY
from graphflow.transport.memory import MemorySession, Network
from tests.deadlock.diary import Diary
from tests.deadlock.system_actors import Actor, made
from tests.deadlock.systems import System
from tests.deadlock.verdicts import SCATTER, check, shapes, unnamed

STILL = 2.2
"""Seconds without a step after which nothing will move any more: longer than to leave a goal, and what is `pending`."""
BROKEN_WITHIN = 20.0
"""Seconds until a ring is broken, at most: processes that see each other's calls late disagree on the youngest."""

LOOK_EVERY = 0.41
"""Seconds between two pictures of all processes at one moment that the test takes itself."""
SAID_WITHIN = 9.0
"""Seconds until what is less urgent is said, at most: that a ring has cleared, and who waits behind one."""


class Scattered(MemorySession):
    """One of several processes, which take their pictures at moments of their own."""

    def __init__(self, network: Network, random: Random, number: int) -> None:
        loop = asyncio.get_running_loop()
        super().__init__(network, loop)
        self.zid = f"{number + 1:016x}"
        self._random = random

    def ask_reports(self, key: str, limit: float, told: Callable[[list[bytes], bool], None]) -> None:
        found: list[bytes] = []
        reports = [report for known, report in self._network.reports.items() if known.startswith(key.rstrip("*"))]

        def arrive(report: Callable[[], bytes]) -> None:
            found.append(report())
            if len(found) == len(reports):
                told(found, True)

        def early() -> None:
            if len(found) < len(reports):
                told(found.copy(), False)

        for report in reports:
            self._loop.call_later(self._random.uniform(0, SCATTER), arrive, report)
        self._loop.call_later(EARLY, early)


class Outcome(NamedTuple):
    """What has come of a system."""

    stuck: frozenset[str]
    hopeless: int
    """Calls of its that nobody can ever answer, as far as their chains tell."""
    refused: int
    """Calls that ended with DeadlockError."""
    told: int
    """Reports."""
    unnamed: frozenset[str]
    """Who is stuck, and in no report."""
    seconds: float
    """Until nothing moved any more, and nothing was to be taken back."""
    shapes: frozenset[str]


def outcome_of(system: System, seed: int, policy: DeadlockPolicy) -> Outcome:
    """Run a system until nothing moves any more, and hold what was said of it against what has happened."""
    diary = Diary(system)
    loggers = [logging.getLogger("graphflow"), logging.getLogger("asyncio")]
    former = [(logger, logger.level, logger.propagate) for logger in loggers]
    for logger in loggers:
        logger.addHandler(diary)
        logger.setLevel(logging.DEBUG)
        logger.propagate = False
    try:
        found: Outcome = simulate(lambda world: play(diary, policy, world), seed, delay=(0.0, system.delay))
        return found
    finally:
        for logger, level, propagates in former:
            logger.removeHandler(diary)
            logger.setLevel(level)
            logger.propagate = propagates


async def play(diary: Diary, policy: DeadlockPolicy, world: World) -> Outcome:
    system, loop = diary.system, asyncio.get_running_loop()
    contexts: dict[int, Context] = {}
    for process in sorted(set(system.processes)):
        session = Scattered(world.network, world.random, process)
        contexts[process] = Context(session, clock=LoopClock(loop), deadlock=policy, call_timeout=None)
    diary.contexts += contexts.values()
    diary.breaks = policy == "break"
    actors = made(diary)
    for actor, process in zip(actors, system.processes, strict=True):
        await core_of(actor).start(contexts[process])
    await asyncio.sleep(1.0)
    for begin in (begin for actor in actors for begin in actor.starts):
        begin()
    begun = loop.time() + max(starter.after * starter.times for starter in system.starters)
    try:
        while loop.time() < begun or not is_still(diary, loop.time()):
            assert loop.time() < 1000.0, "it goes on and on"
            await asyncio.sleep(LOOK_EVERY)
            diary.look()
        seconds = loop.time()
        check(diary)
        await forever(actors)
        stuck = frozenset(life.id for life in diary.stuck())
        return Outcome(
            stuck,
            len(diary.hopeless()),
            diary.refused,
            len(diary.reports),
            frozenset(unnamed(diary)),
            seconds,
            frozenset(shapes(diary)),
        )
    finally:
        for actor in actors:
            await core_of(actor).stop()
        for context in diary.contexts:
            await context.close()


def is_still(diary: Diary, now: float) -> bool:
    """Whether nothing will move any more, and everything has been said."""
    since = now - (diary.times[-1] if diary.times else 0.0)
    if diary.pending or since <= (BROKEN_WITHIN if diary.breaks and diary.stuck() else STILL):
        return False
    is_cleared = not any(diary.lives[name].is_over for ring in diary.standing() for name in ring)
    return since > SAID_WITHIN or (is_cleared and not unnamed(diary))


async def forever(actors: list[Actor]) -> None:
    """Nothing moves, however long one waits."""
    [diary] = {actor.diary for actor in actors}
    for context in diary.contexts:
        context.search.close()
    for actor in actors:
        for timer in actor.timers.values():
            timer.cancel()
    before = len(diary.times)
    await asyncio.sleep(1000.0)
    assert len(diary.times) == before

"""Programs with a loop that ends by itself, whatever its flag says: nothing is said of them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import suppress
from functools import partial
from time import monotonic_ns

import numpy as np
import pytest

from graphflow import Node, Subscription
from graphflow.executor.clock import Clock
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.cases import sample
from tests.deadlock.cast import Caplog, Driver, DrivesByPose, Robot
from tests.deadlock.lookalikes import goes_on, in_three_seconds, legal, three_seconds_from_now


class LooksItself(Driver):
    """The loop asks a method that may find that it is there."""

    looks = 0

    def look(self) -> None:
        self.looks += 1
        self.there = self.looks > 30

    async def go(self, _: String) -> None:
        while not self.there:
            self.look()
            await self.clock.sleep(0.1)


class StepsItself(DrivesByPose):
    """The loop moves what it looks at."""

    async def step(self) -> None:
        self.pose = Pose(x=self.pose.x + 0.2, y=self.pose.y + 0.2)
        await self.clock.sleep(0.02)

    async def go(self, _: String) -> None:
        while self.distance(5.0, 5.0) > 0.1:
            await self.step()
            await self.clock.sleep(0.1)


class EndsAtATime(Driver):
    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        while not self.there and self.clock.monotonic_ns() < end:
            await self.clock.sleep(0.1)


class EndsAtATimeByImport(Driver):
    """The clock is a function of a module, called by its own name."""

    async def go(self, _: String) -> None:
        end = monotonic_ns() + 1_000_000_000_000
        while not self.there and monotonic_ns() < end:
            await self.clock.sleep(0.1)

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(self.stop_going)]

    def stop_going(self) -> None:
        for runner in core_of(self).runners:
            for run in runner.active:
                run.cancel()


class EndsAfterTurns(Driver):
    async def go(self, _: String) -> None:
        async for n in self.clock.every(0.1):
            if self.there or n >= 30:
                break


class EndsAfterTurnsCounted(Driver):
    async def go(self, _: String) -> None:
        n = 0
        while not self.there and n < 30:
            n += 1
            await self.clock.sleep(0.1)


class EndsAfterTurnsAddedUp(Driver):
    async def go(self, _: String) -> None:
        n = 0
        while not self.there and n < 30:
            n = n + 1
            await self.clock.sleep(0.1)


class EndsAfterTurnsInTwos(Driver):
    async def go(self, _: String) -> None:
        last, n = 0, 1
        while not self.there and n < 30:
            last, n = n, n + 1
            self.log.debug("after %d comes %d", last, n)
            await self.clock.sleep(0.1)


class EndsByAGlobal(Driver):
    async def go(self, _: String) -> None:
        while not self.there and not is_over:
            await self.clock.sleep(0.1)

    def others(self) -> Sequence[Node]:
        say_over(False)
        return [in_three_seconds(lambda: say_over(True))]


is_over = False


def say_over(value: bool) -> None:
    global is_over
    is_over = value


class EndsByAKeyword(Driver):
    async def until(self, *, said: list[str]) -> None:
        while not self.there and not said:
            await self.clock.sleep(0.1)

    async def go(self, _: String) -> None:
        said: list[str] = []
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: said.append("end"))
        await self.until(said=said)


class EndsByAnAssertion(Driver):
    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        with suppress(AssertionError):
            while not self.there:
                assert self.clock.monotonic_ns() < end
                await self.clock.sleep(0.1)


class EndsByAnErrorOfItsMethod(Driver):
    def hurry(self, end: int) -> None:
        if self.clock.monotonic_ns() >= end:
            raise TimeoutError

    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        with suppress(TimeoutError):
            while not self.there:
                self.hurry(end)
                await self.clock.sleep(0.1)


class EndsByAnErrorOfAFunction(Driver):
    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        with suppress(TimeoutError):
            while not self.there:
                hurry(self.clock, end)
                await self.clock.sleep(0.1)


def hurry(clock: Clock, end: int) -> None:
    if clock.monotonic_ns() >= end:
        raise TimeoutError


class EndsAfterAFor(Driver):
    async def go(self, _: String) -> None:
        for _turn in range(30):
            if self.there:
                break
            await self.clock.sleep(0.1)


class Stopwatch:
    """Says when its time is over."""

    def __init__(self, clock: Clock) -> None:
        self._clock, self._end = clock, three_seconds_from_now(clock)

    @property
    def is_over(self) -> bool:
        return self._clock.monotonic_ns() >= self._end


class EndsByAStopwatch(Driver):
    async def go(self, _: String) -> None:
        watch = Stopwatch(self.clock)
        while not self.there and not watch.is_over:
            await self.clock.sleep(0.1)


class EndsByAStopwatchOfItsOwn(Driver):
    async def go(self, _: String) -> None:
        self.watch = Stopwatch(self.clock)
        while not self.there and not self.watch.is_over:
            await self.clock.sleep(0.1)


class EndsByAFunction(Driver):
    async def go(self, _: String) -> None:
        watch = Stopwatch(self.clock)
        while not self.there and not has_ended(watch):
            await self.clock.sleep(0.1)


def has_ended(watch: Stopwatch) -> bool:
    return watch.is_over


class EndsWithATask(Driver):
    async def go(self, _: String) -> None:
        resting = asyncio.ensure_future(self.clock.sleep(3.0))
        while not self.there and not resting.done():
            await self.clock.sleep(0.1)


class EndsWithALocalList(Driver):
    async def go(self, _: String) -> None:
        said: list[str] = []
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: said.append("end"))
        while not self.there and not said:
            await self.clock.sleep(0.1)


class EndsWithAMethodOfALocalList(Driver):
    async def go(self, _: String) -> None:
        said: list[str] = []
        self.clock.call_at(three_seconds_from_now(self.clock), partial(said.append, "end"))
        while not self.there and not said:
            await self.clock.sleep(0.1)


class EndsWithAMethodOfItsList(Driver):
    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []

    async def go(self, _: String) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), partial(self.said.append, "end"))
        while not self.there and not self.said:
            await self.clock.sleep(0.1)


def bring(somewhere: list[list[str]], said: list[str]) -> None:
    somewhere.append(said)


class EndsWithALocalListGivenAway(Driver):
    async def go(self, _: String) -> None:
        said: list[str] = []
        known: list[list[str]] = []
        bring(known, said)
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: known[0].append("end"))
        while not self.there and not said:
            await self.clock.sleep(0.1)


class EndsAfterTurnsInAList(Driver):
    async def go(self, _: String) -> None:
        turns: list[int] = []
        while not self.there and len(turns) < 30:
            turns.append(1)
            await self.clock.sleep(0.1)


class EndsAfterTurnsInAPartOfAList(Driver):
    async def go(self, _: String) -> None:
        turns = [0]
        while not self.there and turns[0] < 30:
            turns[0] += 1
            await self.clock.sleep(0.1)


class EndsAfterTurnsInAMessage(Driver):
    async def go(self, message: String) -> None:
        while not self.there and len(message.data) < 30:
            message.data += "."
            await self.clock.sleep(0.1)


class EndsAfterTurnsInAnArray(Driver):
    async def go(self, _: String) -> None:
        turns = np.zeros(1)
        while not self.there and turns[0] < 30:
            turns[0] += 1
            await self.clock.sleep(0.1)


class EndsWithItsGenerator(Driver):
    async def three_turns(self) -> AsyncIterator[int]:
        for n in range(3):
            await self.clock.sleep(1.0)
            yield n

    async def go(self, _: String) -> None:
        async for _turn in self.three_turns():
            if self.there:
                break


class EndsWithAMessage(Driver):
    words = Subscription(String, "words")

    async def go(self, _: String) -> None:
        async for message in self.words:
            if self.there or message.data == "end":
                break

    def others(self) -> Sequence[Node]:
        outside = Node("outside")
        speaker = outside.create_publisher(String, "words")
        outside.create_timer(3.0, lambda: speaker.publish(String(data="end")))
        return [outside]


@pytest.mark.parametrize(
    "program",
    sample(
        [
            legal(LooksItself),
            legal(StepsItself),
            legal(EndsAtATime),
            legal(EndsAtATimeByImport),
            legal(EndsAfterTurns),
            legal(EndsAfterTurnsCounted),
            legal(EndsAfterTurnsAddedUp),
            legal(EndsAfterTurnsInTwos),
            legal(EndsByAGlobal),
            legal(EndsByAKeyword),
            legal(EndsByAnAssertion),
            legal(EndsByAnErrorOfItsMethod),
            legal(EndsByAnErrorOfAFunction),
            legal(EndsAfterAFor),
            legal(EndsByAStopwatch),
            legal(EndsByAStopwatchOfItsOwn),
            legal(EndsByAFunction),
            legal(EndsWithATask),
            legal(EndsWithALocalList),
            legal(EndsWithAMethodOfALocalList),
            legal(EndsWithAMethodOfItsList),
            legal(EndsWithALocalListGivenAway),
            legal(EndsAfterTurnsInAList),
            legal(EndsAfterTurnsInAPartOfAList),
            legal(EndsAfterTurnsInAMessage),
            legal(EndsAfterTurnsInAnArray),
            legal(EndsWithItsGenerator),
            legal(EndsWithAMessage),
        ]
    ),
)
async def test_a_program_that_goes_on(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """Nothing is ever said of it, though it waits for seconds while others of its group queue."""
    await goes_on(graph, caplog, program())

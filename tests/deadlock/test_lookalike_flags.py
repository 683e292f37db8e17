"""Programs that poll a flag that something out of sight sets: nothing is said of them."""

from __future__ import annotations

import asyncio
import functools
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from graphflow import Node, Param, timer
from graphflow.executor.clock import Clock
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.cases import sample
from tests.deadlock.cast import Caplog, Driver, Robot
from tests.deadlock.lookalikes import goes_on, in_three_seconds, legal, three_seconds_from_now


class FlagOfATask(Driver):
    async def toil(self) -> None:
        await self.clock.sleep(3.0)
        self.there = True

    async def go(self, _: String) -> None:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self.toil())
            while not self.there:
                await self.clock.sleep(0.1)


class FlagOfALocalHandler(Driver):
    async def on_start(self) -> None:
        async def look() -> None:
            self.there = True

        self.create_timer(3.0, look)


class FlagByAnotherName(Driver):
    @timer(3.0)
    async def look(self) -> None:
        setattr(self, "the" + "re", True)


def noting(fn: Any) -> Any:
    """A decorator of the user's own, which writes the attribute."""

    @functools.wraps(fn)
    async def wrapper(self: Any) -> None:
        self.there = True
        await fn(self)

    return wrapper


class FlagByADecorator(Driver):
    @timer(3.0)
    @noting
    async def look(self) -> None: ...


class FlagByAFunctionPutThere(Driver):
    note: Any

    @timer(3.0)
    async def look(self) -> None:
        self.note()


def _note(node: Any) -> None:
    vars(node)["there"] = True


FlagByAFunctionPutThere.note = _note


class FlagByWhatAssigningDoes(Driver):
    def __setattr__(self, name: str, value: object) -> None:
        super().__setattr__("there" if name == "seen" else name, value)

    @timer(3.0)
    async def look(self) -> None:
        self.seen = True


class FlagThroughTheDictionary(Driver):
    @timer(3.0)
    async def look(self) -> None:
        self.__dict__["there"] = True


class FlagOfAPartner(Driver):
    """What watches and what sets run side by side in one handler."""

    async def drive(self) -> None:
        await self.clock.sleep(3.0)
        self.there = True

    async def watch(self) -> None:
        while not self.there:
            await self.clock.sleep(0.1)

    async def go(self, _: String) -> None:
        await asyncio.gather(self.drive(), self.watch())


def without_source(text: str) -> type[Driver]:
    """The class `Made` of a program that is nowhere in a file, as in a notebook."""
    names: dict[str, Any] = {"Driver": Driver, "timer": timer, "__name__": "notebook"}
    exec(text, names)
    made: type[Driver] = names["Made"]
    return made


FlagOfAChildWithoutSource = without_source(
    """
class Made(Driver):
    @timer(3.0)
    async def look(self):
        self.there = True
"""
)


class FlagOfAParentWithoutSource(FlagOfAChildWithoutSource):  # type: ignore[misc, valid-type]
    async def go(self, _: String) -> None:
        while not self.there:
            await self.clock.sleep(0.1)


class FlagOfAParameter(Robot):
    speed = Param(0.0)

    async def go(self, _: String) -> None:
        while not self.speed:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        self.speed = 1.0

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.parameters.set({"speed": 1.0}))]


class State:
    """Something with a field."""

    lifted = False


class EndsWithAStateGivenAway(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.condition = State()

    async def go(self, _: String) -> None:
        lift_later(self.condition, self.clock)
        while not self.condition.lifted:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        self.condition.lifted = False


def lift_later(state: State, clock: Clock) -> None:
    def lift() -> None:
        state.lifted = True

    clock.call_at(three_seconds_from_now(clock), lift)


class Fetched(Robot):
    """Its flag is set by another node."""

    fetched = False

    async def go(self, _: String) -> None:
        while not self.fetched:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        self.fetched = True

    def others(self) -> Sequence[Node]:
        return [Fetcher(self)]


class Fetcher(Node):
    def __init__(self, robot: Fetched) -> None:
        super().__init__()
        self.robot = robot

    @timer(3.0)
    async def fetch(self) -> None:
        self.robot.fetched = True


class Told(Driver):
    """Its method is called by another node."""

    def tell(self) -> None:
        self.there = True

    async def arrive(self, _: String) -> None:
        self.tell()

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.tell())]


class ToldByAnother(Told):
    def others(self) -> Sequence[Node]:
        return [Teller(self)]


class Teller(Node):
    def __init__(self, robot: Told) -> None:
        super().__init__()
        self.robot = robot

    @timer(3.0)
    async def tell_it(self) -> None:
        self.robot.tell()


class Twin(Robot):
    """Each sets the other's flag."""

    freed = False
    twin: Twin

    async def go(self, _: String) -> None:
        while not self.freed:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        await self.clock.sleep(1.0)
        self.twin.freed = True

    def others(self) -> Sequence[Node]:
        self.twin = Twin("twin", remap=["go:=nothing"])
        self.twin.twin = self
        return [self.twin]


class TheParentSets(Driver):
    """The parent's handler is in no group, and the child's does what it did."""

    @timer(3.0)
    async def look(self) -> None:
        self.there = True

    async def arrive(self, _: String) -> None:
        self.there = False


class TheParentSetsStill(TheParentSets):
    async def look(self) -> None:
        await super().look()


class FilledThroughAView(Robot):
    """A task in no group writes to the same array by another name."""

    def __init__(self) -> None:
        super().__init__()
        self.ranges = np.zeros(8)
        self.middle = self.view_of_it()

    def view_of_it(self) -> Any:
        return self.ranges[2:6]

    async def go(self, _: String) -> None:
        while self.ranges.max() < 0.5:
            await self.clock.sleep(0.05)

    async def arrive(self, _: String) -> None:
        self.ranges[:] = 1.0

    @timer(3.0)
    def fill(self) -> None:
        self.middle[0] = 1.0


class FilledThroughAShape(FilledThroughAView):
    def view_of_it(self) -> Any:
        return self.ranges.reshape(2, 4)[0]


class FilledThroughAFunction(FilledThroughAView):
    def view_of_it(self) -> Any:
        return np.asarray(self.ranges)


class SetThroughAPart(Robot):
    """The same with a message."""

    def __init__(self) -> None:
        super().__init__()
        self.speed = Twist()
        self.ahead = self.speed.linear

    async def go(self, _: String) -> None:
        while self.speed.linear.x < 0.5:
            await self.clock.sleep(0.05)

    async def arrive(self, _: String) -> None:
        self.speed.linear.x = 1.0

    @timer(3.0)
    def push(self) -> None:
        self.ahead.x = 1.0


class SetByName(Robot):
    """By another class, which finds the attribute by a string."""

    is_clear = False

    async def go(self, _: String) -> None:
        while not self.is_clear:
            await self.clock.sleep(0.05)

    async def arrive(self, _: String) -> None:
        self.is_clear = True

    def others(self) -> Sequence[Node]:
        return [Clears(self)]


class Clears(Node):
    def __init__(self, robot: Robot) -> None:
        super().__init__("clears")
        self.robot = robot

    @timer(3.0)
    def clear(self) -> None:
        setattr(self.robot, "is_clear", True)  # noqa: B010


@pytest.mark.parametrize(
    "program",
    sample(
        [
            legal(FlagOfATask),
            legal(FlagOfALocalHandler),
            legal(FlagByAnotherName),
            legal(FlagThroughTheDictionary),
            legal(FlagByADecorator),
            legal(FlagByAFunctionPutThere),
            legal(FlagByWhatAssigningDoes),
            legal(FlagOfAPartner),
            pytest.param(FlagOfAChildWithoutSource, id="FlagOfAChildWithoutSource"),
            legal(FlagOfAParentWithoutSource),
            legal(FlagOfAParameter),
            legal(FilledThroughAView),
            legal(FilledThroughAShape),
            legal(FilledThroughAFunction),
            legal(SetThroughAPart),
            legal(SetByName),
            legal(EndsWithAStateGivenAway),
            legal(Fetched),
            legal(Told),
            legal(ToldByAnother),
            legal(Twin),
            legal(TheParentSets),
            legal(TheParentSetsStill),
        ]
    ),
)
async def test_a_program_that_goes_on(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """Nothing is ever said of it, though it waits for seconds while others of its group queue."""
    await goes_on(graph, caplog, program())

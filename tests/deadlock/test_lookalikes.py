"""Programs that look like deadlocks and go on: nothing is ever said of them."""

from __future__ import annotations

import asyncio
import functools
import threading
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from functools import partial
from time import monotonic_ns
from types import TracebackType
from typing import Any

import numpy as np
import pytest

from graphflow import (
    ActionClient,
    CallError,
    CallTimeout,
    Client,
    GoalCanceled,
    Group,
    Node,
    Param,
    ServerBusy,
    Subscription,
    action,
    service,
    subscription,
    task,
    timer,
)
from graphflow.executor.clock import Clock
from graphflow.interface import DeadlockPolicy, GroupChange, WhenFull
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.cases import sample
from tests.deadlock.cast import Caplog, Dialler, Driver, DrivesByPose, Planner, Promised, Robot, Waiter, reports, say
from tests.runtime.cast import Log


def in_three_seconds(do: Callable[[], Any]) -> Node:
    """Somebody outside who does something."""
    outside = Node("outside")
    outside.create_timer(3.0, do)
    return outside


def three_seconds_from_now(clock: Clock) -> int:
    return clock.monotonic_ns() + 3_000_000_000


class SetInNoGroup(Waiter):
    @timer(3.0)
    async def look(self) -> None:
        self.arrived.set()


class SetInAnotherGroup(Waiter):
    sense = Group(1)

    @timer(3.0, group=sense)
    async def look(self) -> None:
        self.arrived.set()


class SetByATimerOfItsOwnMaking(Waiter):
    def __init__(self) -> None:
        super().__init__()
        self.create_timer(3.0, self.look)

    async def look(self) -> None:
        self.arrived.set()


class SetByALambda(Waiter):
    def __init__(self) -> None:
        super().__init__()
        self.create_timer(3.0, lambda: self.arrived.set())


class SetByALocalFunction(Waiter):
    async def on_start(self) -> None:
        async def look() -> None:
            self.arrived.set()

        self.create_timer(3.0, look)


class SetByATask(Waiter):
    @task
    async def main(self) -> None:
        await self.clock.sleep(3.0)
        self.arrived.set()


class SetByWhatItSpawned(Waiter):
    async def toil(self) -> None:
        await self.clock.sleep(3.0)
        self.arrived.set()

    async def go(self, _: String) -> None:
        self.spawn(self.toil)
        await self.arrived.wait()


class SetByATaskOfItsOwn(SetByWhatItSpawned):
    async def go(self, _: String) -> None:
        self.toiling = asyncio.ensure_future(self.toil())
        await self.arrived.wait()


class SetByACallback(Waiter):
    async def go(self, _: String) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), self.arrived.set)
        await self.arrived.wait()


class SetByALambdaOfItsOwn(Waiter):
    async def go(self, _: String) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: self.arrived.set())
        await self.arrived.wait()


class SetByAnotherName(Waiter):
    """The event has a second name, by which a timer sets it."""

    def __init__(self) -> None:
        super().__init__()
        arrived = self.arrived = asyncio.Event()
        self.create_timer(3.0, arrived.set)


class FulfilledByAnotherName(Promised):
    async def go(self, _: String) -> None:
        promise = self.promise = asyncio.get_running_loop().create_future()
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: promise.set_result(None))
        await self.promise

    async def arrive(self, _: String) -> None:
        if not self.promise.done():
            self.promise.set_result(None)


class FulfilledByACallback(Promised):
    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        self.clock.call_at(three_seconds_from_now(self.clock), partial(self.promise.set_result, None))
        await self.promise

    async def arrive(self, _: String) -> None:
        if not self.promise.done():
            self.promise.set_result(None)


class SetByAMethodGivenAway(Waiter):
    def note_it(self) -> None:
        self.arrived.set()

    async def arrive(self, _: String) -> None:
        self.note_it()

    async def on_start(self) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), self.note_it)


class SetBesideTheWait(Waiter):
    async def go(self, _: String) -> None:
        waiting = asyncio.ensure_future(self.arrived.wait())
        resting = asyncio.ensure_future(self.clock.sleep(3.0))
        await asyncio.wait([waiting, resting], return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()


class Tracker:
    """Something that is given an event."""

    def __init__(self, event: asyncio.Event, clock: Clock) -> None:
        clock.call_at(three_seconds_from_now(clock), event.set)


class SetByAnObject(Waiter):
    async def go(self, _: String) -> None:
        self.tracker = Tracker(self.arrived, self.clock)
        await self.arrived.wait()


class SetByAFollower(Waiter):
    speed = Param(0.0)

    @speed.on_change
    async def speed_changed(self, old: float, new: float) -> None:
        self.arrived.set()

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.parameters.set({"speed": 1.0}))]


class SetByAFollowersHelper(SetByAFollower):
    def note_it(self) -> None:
        self.arrived.set()

    async def speed_changed(self, old: float, new: float) -> None:
        self.note_it()

    async def arrive(self, _: String) -> None:
        self.note_it()


class SetByACheck(Waiter):
    speed = Param(0.0)

    def note_it(self) -> None:
        self.arrived.set()

    @speed.check
    def check_speed(self, value: float) -> None:
        self.note_it()

    async def arrive(self, _: String) -> None:
        self.note_it()

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.parameters.set({"speed": 1.0}))]


class SetByAnEvent(Waiter):
    """By an event of a subscription's, which takes no slot."""

    def note_it(self) -> None:
        self.arrived.set()

    def noticed(self, event: Any) -> None:
        self.note_it()

    @subscription(String, "words", on_event=noticed)
    async def heard(self, message: String) -> None:
        """Take no notice."""

    async def arrive(self, _: String) -> None:
        self.note_it()

    def others(self) -> Sequence[Node]:
        outside = in_three_seconds(lambda: outside.create_publisher(String, "words"))
        return [outside]


class Distracted(Robot):
    """A call that lives, in no group, makes somebody look at what its other handlers do."""

    pong = Client(Empty, "pong")

    @service(Empty, "pong")
    async def on_pong(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.5)
        return Empty.Response()

    @subscription(String, "arrive")
    async def arrive(self, _: String) -> None:
        await self.pong.call(Empty.Request())


class SetByWhoPushesItOut(Distracted):
    """Newer work of the group cancels what waits for it."""

    latest = Group(1, "cancel_running")

    def __init__(self) -> None:
        super().__init__()
        self.fresh = asyncio.Event()

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.fresh.wait()

    @subscription(String, "words", group=latest)
    async def heard(self, _: String) -> None:
        self.fresh.set()

    def others(self) -> Sequence[Node]:
        outside = Node("outside")
        speaker = outside.create_publisher(String, "words")
        outside.create_timer(3.0, lambda: speaker.publish(String()))
        return [outside]


class SetInTheGroupItHasLeft(Distracted):
    """Nobody holds the slot that what sets it will need."""

    def __init__(self) -> None:
        super().__init__()
        self.told = asyncio.Event()

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.told.wait()

    @subscription(String, "words", group=Robot.motion)
    async def heard(self, _: String) -> None:
        self.told.set()

    def others(self) -> Sequence[Node]:
        outside = Node("outside")
        speaker = outside.create_publisher(String, "words")
        outside.create_timer(3.0, lambda: speaker.publish(String()))
        return [outside]


class SetByWhoHasLeft(Waiter):
    """A handler of the group is under way that sets it, without a slot."""

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.clock.sleep(3.0)
            self.arrived.set()

    async def arrive(self, _: String) -> None:
        await self.arrived.wait()


class WaitsWithoutItsSlot(Waiter):
    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.arrived.wait()

    async def arrive(self, _: String) -> None:
        await self.clock.sleep(1.5)
        self.arrived.set()


class SetWithinALargerGroup(Waiter):
    pair = Group(2)

    @subscription(String, "go", group=pair)
    async def go(self, _: String) -> None:
        await self.clock.sleep(3.0)
        self.arrived.set()

    @subscription(String, "arrive", group=pair)
    async def arrive(self, _: String) -> None:
        await self.arrived.wait()


class CallsIntoAFullPair(Robot):
    """One of the two slots that its call needs is its own, the other is somebody's who will give it back."""

    pair = Group(2)
    pung = Client(Empty, "pung")

    @service(Empty, "pung", group=pair)
    async def on_pung(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @subscription(String, "go", group=pair)
    async def rest(self, _: String) -> None:
        await self.clock.sleep(2.5)

    @subscription(String, "arrive", group=pair)
    async def arrive(self, _: String) -> None:
        await self.pung.call(Empty.Request())


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


class LockOfAPartner(Driver):
    """One part of a `gather` releases what the other waits for."""

    pause = 1.5

    def __init__(self) -> None:
        super().__init__()
        self.wheel = asyncio.Lock()

    async def steer(self) -> None:
        await self.wheel.acquire()
        await self.clock.sleep(self.pause)
        self.wheel.release()

    async def go(self, _: String) -> None:
        await asyncio.gather(self.steer(), self.steer())


class LockOfOneLeftBehind(LockOfAPartner):
    """The `gather` is over, since one has failed; the other goes on."""

    pause = 3.0

    async def slip(self) -> None:
        raise ValueError

    async def go(self, _: String) -> None:
        with suppress(ValueError):
            await asyncio.gather(self.steer(), self.slip())
        await self.wheel.acquire()
        self.wheel.release()


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


class LooksInBetween(Waiter):
    """It never waits for long before it looks itself."""

    looks = 0

    def look(self) -> None:
        self.looks += 1
        if self.looks > 30:
            self.arrived.set()

    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            self.look()
            with suppress(TimeoutError):
                async with self.clock.timeout(0.1):
                    await self.arrived.wait()


class Within:
    """A timeout of the user's own making."""

    def __init__(self, clock: Clock) -> None:
        self._timeout = clock.timeout(0.1)

    async def __aenter__(self) -> None:
        await self._timeout.__aenter__()

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._timeout.__aexit__(kind, error, trace)


class LooksInBetweenByItsOwnTimeout(LooksInBetween):
    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            self.look()
            with suppress(TimeoutError):
                async with Within(self.clock):
                    await self.arrived.wait()


@asynccontextmanager
async def within(clock: Clock) -> AsyncIterator[None]:
    async with clock.timeout(0.1):
        yield


class LooksInBetweenByAGenerator(LooksInBetween):
    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            self.look()
            with suppress(TimeoutError):
                async with within(self.clock):
                    await self.arrived.wait()


class LooksInBetweenByAStack(LooksInBetween):
    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            self.look()
            with suppress(TimeoutError):
                async with AsyncExitStack() as stack:
                    await stack.enter_async_context(self.clock.timeout(0.1))
                    await self.arrived.wait()


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


class ShieldsInATask(Robot):
    """The task waits for what it shields, and not for itself."""

    async def go(self, _: String) -> None:
        await self.clock.sleep(3.0)

    @task
    async def work(self) -> None:
        await asyncio.shield(asyncio.ensure_future(self.clock.sleep(4.0)))


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


class EndsWithAGoal(Robot):
    """The state of a goal changes without anybody assigning it."""

    plan = ActionClient(Fibonacci, "plan")
    trip: Any = None

    @action(Fibonacci, "plan")
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.clock.sleep(3.0)
        return Fibonacci.Result()

    async def go(self, _: String) -> None:
        self.trip = await self.plan.send_goal(Fibonacci.Goal(order=1))
        while not self.trip.done:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        await self.trip.cancel()


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


class PollsWhatAnotherCancels(Dialler):
    """It ends with an error, which is an end."""

    async def go(self, _: String) -> None:
        self.asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        while not self.asking.done():
            await self.clock.sleep(0.05)

    @timer(3.0)
    def give_up(self) -> None:
        self.asking.cancel()


class PollsWhatItGaveAway(Dialler):
    def __init__(self) -> None:
        super().__init__()
        self.begun: list[asyncio.Task[Any]] = []

    async def go(self, _: String) -> None:
        asking = asyncio.create_task(self.ping.call(Empty.Request()))
        self.begun.append(asking)
        while not asking.done():
            await self.clock.sleep(0.05)

    @timer(3.0)
    def give_up(self) -> None:
        for asking in self.begun:
            asking.cancel()


class PollsUntilItIsReplaced(Dialler):
    task_of_go: asyncio.Task[Any] | None = None

    async def go(self, _: String) -> None:
        self.task_of_go = asyncio.create_task(self.ping.call(Empty.Request()))
        while self.task_of_go and not self.task_of_go.done():
            await self.clock.sleep(0.05)

    @timer(3.0)
    def give_up(self) -> None:
        self.task_of_go = None


class PollsWhatTakesItsTime(Dialler):
    async def go(self, _: String) -> None:
        walking = asyncio.create_task(self.clock.sleep(3.0))
        while not walking.done():
            await self.clock.sleep(0.05)


class PollsTheFirstOfTwo(Dialler):
    """One of them is never answered, which does not matter."""

    async def go(self, _: String) -> None:
        asking = [asyncio.create_task(client.call(Empty.Request())) for client in (self.ping, self.pong)]
        while not any(each.done() for each in asking):
            await self.clock.sleep(0.1)
        await self.clock.sleep(2.0)
        for each in asking:
            each.cancel()


class PollsAndCancels(Dialler):
    """Counts, and loses patience."""

    async def go(self, _: String) -> None:
        asking = asyncio.create_task(self.ping.call(Empty.Request()))
        turns = 0
        while not asking.done():
            turns += 1
            if turns == 30:
                asking.cancel()
            await self.clock.sleep(0.1)


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


class CancelsItsTaskFromOutside(Dialler):
    """A handler in no group ends the wait."""

    calling: asyncio.Task[Any] | None = None

    async def go(self, _: String) -> None:
        self.calling = asyncio.create_task(self.ping.call(Empty.Request()))
        with suppress(asyncio.CancelledError):
            await self.calling

    @timer(3.0)
    def lose_patience(self) -> None:
        if self.calling is not None:
            self.calling.cancel()


class CancelsItsGoalFromOutside(Planner):
    errand: Any = None

    async def go(self, _: String) -> None:
        self.errand = await self.plan.send_goal(Fibonacci.Goal(order=1))
        with suppress(GoalCanceled):
            await self.errand.result()

    @timer(3.0)
    async def lose_patience(self) -> None:
        if self.errand is not None and not self.errand.done:
            await self.errand.cancel()


class CancelsWhateverItHasBegun(Dialler):
    def __init__(self) -> None:
        super().__init__()
        self.calls: dict[int, asyncio.Task[Any]] = {}

    async def go(self, _: String) -> None:
        self.calls[1] = asyncio.create_task(self.ping.call(Empty.Request()))
        with suppress(asyncio.CancelledError):
            await self.calls[1]

    @timer(3.0)
    def lose_patience(self) -> None:
        for call in self.calls.values():
            call.cancel()


class PushesItselfOut(Robot):
    """The call that comes back is newer work of a group that cancels for it."""

    latest = Group(1, "cancel_running")
    there = Client(Empty, "there")

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.there.call(Empty.Request(), timeout=None)

    @service(Empty, "back", group=latest)
    async def on_back(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


def legal(program: type[Robot]) -> Any:
    return pytest.param(program, id=program.__name__)


@pytest.mark.parametrize(
    "program",
    sample(
        [
            legal(SetInNoGroup),
            legal(SetInAnotherGroup),
            legal(SetByATimerOfItsOwnMaking),
            legal(SetByALambda),
            legal(SetByALocalFunction),
            legal(SetByATask),
            legal(SetByWhatItSpawned),
            legal(SetByATaskOfItsOwn),
            legal(SetByACallback),
            legal(SetByALambdaOfItsOwn),
            legal(SetByAnotherName),
            legal(FulfilledByAnotherName),
            legal(FulfilledByACallback),
            legal(SetByAMethodGivenAway),
            legal(SetBesideTheWait),
            legal(SetByAnObject),
            legal(SetByAFollower),
            legal(SetByAFollowersHelper),
            legal(SetByACheck),
            legal(SetByAnEvent),
            legal(SetByWhoPushesItOut),
            legal(SetByWhoHasLeft),
            legal(WaitsWithoutItsSlot),
            legal(SetInTheGroupItHasLeft),
            legal(SetWithinALargerGroup),
            legal(CallsIntoAFullPair),
            legal(FlagOfATask),
            legal(FlagOfALocalHandler),
            legal(FlagByAnotherName),
            legal(FlagThroughTheDictionary),
            legal(FlagByADecorator),
            legal(FlagByAFunctionPutThere),
            legal(FlagByWhatAssigningDoes),
            legal(FlagOfAPartner),
            legal(LockOfAPartner),
            legal(LockOfOneLeftBehind),
            pytest.param(FlagOfAChildWithoutSource, id="FlagOfAChildWithoutSource"),
            legal(FlagOfAParentWithoutSource),
            legal(FlagOfAParameter),
            legal(LooksItself),
            legal(LooksInBetween),
            legal(LooksInBetweenByItsOwnTimeout),
            legal(LooksInBetweenByAGenerator),
            legal(LooksInBetweenByAStack),
            legal(StepsItself),
            legal(EndsAtATime),
            legal(PollsWhatAnotherCancels),
            legal(PollsWhatItGaveAway),
            legal(PollsUntilItIsReplaced),
            legal(PollsWhatTakesItsTime),
            legal(PollsTheFirstOfTwo),
            legal(PollsAndCancels),
            legal(FilledThroughAView),
            legal(FilledThroughAShape),
            legal(FilledThroughAFunction),
            legal(SetThroughAPart),
            legal(SetByName),
            legal(CancelsItsTaskFromOutside),
            legal(CancelsItsGoalFromOutside),
            legal(CancelsWhateverItHasBegun),
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
            legal(ShieldsInATask),
            legal(EndsWithItsGenerator),
            legal(EndsWithAMessage),
            legal(EndsWithAGoal),
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
    graph.deadlock = "report"
    robot = program()
    await graph.start(robot, *robot.others())
    await say(graph, "/go", "/arrive", "/arrive")
    for _ in range(20):
        await graph.clock.advance(0.1)
    assert any(runner.active for runner in core_of(robot).runners)
    for _ in range(30):
        await graph.clock.advance(0.1)

    assert reports(caplog) == []
    assert not any(runner.active for runner in core_of(robot).runners)
    assert "Error" not in caplog.text


class Threaded(Waiter):
    """Waits for a thread, which the test holds up."""

    is_up = False

    def __init__(self) -> None:
        super().__init__()
        self.hold = threading.Event()

    def lift(self) -> None:
        assert self.hold.wait(10.0)
        self.is_up = True

    def lift_and_tell(self) -> None:
        self.lift()
        self.context.loop.call_soon_threadsafe(self.arrived.set)


class SetByAThread(Threaded):
    async def go(self, _: String) -> None:
        threading.Thread(target=self.lift_and_tell, daemon=True).start()
        await self.arrived.wait()


class SetByWhatIsOffloaded(Threaded):
    async def go(self, _: String) -> None:
        while not self.is_up:
            await self.offload(self.lift)


class SetByWhatAsyncioOffloads(Threaded):
    async def go(self, _: String) -> None:
        while not self.is_up:
            await asyncio.to_thread(self.lift)


@pytest.mark.parametrize(
    "program",
    [legal(SetByAThread), legal(SetByWhatIsOffloaded), legal(SetByWhatAsyncioOffloads)],
)
async def test_a_program_that_waits_for_a_thread(graph: Graph, caplog: Caplog, program: type[Threaded]) -> None:
    """A thread may end any wait."""
    graph.deadlock, graph.waits_outside = "report", False
    robot = program()
    await graph.start(robot)
    await say(graph, "/go", "/arrive")
    try:
        await graph.clock.advance(5.0)
        assert robot.motion.running
    finally:
        robot.hold.set()
    while robot.motion.running:
        await asyncio.sleep(0.001)

    assert reports(caplog) == []


class CallsWithoutItsSlot(Dialler):
    async def go(self, _: String) -> None:
        async with self.group.released():
            await self.ping.call(Empty.Request())


@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_call_with_the_slot_released(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """It is answered, and the handler comes back."""
    graph.deadlock = policy
    robot = CallsWithoutItsSlot()
    await graph.start(robot)
    await say(graph, "/go")
    await graph.clock.advance(1.0)

    assert robot.statistics()["service /ping"]["runs"] == 1
    assert robot.motion.running == 0
    assert reports(caplog) == []


@pytest.mark.parametrize(
    ("when_full", "outcome"), [("drop_new", ServerBusy), ("cancel_running", asyncio.CancelledError)]
)
@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_call_into_its_own_group_that_does_not_queue(
    graph: Graph, caplog: Caplog, when_full: WhenFull, outcome: type[BaseException], policy: DeadlockPolicy
) -> None:
    """The call is refused, or the caller makes room for it: either way nobody is stuck."""
    graph.deadlock = policy
    outcomes = Log()

    class Cautious(Dialler):
        async def go(self, _: String) -> None:
            try:
                await self.ping.call(Empty.Request())
            except BaseException as error:
                outcomes(type(error))
                raise

    robot = Cautious(concurrency={"motion": GroupChange(when_full=when_full)})
    await graph.start(robot)
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    assert outcomes == [outcome]
    assert robot.motion.running == 0
    assert reports(caplog) == []


class GivesUp(Node):
    """Waits a second for an answer, and then does something else, in the group that the answer needs."""

    work = Group(1)
    inspect = Client(Empty, "inspect")

    @subscription(String, "go", group=work)
    async def ask(self, _: String) -> None:
        try:
            await self.inspect.call(Empty.Request(), timeout=1.0)
        except CallTimeout:
            await self.clock.sleep(3.0)

    @service(Empty, "answer", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


class Inspector(Node):
    """Takes two seconds before it asks back."""

    answer = Client(Empty, "answer")

    def __init__(self) -> None:
        super().__init__()
        self.outcomes = Log()

    @service(Empty, "inspect")
    async def on_inspect(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.0)
        try:
            self.outcomes(await self.answer.call(Empty.Request()))
        except CallError as error:
            self.outcomes(type(error))
        return Empty.Response()


@pytest.mark.parametrize(
    "policy",
    [
        "report",
        "raise",
    ],
)
async def test_a_caller_that_has_given_up(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """What was called for it may call it: it waits no more, and will give its slot back."""
    graph.deadlock = policy
    inspector = Inspector()
    await graph.start(GivesUp(), inspector)
    await say(graph, "/go")
    await graph.clock.advance(6.0)

    assert inspector.outcomes == [Empty.Response()]
    assert reports(caplog) == []


class TakesTheFirstFuture(Dialler):
    """One of two is dead, and the test ends the other."""

    def __init__(self) -> None:
        super().__init__()
        self.living: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    async def go(self, _: String) -> None:
        asking: asyncio.Future[Any] = asyncio.ensure_future(self.ping.call(Empty.Request()))
        await asyncio.wait([asking, self.living], return_when=asyncio.FIRST_COMPLETED)
        asking.cancel()


class GathersAFuture(TakesTheFirstFuture):
    async def go(self, _: String) -> None:
        asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        try:
            await asyncio.gather(asking, self.living)
        finally:
            asking.cancel()


@pytest.mark.parametrize(
    "program",
    [legal(TakesTheFirstFuture), legal(GathersAFuture)],
)
async def test_what_is_about_to_go_on(graph: Graph, program: type[TakesTheFirstFuture]) -> None:
    """A wait that is over is none, though its handler has not had its turn of the loop yet."""
    graph.deadlock = "report"
    robot = program()
    await graph.start(robot)
    await say(graph, "/go")
    if program is GathersAFuture:
        robot.living.set_exception(ValueError())
    else:
        robot.living.set_result(None)
    for _ in range(5):
        picture = robot.context.search.snapshot.take()
        assert explained(picture, deadlocked(picture)) == []
        await asyncio.sleep(0)
    assert robot.motion.running == 0


class AsksBack(Node):
    back = Client(Empty, "back")

    @service(Empty, "there")
    async def on_there(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(3.0)
        return await self.back.call(Empty.Request(), timeout=None)


async def test_a_call_that_comes_back_and_cancels_who_waits_for_it(graph: Graph, caplog: Caplog) -> None:
    """With the policy that fails hopeless calls: this one is not."""
    graph.deadlock = "raise"
    robot = PushesItselfOut()
    await graph.start(robot, AsksBack("other"))
    await say(graph, "/go")
    await graph.clock.advance(4.0)

    assert reports(caplog) == []
    assert "Error" not in caplog.text
    assert not any(runner.active for runner in core_of(robot).runners)


class AlsoServes(Node):
    """Another server of the service."""

    @service(Empty, "ping")
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.0)
        return Empty.Response()


class CallsOneOfTwo(Dialler):
    async def go(self, _: String) -> None:
        await self.ping.call(Empty.Request())


@pytest.mark.parametrize("policy", ["raise", "report"])
async def test_a_call_that_another_server_answers(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """One of the two needs a slot that the caller holds."""
    graph.deadlock = policy
    robot = CallsOneOfTwo()
    await graph.start(robot, AlsoServes("other"))
    await say(graph, "/go")
    await graph.clock.advance(3.0)

    assert reports(caplog) == []
    assert "Error" not in caplog.text
    assert not robot.motion.running

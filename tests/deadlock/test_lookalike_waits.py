"""Programs that wait for an event, a future, a lock or a thread, look deadlocked and go on: nothing is said of them."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator, Sequence
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from functools import partial
from types import TracebackType
from typing import Any

import pytest

from graphflow import Client, Group, Node, Param, service, subscription, task, timer
from graphflow.executor.clock import Clock
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from tests.cases import sample, slow
from tests.deadlock.cast import Caplog, Driver, Promised, Robot, Waiter, reports, say
from tests.deadlock.lookalikes import goes_on, in_three_seconds, legal, three_seconds_from_now
from tests.until import eventually


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


class ShieldsInATask(Robot):
    """The task waits for what it shields, and not for itself."""

    async def go(self, _: String) -> None:
        await self.clock.sleep(3.0)

    @task
    async def work(self) -> None:
        await asyncio.shield(asyncio.ensure_future(self.clock.sleep(4.0)))


@slow
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
            legal(LockOfAPartner),
            legal(LockOfOneLeftBehind),
            legal(LooksInBetween),
            legal(LooksInBetweenByItsOwnTimeout),
            legal(LooksInBetweenByAGenerator),
            legal(LooksInBetweenByAStack),
            legal(ShieldsInATask),
        ]
    ),
)
async def test_a_program_that_goes_on(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """Nothing is ever said of it, though it waits for seconds while others of its group queue."""
    await goes_on(graph, caplog, program())


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
    await eventually(lambda: not robot.motion.running)

    assert reports(caplog) == []

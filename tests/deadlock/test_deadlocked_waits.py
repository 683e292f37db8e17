"""Programs that wait in vain for an event, a queue, a future or a lock: each is explained, with the right line."""

from __future__ import annotations

import asyncio
import threading
from contextlib import suppress

import pytest

from graphflow import Group, Node, subscription, task, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.cases import sample, slow
from tests.deadlock.cast import Caplog, EventWithin, Promised, Robot, Waiter, at, in_vain, reports, say, the_report
from tests.deadlock.deadlocked import Stuck, cannot_go_on, stuck
from tests.flat import flat


class EventWaitedFor(Waiter):
    async def go(self, _: String) -> None:
        await asyncio.wait_for(self.arrived.wait(), 60.0)  # stuck: EventWaitedFor


class EventTriedFor(Waiter):
    async def go(self, _: String) -> None:
        for _attempt in range(3):
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self.arrived.wait(), 30.0)  # stuck: EventTriedFor


class EventGathered(Waiter):
    async def go(self, _: String) -> None:
        await asyncio.gather(self.arrived.wait(), self.clock.sleep(60.0))  # stuck: EventGathered


class EventPolled(Waiter):
    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            await self.clock.sleep(0.05)  # stuck: EventPolled


class EventOfTheNextMessage(Waiter):
    """The handler sets it itself, at its second message, which its first run does not let in."""

    heard = 0

    async def go(self, _: String) -> None:
        """Be quick."""

    async def arrive(self, _: String) -> None:
        self.heard += 1
        if self.heard == 2:
            self.arrived.set()
        await self.arrived.wait()  # stuck: EventOfTheNextMessage


class Eater(Robot):
    """Waits at a queue that another handler of the group fills."""

    def __init__(self) -> None:
        super().__init__()
        self.words = asyncio.Queue[String]()

    async def go(self, _: String) -> None:
        await self.words.get()  # stuck: Eater

    async def arrive(self, message: String) -> None:
        self.words.put_nowait(message)


class QueuePolled(Eater):
    async def go(self, _: String) -> None:
        while self.words.empty():
            await self.clock.sleep(0.05)  # stuck: QueuePolled


class Feeder(Robot):
    """Waits at a full queue that another handler of the group empties."""

    def __init__(self) -> None:
        super().__init__()
        self.plates: asyncio.Queue[String] = asyncio.Queue(1)

    async def go(self, message: String) -> None:
        await self.plates.put(message)
        await self.plates.put(message)  # stuck: Feeder

    async def arrive(self, _: String) -> None:
        self.plates.get_nowait()


class PermitsTwiceInEach(Robot):
    """Each of two parts takes one of two permits, and then wants another."""

    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(2)

    async def part(self) -> None:
        async with self.permits:
            await self.clock.sleep(0.1)
            async with self.permits:  # stuck: PermitsTwiceInEach
                pass

    async def go(self, _: String) -> None:
        await asyncio.gather(self.part(), self.part())


class PermitsInTime(PermitsTwiceInEach):
    async def go(self, _: String) -> None:
        async with self.clock.timeout(5.0), asyncio.TaskGroup() as group:
            group.create_task(self.part())
            group.create_task(self.part())


class PermitsInTurn(PermitsTwiceInEach):
    """There is one more than are held."""

    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(3)


@slow
@pytest.mark.parametrize(
    ("program", "words"),
    [
        (PermitsTwiceInEach, "LIKELY DEADLOCK: task part of /robot waits for self.permits, which it holds itself;"),
        (PermitsInTime, "WAITS IN VAIN: task part of /robot waits for self.permits, which it holds itself,"),
        (PermitsInTurn, ""),
    ],
)
async def test_the_parts_of_a_gather(graph: Graph, caplog: Caplog, program: type[Robot], words: str) -> None:
    """Each holds for itself what it has entered."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    texts = [*reports(caplog), *in_vain(caplog)]
    assert len(texts) == bool(words)
    for told in map(flat, texts):
        assert told.startswith(words)
        assert f"waits for self.permits {at('stuck: PermitsTwiceInEach')}part, for" in told
        assert "behind them: subscription go of /robot" in told


class PermitsAcquiredTwice(PermitsTwiceInEach):
    """The same by hand."""

    async def part(self) -> None:
        await self.permits.acquire()
        await self.clock.sleep(0.1)
        await self.permits.acquire()  # stuck: PermitsAcquiredTwice
        self.permits.release()
        self.permits.release()


class LockAcquiredTwice(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.bar = asyncio.Lock()

    async def part(self) -> None:
        await self.bar.acquire()
        await self.bar.acquire()  # stuck: LockAcquiredTwice
        self.bar.release()
        self.bar.release()

    async def go(self, _: String) -> None:
        await asyncio.gather(*(self.part() for _ in range(2)))


@slow
@pytest.mark.parametrize("program", [PermitsAcquiredTwice, LockAcquiredTwice])
async def test_parts_of_a_gather_that_only_release(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """What one of them holds is not to be seen; but all that could release it stand still."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    told = flat(the_report(caplog))
    assert told.startswith("LIKELY DEADLOCK: subscription go of /robot waits for self.")
    assert f"task part of /robot {at(f'stuck: {program.__name__}')}part, for" in told.replace("  ", " ")


class SemaphoreAcquired(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(0)

    async def go(self, _: String) -> None:
        await self.permits.acquire()  # stuck: SemaphoreAcquired

    async def arrive(self, _: String) -> None:
        self.permits.release()


class Notified(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.news = asyncio.Condition()
        self.has_news = False

    async def go(self, _: String) -> None:
        async with self.news:
            await self.news.wait()  # stuck: Notified

    async def arrive(self, _: String) -> None:
        async with self.news:
            self.has_news = True
            self.news.notify_all()


class NotifiedFor(Notified):
    async def go(self, _: String) -> None:
        async with self.news:
            await self.news.wait_for(lambda: self.has_news)  # stuck: NotifiedFor


class PromisedByAnotherName(Promised):
    async def go(self, _: String) -> None:
        promise = self.promise = asyncio.get_running_loop().create_future()
        await promise  # stuck: PromisedByAnotherName


class PromisedInTime(Promised):
    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        await asyncio.wait_for(self.promise, 60.0)  # stuck: PromisedInTime


class DropsNews(Waiter):
    """What sets the event is not even kept."""

    latest = Group(1, "drop_new")

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.arrived.wait()  # stuck: DropsNews

    @subscription(String, "arrive", group=latest)
    async def arrive(self, _: String) -> None:
        self.arrived.set()


class LocksTwice(Robot):
    """A lock is not to be had twice."""

    def __init__(self) -> None:
        super().__init__()
        self.latch = asyncio.Lock()

    async def go(self, _: String) -> None:
        async with self.latch:
            await self.halt()

    async def halt(self) -> None:
        async with self.latch:  # stuck: LocksTwice
            self.log.info("stopped")


class LocksCrosswise(Robot):
    """Two handlers take two locks, each the other one first."""

    def __init__(self) -> None:
        super().__init__()
        self.left, self.right = asyncio.Lock(), asyncio.Lock()

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        async with self.left:
            await self.clock.sleep(0.1)
            async with self.right:  # stuck: LocksCrosswise
                self.log.info("both")

    @subscription(String, "arrive")
    async def arrive(self, _: String) -> None:
        async with self.right:
            await self.clock.sleep(0.1)
            async with self.left:
                self.log.info("both")


class AwaitsAnswersById(Node):
    """A future for each request, in a dictionary; no other code that is read here ends a future."""

    node_name = "robot"
    motion = Group(1)

    def __init__(self) -> None:
        super().__init__()
        self.pending: dict[int, asyncio.Future[None]] = {}

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        self.pending[1] = asyncio.get_running_loop().create_future()
        await self.pending[1]  # stuck: AwaitsAnswersById

    @subscription(String, "arrive", group=motion)
    async def arrive(self, _: String) -> None:
        self.pending.pop(1).set_result(None)


class SleepsOnAThread(Robot):
    """Waits in a thread for an event that is set on the loop."""

    def __init__(self) -> None:
        super().__init__()
        self.alarm = threading.Event()

    async def go(self, _: String) -> None:
        await self.offload(self.alarm.wait)  # stuck: SleepsOnAThread

    async def arrive(self, _: String) -> None:
        self.alarm.set()

    async def on_shutdown(self) -> None:
        self.alarm.set()


class TriesAgain(Waiter):
    """Gives up each tenth of a second, to try again."""

    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            with suppress(TimeoutError):
                await asyncio.wait_for(self.arrived.wait(), 0.1)  # stuck: TriesAgain


@pytest.mark.parametrize(
    "case",
    sample(
        [
            stuck(Waiter, "self.arrived"),
            stuck(EventWithin, "self.arrived", verdict="WAITS IN VAIN"),
            stuck(EventWaitedFor, "self.arrived", verdict="WAITS IN VAIN"),
            stuck(EventTriedFor, "self.arrived", verdict="WAITS IN VAIN"),
            stuck(EventGathered, "self.arrived"),
            stuck(EventPolled, "self.arrived"),
            stuck(EventOfTheNextMessage, "self.arrived", holder="subscription arrive"),
            stuck(DropsNews, "self.arrived", group="latest"),
            stuck(Eater, "self.words"),
            stuck(QueuePolled, "self.words"),
            stuck(Feeder, "self.plates"),
            stuck(SemaphoreAcquired, "self.permits"),
            stuck(Notified, "self.news"),
            stuck(NotifiedFor, "self.news"),
            stuck(Promised, "self.promise"),
            stuck(PromisedByAnotherName, "self.promise"),
            stuck(PromisedInTime, "self.promise", verdict="WAITS IN VAIN"),
            stuck(LocksTwice, "self.latch", "subscription go"),
            stuck(LocksCrosswise, "self.right", "subscription arrive", "subscription go", ""),
            stuck(AwaitsAnswersById, "a part of self.pending"),
            stuck(SleepsOnAThread, "self.alarm"),
            stuck(TriesAgain, "self.arrived"),
        ]
    ),
)
async def test_a_program_that_cannot_go_on(graph: Graph, caplog: Caplog, case: Stuck) -> None:
    """It is told once, within a second: who holds what and waits where, for whom that cannot run."""
    await cannot_go_on(graph, caplog, case)


class OnlyTimers(Node):
    """In no group, and nothing is queued; but periods are skipped."""

    node_name = "robot"

    def __init__(self) -> None:
        super().__init__()
        self.left_hand, self.right_hand = asyncio.Lock(), asyncio.Lock()

    @timer(1.0)
    async def juggle(self) -> None:
        async with self.left_hand:
            await self.clock.sleep(0.3)
            async with self.right_hand:  # stuck: OnlyTimers
                self.log.info("juggled")

    @timer(1.0)
    async def clap(self) -> None:
        async with self.right_hand:
            await self.clock.sleep(0.3)
            async with self.left_hand:
                self.log.info("clapped")


async def test_timers_that_wait_for_each_other(graph: Graph, caplog: Caplog) -> None:
    """The next period makes somebody look."""
    graph.deadlock = "report"
    await graph.start(OnlyTimers())
    await graph.clock.advance(3.0)

    assert at("stuck: OnlyTimers") in the_report(caplog)


class OnlyTasks(Node):
    """Two tasks, each of which waits for what the other sets then; nobody calls, and nothing is queued."""

    node_name = "robot"

    def __init__(self) -> None:
        super().__init__()
        self.mapped, self.localized = asyncio.Event(), asyncio.Event()

    @task
    async def build(self) -> None:
        await self.clock.sleep(3.0)
        await self.localized.wait()  # stuck: OnlyTasks
        self.mapped.set()

    @task
    async def localize(self) -> None:
        await self.clock.sleep(5.0)
        await self.mapped.wait()
        self.localized.set()


async def test_tasks_that_wait_for_each_other(graph: Graph, caplog: Caplog) -> None:
    """Nobody need call for them to be looked at."""
    graph.deadlock = "report"
    await graph.start(OnlyTasks())
    await graph.clock.advance(5.0)
    assert reports(caplog) == []
    await graph.clock.advance(2.5)

    assert at("stuck: OnlyTasks") in the_report(caplog)


class SlotOfAnother(Waiter):
    """Comes back to its group to set what the handler waits for that has taken its place."""

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.clock.sleep(0.2)
        self.arrived.set()

    async def arrive(self, _: String) -> None:
        await self.arrived.wait()  # stuck: SlotOfAnother


async def test_a_run_that_cannot_come_back_to_its_group(graph: Graph, caplog: Caplog) -> None:
    """It is found without anything else that waits, and so is the handler that holds its slot."""
    graph.deadlock = "report"
    await graph.start(SlotOfAnother())
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(2.0)

    assert at("stuck: SlotOfAnother") in the_report(caplog)

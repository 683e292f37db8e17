"""Generated systems of real nodes under virtual time: what stands still for ever is reported, and nothing else.

A system is nodes in one or two processes with groups, services, actions, and what starts call trees through them. It
runs until nothing moves. What its handlers write into a `Diary` says who has never ended, who waits for whom, and who
took a step when: the truth that reports are held against, which is not read from graphflow's own account of waits.
"""

from __future__ import annotations

import asyncio
import logging
import re
from asyncio import CancelledError, Task
from collections import Counter
from collections.abc import Callable, Coroutine, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from random import Random
from typing import Any, Literal, NamedTuple

import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from graphflow import CallError, DeadlockError, GoalError, Group, Node
from graphflow.interface import DeadlockPolicy
from graphflow.machines.waits.explain import title
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.wait_graph import WaitGraph, joined
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints.timer import Timer
from graphflow.runtime.node_core import core_of
from graphflow.testing.simulation import LoopClock, World, simulate
from graphflow.transport.base import EARLY
from graphflow.transport.memory import MemorySession, Network
from tests.cases import cases, count, limit
from tests.flat import flat

CASES = count(few=15, full=300)
"""Systems that are tried."""
REPORTED_WITHIN = 1.5
"""Seconds from the last step of anybody in a ring to its report: a quarter of one, and two questions to others.

They are asked anew when one of several things that somebody waits for has come between the questions.
"""
SCATTER = 0.2
"""Seconds between the pictures that two processes take of themselves for one question, at most: some come late."""
STILL = 2.2
"""Seconds without a step after which nothing will move any more: longer than to leave a goal, and what is `pending`."""
BROKEN_WITHIN = 20.0
"""Seconds until a ring is broken, at most: processes that see each other's calls late disagree on the youngest."""

LOOK_EVERY = 0.41
"""Seconds between two pictures of all processes at one moment that the test takes itself."""
SAID_WITHIN = 9.0
"""Seconds until what is less urgent is said, at most: that a ring has cleared, and who waits behind one."""

# What is to be done


@dataclass(frozen=True, slots=True)
class Nap:
    """Wait for time to pass."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Fail:
    """Raise an error after a while."""

    after: float = 0.0


@dataclass(frozen=True, slots=True)
class Ask:
    """Call a service or send a goal; `steps` is what the handler does for it."""

    server: int
    steps: Steps = ()
    how: Literal["result", "block", "feedback"] = "result"
    """How the end of a goal is waited for; a block that is left cancels it."""
    timeout: float | None = None
    is_tolerant: bool = True
    """Go on when it fails."""


@dataclass(frozen=True, slots=True)
class Both:
    """Wait for all of them."""

    of: tuple[Work, ...]
    how: How = "gather"


@dataclass(frozen=True, slots=True)
class Either:
    """Wait for the first of them, and cancel the others."""

    of: tuple[Work, ...]


@dataclass(frozen=True, slots=True)
class Meet:
    """Wait for the end of a task of one's own node."""

    starter: int


How = Literal["gather", "group", "wait", "gather errors"]
"""The latter two wait for those who are left when one has failed."""
Work = Nap | Fail | Ask | Both | Either | Meet


@dataclass(frozen=True, slots=True)
class Step:
    """What a handler waits for at one time."""

    work: Work
    is_released: bool = False
    """Without its slot, which it takes again afterwards."""
    limit: float | None = None
    """It gives up after so many seconds, and goes on."""


Steps = tuple[Step, ...]


class Place(NamedTuple):
    """Where a handler is: a node, and one of the system's groups or none."""

    node: int
    group: int | None


@dataclass(frozen=True, slots=True)
class Server:
    """A service, or an action by its policy."""

    place: Place
    kind: Literal["service", "queue", "parallel"]

    @property
    def is_action(self) -> bool:
        return self.kind != "service"


@dataclass(frozen=True, slots=True)
class Starter:
    """Begins a call tree, once or twice."""

    place: Place
    kind: Literal["timer", "subscription", "task"]
    after: float
    times: int
    steps: Steps


@dataclass(frozen=True, slots=True)
class System:
    """Nodes before their start."""

    processes: tuple[int, ...]
    """By node."""
    groups: tuple[tuple[int, int], ...]
    """Node and limit of each."""
    replies: tuple[int | None, ...]
    """By node: the group in which answers to its calls are delivered, as in ROS 2."""
    servers: tuple[Server, ...]
    starters: tuple[Starter, ...]
    delay: float = 0.0
    """Seconds that something takes on the network, at most."""
    have_handlers: bool = True
    """Whether every node has a handler besides."""


def slots(place: Place, own: str, kind: str) -> list[str]:
    """The slots that a run of a handler takes: of its group, and the one for which it queues behind itself."""
    group = [] if place.group is None or kind == "task" else [f"group{place.group}"]
    is_alone = kind == "queue" or (place.group is None and kind not in ("parallel", "task"))
    return [*group, own] if is_alone else group


# What has been done


@dataclass(eq=False, slots=True)
class Life:
    """A run of a handler, or a task."""

    id: str
    """As in pictures of waits."""
    holds: set[str]
    """Slots that it has."""
    serves: int
    """The request that it is for; 0 for none."""
    wants: str = ""
    """The slot that it waits to take again."""
    does: Step | None = None
    asks: set[int] = field(default_factory=set)
    """Requests that it waits for."""
    meets: list[int] = field(default_factory=list)
    """Tasks that it waits for, by their starters."""
    moves: list[int] = field(default_factory=list)
    """When it went on, as the diary counts."""
    is_over: bool = False


class Request(NamedTuple):
    ask: Ask
    by: Life
    is_direct: bool
    """It is awaited in the handler's own body and not in a task."""
    replies: str
    """The slot that its answer needs, if any."""


class Report(NamedTuple):
    when: int
    ring: frozenset[str]
    text: str

    @property
    def is_partial(self) -> bool:
        return "(unless something else" in self.text


FORESEEN = re.compile("Mishap|TaskGroup")
"""Errors that are meant to happen."""
STUMBLED = re.compile("LIKELY DEADLOCK|the search for deadlocks|a snapshot of waits that cannot be read")
"""What is not meant to be said, at whatever level."""


def dead(picture: WaitGraph) -> set[str]:
    """Who is dead of those that users have written."""
    return {name for name in deadlocked(picture) if not picture.activities[name].is_inner}


class Diary(logging.Handler):
    """What happened in one system, in order: everything that is written down has its time, and counts up."""

    def __init__(self, system: System) -> None:
        super().__init__(logging.DEBUG)
        self.system = system
        self.contexts: list[Context] = []
        self.breaks = False
        """Whether calls of rings are ended."""
        self.times: list[float] = []
        self.lives: dict[str, Life] = {}
        self.requests: dict[int, Request] = {}
        self.served: dict[int, Life] = {}
        self.tasks: dict[int, Life] = {}
        """By their starters."""
        self.pending = 0
        """Naps, and limits that may end a wait."""
        self.given_up: list[int] = []
        """When a limit, a cancellation or the policy `break` ended something."""
        self.failed: list[int] = []
        """When an error did."""
        self.refused = 0
        """Calls that ended with DeadlockError."""
        self.reports: list[Report] = []
        self.looks: list[Report] = []
        """Who was dead in pictures that the test has taken."""
        self.behind: list[str] = []
        """Who was said to wait for a ring after its report."""
        self.cleared = 0
        """Reports that were taken back."""
        self.stumbled: list[str] = []
        """What was logged and should not have been."""

    def write(self) -> int:
        self.times.append(asyncio.get_running_loop().time())
        return len(self.times) - 1

    def emit(self, record: logging.LogRecord) -> None:
        text = record.getMessage()
        if text.startswith("DEADLOCK"):
            known = {report.ring for report in self.reports}
            told = [(r, report.text) for c in self.contexts for r, report in c.search.reports.items()]
            is_again = text.startswith("DEADLOCK again")
            new = [(ring, whole) for ring, whole in told if whole == text or (is_again and ring not in known)]
            self.reports += [Report(self.write(), ring, whole) for ring, whole in new]
        elif text.startswith("the deadlock of ") and text.endswith(" has cleared"):
            self.cleared += 1
        elif " waits behind the deadlock of " in text:
            self.behind.append(text)
        elif STUMBLED.match(text) or (record.levelno >= logging.ERROR and not FORESEEN.search(text)):
            self.stumbled.append(text)

    def begin(self, context: Context, taken: Iterable[str], serves: int) -> Life:
        """The running task begins to live."""
        me: Any = asyncio.current_task()
        name = f"t{context.search.snapshot.number_of(me)}" if isinstance(me, Task) else me.number
        life = self.lives[f"{context.session.zid}:{name}"] = Life(f"{context.session.zid}:{name}", set(taken), serves)
        if serves:
            self.served[serves] = life
        life.moves.append(self.write())
        return life

    def picture(self) -> WaitGraph:
        """Of all processes, at one moment."""
        return joined([context.search.snapshot.take() for context in self.contexts])

    def look(self) -> None:
        """Note who is dead now; a report of its own, which something that fails may end."""
        now = len(self.times) - 1
        if self.times and (not self.looks or self.looks[-1].when != now):
            self.looks.append(Report(now, frozenset(dead(self.picture())), "(unless something else fails)"))

    # who waits for whom, once nothing moves

    def standing(self) -> list[frozenset[str]]:
        """The rings that are reported and have not cleared."""
        return [ring for context in self.contexts for ring in context.search.reports]

    def stuck(self) -> list[Life]:
        return [life for life in self.lives.values() if not life.is_over]

    def needs(self, server: int) -> list[str]:
        return slots(self.system.servers[server].place, f"server{server}", self.system.servers[server].kind)

    def limit(self, slot: str) -> int:
        return self.system.groups[int(slot[5:])][1] if slot.startswith("group") else 1

    def holders(self, slot: str) -> set[Life]:
        """Those who hold all slots of a group; nobody when one is free."""
        found = {life for life in self.lives.values() if slot in life.holds}
        return found if len(found) >= self.limit(slot) else set()

    def missing(self, life: Life) -> Iterator[str]:
        """The slots without which somebody does not go on."""
        if life.wants:
            yield life.wants
        for number in life.asks:
            request = self.requests[number]
            if number not in self.served:
                yield from self.needs(request.ask.server)
            elif self.served[number].is_over and request.replies:
                yield request.replies

    def edges(self, life: Life) -> set[Life]:
        servers = {self.served[number] for number in life.asks if number in self.served}
        tasks = {self.tasks[number] for number in life.meets}
        return {o for o in servers | tasks if not o.is_over}.union(*map(self.holders, self.missing(life)))

    def before(self, life: Life) -> set[Life]:
        """Who has to go on before somebody does, himself included if he waits for himself."""
        found: set[Life] = set()
        todo = [life]
        while todo:
            new = self.edges(todo.pop()) - found
            found |= new
            todo += new
        return found

    def deadlocks(self) -> list[set[Life]]:
        """Those who wait for each other and for nobody else: the least that has to be reported."""
        reached = {life: self.before(life) for life in self.stuck()}
        assert all(reached.values()), "somebody waits for nothing"
        found = [reach for life, reach in reached.items() if all(life in reached[other] for other in reach)]
        return [reach for i, reach in enumerate(found) if reach not in found[:i]]

    def last_move(self, life: Life) -> int:
        """When it began to wait as it does, or the answers came that wait for a slot."""
        return max(life.moves[-1], *(self.served[i].moves[-1] for i in life.asks if i in self.served), 0)

    def hopeless(self) -> list[int]:
        """Calls whose server's group is full of those who wait, directly or through each other, for them."""
        found = []
        for number, request in self.requests.items():
            server = request.ask.server
            waits = number in request.by.asks and number not in self.served
            if waits and request.is_direct and not self.system.servers[server].is_action:
                [slot] = self.needs(server)
                if self.holders(slot) and self.holders(slot) <= self._chain(request):
                    found.append(number)
        return found

    def _chain(self, request: Request | None) -> set[Life]:
        """Those who await a call directly, and the calls for which they do it; a goal begins a new chain."""
        found: set[Life] = set()
        while request is not None and request.is_direct:
            found.add(request.by)
            request = self.requests.get(request.by.serves)
            if request is not None and self.system.servers[request.ask.server].is_action:
                break
        return found


# Nodes that do it


class Mishap(Exception):
    """What `Fail` raises."""


class Actor(Node):
    """Does what it is asked to do."""

    def __init__(self, number: int, diary: Diary, *, has_handlers: bool = True) -> None:
        super().__init__(
            f"actor{number}", start_parameter_services=False, enable_rosout=False, enable_logger_service=False
        )
        if has_handlers:
            self.create_subscription(Int32, "/never", self.hear)
        self.diary = diary
        self.to: dict[int, Any] = {}
        """Its clients."""
        self.replies = diary.system.replies[number]
        self.starts: list[Callable[[], None]] = []
        self.timers: dict[int, Timer] = {}
        self.working: dict[int, Any] = {}
        """Its tasks, by starter."""

    async def hear(self, _: Int32) -> None:
        """Hear what nobody says."""

    def serve(self, number: int, server: Server, group: Group | None) -> None:
        async def answer(request: AddTwoInts.Request) -> AddTwoInts.Response:
            await self.live(self.diary.needs(number), self.diary.requests[request.a].ask.steps, request.a)
            return AddTwoInts.Response()

        async def reach(goal: Fibonacci.Handle) -> Fibonacci.Result:
            asked = goal.request.order
            await self.live(self.diary.needs(number), self.diary.requests[asked].ask.steps, asked)
            return Fibonacci.Result()

        answer.__name__ = reach.__name__ = f"server{number}"
        if server.kind == "service":
            self.create_service(AddTwoInts, f"/server{number}", answer, group=group)
        else:
            self.create_action_server(Fibonacci, f"/server{number}", reach, group=group, policy=server.kind)

    def use(self, number: int, server: Server, replies: Group | None) -> None:
        if server.is_action:
            self.to[number] = self.create_action_client(Fibonacci, f"/server{number}")
        else:
            self.to[number] = self.create_client(AddTwoInts, f"/server{number}", group=replies)

    def prepare(self, number: int, starter: Starter, group: Group | None) -> None:
        """Have a call tree begin when it is due after `begin`."""
        left = iter(reversed(range(starter.times)))

        async def go() -> None:
            await self.live(slots(starter.place, f"starter{number}", starter.kind), starter.steps)

        async def tick() -> None:
            if next(left) == 0:
                timers[number].cancel()
            await go()

        async def hear(_: Int32) -> None:
            await go()

        async def work() -> None:
            with suppress(Mishap, ExceptionGroup):  # it would end the node
                await self.live([], (Step(Nap(starter.after)), *starter.steps), starts=number)

        def begin() -> None:
            match starter.kind:
                case "timer":
                    timers[number] = self.create_timer(starter.after, tick, group=group, on_error="log")
                case "subscription":
                    for time in range(starter.times):
                        self.context.loop.call_later(starter.after * (time + 1), publisher.publish, Int32())
                case "task":
                    self.spawn(work)

        tick.__name__ = hear.__name__ = work.__name__ = f"starter{number}"
        timers = self.timers
        self.starts.append(begin)
        if starter.kind == "subscription":
            self.create_subscription(Int32, f"/starter{number}", hear, group=group, on_error="log")
            publisher = self.create_publisher(Int32, f"/starter{number}")

    async def live(self, taken: Iterable[str], steps: Steps, serves: int = 0, starts: int | None = None) -> None:
        life = self.diary.begin(self.context, taken, serves)
        if starts is not None:
            self.diary.tasks[starts] = life
            self.working[starts] = asyncio.current_task()
        try:
            for life.does in steps:
                await self.take(life, life.does)
                life.moves.append(self.diary.write())
        finally:
            life.moves.append(self.diary.write())
            life.is_over = True
            life.holds.clear()

    async def take(self, life: Life, step: Step) -> None:
        group = next((slot for slot in life.holds if slot.startswith("group")), "")
        if not (step.is_released and group):
            await self.within(life, step)
            return
        try:
            async with self.group.released():
                life.holds.discard(group)
                try:
                    await self.within(life, step)
                finally:
                    life.moves.append(self.diary.write())
                    life.wants = group
        finally:
            life.wants = ""
            life.holds.add(group)

    async def within(self, life: Life, step: Step) -> None:
        diary = self.diary
        try:
            if step.limit is None:
                await self.do(life, step.work)
            elif isinstance(step.work, (Both, Either)):
                with self.limited():
                    await asyncio.wait_for(self.do(life, step.work), step.limit)
            else:
                with self.limited():
                    async with self.clock.timeout(step.limit):
                        await self.do(life, step.work)
        except CancelledError:
            diary.given_up.append(diary.write())
            raise
        except TimeoutError:
            diary.given_up.append(diary.write())

    @contextmanager
    def limited(self) -> Iterator[None]:
        """For as long as something will end by itself."""
        self.diary.pending += 1
        try:
            yield
        finally:
            self.diary.pending -= 1

    async def nap(self, seconds: float) -> None:
        with self.limited():
            await self.clock.sleep(seconds)

    async def do(self, life: Life, work: Work, *, is_direct: bool = True) -> None:
        match work:
            case Nap(seconds=seconds):
                await self.nap(seconds)
            case Fail(after=seconds):
                await self.nap(seconds)
                self.diary.failed.append(self.diary.write())
                raise Mishap
            case Meet(starter=number):
                life.meets.append(number)
                try:
                    await asyncio.shield(self.working[number])
                finally:
                    life.meets.remove(number)
            case Ask():
                await self.ask(life, work, is_direct=is_direct)
            case Both(of=works, how="group"):
                async with asyncio.TaskGroup() as group:
                    for part in works:
                        group.create_task(self.do(life, part, is_direct=False))
            case Both(of=works, how=how):
                with self.started(self.do(life, part, is_direct=False) for part in works) as tasks:
                    if how == "wait":
                        await asyncio.wait(tasks)
                    else:
                        await asyncio.gather(*tasks, return_exceptions=how == "gather errors")
            case Either(of=works):
                with self.started(self.do(life, part, is_direct=False) for part in works) as tasks:
                    await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)

    @contextmanager
    def started(self, works: Iterable[Coroutine[Any, Any, None]]) -> Iterator[list[Task[None]]]:
        """Tasks that are cancelled when the block is left; their errors are nobody's but whoever awaits them."""
        tasks = [asyncio.ensure_future(work) for work in works]
        for task in tasks:
            task.add_done_callback(lambda task: task.cancelled() or task.exception())
        try:
            yield tasks
        finally:
            for task in tasks:
                task.cancel()

    async def ask(self, life: Life, ask: Ask, *, is_direct: bool) -> None:
        diary, number = self.diary, len(self.diary.requests) + 1
        is_action = diary.system.servers[ask.server].is_action
        replies = "" if self.replies is None or is_action else f"group{self.replies}"
        diary.requests[number] = Request(ask, life, is_direct, replies)
        life.asks.add(number)
        diary.pending += ask.timeout is not None
        try:
            if is_action:
                await self.send(ask, Fibonacci.Goal(order=number))
            else:
                await self.to[ask.server].call(AddTwoInts.Request(a=number), timeout=ask.timeout)
        except (CallError, GoalError, TimeoutError) as error:
            diary.refused += isinstance(error, DeadlockError)
            is_ended = isinstance(error, TimeoutError) or (isinstance(error, DeadlockError) and diary.breaks)
            (diary.given_up if is_ended else diary.failed).append(diary.write())
            if not ask.is_tolerant:
                raise Mishap from error
        finally:
            diary.pending -= ask.timeout is not None
            life.asks.discard(number)

    async def send(self, ask: Ask, goal: Fibonacci.Goal) -> None:
        client = self.to[ask.server]
        if ask.how == "block":
            async with client.send(goal) as sent:
                await sent.result(timeout=ask.timeout)
            return
        sent = await client.send_goal(goal)
        if ask.how == "feedback" and ask.timeout is None:
            async for _ in sent.feedback():
                pass
        await sent.result(timeout=ask.timeout)


# Their life


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


def asks_of(steps: Steps) -> Iterator[Ask]:
    """The requests that a handler makes itself."""
    todo: list[Work] = [step.work for step in steps]
    while todo:
        work = todo.pop()
        todo += work.of if isinstance(work, (Both, Either)) else ()
        if isinstance(work, Ask):
            yield work


def trees_of(system: System) -> Iterator[tuple[int, Ask]]:
    """Every request of a system, and the node that makes it."""
    todo = [(starter.place.node, ask) for starter in system.starters for ask in asks_of(starter.steps)]
    while todo:
        node, ask = todo.pop()
        yield node, ask
        todo += [(system.servers[ask.server].place.node, inner) for inner in asks_of(ask.steps)]


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


def made(diary: Diary) -> list[Actor]:
    """The nodes of a system."""
    system = diary.system
    groups: dict[int | None, Group] = {number: Group(limit) for number, (_, limit) in enumerate(system.groups)}
    actors = [Actor(n, diary, has_handlers=system.have_handlers) for n in range(len(system.processes))]
    for number, server in enumerate(system.servers):
        actors[server.place.node].serve(number, server, groups.get(server.place.group))
    for node, number in sorted({(node, ask.server) for node, ask in trees_of(system)}):
        actors[node].use(number, system.servers[number], groups.get(system.replies[node]))
    for number, starter in enumerate(system.starters):
        actors[starter.place.node].prepare(number, starter, groups.get(starter.place.group))
    return actors


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


# What holds


def check(diary: Diary) -> None:
    """Who is stuck for ever is dead in a picture, every ring of them is reported in time, and nothing else is."""
    assert diary.stumbled == []
    stuck = {life.id for life in diary.stuck()}
    whole = diary.picture()
    assert dead(whole) == stuck
    standing = diary.standing()
    assert all(ring <= stuck for ring in standing)
    assert len(standing) == len(set(standing)), "told by two processes"
    for members in diary.deadlocks():
        names = {life.id for life in members}
        assert any(ring <= names for ring in standing)
        closed = diary.times[max(map(diary.last_move, members))]
        assert any(r.ring <= names and diary.times[r.when] <= closed + REPORTED_WITHIN for r in diary.reports)
    for report in diary.reports + diary.looks:
        check_true(report, diary)
    assert not diary.cleared or diary.given_up or diary.failed
    # Of those who wait for each other, a report tells one ring.
    assert not unnamed(diary) - {life.id for life in diary.stuck() if life in diary.before(life)}


def unnamed(diary: Diary) -> set[str]:
    """Who is stuck and in no report, neither in a ring nor behind one."""
    said = flat("\n".join([report.text for report in diary.reports] + diary.behind))
    known = diary.picture().activities
    return {life.id for life in diary.stuck() if f"{title(known[life.id])} " not in said}


def check_true(report: Report, diary: Diary) -> None:
    """Nobody in a ring goes on before something is given up; or, if that is said, before something fails."""
    ends = diary.given_up + (diary.failed if report.is_partial else [])
    # Between the pictures and the report something may have ended.
    since = [i for i in ends if diary.times[i] >= diary.times[report.when] - 2 * SCATTER]
    for name in report.ring:
        later = [i for i in diary.lives[name].moves if i > report.when]
        assert not later or (since and min(since) < later[0])


def shapes(diary: Diary) -> Iterator[str]:
    """What kinds of deadlocks there are."""
    for members in diary.deadlocks():
        yield {1: "of one", 2: "of two"}.get(len(members), "of several")
        if len({life.id.partition(":")[0] for life in members}) > 1:
            yield "in two processes"
        for life in members:
            yield from shapes_of(life, diary)
    if any(report.is_partial for report in diary.reports):
        yield "partial"


def shapes_of(life: Life, diary: Diary) -> Iterator[str]:
    if life.does is not None and isinstance(life.does.work, (Both, Either)):
        yield "first of several" if isinstance(life.does.work, Either) else "all of several"
    if any(diary.limit(slot) > 1 for slot in diary.missing(life)):
        yield "limit above 1"
    if any(diary.system.servers[diary.requests[i].ask.server].is_action for i in life.asks):
        yield "goal"
    if any(i in diary.served and diary.served[i].is_over for i in life.asks):
        yield "reply"
    if life.wants:
        yield "on the way back"
    if ":t" in life.id:
        yield "task"


# Which systems


SECONDS = st.sampled_from([0.05, 0.1, 0.2, 0.3, 0.7])
LONGER = st.sampled_from([0.05, 0.1, 0.2, 0.3, 0.7, 3.0])
ALONE = st.sampled_from([*["ask"] * 6, "both", "either", "either", "nap", "meet"])
TOGETHER = st.sampled_from([*["ask"] * 5, "nap", "both", "either", "meet"])
HOWS: st.SearchStrategy[Literal["result", "block", "feedback"]] = st.sampled_from(["result", "block", "feedback"])
JOINTS: st.SearchStrategy[How] = st.sampled_from(["gather", "group", "wait", "gather errors"])
BRITTLE: st.SearchStrategy[How] = st.sampled_from(["gather", "group"])
"""Those of which a failure is noticed at once."""
KINDS: st.SearchStrategy[Literal["service", "queue", "parallel"]] = st.sampled_from(
    ["service", "service", "service", "queue", "parallel"]
)
STARTS: st.SearchStrategy[Literal["timer", "subscription", "task"]] = st.sampled_from(
    ["timer", "timer", "subscription", "subscription", "task"]
)


@st.composite
def systems(draw: st.DrawFn, *, ends: bool = False, replies: bool = True) -> System:
    """Up to 4 nodes with 4 servers and 3 starters, and up to 8 requests in all.

    Args:
        ends: Some waits are given up after a while, and some work fails.
        replies: Answers may need slots.
    """
    processes = draw(st.sampled_from([(0,), (0, 1), (0, 1), (0, 0, 1), (0, 1, 1, 0)]))
    nodes = st.integers(0, len(processes) - 1)
    limits = st.sampled_from([1, 1, 2, 2, 3])
    groups = tuple((draw(nodes), draw(limits)) for _ in range(draw(st.integers(1, 4))))
    homes = [Place(node, group) for group, (node, _) in enumerate(groups)]
    places = st.one_of(st.sampled_from(homes), st.builds(Place, nodes, st.none()))
    servers = tuple(Server(draw(places), draw(KINDS)) for _ in range(draw(st.integers(2, 4))))
    requests = 8

    def work(me: Place, depth: int, kinds: st.SearchStrategy[str], width: int) -> Work:
        nonlocal requests
        if ends and draw(st.integers(0, 9)) > (8 if width == 2 else 6):
            return Fail(draw(SECONDS))
        match draw(kinds):
            case "both" if width:
                return Both(several(me, depth, width), draw(BRITTLE if ends else JOINTS))
            case "either" if width:
                return Either(several(me, depth, width))
            case "ask" if requests:
                requests -= 1
                others = [i for i, server in enumerate(servers) if server.place != me]
                asked = draw(st.sampled_from([*range(len(servers)), *others, *others]))
                return Ask(asked, steps(servers[asked].place, depth + 1), draw(HOWS), *end())
            case "meet" if met := tasks(me, depth):
                return Meet(draw(st.sampled_from(met)))
            case _:
                return Nap(draw(SECONDS if width == 2 else LONGER))

    def end() -> tuple[float | None, bool]:
        return (draw(st.sampled_from([None, None, None, 0.6, 2.0])), draw(st.booleans())) if ends else (None, True)

    def tasks(me: Place, depth: int) -> list[int]:
        """Which may be waited for; a ring of tasks alone is none that anybody looks for."""
        now = len(starters)
        found = [i for i, (place, kind) in enumerate(begun) if kind == "task" and place.node == me.node]
        return [i for i in found if i < now] if depth == 0 and begun[now][1] == "task" else found

    def several(me: Place, depth: int, width: int) -> tuple[Work, ...]:
        return tuple(work(me, depth, TOGETHER, width - 1) for _ in range(draw(st.integers(2, 3))))

    def steps(me: Place, depth: int) -> Steps:
        if depth > 3:
            return ()
        return tuple(step(me, depth) for _ in range(draw(st.integers(0 if depth else 1, 2))))

    def step(me: Place, depth: int) -> Step:
        limit = draw(st.sampled_from([*[None] * 5, 0.5, 1.5])) if ends else None
        return Step(work(me, depth, ALONE, 2), draw(st.integers(0, 4)) > 2, limit)

    begun = [(draw(places), draw(STARTS)) for _ in range(draw(st.integers(1, 3)))]
    starters: list[Starter] = []
    for place, kind in begun:
        starters.append(Starter(place, kind, draw(SECONDS), draw(st.integers(1, 2)), steps(place, 0)))
    own: list[list[int]] = [[i for i, (node, _) in enumerate(groups) if node == n] for n in range(len(processes))]
    answers = tuple(draw(st.sampled_from([*[None] * 5, *(mine if replies else ())])) for mine in own)
    return System(processes, groups, answers, servers, tuple(starters), draw(st.sampled_from([0.0, 0.02])))


SEEDS = st.integers(0, 1000)
long = limit(CASES)

SEEN: Counter[str] = Counter()
"""What has come of the systems that were tried."""
SHAPES = {"of one", "of two", "of several", "in two processes", "all of several", "limit above 1", "goal"}


@pytest.fixture(scope="module", autouse=True)
def many_kinds(request: pytest.FixtureRequest) -> Iterator[None]:
    """See that a good part of what is generated stands still, and not always in the same way."""
    SEEN.clear()
    yield
    if SEEN["deadlock"] + SEEN["no deadlock"] >= 100 and not request.session.testsfailed:
        assert 0.2 <= SEEN["deadlock"] / (SEEN["deadlock"] + SEEN["no deadlock"]) <= 0.7
        assert set(SEEN) >= SHAPES


def tell(*happened: str) -> None:
    SEEN.update(happened)
    for what in happened:
        event(what)


@long
@cases(CASES * 2 // 5)
@given(systems(), SEEDS)
def test_what_never_ends_is_reported(system: System, seed: int) -> None:
    """Every ring of those who wait for ever for each other is reported in time; what ends is never named."""
    outcome = outcome_of(system, seed, "report")

    assert outcome.refused == 0
    tell("deadlock" if outcome.stuck else "no deadlock", *outcome.shapes)


@long
@cases(CASES // 5)
@given(systems(ends=True), SEEDS)
def test_what_is_given_up_or_fails(system: System, seed: int) -> None:
    """A report is true until something is given up, or fails where it says so; what stands then is reported."""
    outcome = outcome_of(system, seed, "report")

    tell("stuck" if outcome.stuck else "not stuck", *outcome.shapes)


@long
@cases(CASES // 5)
@given(systems(replies=False), SEEDS)
def test_hopeless_calls_fail(system: System, seed: int) -> None:
    """Where a call could never be answered, one fails, and none is left; everywhere else, none does."""
    reported, raised = outcome_of(system, seed, "report"), outcome_of(system, seed, "raise")

    assert (raised.refused > 0) is (reported.hopeless > 0)
    assert raised.hopeless == 0
    tell("raised" if raised.refused else "nothing raised", *reported.shapes)


@long
@cases(CASES // 5)
@given(st.one_of(systems(), systems(ends=True)), SEEDS)
def test_rings_are_broken(system: System, seed: int) -> None:
    """With the policy `break` everything ends."""
    outcome = outcome_of(system, seed, "break")

    assert not outcome.stuck
    tell("broken" if outcome.refused else "nothing broken")


# By hand

HOME = Place(0, 0)


def alone(*starters: Starter, replies: int | None = None) -> System:
    """One node with a service, both in one group with one slot."""
    return System((0,), ((0, 1),), (replies,), (Server(HOME, "service"),), starters)


@pytest.mark.parametrize("how", ["wait", "gather errors"])
def test_a_wait_for_all_of_which_one_has_failed(how: How) -> None:
    """It is as dead as the one that is left."""
    both = Both((Ask(0), Fail()), how)

    outcome_of(alone(Starter(HOME, "timer", 0.1, 1, (Step(both),))), 0, "report")


def test_a_hopeless_call_of_a_client_in_a_group() -> None:
    """It fails as any other does."""
    outcome = outcome_of(alone(Starter(HOME, "timer", 0.1, 1, (Step(Ask(0)),)), replies=0), 0, "raise")

    assert outcome.refused == 1


def test_a_report_that_is_taken_back() -> None:
    """It is taken back half a second after the ring has ended, whatever else there was to be looked at."""
    servers = Server(Place(0, 0), "service"), Server(Place(1, 1), "service"), Server(Place(1, None), "parallel")
    ring = [Starter(Place(i, i), "timer", 0.05, 1, (Step(Ask(1 - i, timeout=0.6)),)) for i in (0, 1)]
    slow = Step(Ask(2, (Step(Nap(0.5)),)))
    others = [Starter(Place(0, None), "task", 0.05 + 0.01 * i, 1, (slow,)) for i in range(8)]
    system = System((0, 1), ((0, 1), (1, 1)), (None, None), servers, (*ring, *others))

    outcome = outcome_of(system, 0, "report")

    assert outcome.told == 1
    assert outcome.seconds < 5.0


def test_a_report_that_somebody_without_handlers_had_a_part_in() -> None:
    """It is taken back as any other is."""
    asks = Step(Ask(0, (Step(Ask(0, timeout=0.6)),)))
    servers = (Server(Place(0, None), "service"),)
    starters = (Starter(Place(1, None), "task", 0.1, 1, (asks,)),)

    system = System((0, 1), (), (None, None), servers, starters, have_handlers=False)

    assert [outcome_of(system, seed, "report").told for seed in range(20)] == [1] * 20


def test_a_ring_that_becomes_another() -> None:
    """One of three gives up and waits for the first all the same: that is told again, and nothing has cleared."""
    inner = Step(Ask(0, (Step(Nap(0.3), is_released=True),), timeout=0.9), is_released=True)
    first = Starter(HOME, "timer", 0.05, 1, (Step(Ask(0, (inner,))),))
    second = Starter(HOME, "timer", 0.2, 1, (Step(Ask(0)),))

    outcome = outcome_of(System((0,), ((0, 2),), (None,), (Server(HOME, "service"),), (first, second)), 0, "report")

    assert outcome.told == 2


def test_somebody_who_joins_a_deadlock() -> None:
    """He is told of, as others are who come to wait for it."""
    home = Place(0, None)
    late, soon = Ask(0, (Step(Nap(1.0)), Step(Ask(2)))), Ask(1, (Step(Ask(2)),))
    starter = Starter(home, "task", 0.1, 1, (Step(Ask(2, (Step(Both((late, soon))),))),))

    outcome = outcome_of(System((0,), (), (None,), (Server(home, "service"),) * 3, (starter,)), 0, "report")

    assert outcome.told == 1
    assert not outcome.unnamed


def test_a_deadlock_of_several_rings_in_two_processes() -> None:
    """It is told once."""
    inner = Step(Both((Ask(0), Ask(1))))
    asks = Step(Ask(1, (Step(Ask(0, (inner,))),)))
    servers = Server(Place(1, None), "service"), Server(Place(0, None), "service")
    system = System((0, 1), (), (None, None), servers, (Starter(Place(0, None), "task", 0.1, 1, (asks,)),))

    assert [outcome_of(system, seed, "report").told for seed in range(5)] == [1] * 5


def test_tasks_that_wait_for_each_other() -> None:
    """They are found though nothing else waits."""
    starters = (Starter(HOME, "task", 0.1, 1, (Step(Meet(other)),)) for other in (1, 0))

    assert outcome_of(alone(*starters), 0, "report").told == 1

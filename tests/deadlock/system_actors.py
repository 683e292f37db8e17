"""Real nodes that do what a system says, and write it into its diary."""

from __future__ import annotations

import asyncio
from asyncio import CancelledError, Task
from collections.abc import Callable, Coroutine, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from graphflow import CallError, DeadlockError, GoalError, Group, Node
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.runtime.endpoints.timer import Timer
from tests.deadlock.diary import Diary, Life, Request
from tests.deadlock.systems import (
    Ask,
    Both,
    Either,
    Fail,
    Meet,
    Nap,
    Server,
    Starter,
    Step,
    Steps,
    Work,
    slots,
    trees_of,
)


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

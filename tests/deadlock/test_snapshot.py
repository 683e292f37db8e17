"""What is read off runs and tasks that wait, as a wait graph: each kind of wait, groups, queues and times."""

from __future__ import annotations

import asyncio
import sys
import threading
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import pytest

from graphflow.deadlock.snapshot import Snapshot
from graphflow.deadlock.watchdog import Watchdog
from graphflow.executor.clock import WallClock
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.ledger import PendingGoal
from graphflow.executor.runner import Runner
from graphflow.machines.waits.wait_graph import FREE, ActivityView, All, AnyOf, Call, Condition, Join, SetBy, Slot
from graphflow.testing.clock import settle
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind
from tests.deadlock.stage import Actor, Stage, begin
from tests.written import Written

GID = b"\1" * 16
ADD = Call(f"{GID.hex()}:7", "/add")
ADD_TOO = Call(f"{GID.hex()}:8", "/add")
TURN = Call("goal:" + "02" * 16, "/turn")
SECOND = 1_000_000_000


class Goal(PendingGoal):
    """A goal that was sent."""

    goal_id, action, began_ns, done = b"\2" * 16, "/turn", 0, False


class Scene:
    """A process with one node, and what its handlers may wait for."""

    def __init__(self, instance: object = None) -> None:
        self.stage = Stage()
        self.actor: Actor = self.stage.actor(instance)
        self.watchdog = Watchdog(self.stage.loop, lambda: None)
        self.snapshot = Snapshot(self.stage, self.watchdog)
        self.zid = self.stage.session.zid

    async def add(self, number: int = 7, deadline_ns: int | None = None) -> None:
        future = self.stage.loop.create_future()
        with self.stage.ledger.call(future, GID, number, "/add", self.stage.clock.monotonic_ns(), deadline_ns):
            await future

    async def turn(self) -> None:
        future = self.stage.loop.create_future()
        with self.stage.ledger.goal(future, Goal()):
            await future

    async def serve(self) -> None:
        future = self.stage.loop.create_future()
        with self.stage.ledger.serving(future, b"\2" * 16):
            await future

    def task(self, awaitable: Awaitable[Any]) -> asyncio.Task[Any]:
        return asyncio.ensure_future(awaitable)

    def own(self, name: str, group: HandlerGroup | None = None) -> Runner:
        """A handler that is a method of the node's, named nowhere else in this file."""
        return self.stage.handler(self.actor, name, getattr(self.actor.instance, name), group)

    async def wait_of(self, body: Callable[[], Awaitable[Any]], group: HandlerGroup | None = None) -> Condition:
        """What a run of a handler waits for."""
        return (await self.view_of(body, group)).wait

    async def view_of(self, body: Callable[[], Awaitable[Any]], group: HandlerGroup | None = None) -> ActivityView:
        await begin(self.stage.handler(self.actor, "on_go", lambda _: body(), group), "message")
        views = self.snapshot.take().activities.values()
        return next(view for view in views if view.label == "subscription on_go")


async def ended() -> None:
    """End at once."""


WAITS: dict[str, tuple[Callable[[Scene], Awaitable[Any]], Condition]] = {
    "time": (lambda s: s.stage.clock.sleep(9.0), FREE),
    "a future of nobody's": (lambda s: s.stage.loop.create_future(), FREE),
    "a call": (lambda s: s.add(), ADD),
    "a goal": (lambda s: s.turn(), TURN),
    "a goal of its own": (lambda s: s.serve(), Call(TURN.id, "")),
    "a call in a task": (lambda s: s.task(s.add()), ADD),
    "a call in a shield": (lambda s: asyncio.shield(s.add()), ADD),
    "all of two": (lambda s: asyncio.gather(s.add(), s.add(8)), All((ADD, ADD_TOO))),
    "all, one of them free": (lambda s: asyncio.gather(s.add(), s.stage.clock.sleep(9.0)), All((ADD, FREE))),
    "all, one of them done": (lambda s: asyncio.gather(s.add(), ended()), All((ADD,))),
    "the first of two": (
        lambda s: asyncio.wait([s.task(s.add())], return_when=asyncio.FIRST_COMPLETED),
        AnyOf((ADD,)),
    ),
    "all of a set": (lambda s: asyncio.wait([s.task(s.add())]), All((ADD,))),
}


@pytest.mark.parametrize("name", WAITS)
async def test_what_a_run_waits_for(graphflow_runner: asyncio.Runner, name: str) -> None:
    """Each kind of wait, through tasks and asyncio's means of waiting for several."""
    scene = Scene()
    wait, condition = WAITS[name]

    async def body() -> None:
        await wait(scene)

    assert await scene.wait_of(body) == condition


@pytest.mark.parametrize("is_task", [False, True])
async def test_a_call_in_time(graphflow_runner: asyncio.Runner, is_task: bool) -> None:
    """It is a wait for the call, or for all of it, as asyncio's way to limit it differs between Python's versions."""
    scene = Scene()

    async def body() -> None:
        await asyncio.wait_for(scene.task(scene.add()) if is_task else scene.add(), 60.0)

    assert await scene.wait_of(body) in (ADD, All((ADD,)))


async def test_a_task_group(graphflow_runner: asyncio.Runner) -> None:
    """Its end waits for all of its tasks, not for its body's."""
    scene = Scene()

    async def body() -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(scene.add())

    assert await scene.wait_of(body) == All((ADD,))


async def test_a_wait_that_is_over(graphflow_runner: asyncio.Runner) -> None:
    """Where one of those that are waited for has ended the wait, the next step is due."""
    scene = Scene()
    failing: asyncio.Future[None] = scene.stage.loop.create_future()

    async def body() -> None:
        await asyncio.gather(scene.add(), failing)

    assert await scene.wait_of(body) == All((ADD, FREE))
    failing.set_exception(ValueError())
    [view] = scene.snapshot.take().activities.values()
    assert view.wait == FREE
    await settle()


@pytest.mark.parametrize(
    ("wait", "service", "seen"),
    [("add", "/add", replace(ADD, servers=2)), ("turn", "/turn/_action/send_goal", replace(TURN, servers=2))],
)
async def test_another_server_may_answer(
    graphflow_runner: asyncio.Runner, wait: str, service: str, seen: Condition
) -> None:
    """Two servers have the same call, and may have accepted the same goal."""
    scene = Scene()
    for zid in ("aa", "bb"):
        server = Entity(0, zid, 0, 1, Kind.SERVICE, "/", "server", service, "std_srvs/srv/Empty", "x")
        scene.stage.cache.apply(server.token, alive=True)

    assert await scene.wait_of(getattr(scene, wait)) == seen


async def test_the_tasks_of_a_node(graphflow_runner: asyncio.Runner) -> None:
    """They are activities of their own, for which others wait by name; no two ever have one id."""
    scene = Scene()
    task = asyncio.create_task(scene.add(), name="/robot.run")
    scene.actor.tasks.add(task)

    async def body() -> None:
        await task

    wait = await scene.wait_of(body)
    [view] = [v for v in scene.snapshot.take().activities.values() if v.label == "task run"]
    assert wait == Join(view.id)
    assert (view.wait, view.holds, view.node) == (ADD, (), "/robot")
    assert scene.snapshot.number_of(task) == scene.snapshot.number_of(task)
    assert scene.snapshot.number_of(object_with_a_name()) != scene.snapshot.number_of(task)


def object_with_a_name() -> Any:
    """Something that is no task, and can be remembered as one is."""
    return threading.Event()


async def test_the_way_back_to_a_group(graphflow_runner: asyncio.Runner) -> None:
    """A run that has released its slot, and waits to come back, holds none and waits for one."""
    scene = Scene()
    group = scene.actor.groups.named("motion")
    assert group is not None

    async def body() -> None:
        async with group.released():
            group.admit(Other())

    view = await scene.view_of(body, group)
    assert view.wait == Slot(f"{scene.zid}:/robot:motion", int(view.id.partition(":")[2]))
    assert view.holds == ()


class Other:
    """Takes a slot."""

    def granted(self, group: HandlerGroup) -> None:
        """Not reached."""

    def yields(self) -> None:
        """Not reached."""

    def wake(self) -> None:
        """It has nothing to run."""


class Waiter:
    """Its source tells who sets what it waits for."""

    def __init__(self) -> None:
        self.arrived, self.lock = asyncio.Event(), asyncio.Lock()

    async def on_go(self, _: object) -> None:
        await self.arrived.wait()

    def on_arrive(self, _: object) -> None:
        self.arrived.set()

    async def on_ask(self, _: object) -> None:
        await asyncio.create_task(self.arrived.wait())

    async def enter(self, _: object) -> None:
        async with self.lock:
            await asyncio.sleep(60)

    async def enter_twice(self, _: object) -> None:
        async with self.lock, self.lock:
            pass

    async def gather(self, item: object) -> None:
        await asyncio.gather(self.enter_twice(item), self.enter(item))


@pytest.mark.parametrize(("name", "age"), [("on_go", 7), ("on_ask", 0)])
async def test_the_age_of_what_only_the_source_tells(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, name: str, age: int
) -> None:
    """It counts from when the run began to wait; through a task, which may wait for something else by now, from now."""
    scene = Scene(Waiter())
    monkeypatch.setattr(scene.stage, "clock", WallClock())
    scene.own("on_arrive")
    runner = scene.own(name)
    await begin(runner, "message")
    [run] = runner.active
    run.suspended_at -= 7.0

    [view] = scene.snapshot.take().activities.values()
    assert isinstance(view.wait, SetBy)
    assert age <= view.age < age + 5


async def test_what_only_the_source_tells(graphflow_runner: asyncio.Runner) -> None:
    """Who sets it: the queue of a handler, and its runs under way; nobody, if that handler is not there."""
    scene = Scene(Waiter())
    arrive = scene.own("on_arrive")
    await begin(scene.own("on_go"), "message")

    [view] = scene.snapshot.take().activities.values()
    assert view.wait == SetBy("self.arrived", (f"{scene.zid}:q{arrive.number}",))
    scene.actor.runners.remove(arrive)
    [view] = scene.snapshot.take().activities.values()
    assert view.wait == FREE


async def test_who_holds_a_lock(graphflow_runner: asyncio.Runner) -> None:
    """Those who are inside of it, if the source shows nobody else who could let somebody in."""
    scene = Scene(Waiter())
    runner = scene.own("enter", HandlerGroup(None))
    await begin(runner, "first", "second")

    first, second = scene.snapshot.take().activities.values()
    assert first.wait == FREE
    assert second.wait == SetBy("self.lock", (), (first.id,), is_held=True, verb="releases")
    await runner.cancel()


async def test_who_holds_a_lock_below_a_handler(graphflow_runner: asyncio.Runner) -> None:
    """A task that a handler waits for is shown if it is inside of a lock: it may leave that before the handler ends."""
    scene = Scene(Waiter())
    runner = scene.own("gather")
    await begin(runner, "message")

    handler, task = scene.snapshot.take().activities.values()
    held = SetBy("self.lock", (), (task.id,), is_held=True, verb="releases")
    assert handler.wait == All((held, held))
    assert (task.label, task.wait, task.holds, task.left) == ("task enter_twice", held, (), None)
    await runner.cancel()


async def test_a_thread(graphflow_runner: asyncio.Runner) -> None:
    """Who waits for a thread waits for what that waits for: the answer to a call that it has made."""
    scene = Scene()
    gate = threading.Event()
    thread = threading.Thread(target=gate.wait)
    future = scene.stage.loop.create_future()

    async def body() -> None:
        with scene.stage.ledger.thread_work(future, thread):
            thread.start()
            await future

    assert await scene.wait_of(body) == FREE
    task = asyncio.create_task(scene.add())
    await settle()
    assert thread.ident is not None
    with scene.stage.ledger.asked_from(thread.ident, task):
        [view] = scene.snapshot.take().activities.values()
    assert view.wait == ADD
    gate.set()
    thread.join()


# What else is told of a run


async def test_a_run(graphflow_runner: asyncio.Runner) -> None:
    """Its label, node, place and process; whether `await` can stand where it waits."""
    scene = Scene()
    motion = scene.actor.groups.named("motion")

    async def body() -> None:
        await scene.add()  # here

    view = await scene.view_of(body, motion)
    assert (view.label, view.node, view.process) == ("subscription on_go", "/robot", scene.zid)
    assert view.holds == (f"{scene.zid}:/robot:motion",)
    assert (view.place.file, view.function, view.is_async) == (__file__, "add", True)


@pytest.mark.parametrize(
    ("deadline_ns", "limit", "age", "left"),
    [(None, None, 2.0, None), (5 * SECOND, None, 2.0, 3.0), (5 * SECOND, 4.0, 2.0, 2.0), (None, 9.0, 2.0, 7.0)],
)
async def test_times(
    graphflow_runner: asyncio.Runner, deadline_ns: int | None, limit: float | None, age: float, left: float | None
) -> None:
    """Since when it waits, and when it gives up: by the call's deadline or a timeout around it, whichever is first."""
    scene = Scene()

    async def body() -> None:
        if limit is None:
            await scene.add(7, deadline_ns)
        else:
            async with scene.stage.clock.timeout(limit):
                await scene.add(7, deadline_ns)

    await begin(scene.stage.handler(scene.actor, "on_go", lambda _: body()), "message")
    await scene.stage.clock.advance(2.0)
    [view] = scene.snapshot.take().activities.values()

    assert (view.age, view.left) == (age, left)


async def test_an_ended_run_is_not_told(graphflow_runner: asyncio.Runner) -> None:
    """Nor is one that has not begun."""
    scene = Scene()
    await begin(scene.stage.handler(scene.actor, "on_go"), "message")

    assert scene.snapshot.take().activities == {}


# Groups and queues


async def test_a_queue(graphflow_runner: asyncio.Runner) -> None:
    """The calls and items that wait in it, those that have just arrived too, and the groups whose slots a run needs."""
    scene = Scene()
    motion = scene.actor.groups.named("motion")
    assert motion is not None
    motion.admit(Other())
    runner = scene.stage.handler(scene.actor, "add", group=motion, kind="service", is_serial=True)
    await begin(runner, Request(7), Request(-8), Request(None))
    scene.stage.requests.append((runner, GID, 9))

    graph = scene.snapshot.take()
    [queue] = graph.queues.values()
    names = (f"{scene.zid}:/robot:motion", f"{scene.zid}:own{runner.number}")
    assert (queue.label, queue.node, queue.needs) == ("service add", "/robot", names)
    assert queue.calls == (ADD.id, ADD_TOO.id, f"{GID.hex()}:9")
    assert (queue.waiting, queue.is_declared, queue.process) == (4, True, scene.zid)
    assert {name: group.name for name, group in graph.groups.items()} == dict(zip(names, ("motion", ""), strict=True))


class Request:
    """A request as a service's queue has it."""

    def __init__(self, number: int | None) -> None:
        self.attachment = None if number is None else attachment.pack(number, 0, GID)


@pytest.mark.parametrize(
    ("group", "limit"),
    [(HandlerGroup(2, "g"), 2), (HandlerGroup(None, "g"), None), (HandlerGroup(1, "g", "cancel_running"), None)],
)
async def test_limits(graphflow_runner: asyncio.Runner, group: HandlerGroup, limit: int | None) -> None:
    """A group in which newer work cancels what runs is never full for good."""
    scene = Scene()
    scene.stage.handler(scene.actor, "on_go", group=group)

    [view] = scene.snapshot.take().groups.values()
    assert (view.limit, view.name, view.is_declared) == (limit, "", False)


# From where it is taken


async def test_from_another_thread(graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """The loop takes it for others, where it can; where it is blocked or slow, they take it themselves."""
    scene = Scene()
    await scene.view_of(scene.add)
    threads: list[int] = []
    take = scene.snapshot.take

    def taken() -> Any:
        threads.append(threading.get_ident())
        return take()

    monkeypatch.setattr(scene.snapshot, "take", taken)
    expected = take()
    assert scene.snapshot.take_for_others() == expected
    assert await asyncio.to_thread(scene.snapshot.take_for_others) == expected
    assert threads == [threading.get_ident()] * 2
    monkeypatch.setattr("graphflow.deadlock.snapshot.LOOP_LIMIT", 0.001)
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(scene.snapshot.take_for_others).result() == expected  # this line keeps the loop
    assert threads[2] != threading.get_ident()


async def test_what_changes_while_it_is_looked_at(graphflow_runner: asyncio.Runner) -> None:
    """It is looked at again, a few times; then nothing is told."""
    scene = Scene()
    attempts: list[int] = []

    class Changing(set[Any]):
        def __iter__(self) -> Any:
            attempts.append(1)
            if len(attempts) < limit:
                raise RuntimeError("Set changed size during iteration")
            return super().__iter__()

    scene.stage.handler(scene.actor, "on_go")
    scene.actor.tasks = Changing()
    limit = 3
    assert scene.snapshot.take().queues != {}
    attempts.clear()
    limit = 1000
    assert scene.snapshot.take().queues == {}


@pytest.mark.parametrize("is_async", [False, True])
async def test_a_loop_that_is_blocked(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, is_async: bool
) -> None:
    """Who keeps it is an activity, with the call that it waits for in vain; seen from other threads only."""
    scene = Scene()
    found: list[Any] = []
    monkeypatch.setattr(Watchdog, "blocked_for", 3.0)

    def blocks(_: object) -> None:
        future = scene.stage.loop.create_future()
        with scene.stage.ledger.call(future, GID, 7, "/add", 0, None), scene.stage.ledger.blocked_by(future):
            with ThreadPoolExecutor(1) as pool:
                found.append(pool.submit(scene.snapshot.take).result())  # here
            assert scene.snapshot.take().blocked == {}

    async def runs(message: object) -> None:
        blocks(message)

    await begin(scene.stage.handler(scene.actor, "on_go", runs if is_async else blocks), "message")

    [graph] = found
    [view] = graph.activities.values()
    assert graph.blocked == {scene.zid: view.id}
    assert (view.label, view.wait, view.age, view.is_async) == ("subscription on_go", ADD, 3.0, is_async)
    assert (view.place.file, view.function) == (__file__, "blocks")


POLLS = """
import time


class N:
    there = False

    def on_go(self, _):
        while not self.there:
            self.look()
            time.sleep(60)

    def look(self):
        GATE.acquire()

    def on_arrive(self):
        self.there = True
"""


async def test_a_loop_that_polls(
    graphflow_runner: asyncio.Runner, written: Written, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is shown where it pauses, though it may be seen doing something else."""
    module: Any = written(POLLS)
    node = module.N()
    scene = Scene(node)
    monkeypatch.setattr(Watchdog, "blocked_for", 3.0)
    scene.stage.handler(scene.actor, "on_arrive")
    found: list[Any] = []

    def pause(seconds: float) -> None:
        if threading.get_ident() == loops_thread:  # other tests may have left threads that sleep
            node.there = True
        else:
            threading.Event().wait(seconds)

    def watch() -> None:
        looks, before, times = type(node).look.__code__, None, 0
        while times < 20:  # until it stands in `acquire`; on its way there, it would be seen doing something else
            frame = sys._current_frames()[loops_thread]
            now = frame.f_code, frame.f_lasti
            times = times + 1 if now == before and frame.f_code is looks else 0
            before = now
            threading.Event().wait(0.01)  # not time.sleep, which the test replaces
        try:
            found.append(scene.snapshot.take())
        finally:
            module.GATE.release()

    loops_thread, module.GATE = threading.get_ident(), threading.Lock()
    module.GATE.acquire()
    looker = threading.Thread(target=watch)
    looker.start()
    monkeypatch.setattr("time.sleep", pause)
    await begin(scene.stage.handler(scene.actor, "on_go", node.on_go), "message")
    looker.join()

    [view] = found[0].activities.values()
    assert isinstance(view.wait, SetBy)
    first = type(node).on_go.__code__.co_firstlineno
    assert (view.place.line, view.function, view.called) == (first + 3, "on_go", "")


SHARED = """
import asyncio

import numpy as np

OCCUPIED = np.zeros(3)


class N:
    async def on_go(self):
        while not OCCUPIED.any():
            await asyncio.sleep(60)

    def on_arrive(self):
        OCCUPIED[0] = 1.0
"""


async def test_a_polled_array_of_the_module(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """The node's own handlers end the wait, until there is another node whose methods are in that module."""
    module = written(SHARED)
    scene = Scene(module.N())
    scene.own("on_arrive")
    node = scene.actor.instance
    await begin(scene.stage.handler(scene.actor, "on_go", lambda _: node.on_go()), "message")  # type: ignore[attr-defined]

    def wait() -> Condition:
        views = Snapshot(scene.stage, scene.watchdog).take().activities.values()
        return next((view.wait for view in views if view.wait is not FREE), FREE)

    assert isinstance(wait(), SetBy)
    scene.stage.actor(object(), "/stranger")
    assert isinstance(wait(), SetBy)
    scene.stage.actor(module.N(), "/another")
    assert wait() is FREE

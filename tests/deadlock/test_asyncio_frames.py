"""Every name of asyncio's and CPython's internals that the search relies on, pinned by what real waits show.

What is new in a Python, or gone from it, turns up here: the test that fails, or its parameter, is named for it.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import queue
import sys
import threading
import time
import types
from asyncio import FIRST_COMPLETED, FIRST_EXCEPTION
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine, Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import pytest

from graphflow.analysis.frames import Frame, stack_of
from graphflow.deadlock import asyncio_frames as aio
from graphflow.executor.activity import Activity
from graphflow.testing.clock import settle

NOW = 100.0
"""Seconds, by the loop's clock in those tests that are about deadlines."""


async def suspended(awaitable: Awaitable[Any]) -> asyncio.Task[Any]:
    """A task that awaits something that does not come."""

    async def body() -> None:
        await awaitable

    task = asyncio.create_task(body())
    await settle()
    assert not task.done()
    return task


async def never() -> None:
    """Wait for what nobody brings."""
    await asyncio.get_running_loop().create_future()


def pending() -> asyncio.Task[Any]:
    """A task that does not end."""
    return asyncio.create_task(never())


def names_of(task: Any) -> list[str]:
    return [frame.f_code.co_name for frame in aio.frames_of(task)]


def joint_waits(task: Any) -> list[aio.JointWait]:
    return [wait for wait in map(aio.joint_wait, aio.frames_of(task)) if wait is not None]


# What CPython tells of coroutines


async def test_cr_await_and_cr_frame(graphflow_runner: asyncio.Runner) -> None:
    """`cr_await` leads from each coroutine to the one that it awaits, and `cr_frame` tells where it is suspended."""

    async def inner() -> None:
        await never()  # here

    async def outer() -> None:
        await inner()

    task = await suspended(outer())

    assert names_of(task) == ["body", "outer", "inner", "never"]
    assert aio.frames_of(task)[2].f_lineno == inner.__code__.co_firstlineno + 1


async def test_gi_yieldfrom_and_gi_frame(graphflow_runner: asyncio.Runner) -> None:
    """Coroutines that are generators, of `__await__` methods and `types.coroutine`, are parts of the chain."""

    class Old:
        def __await__(self) -> Generator[Any, None, None]:
            yield from older()

    @types.coroutine
    def older() -> Generator[Any, None, None]:
        yield from never()

    assert names_of(await suspended(Old())) == ["body", "__await__", "older", "never"]


async def test_an_asynchronous_generator_ends_the_chain(graphflow_runner: asyncio.Runner) -> None:
    """Who iterates over one may leave its loops, so that these tell nothing: it is not looked into."""

    async def numbers() -> AsyncIterator[int]:
        await never()
        yield 1

    async def iterates() -> None:
        async for _ in numbers():
            """Not reached."""

    task = await suspended(iterates())

    assert names_of(task) == ["body", "iterates"]
    assert aio.waiter_of(task) is not None


async def test_an_ended_coroutine_has_no_frame(graphflow_runner: asyncio.Runner) -> None:
    """There is nothing to read."""

    async def body() -> None:
        """Be quick."""

    task = asyncio.create_task(body())
    await task

    assert aio.frames_of(task) == []


async def test_fut_waiter(graphflow_runner: asyncio.Runner) -> None:
    """`Task._fut_waiter`, and that of an activity, is the very future; None when the next step is due."""
    loop = asyncio.get_running_loop()
    future = loop.create_future()

    async def body() -> None:
        await future

    task = asyncio.create_task(body())
    activity = Activity(loop, body(), "run", lambda _, __: None)
    assert aio.waiter_of(task) is None
    loop.call_soon(activity.start)
    await settle()

    assert aio.waiter_of(task) is future
    assert aio.waiter_of(activity) is future
    assert names_of(activity) == ["body"]
    future.set_result(None)
    await settle()
    assert aio.waiter_of(task) is aio.waiter_of(activity) is None


async def test_is_done(graphflow_runner: asyncio.Runner) -> None:
    """Futures of asyncio and of threads, and tasks, tell whether they are done."""
    futures: list[Any] = [asyncio.get_running_loop().create_future(), concurrent.futures.Future[None]()]

    assert not any(map(aio.is_done, [*futures, pending()]))
    for future in futures:
        future.set_result(None)
    assert all(map(aio.is_done, futures))


# What has been entered by `with`


class Room:
    """Is entered by `with` and `async with`."""

    def __enter__(self) -> None:
        """Take no time."""

    def __exit__(self, *_: object) -> None:
        """Take no time."""

    async def __aenter__(self) -> None:
        """Take no time."""

    async def __aexit__(self, *_: object) -> None:
        """Take no time."""


class WaitsAtTheDoor(Room):
    async def __aenter__(self) -> None:
        await never()


class WaitsOnTheWayOut(Room):
    async def __aexit__(self, *_: object) -> None:
        await never()


async def entered_by(coroutine: Coroutine[Any, Any, None]) -> list[Any]:
    task = await suspended(coroutine)
    return [thing for each in aio.coroutines(task) for thing in aio.entered(each)]


async def test_exit_methods_on_the_stack(graphflow_runner: asyncio.Runner) -> None:
    """`gc` shows the `__exit__` and `__aexit__` of all that a coroutine has entered and not left, in that order."""
    a, b, c, left = Room(), Room(), WaitsAtTheDoor(), Room()

    async def inner() -> None:
        async with b, c:
            """Not reached."""

    async def outer() -> None:
        with left:
            await asyncio.sleep(0)
        with a, memoryview(b""), contextlib.nullcontext():
            await inner()

    found = await entered_by(outer())

    assert [thing for thing in found if not isinstance(thing, contextlib.nullcontext)] == [a, b, c]
    assert len(found) == 4


async def test_what_is_being_left(graphflow_runner: asyncio.Runner) -> None:
    """It is not entered any more, though its own `__aexit__` is suspended; nor are locals that are such methods."""
    room = WaitsOnTheWayOut()

    async def body() -> None:
        methods = [WaitsOnTheWayOut.__aexit__, Room.__exit__]
        [leaves, _] = methods
        async with room:
            assert leaves in methods

    assert await entered_by(body()) == []


async def test_whose_code_was_entered(graphflow_runner: asyncio.Runner) -> None:
    """It is the file of a class, or of the generator that contextlib keeps in `gen`; a stack of them is not known."""

    @contextlib.contextmanager
    def plain() -> Iterator[None]:
        yield

    @contextlib.asynccontextmanager
    async def asynchronous() -> AsyncIterator[None]:
        yield

    async def body() -> None:
        async with Room(), asynchronous(), asyncio.Lock(), contextlib.AsyncExitStack():
            with Room(), plain(), contextlib.suppress(ValueError), contextlib.ExitStack():
                await never()

    task = await suspended(body())
    found = [file for each in aio.coroutines(task) for file in aio.files_entered(each)]
    assert found == [__file__, __file__, asyncio.locks.__file__, "", __file__, __file__, contextlib.__file__, ""]


@pytest.mark.parametrize("kind", [asyncio.Lock, asyncio.Condition, asyncio.Semaphore, asyncio.BoundedSemaphore])
async def test_who_is_inside(graphflow_runner: asyncio.Runner, kind: Callable[[], Any]) -> None:
    """Who has entered a lock is inside, and who waits in its `__aenter__` is not."""
    lock = kind()

    async def enters() -> None:
        async with lock:
            await never()

    first, second = await suspended(enters()), await suspended(enters())

    assert (aio.times_inside(first, lock), aio.times_inside(second, lock)) == (1, 0)
    assert aio.times_inside(first, kind()) == 0


async def test_inside_twice(graphflow_runner: asyncio.Runner) -> None:
    """Who has taken two permits is inside twice; at the third he only waits."""
    permits = asyncio.Semaphore(2)

    async def enters() -> None:
        async with permits, permits, permits:
            """Not reached."""

    assert aio.times_inside(await suspended(enters()), permits) == 2


async def test_the_lock_of_a_condition(graphflow_runner: asyncio.Runner) -> None:
    """Who has entered a condition has its `_lock`; not while in its `wait`."""
    lock = asyncio.Lock()
    condition = asyncio.Condition(lock)

    async def works() -> None:
        async with condition:
            await never()

    async def waits() -> None:
        async with condition:
            await condition.wait()

    first = await suspended(waits())
    second = await suspended(works())

    assert [aio.times_inside(task, thing) for task in (first, second) for thing in (lock, condition)] == [0, 0, 1, 1]
    assert aio.is_inside(condition, lock)
    assert aio.is_inside(lock, lock)
    assert not aio.is_inside(lock, condition)


@pytest.mark.parametrize("lock", [threading.Lock(), threading.RLock()])
def test_the_lock_of_a_threads_condition(lock: Any) -> None:
    """It is called `_lock` too."""
    assert aio.is_inside(threading.Condition(lock), lock)


# Waits for several tasks


@pytest.mark.parametrize("fails", [False, True])
async def test_the_end_of_a_task_group(graphflow_runner: asyncio.Runner, fails: bool) -> None:
    """`TaskGroup.__aexit__` waits for all of `self._tasks`, fewer and fewer, and for the first error."""
    children: list[asyncio.Task[Any]] = []
    quick, slow = asyncio.Event(), asyncio.Event()

    async def cleans_up() -> None:
        try:
            await never()
        finally:
            await slow.wait()

    async def body() -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(quick.wait())
            children.append(group.create_task(cleans_up()))
            await asyncio.sleep(0)
            if fails:
                raise ValueError

    task = await suspended(body())
    quick.set()
    await settle()

    waits = joint_waits(task)
    slow.set()
    assert waits
    assert all(wait == (children, "all", True) for wait in waits)


async def test_the_body_of_a_task_group(graphflow_runner: asyncio.Runner) -> None:
    """Who is in the body of a group does not wait for its tasks."""

    async def body() -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(never())
            await never()

    assert joint_waits(await suspended(body())) == []


@pytest.mark.parametrize(
    ("return_when", "wants"),
    [(asyncio.ALL_COMPLETED, "all"), (FIRST_COMPLETED, "any"), (FIRST_EXCEPTION, "any")],
)
async def test_wait(graphflow_runner: asyncio.Runner, return_when: str, wants: str) -> None:
    """The locals `fs` and `return_when` of `asyncio.tasks._wait` are what it waits for, and how."""
    tasks = {pending(), pending()}

    [wait] = joint_waits(await suspended(asyncio.wait(tasks, return_when=return_when)))

    assert (set(wait.tasks), wait.wants, wait.fails_early) == (tasks, wants, False)


async def test_the_task_of_wait_for(graphflow_runner: asyncio.Runner) -> None:
    """A task that is given to `asyncio.wait_for` is its local `fut`."""
    task = pending()

    for timeout in (60.0, None):
        assert joint_waits(await suspended(asyncio.wait_for(task, timeout))) == [([task], "all", True)]


async def test_the_coroutine_of_wait_for(graphflow_runner: asyncio.Runner) -> None:
    """A coroutine that is given to `asyncio.wait_for` is found: behind a task until 3.11, in the chain since 3.12."""
    task = await suspended(asyncio.wait_for(never(), 60.0))

    waits = joint_waits(task)
    inner = waits[0].tasks[0] if waits else task
    assert names_of(inner)[-1] == "never"
    assert bool(waits) is (sys.version_info < (3, 12))


@pytest.mark.parametrize("return_exceptions", [False, True])
async def test_gather(graphflow_runner: asyncio.Runner, return_exceptions: bool) -> None:
    """`_children` of the future are what it gathers; the closure of their callbacks has `return_exceptions`."""
    tasks = [pending(), pending()]
    future = asyncio.gather(*tasks, return_exceptions=return_exceptions)

    assert aio.waiter_of(await suspended(future)) is future
    assert aio.gathered(future) == (tasks, "all", not return_exceptions)
    assert aio.gathered(tasks[0]) is None


async def test_shield(graphflow_runner: asyncio.Runner) -> None:
    """The closure of `_outer_done_callback`, among the `_callbacks` of the outer future, has the inner."""
    inner = pending()
    outer = asyncio.shield(inner)
    task = await suspended(outer)

    assert aio.waiter_of(task) is outer
    assert aio.shielded(outer) is inner
    assert aio.shielded(inner) is None
    assert aio.shielded(task) is None


async def test_futures_that_stand_for_others(graphflow_runner: asyncio.Runner) -> None:
    """Tasks, and what `gather` and `shield` make; not a future of its own."""
    task = await suspended(pending())

    assert all(map(aio.stands_for_others, [task, asyncio.gather(task), asyncio.shield(task)]))
    assert not aio.stands_for_others(asyncio.get_running_loop().create_future())


async def test_futures_that_have_failed(graphflow_runner: asyncio.Runner) -> None:
    """With an error, or by cancellation."""
    well, ill, canceled = (asyncio.get_running_loop().create_future() for _ in range(3))
    well.set_result(None)
    ill.set_exception(ValueError())
    canceled.cancel()

    assert [aio.has_failed(future) for future in (well, ill, canceled)] == [False, True, True]


# Deadlines


async def deadlines_of(awaitable: Awaitable[Any], monkeypatch: pytest.MonkeyPatch) -> list[float]:
    monkeypatch.setattr(asyncio.get_running_loop(), "time", lambda: NOW)
    task = await suspended(awaitable)
    return [when for coroutine in aio.coroutines(task) for when in aio.deadlines(coroutine)]


@pytest.mark.parametrize(("timeout", "due"), [(60.0, [NOW + 60.0]), (None, [])])
async def test_the_deadline_of_wait(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, timeout: float | None, due: list[float]
) -> None:
    """`timeout_handle`, a local of `asyncio.tasks._wait`, has `when`."""
    assert await deadlines_of(asyncio.wait([pending()], timeout=timeout), monkeypatch) == due


@pytest.mark.parametrize("of", [never, pending])
@pytest.mark.parametrize(("timeout", "due"), [(60.0, [NOW + 60.0]), (None, [])])
async def test_the_deadline_of_wait_for(
    graphflow_runner: asyncio.Runner,
    monkeypatch: pytest.MonkeyPatch,
    timeout: float | None,
    due: list[float],
    of: Callable[[], Any],
) -> None:
    """It is in the local `timeout_handle` of `asyncio.wait_for` until 3.11, and an `asyncio.timeout` since 3.12."""
    assert await deadlines_of(asyncio.wait_for(of(), timeout), monkeypatch) == due


async def test_the_deadlines_of_timeouts(graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each `asyncio.Timeout` that was entered has its `when`, but for those that never end."""

    async def body() -> None:
        async with asyncio.timeout(60.0), asyncio.timeout(None), asyncio.timeout_at(NOW + 5.0):
            await never()

    assert sorted(await deadlines_of(body(), monkeypatch)) == [NOW + 5.0, NOW + 60.0]


# Waits for objects


class Wait(NamedTuple):
    """A wait at one of the primitives that are known."""

    code: types.CodeType
    thing: Callable[[], Any]
    begin: Callable[..., Any]
    """Called with the thing; by threads, with a timeout too if it can have one."""
    end: Callable[[Any], object]
    endings: set[str]
    has_timeout: bool = True


def full(kind: Callable[[int], Any]) -> Callable[[], Any]:
    """Makes queues that are full."""

    def made() -> Any:
        made = kind(1)
        made.put_nowait(0)
        return made

    return made


async def waits_inside(condition: asyncio.Condition) -> None:
    async with condition:
        await condition.wait()


def notified(condition: Any) -> None:
    with condition:
        condition.notify()


def waits_inside_in_a_thread(condition: threading.Condition, timeout: float | None) -> None:
    with condition:
        condition.wait(timeout)


OF_ASYNCIO = {
    "Event.wait": Wait(asyncio.Event.wait.__code__, asyncio.Event, lambda e: e.wait(), lambda e: e.set(), {"set"}),
    "Queue.get": Wait(
        asyncio.Queue.get.__code__,
        asyncio.Queue,
        lambda q: q.get(),
        lambda q: q.put_nowait(1),
        {"put", "put_nowait"},
    ),
    "Queue.put": Wait(
        asyncio.Queue.put.__code__,
        full(asyncio.Queue),
        lambda q: q.put(1),
        lambda q: q.get_nowait(),
        {"get", "get_nowait"},
    ),
    "Queue.join": Wait(
        asyncio.Queue.join.__code__,
        full(asyncio.Queue),
        lambda q: q.join(),
        lambda q: q.task_done(),
        {"task_done"},
    ),
    "Condition.wait": Wait(
        asyncio.Condition.wait.__code__,
        asyncio.Condition,
        waits_inside,
        lambda c: asyncio.ensure_future(notify(c)),
        {"notify", "notify_all"},
    ),
    "Semaphore.acquire": Wait(
        asyncio.Semaphore.acquire.__code__,
        lambda: asyncio.Semaphore(0),
        lambda s: s.acquire(),
        lambda s: s.release(),
        {"release"},
    ),
    "Lock.acquire": Wait(
        asyncio.Lock.acquire.__code__, lambda: held(), lambda k: k.acquire(), lambda k: k.release(), {"release"}
    ),
}


async def notify(condition: asyncio.Condition) -> None:
    async with condition:
        condition.notify()


def held() -> asyncio.Lock:
    """A lock that somebody has taken."""
    lock = asyncio.Lock()
    with contextlib.suppress(StopIteration):  # a lock that is free is taken without a wait
        lock.acquire().send(None)
    return lock


OF_THREADS = {
    "Event.wait": Wait(
        threading.Event.wait.__code__, threading.Event, lambda e, t: e.wait(t), lambda e: e.set(), {"set"}
    ),
    "Condition.wait": Wait(
        threading.Condition.wait.__code__,
        threading.Condition,
        waits_inside_in_a_thread,
        notified,
        {"notify", "notify_all"},
    ),
    "Semaphore.acquire": Wait(
        threading.Semaphore.acquire.__code__,
        lambda: threading.Semaphore(0),
        lambda s, t: s.acquire(timeout=t),
        lambda s: s.release(),
        {"release"},
    ),
    "Queue.get": Wait(
        queue.Queue.get.__code__,
        queue.Queue,
        lambda q, t: q.get(timeout=t),
        lambda q: q.put(1),
        {"put", "put_nowait"},
    ),
    "Queue.put": Wait(
        queue.Queue.put.__code__,
        full(queue.Queue),
        lambda q, t: q.put(1, timeout=t),
        lambda q: q.get(),
        {"get", "get_nowait"},
    ),
    "Queue.join": Wait(
        queue.Queue.join.__code__,
        full(queue.Queue),
        lambda q, _: q.join(),
        lambda q: q.task_done(),
        {"task_done"},
        has_timeout=False,
    ),
    "Future.result": Wait(
        concurrent.futures.Future.result.__code__,
        concurrent.futures.Future,
        lambda f, t: f.result(t),
        lambda f: f.set_result(None),
        {"set_result", "set_exception", "cancel"},
    ),
}


def test_every_known_wait_is_tried() -> None:
    """The two tables of this file have all that the search knows, and nothing else."""
    tried = {wait.code for wait in (*OF_ASYNCIO.values(), *OF_THREADS.values())}
    assert tried | {asyncio.Barrier.wait.__code__} == set(aio._WAITS)  # which ends by others who come: see test_held
    assert {"clear", *aio.FUTURE} < aio.ENDINGS


def of_code(frames: list[Frame], code: types.CodeType) -> Iterator[aio.ObjectWait]:
    """What is waited for in those frames that run a code."""
    for frame in frames:
        if frame.f_code is code:
            wait = aio.object_wait(frame)
            assert wait is not None
            yield wait


@pytest.mark.parametrize("name", OF_ASYNCIO)
async def test_a_primitive_of_asyncio(graphflow_runner: asyncio.Runner, name: str) -> None:
    """The local `self` of its method is what is waited for, until one of the endings is called."""
    case = OF_ASYNCIO[name]
    thing = case.thing()
    task = await suspended(case.begin(thing))

    [(found, endings, is_bounded)] = of_code(aio.frames_of(task), case.code)
    assert found is thing
    assert set(endings) == case.endings
    assert all(callable(getattr(thing, ending)) for ending in endings)
    assert not is_bounded
    case.end(thing)
    await settle()
    assert task.done()


@pytest.mark.parametrize("name", OF_THREADS)
@pytest.mark.parametrize("timeout", [None, 3600.0])
def test_a_primitive_of_threads(name: str, timeout: float | None) -> None:
    """The local `self` of its method is what is waited for; `timeout` tells whether that is given up."""
    case = OF_THREADS[name]
    thing = case.thing()
    thread = threading.Thread(target=case.begin, args=(thing, timeout), daemon=True)
    thread.start()

    [(found, endings, is_bounded)] = seen_in(thread, case.code)
    assert found is thing
    assert set(endings) == case.endings
    assert all(callable(getattr(thing, ending)) for ending in endings)
    assert is_bounded is (case.has_timeout and timeout is not None)
    case.end(thing)
    thread.join()


def seen_in(thread: threading.Thread, code: types.CodeType) -> list[aio.ObjectWait]:
    """What a thread waits for, as soon as it does."""
    assert thread.ident is not None
    while not (frames := [f for f in stack_of(thread.ident) if f.f_code is code]):
        assert thread.is_alive()
        time.sleep(0)  # give it its turn
    return list(of_code(frames, code))


async def test_an_awaited_future(graphflow_runner: asyncio.Runner) -> None:
    """A plain future can be ended by whoever knows it, a task ends by itself."""
    future = asyncio.get_running_loop().create_future()

    assert aio.awaited_future(future) == (future, ("set_result", "set_exception", "cancel"), False)
    assert aio.awaited_future(pending()) is None
    assert aio.awaited_future(None) is None


async def test_a_frame_of_none_of_them(graphflow_runner: asyncio.Runner) -> None:
    """Nothing is made of other code."""
    frames = aio.frames_of(await suspended(never()))

    assert frames
    for frame in frames:
        assert (aio.object_wait(frame), aio.joint_wait(frame)) == (None, None)


# The loop


async def test_the_current_task_from_another_thread(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.current_task(loop)` tells any thread what the loop is stepping: a task, or an activity."""
    loop = asyncio.get_running_loop()
    seen: list[Any] = []

    async def blocks() -> None:
        with ThreadPoolExecutor(1) as pool:
            seen.append(pool.submit(aio.current_task, loop).result())

    task = asyncio.create_task(blocks())
    activity = Activity(loop, blocks(), "run", lambda _, __: None)
    await task
    loop.call_soon(activity.start)
    await settle()

    assert seen == [task, activity]

"""asyncio works inside an activity from its first line on, and a cancellation arrives where it waits."""

from __future__ import annotations

import asyncio
from asyncio import CancelledError
from collections.abc import Callable, Coroutine, Generator
from contextvars import ContextVar, copy_context
from typing import Any

import pytest

from graphflow.executor.activity import Activity
from graphflow.testing.clock import settle


def activity(coroutine: Coroutine[Any, Any, Any]) -> tuple[Activity, list[tuple[Any, BaseException | None]]]:
    ended: list[tuple[Any, BaseException | None]] = []
    made = Activity(
        asyncio.get_running_loop(), coroutine, "activity", lambda result, error: ended.append((result, error))
    )
    return made, ended


async def begin(run: Activity) -> None:
    asyncio.get_running_loop().call_soon(run.start)
    await settle()


async def outcome(body: Callable[[], Coroutine[Any, Any, Any]]) -> Any:
    """Return the result of an activity that runs the body's coroutine, or raise its error."""
    loop = asyncio.get_running_loop()
    end = loop.create_future()

    def finished(result: Any, error: BaseException | None) -> None:
        end.set_result(result) if error is None else end.set_exception(error)

    loop.call_soon(Activity(loop, body(), "activity", finished).start)
    return await end


# what asyncio offers


async def test_current_task_is_the_activity(graphflow_runner: asyncio.Runner) -> None:
    """The activity is the current task from the first line on and after every suspension, and nowhere else."""
    seen: list[Any] = []

    async def body() -> None:
        seen.append(asyncio.current_task())
        await asyncio.sleep(0)
        seen.append(asyncio.current_task())

    test = asyncio.current_task()
    run, ended = activity(body())
    assert not run.done()
    await begin(run)

    assert seen == [run, run]
    assert ended == [(None, None)]
    assert asyncio.current_task() is test


async def test_what_a_task_tells_of_itself(graphflow_runner: asyncio.Runner) -> None:
    """An activity has a task's name, loop, coroutine and context, and reports its end."""
    coroutine = asyncio.sleep(0)
    context = copy_context()
    loop = asyncio.get_running_loop()
    run = Activity(loop, coroutine, "/talker.greet", lambda _, __: None, context)

    assert (run.get_name(), run.get_loop(), run.get_coro(), run.get_context()) == (
        "/talker.greet",
        loop,
        coroutine,
        context,
    )
    assert repr(run) == "<Activity /talker.greet>"
    await begin(run)
    assert run.done()
    assert run.get_coro() is None
    assert repr(run) == "<Activity /talker.greet done>"


async def test_its_own_context(graphflow_runner: asyncio.Runner) -> None:
    """An activity keeps its context variables from step to step and does not leak them; by default it gets a copy."""
    variable: ContextVar[str] = ContextVar("variable", default="nothing")
    variable.set("the caller's")
    seen: list[str] = []

    async def body() -> None:
        seen.append(variable.get())
        variable.set("its own")
        await asyncio.sleep(0)
        seen.append(variable.get())

    run, _ = activity(body())
    await begin(run)

    assert seen == ["the caller's", "its own"]
    assert variable.get() == "the caller's"


async def test_a_timeout_that_expires(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.timeout` cancels the wait and raises TimeoutError, and the handler goes on."""

    async def body() -> str:
        try:
            async with asyncio.timeout(0):
                await asyncio.Event().wait()
        except TimeoutError:
            await asyncio.sleep(0)
            task = asyncio.current_task()
            assert task is not None
            return f"late, {task.cancelling()} cancellations left"
        return "in time"

    assert await outcome(body) == "late, 0 cancellations left"


async def test_a_timeout_that_does_not_expire(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.timeout` around fast code has no effect."""

    async def body() -> str:
        async with asyncio.timeout(3600) as scope:
            await asyncio.sleep(0)
        assert not scope.expired()
        return "in time"

    assert await outcome(body) == "in time"


async def test_a_timeout_inside_a_timeout(graphflow_runner: asyncio.Runner) -> None:
    """The outer one's expiry passes through the inner as a cancellation."""

    async def body() -> str:
        try:
            async with asyncio.timeout(0):
                async with asyncio.timeout(3600):
                    await asyncio.Event().wait()
        except TimeoutError:
            return "outer"
        return "none"

    assert await outcome(body) == "outer"


async def test_a_task_group_waits_for_its_children(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.TaskGroup` runs children beside each other and ends when they have."""

    async def child(n: int) -> int:
        await asyncio.sleep(0)
        return n * n

    async def body() -> list[int]:
        async with asyncio.TaskGroup() as group:
            children = [group.create_task(child(n)) for n in range(3)]
        return [c.result() for c in children]

    assert await outcome(body) == [0, 1, 4]


@pytest.mark.parametrize("waits", [False, True])
async def test_a_child_error_cancels_the_group(graphflow_runner: asyncio.Runner, waits: bool) -> None:
    """One child's error cancels its siblings and the block, and arrives as a group of errors, as in any task."""
    cancelled: list[str] = []

    async def sibling() -> None:
        try:
            await asyncio.Event().wait()
        except CancelledError:
            cancelled.append("sibling")
            raise

    async def wrong() -> None:
        raise ValueError("wrong")

    async def body() -> tuple[str, int]:
        try:
            async with asyncio.TaskGroup() as group:
                group.create_task(sibling())
                group.create_task(wrong())
                if waits:
                    try:
                        await asyncio.Event().wait()
                    except CancelledError:
                        cancelled.append("block")
                        raise
        except* ValueError as errors:
            text = str(errors.exceptions)
        await asyncio.sleep(0)
        task = asyncio.current_task()
        assert task is not None
        return text, task.cancelling()

    text, cancelling = await outcome(body)

    assert text == "(ValueError('wrong'),)"
    assert sorted(cancelled) == (["block", "sibling"] if waits else ["sibling"])
    # How many cancellations are left over differs between Python's versions.
    assert (text, cancelling) == await asyncio.create_task(body())


async def test_wait_for(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.wait_for` returns the result, or raises TimeoutError after cancelling the awaitable."""
    cleaned: list[str] = []

    async def never() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            cleaned.append("up")

    async def body() -> tuple[str, str]:
        quick = await asyncio.wait_for(asyncio.sleep(0, "quick"), 3600)
        try:
            await asyncio.wait_for(asyncio.ensure_future(never()), 0.001)
        except TimeoutError:
            return quick, "late"
        return quick, "?"

    assert await outcome(body) == ("quick", "late")
    assert cleaned == ["up"]


async def test_gather(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.gather` returns results in order, and errors as results on request."""

    async def wrong() -> None:
        raise ValueError("wrong")

    async def body() -> Any:
        return await asyncio.gather(asyncio.sleep(0, 1), wrong(), asyncio.sleep(0, 2), return_exceptions=True)

    first, error, last = await outcome(body)
    assert (first, str(error), last) == (1, "wrong", 2)


async def test_shield(graphflow_runner: asyncio.Runner) -> None:
    """Cancelling an activity does not cancel an awaitable that it shields."""
    gate = asyncio.Event()
    inner: list[asyncio.Task[str]] = []

    async def work() -> str:
        await gate.wait()
        return "done"

    async def body() -> None:
        inner.append(asyncio.ensure_future(work()))
        await asyncio.shield(inner[0])

    run, ended = activity(body())
    await begin(run)
    run.cancel()
    await settle()
    assert isinstance(ended[0][1], CancelledError)

    gate.set()
    assert await inner[0] == "done"


async def test_to_thread(graphflow_runner: asyncio.Runner) -> None:
    """`asyncio.to_thread` gives the thread's result, and its error; the context goes with it."""
    where: ContextVar[str] = ContextVar("where", default="nowhere")

    def wrong() -> None:
        raise ValueError("in the thread")

    async def body() -> tuple[int, str, str]:
        where.set("here")
        try:
            await asyncio.to_thread(wrong)
        except ValueError as error:
            text = str(error)
        return await asyncio.to_thread(pow, 2, 10), await asyncio.to_thread(where.get), text

    assert await outcome(body) == (1024, "here", "in the thread")


async def test_awaiting_something_foreign_is_an_error_there(graphflow_runner: asyncio.Runner) -> None:
    """An awaitable that asyncio does not know raises RuntimeError at the await."""

    class Foreign:
        def __await__(self) -> Generator[object, None, None]:
            yield "something"

    async def body() -> str:
        try:
            await Foreign()
        except RuntimeError as error:
            return str(error)
        return "?"

    assert await outcome(body) == "activity awaited 'something', which asyncio cannot await"


async def test_awaiting_what_belongs_to_another_loop(graphflow_runner: asyncio.Runner) -> None:
    """A future of another event loop raises RuntimeError at the await."""
    other = asyncio.new_event_loop()
    future = other.create_future()

    async def body() -> str:
        try:
            await future
        except RuntimeError as error:
            return str(error)
        return "?"

    assert (await outcome(body)).endswith(", which belongs to another event loop")
    other.close()


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit])
def test_an_error_that_ends_the_program(error: type[BaseException]) -> None:
    """It ends the activity and propagates to the caller of the loop."""
    ended: list[BaseException | None] = []

    async def body() -> None:
        raise error

    async def main() -> None:
        loop = asyncio.get_running_loop()
        run = Activity(loop, body(), "activity", lambda _, error: ended.append(error))
        loop.call_soon(run.start)
        await settle()

    with pytest.raises(error):
        asyncio.run(main())
    assert isinstance(ended[0], error)


# cancellation


async def test_cancelled_before_its_first_step(graphflow_runner: asyncio.Runner) -> None:
    """A run that is cancelled before it began does not begin."""
    log: list[str] = []

    async def body() -> None:
        log.append("began")

    run, ended = activity(body())
    assert run.cancel("no more")
    await begin(run)

    assert log == []
    assert isinstance(ended[0][1], CancelledError)
    assert ended[0][1].args == ("no more",)
    assert not run.cancel()


async def test_cancelled_at_each_of_its_awaits(graphflow_runner: asyncio.Runner) -> None:
    """Wherever a run waits, cancellation arrives there and nowhere else, and its `finally` blocks all run."""

    async def body(log: list[str]) -> None:
        loop = asyncio.get_running_loop()
        try:
            log.append("sleep")
            await asyncio.sleep(0)
            log.append("future")
            await loop.create_future()
            log.append("lock")
            async with asyncio.Lock():
                log.append("child")
                await loop.create_task(asyncio.Event().wait())
        finally:
            log.append("finally")
            await asyncio.sleep(0)
            log.append("end")

    steps = ["sleep", "future", "lock", "child"]
    for count in (1, 2, 4):
        log: list[str] = []
        run, ended = activity(body(log))
        asyncio.get_running_loop().call_soon(run.start)
        while len(log) < count:
            await asyncio.sleep(0)
            if log[-1:] == ["future"] and count > 2 and run._fut_waiter is not None:
                run._fut_waiter.set_result(None)
        run.cancel()
        await settle()

        assert log == [*steps[:count], "finally", "end"]
        assert isinstance(ended[0][1], CancelledError)
        assert run.done()


async def test_what_is_said_of_cancellations(graphflow_runner: asyncio.Runner) -> None:
    """Each request counts until it is withdrawn or the activity has ended."""

    async def body() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            await asyncio.Event().wait()

    run, _ = activity(body())
    await begin(run)
    assert (run.cancelling(), run.uncancel()) == (0, 0)
    assert run.cancel()
    await settle()
    assert (run.cancelling(), run.uncancel(), run.cancelling()) == (1, 0, 0)
    assert run.cancel()
    await settle()
    assert run.done()
    assert not run.cancel()


async def test_cancelled_in_its_finally(graphflow_runner: asyncio.Runner) -> None:
    """A second cancellation interrupts the cleanup at its await."""
    log: list[str] = []

    async def body() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            log.append("cleaning")
            try:
                await asyncio.Event().wait()
            finally:
                log.append("interrupted")

    run, ended = activity(body())
    await begin(run)
    run.cancel()
    await settle()
    assert log == ["cleaning"]
    run.cancel()
    await settle()

    assert log == ["cleaning", "interrupted"]
    assert isinstance(ended[0][1], CancelledError)


@pytest.mark.parametrize("waits", [False, True])
async def test_cancelled_by_itself(graphflow_runner: asyncio.Runner, waits: bool) -> None:
    """A run that cancels itself goes on to its next await, be it one that would last for ever."""
    log: list[str] = []

    async def body() -> None:
        task = asyncio.current_task()
        assert task is not None
        task.cancel()
        log.append("still here")
        await (asyncio.Event().wait() if waits else asyncio.sleep(0))
        log.append("not here")

    run, ended = activity(body())
    await begin(run)

    assert log == ["still here"]
    assert isinstance(ended[0][1], CancelledError)


async def test_cancelled_when_what_it_waits_for_is_done(graphflow_runner: asyncio.Runner) -> None:
    """A cancellation between the result and the step that would bring it still cancels."""
    future = asyncio.get_running_loop().create_future()

    async def body() -> object:
        return await future

    run, ended = activity(body())
    await begin(run)
    future.set_result("result")
    run.cancel()
    await settle()

    assert isinstance(ended[0][1], CancelledError)


async def test_a_cancellation_that_is_caught_is_over(graphflow_runner: asyncio.Runner) -> None:
    """A run may refuse to end, and its result counts."""

    async def body() -> str:
        try:
            await asyncio.Event().wait()
        except CancelledError:
            task = asyncio.current_task()
            assert task is not None
            assert task.uncancel() == 0
        await asyncio.sleep(0)
        return "stayed"

    run, ended = activity(body())
    await begin(run)
    run.cancel()
    assert run.cancelling() == 1
    await settle()

    assert ended == [("stayed", None)]

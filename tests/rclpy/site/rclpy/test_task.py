"""Futures and tasks."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest

from rclpy.task import Future, Task


def test_a_future_is_done_when_something_was_set() -> None:
    """A result or an exception; a cancelled one is cancelled, and not done."""
    future: Future[int] = Future()
    assert not future.done()
    assert future.result() is None
    future.set_result(3)
    assert future.done()
    assert future.result() == 3
    future.cancel()
    assert not future.cancelled()
    failed: Future[int] = Future()
    failed.set_exception(ValueError("no"))
    with pytest.raises(ValueError, match="no"):
        failed.result()
    other: Future[int] = Future()
    other.cancel()
    assert other.cancelled()
    assert not other.done()


def test_those_who_asked_are_called_where_it_was_set() -> None:
    """Once; those who ask later at once."""
    future, told = Future[int](), list[Any]()
    future.add_done_callback(lambda f: told.append(f.result()))
    future.set_result(1)
    future.add_done_callback(lambda f: told.append("late"))
    assert told == [1, "late"]


def test_an_executors_future_calls_by_tasks() -> None:
    """So callbacks run where the executor's run."""

    class Runs:
        def __init__(self) -> None:
            self.tasks: list[Any] = []

        def create_task(self, callback: Any, *args: Any) -> None:
            self.tasks.append((callback, args))

    runs = Runs()
    future: Future[int] = Future(executor=runs)
    future.add_done_callback(print)
    future.set_result(1)
    future.add_done_callback(repr)
    assert runs.tasks == [(print, (future,)), (repr, (future,))]


def test_an_exception_that_nobody_looked_at_is_told() -> None:
    """When the future goes."""
    with pytest.warns(UserWarning, match="never retrieved: lost"):
        Future[int]().set_exception(ValueError("lost"))


def test_a_callback_that_fails_is_not_the_setters_error() -> None:
    """It is told, and the others are called."""
    future, told = Future[int](), list[int]()
    future.add_done_callback(lambda f: 1 // 0)
    future.add_done_callback(lambda f: told.append(1))
    with pytest.warns(UserWarning, match="by zero"):
        future.set_result(1)
    assert told == [1]


def test_a_task_runs_a_function_or_steps_a_coroutine() -> None:
    """A step for each call, until it is done."""
    future: Future[int] = Future()

    async def work(a: int, b: int = 0) -> int:
        return a + b + await future

    plain, stepped = Task[int](max, (1, 2)), Task[int](work, (1,), {"b": 2})
    plain()
    stepped()
    assert (plain.result(), stepped.done(), stepped.awaits) == (2, False, future)
    future.set_result(10)
    stepped()
    stepped()
    assert stepped.result() == 13
    failed = Task[int](lambda: 1 // 0)
    failed()
    assert isinstance(failed.exception(), ZeroDivisionError)


def test_a_task_that_is_cancelled_runs_no_further() -> None:
    """Its `finally` does."""
    told: list[str] = []

    async def work() -> None:
        try:
            await Future[int]()
        finally:
            told.append("cleaned up")

    task = Task[None](work)
    task()
    task.cancel()
    task()
    assert told == ["cleaned up"]
    assert task.cancelled()


def test_a_future_is_awaited_in_asyncio_too() -> None:
    """Whichever thread sets it."""
    future: Future[int] = Future()
    threading.Timer(0.01, future.set_result, (4,)).start()

    async def twice() -> list[int]:
        async with asyncio.timeout(5):
            return [await future, await future]

    assert asyncio.run(twice()) == [4, 4]

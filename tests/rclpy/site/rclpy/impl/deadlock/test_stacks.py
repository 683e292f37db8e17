"""What threads are doing, read from their stacks."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import pytest

import rclpy
from rclpy.executors import Executor, ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.deadlock.stacks import Stack, stacks, standing
from rclpy.node import Node
from tests.until import until

LIMIT = 20.0


def spin(executor: Executor) -> None:
    """Spin until the context ends."""
    with suppress(ExternalShutdownException):
        executor.spin()


def of(thread: threading.Thread) -> Stack | None:
    return next((stack for stack in stacks() if stack.thread is thread), None)


def test_a_thread_that_spins_and_has_nothing_to_do_is_idle(node: Node) -> None:
    """It is seen to spin, and stands nowhere."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    thread = threading.Thread(target=spin, args=(executor,))
    thread.start()
    stack: Stack = until(lambda: (s := of(thread)) is not None and s.is_idle and s)
    assert stack.is_users
    assert set(stack.spins) == {executor}
    assert len(stack.levels) == 1
    assert thread.ident not in standing()
    rclpy.shutdown()
    thread.join(LIMIT)


def test_a_callback_is_a_level_of_its_own(node: Node) -> None:
    """With the code of users' that it is in, and where that stands."""
    executor, release = SingleThreadedExecutor(), threading.Event()

    def tick() -> None:
        timer.cancel()
        release.wait(LIMIT)

    timer = node.create_timer(0.01, tick)
    executor.add_node(node)
    thread = threading.Thread(target=spin, args=(executor,))
    thread.start()
    stack: Stack = until(lambda: (s := of(thread)) is not None and len(s.levels) == 2 and s)
    inner = stack.levels[1]
    assert inner.run is not None
    assert inner.run.entity is timer
    assert inner.innermost is not None
    assert inner.innermost.f_code is tick.__code__
    assert not stack.is_idle
    assert until(lambda: standing().get(thread.ident or 0))[0] == id(inner.innermost.original)
    release.set()
    rclpy.shutdown()
    thread.join(LIMIT)


def test_stacks_are_read_while_collections_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    """As those of other threads, which may go on at any moment."""
    waits: list[bool] = []

    @contextmanager
    def noted() -> Iterator[None]:
        waits.append(True)
        yield

    monkeypatch.setattr("rclpy.impl.deadlock.stacks.uncollected", noted)
    assert threading.get_ident() in standing()
    assert waits == [True]


def test_one_that_spins_within_a_callback_waits(node: Node) -> None:
    """It is not idle: the callback waits."""
    executor = SingleThreadedExecutor()

    def tick() -> None:
        timer.cancel()
        executor.spin_once(timeout_sec=LIMIT)

    timer = node.create_timer(0.01, tick)
    executor.add_node(node)
    thread = threading.Thread(target=spin, args=(executor,))
    thread.start()
    stack: Stack = until(lambda: (s := of(thread)) is not None and s.levels[-1].run and s.levels[-1].waiting and s)
    assert stack.levels[-1].waiting is executor
    assert not stack.is_idle
    until(lambda: thread.ident in standing())
    rclpy.shutdown()
    thread.join(LIMIT)


def test_threads_of_a_pool_are_nobodys_to_spin_with(node: Node) -> None:
    """And only those that run something are told of."""
    executor, release = MultiThreadedExecutor(2), threading.Event()

    def tick() -> None:
        timer.cancel()
        release.wait(LIMIT)

    timer = node.create_timer(0.01, tick)
    executor.add_node(node)
    thread = threading.Thread(target=spin, args=(executor,))
    thread.start()
    working: Stack = until(lambda: next((s for s in stacks() if s.thread.name.startswith("executor-")), None))
    assert not working.is_users
    assert [level.run is not None for level in working.levels] == [False, True]
    release.set()
    until(lambda: not any(s.thread.name.startswith("executor-") for s in stacks()))
    rclpy.shutdown()
    thread.join(LIMIT)

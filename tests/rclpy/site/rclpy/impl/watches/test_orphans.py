"""Nodes that a spin has taken out of their executor."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import SimpleNamespace
from typing import Any

import pytest

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.watches import orphans
from rclpy.node import Node
from rclpy.task import Future
from tests.until import until


@contextmanager
def spun(node: Node) -> Iterator[SingleThreadedExecutor]:
    """An executor with that node, which a thread spins."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def spin() -> None:
        while not executor._is_shutdown:
            executor.spin_once(0.05)

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        yield executor
    finally:
        executor.shutdown()
        thread.join(10)


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records if "no longer spun" in record.getMessage()]


def postponed(monkeypatch: pytest.MonkeyPatch) -> tuple[list[Callable[[], object]], list[Any]]:
    """The checks that are to be made later, which a test makes itself; and the executors that they ask about."""
    checks: list[Callable[[], object]] = []
    looks: list[Any] = []
    loop = SimpleNamespace(call_later=lambda _, check: checks.append(check))
    is_spun = orphans._is_spun

    def look(executor: Any) -> bool:
        looks.append(executor)
        return is_spun(executor)

    monkeypatch.setattr(orphans, "LOOP", SimpleNamespace(start=lambda: loop))
    monkeypatch.setattr(orphans, "_is_spun", look)
    return checks, looks


def test_a_spin_in_a_callback(node: Node, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is told with the line, and what to do instead."""
    monkeypatch.setattr(orphans, "WARN_AFTER", 0.05)
    done: Future[None] = Future()
    done.set_result(None)

    def tick() -> None:
        timer.cancel()
        rclpy.spin_until_future_complete(node, done)  # here

    timer = node.create_timer(0.01, tick)
    with spun(node):
        until(lambda: told(caplog))
    [text] = told(caplog)
    line = tick.__code__.co_firstlineno + 2
    assert text.startswith(
        f"/{node.get_name()} is no longer spun: rclpy.spin_until_future_complete, called in "
        f"test_orphans.py:{line} in tick, removed it from its SingleThreadedExecutor"
    )
    assert "do not spin in a callback: future.add_done_callback(...)" in text


def test_a_spin_beside_the_executor(
    node: Node, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its own spin does the same, and keeps the node."""
    monkeypatch.setattr(orphans, "WARN_AFTER", 0.05)
    with spun(node):
        rclpy.spin_once(node, timeout_sec=0.01)
        until(lambda: told(caplog))
    [text] = told(caplog)
    assert "spin the executor, with all its nodes: executor.spin_once(...)" in text


def test_a_node_that_is_spun_again(
    node: Node, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By its executor or by a loop, or one that is destroyed, or whose executor spins no more: nothing is told."""
    checks, looks = postponed(monkeypatch)
    with spun(node) as executor:
        rclpy.spin_once(node, timeout_sec=0.01)
        executor.add_node(node)
        until(lambda: checks)
        checks.pop()()
        assert not looks
    with spun(node):
        rclpy.spin_once(node, timeout_sec=0.01)
    until(lambda: checks)
    checks.pop()()
    assert looks
    assert told(caplog) == []


@pytest.mark.parametrize("limit", [None, 0.02])
def test_a_callback_that_destroys_its_node(
    node: Node, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, limit: float | None
) -> None:
    """It is told where the spin waits for ever; a loop of the program's own may end by itself."""
    checks, looks = postponed(monkeypatch)
    done = threading.Event()

    def tick() -> None:
        node.destroy_node()  # here
        done.set()

    def spin() -> None:
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        while not (limit and done.is_set() and waited):
            executor.spin_once(limit)

    waited: list[bool] = []
    node.create_timer(0.01, tick)
    thread = threading.Thread(target=lambda: suppressed(spin))
    thread.start()
    assert done.wait(10)
    until(lambda: checks)
    checks.pop()()
    assert bool(looks) is (limit is None)
    waited.append(True)
    rclpy.try_shutdown()
    thread.join(10)
    [*texts] = [r.getMessage() for r in caplog.records if "without a node" in r.getMessage()]
    line = tick.__code__.co_firstlineno + 1
    text = f"test_orphans.py:{line} in tick destroyed /node, and its spin goes on without a node: to end it"
    assert [t.partition(" as well")[0] for t in texts] == ([text] if limit is None else [])


def suppressed(fn: Callable[[], Any]) -> None:
    """Call `fn` until the context is shut down."""
    with suppress(ExternalShutdownException):
        fn()

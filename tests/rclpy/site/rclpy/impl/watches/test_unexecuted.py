"""Goals that nobody executes."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from example_interfaces.action import Fibonacci

from rclpy.action import ActionClient, ActionServer
from rclpy.impl.deadlock import waiting
from rclpy.impl.watches import unexecuted
from rclpy.node import Node
from tests.rclpy.conftest import Spinner

Caplog = pytest.LogCaptureFixture


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unexecuted, "WARN_AFTER", 0.1)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)


def told(caplog: Caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if "execute()" in record.getMessage()]


def send(node: Node, spin: Spinner) -> Any:
    sent: Any = ActionClient(node, Fibonacci, "fib").send_goal_async(Fibonacci.Goal())
    spin(sent.done)
    return sent.result().get_result_async()


def test_a_goal_that_is_accepted_and_not_executed(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """It is told once, with the callback that should have executed it."""

    def accept(goal: Any) -> None:
        """Keep nothing."""

    server = ActionServer(node, Fibonacci, "fib", print, handle_accepted_callback=accept)
    send(node, spin)
    spin(lambda: told(caplog))
    send(node, spin)
    line = accept.__code__.co_firstlineno
    [text] = told(caplog)
    assert text.startswith("/node accepted a goal of fib 0.")
    assert text.endswith(f": end accept (test_unexecuted.py:{line}) with goal_handle.execute()")
    server.destroy()


def test_a_goal_that_may_be_executed_yet(
    node: Node, spin: Spinner, caplog: Caplog, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is told later, and not while another one is executed."""
    kept: list[Any] = []

    def execute(goal: Any) -> Any:
        goal.succeed()
        return Fibonacci.Result()

    ActionServer(node, Fibonacci, "fib", execute, handle_accepted_callback=kept.append)
    result = send(node, spin)
    looks: list[object] = []
    is_kept = unexecuted._is_kept

    def look(goal: Any, *known: object) -> bool:
        looks.append(is_kept(goal, *known))
        return bool(looks[-1])

    monkeypatch.setattr(unexecuted, "_is_kept", look)
    spin(lambda: looks)
    assert (looks, told(caplog)) == ([True], [])
    kept[0].execute()
    spin(result.done)
    monkeypatch.setattr(unexecuted, "KEPT", 0.1)
    send(node, spin)
    spin(lambda: told(caplog))


def test_many_goals_that_may_be_executed_yet(node: Node, spin: Spinner, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each look searches the process for the holders of one of them."""
    kept: list[Any] = []
    server = ActionServer(node, Fibonacci, "fib", print, handle_accepted_callback=kept.append)
    searched: list[object] = []
    monkeypatch.setattr(unexecuted, "WARN_AFTER", 0.0)

    def search(goal: object, *_: object) -> bool:
        if threading.current_thread() is threading.main_thread():  # the context looks, too, in a thread of its own
            searched.append(goal)
        return True

    monkeypatch.setattr(unexecuted, "_is_kept", search)
    for _ in range(3):
        send(node, spin)
    watch = unexecuted.Unexecuted(node._graphflow.life)
    for count in (1, 2, 3, 3):
        watch.check()
        assert len(searched) == count
    server.destroy()

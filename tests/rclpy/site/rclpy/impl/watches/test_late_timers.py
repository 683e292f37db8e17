"""Timers of a period of zero, timers that are called late again and again, and time that does not begin."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

import rclpy
from graphflow.runtime.node_clock import TIMELESS
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.impl.deadlock import waiting
from rclpy.impl.watches import late_timers
from rclpy.impl.watches.starvation import empty_group
from rclpy.node import Node
from tests.rclpy.conftest import Spinner

Caplog = pytest.LogCaptureFixture


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(late_timers, "WARN_AFTER", 0.1)
    monkeypatch.setattr(late_timers, "SLOW", 0.05)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)


def told(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "WARNING"]


def tick() -> None:
    time.sleep(0.15)


PLACE = f"test_late_timers.py:{tick.__code__.co_firstlineno + 1} in tick"


def test_a_callback_that_takes_longer_than_its_period(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Told once, at the second time, with the line; a longer period is a way out."""
    node.create_timer(0.01, tick)
    spin(lambda: told(caplog))
    with pytest.raises(AssertionError, match="did not come about"):
        spin(lambda: len(told(caplog)) > 1, limit=0.5)
    [text] = told(caplog)
    assert text.startswith("timer tick of /node takes 0.")
    assert f" s, as in {PLACE}, and is due every 0.01 s: return from it soon" in text
    assert text.endswith(", or give it a longer period")


def test_a_callback_that_keeps_a_timer(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Told with the timer that is late; timers with time to spare are not."""
    chat = node.create_publisher(String, "chat", 10)
    node.create_subscription(String, "chat", lambda _: tick(), 10)
    node.create_timer(0.02, lambda: chat.publish(String()))
    node.create_timer(10.0, lambda: None)
    spin(lambda: told(caplog))
    [text] = told(caplog)
    assert f"as in {PLACE}, and keeps timer <lambda>, which is due every 0.02 s, waiting: return from it soon" in text
    assert text.endswith("give it a callback group of its own and spin with MultiThreadedExecutor()")


def test_a_group_without_callbacks(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """It is named beside what its callbacks would help; a group that has some is not."""
    node.mine, node.other = ReentrantCallbackGroup(), ReentrantCallbackGroup()  # type: ignore[attr-defined]
    node.create_timer(10.0, tick, callback_group=node.mine)  # type: ignore[attr-defined]
    node.create_timer(0.01, tick)
    spin(lambda: told(caplog))
    [text] = told(caplog)
    assert text.endswith(
        ", or give it a longer period; self.other has no callbacks yet: write callback_group=self.other where they are "
        "made"
    )
    node.create_timer(10.0, tick, callback_group=node.other)  # type: ignore[attr-defined]
    assert empty_group(node) == ""


def test_callbacks_that_are_slow_where_nothing_is_late(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Nothing is told; nor of a callback that was slow once."""
    calls: list[Callable[[], None]] = [tick]
    node.create_timer(0.01, lambda: calls.pop()() if calls else None)
    with pytest.raises(AssertionError, match="did not come about"):
        spin(lambda: told(caplog), limit=0.5)


def test_a_period_of_zero(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Told once while the timer runs, and not of one that is cancelled when it is called."""
    once = node.create_timer(0, lambda: once.cancel())
    timer = node.create_timer(0, lambda: None)
    spin(lambda: told(caplog))
    timer.cancel()
    line = test_a_period_of_zero.__code__.co_firstlineno + 3
    place = f"timer <lambda> (test_late_timers.py:{line}) of /node"
    way = "is called continuously: give it one, as in create_timer(0.1, ...)"
    assert told(caplog) == [f"{place} has a period of 0 s, and {way}"]


def test_time_that_does_not_begin(network: Any, capfd: pytest.CaptureFixture[str]) -> None:
    """Told in the node's log, in words of `doctor`; not where /clock speaks."""
    rclpy.init(args=["--ros-args", "-p", "use_sim_time:=true"])
    teller = Node("teller")
    clock = teller.create_publisher(Clock, "/clock", 1)
    message = Clock()
    message.clock.sec = 5
    clock.publish(message)
    spinner = Spinner()
    heard = Node("waiting", namespace="attic", cli_args=["--ros-args", "-r", "/clock:=/other"])
    spinner.executor.add_node(heard)
    found = []

    def is_reported() -> bool:
        found.append(capfd.readouterr().err)
        return TIMELESS in "".join(found)

    spinner(is_reported)
    clock.publish(message)
    text = "".join(found)
    assert text.count(TIMELESS) == 1
    assert f"[attic.waiting]: /attic/waiting: {TIMELESS}" in text
    spinner.executor.shutdown()

"""Subscriptions that lose most of their messages."""

from __future__ import annotations

import time

import pytest
from std_msgs.msg import String

from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.deadlock import waiting
from rclpy.impl.watches import late_timers, slow_readers
from rclpy.node import Node
from rclpy.task import Future
from tests.rclpy.conftest import Spinner

Caplog = pytest.LogCaptureFixture


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(slow_readers, "SLOW", 0.05)
    monkeypatch.setattr(late_timers, "SLOW", 0.05)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)


def told(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if " messages: " in r.getMessage()]


def hear(_: object) -> None:
    time.sleep(0.2)


PLACE = f"test_slow_readers.py:{hear.__code__.co_firstlineno + 1} in hear"
WAY = "return from it soon (a timer does what a sleep does)"


def test_a_callback_that_is_too_slow(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """It is told once, with the line and the losses."""
    chat = node.create_publisher(String, "chat", 10)
    node.create_subscription(String, "chat", hear, 10)
    for _ in range(150):
        chat.publish(String())
    spin(lambda: told(caplog))
    with pytest.raises(AssertionError, match="did not come about"):
        spin(lambda: len(told(caplog)) > 1, limit=0.5)
    [text] = told(caplog)
    assert text.startswith("subscription hear of /node takes 0.")
    assert text.endswith(f" s or more, as in {PLACE}, and has lost 140 of 150 messages: {WAY}")


def test_a_callback_that_keeps_a_subscription(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """It is told with the subscription, and the way to another thread."""
    chat = node.create_publisher(String, "chat", 10)
    node.create_subscription(String, "chat", lambda _: None, 10)

    def tick() -> None:
        for _ in range(150):
            chat.publish(String())
        hear(None)

    node.create_timer(0.01, tick)
    spin(lambda: told(caplog))
    [text] = told(caplog)
    assert "and subscription <lambda> has lost 1" in text
    assert text.endswith(f"{WAY}, or give it a callback group of its own and spin with MultiThreadedExecutor()")


@pytest.mark.parametrize(("depth", "number"), [(1, 150), (10, 90), (300, 450)])
def test_losses_that_may_be_meant(node: Node, spin: Spinner, caplog: Caplog, depth: int, number: int) -> None:
    """A queue of one keeps the newest; few losses, or less than half, are nothing to report."""
    chat = node.create_publisher(String, "chat", 10)
    node.create_subscription(String, "chat", hear, depth)
    for _ in range(number):
        chat.publish(String())
    with pytest.raises(AssertionError, match="did not come about"):
        spin(lambda: told(caplog), limit=0.5)


def test_a_callback_that_spins(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """It waits for other callbacks: what keeps them is told by others."""
    chat = node.create_publisher(String, "chat", 10)

    def wait(_: String) -> None:
        SingleThreadedExecutor().spin_until_future_complete(Future(), timeout_sec=0.2)

    node.create_subscription(String, "chat", wait, 10)
    for _ in range(150):
        chat.publish(String())
    with pytest.raises(AssertionError, match="did not come about"):
        spin(lambda: told(caplog), limit=0.5)

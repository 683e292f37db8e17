"""Callbacks of timers with an argument."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from rclpy.impl.mistakes import timer_arguments
from rclpy.node import Node
from rclpy.timer import TimerInfo


def with_message(message: Any) -> None: ...
def with_info(info: TimerInfo) -> None: ...
def with_default(times: int = 1) -> None: ...
def without() -> None: ...


@pytest.mark.parametrize(
    ("callback", "told"),
    [
        (with_message, "with_message without arguments: leave out message, or write message: TimerInfo"),
        (with_info, ""),
        (with_default, ""),
        (without, ""),
    ],
)
def test_arguments_that_ros_2_does_not_fill(
    node: Node,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    callback: Callable[..., None],
    told: str,
) -> None:
    """They are told once with the line of the callback; graphflow fills them."""
    monkeypatch.setattr(timer_arguments, "_told", set())
    node.create_timer(1.0, callback)
    node.create_timer(2.0, callback)
    place = f"test_timer_arguments.py:{callback.__code__.co_firstlineno}"
    assert caplog.messages == ([f"{place}: in ROS 2 a timer calls {told}"] if told else [])

"""Guard conditions."""

from __future__ import annotations

import threading

import pytest

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from tests.rclpy.conftest import Spinner


def test_the_callback_is_called_once_for_all_triggers_before(node: Node, spin: Spinner) -> None:
    """From whatever thread."""
    calls: list[int] = []
    guard = node.create_guard_condition(lambda: calls.append(1))
    guard.trigger()
    guard.trigger()
    spin(lambda: calls)
    spin.executor.spin_once(timeout_sec=0)
    assert calls == [1]
    threading.Timer(0.01, guard.trigger).start()
    spin(lambda: len(calls) == 2)
    assert node.destroy_guard_condition(guard)
    with pytest.raises(InvalidHandle):
        guard.trigger()

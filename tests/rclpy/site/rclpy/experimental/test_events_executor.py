"""The executor of ROS 2's that is told of events."""

from __future__ import annotations

import time

from rclpy.experimental import EventsExecutor
from rclpy.node import Node


def test_it_runs_callbacks(node: Node) -> None:
    """As the executor of one thread does."""
    ticks: list[int] = []
    node.create_timer(0.001, lambda: ticks.append(1))
    with EventsExecutor() as executor:
        executor.add_node(node)
        until = time.monotonic() + 10
        while len(ticks) < 3 and time.monotonic() < until:
            executor.spin_once(timeout_sec=0.1)
    assert len(ticks) == 3

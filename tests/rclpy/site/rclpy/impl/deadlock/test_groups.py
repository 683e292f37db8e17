"""What executors and callback groups are to the search."""

from __future__ import annotations

from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.deadlock.groups import called, executors, is_exclusive, threads_of
from rclpy.node import Node


def test_how_many_they_let_in(node: Node) -> None:
    """Of kinds whose ways are their own that is not known."""

    class Odd(MutuallyExclusiveCallbackGroup):
        def beginning_execution(self, entity: Any) -> bool:
            return True

    class Strange(SingleThreadedExecutor):
        def spin_once(self, timeout_sec: float | None = None) -> None:
            super().spin_once(timeout_sec)

    assert [is_exclusive(g()) for g in (MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup, Odd)] == [
        True,
        False,
        False,
    ]
    single, pool, strange = SingleThreadedExecutor(), MultiThreadedExecutor(3), Strange()
    assert [threads_of(one) for one in (single, pool, strange)] == [1, 3, None]
    assert {single, pool, strange} <= {*executors()}


def test_how_groups_are_called(node: Node) -> None:
    """By the attribute of their node."""
    node.mine = MutuallyExclusiveCallbackGroup()  # type: ignore[attr-defined]
    node.all = ReentrantCallbackGroup()  # type: ignore[attr-defined]
    assert called(node.default_callback_group, node) == "default callback group"
    assert called(node.mine, node) == "callback group 'mine'"  # type: ignore[attr-defined]
    assert called(node.all, node) == "ReentrantCallbackGroup 'all'"  # type: ignore[attr-defined]
    assert called(MutuallyExclusiveCallbackGroup(), None) == "callback group"

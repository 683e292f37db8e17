"""What callback groups and executors are to the search for deadlocks: how they are called, and how much they let in."""

from __future__ import annotations

from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor, all_executors

ATTEMPTS = 5
"""How often things are looked at that other threads change meanwhile."""


def executors() -> list[Executor]:
    """Those of this process; more may be made meanwhile."""
    for _ in range(ATTEMPTS):
        try:
            return list(all_executors)
        except RuntimeError:  # one was, in another thread
            continue
    return []


def called(group: Any, node: Any) -> str:
    """What a callback group is called: by the attribute of its node."""
    if node is not None and group is node.default_callback_group:
        return "default callback group"
    attribute = next((a for a, value in list(vars(node).items()) if value is group), "") if node is not None else ""
    kind = "callback group" if is_exclusive(group) else type(group).__name__
    return f"{kind} '{attribute}'" if attribute else kind


def is_exclusive(group: Any) -> bool:
    """Whether one callback of a group runs at a time: for groups whose ways are their own that is not known."""
    kind = MutuallyExclusiveCallbackGroup
    return isinstance(group, kind) and type(group).beginning_execution is kind.beginning_execution


def threads_of(executor: Executor) -> int | None:
    """The threads of an executor; None for one whose ways are its own."""
    way = type(executor).spin_once
    if isinstance(executor, SingleThreadedExecutor) and way is SingleThreadedExecutor.spin_once:
        return 1
    if isinstance(executor, MultiThreadedExecutor) and way is MultiThreadedExecutor.spin_once:
        return executor._executor._max_workers
    return None

"""Callback groups and executors as the deadlock detector sees them: their names and capacities."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor, all_executors

if TYPE_CHECKING:
    from rclpy.impl.spinning import Spins
    from rclpy.node import Node


ATTEMPTS = 5
"""Attempts to read a collection that other threads change meanwhile."""


def executors() -> list[Executor]:
    """Return the executors of this process; others may be created meanwhile."""
    for _ in range(ATTEMPTS):
        try:
            return list(all_executors)
        except RuntimeError:  # one was, in another thread
            continue
    return []


def called(group: CallbackGroup, node: Node | None) -> str:
    """Return a callback group's name: the node's attribute that holds it."""
    if node is not None and group is node.default_callback_group:
        return "default callback group"
    attribute = next((a for a, value in list(vars(node).items()) if value is group), "") if node is not None else ""
    kind = "callback group" if is_exclusive(group) else type(group).__name__
    return f"{kind} '{attribute}'" if attribute else kind


def is_exclusive(group: CallbackGroup) -> bool:
    """Whether a group runs one callback at a time; unknown for groups with a `can_execute` of their own."""
    kind = MutuallyExclusiveCallbackGroup
    return isinstance(group, kind) and type(group).beginning_execution is kind.beginning_execution


def threads_of(executor: Spins) -> int | None:
    """Return the number of an executor's threads; None for a user-defined one."""
    single, multi = SingleThreadedExecutor, MultiThreadedExecutor
    if isinstance(executor, single) and type(executor).spin_once is single.spin_once:
        return 1
    if isinstance(executor, multi) and type(executor).spin_once is multi.spin_once:
        return executor.spinning.threads
    return None

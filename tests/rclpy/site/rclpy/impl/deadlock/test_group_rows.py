"""Callback groups and executors as plain data."""

from __future__ import annotations

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.impl.deadlock.group_rows import group_rows
from rclpy.impl.entities import entities_of, role_of
from rclpy.node import Node


def test_the_rows_of_a_node(node: Node) -> None:
    """A row for each group with callbacks of users', and one for the executor, spun or not."""

    def tick() -> None:
        """Nothing."""

    node.create_timer(60.0, tick, callback_group=ReentrantCallbackGroup())
    roles = {entity: role_of(entity) for entity in entities_of(node)}
    row = {"handler": "tick", "kind": "timer", "running": 0, "waiting": 0, "runs": None, "errors": 0}

    [group, none] = group_rows([node], roles, [], [])["/node"]
    assert (group["name"], group["limit"], group["handlers"]) == ("ReentrantCallbackGroup", None, [row])
    assert (none["name"], none["limit"]) == ("no executor", 0)
    executor = MultiThreadedExecutor(3)
    executor.add_node(node)
    for spun, name in (([], "MultiThreadedExecutor (not spinning)"), ([executor], "MultiThreadedExecutor")):
        last = group_rows([node], roles, [], spun)["/node"][-1]
        assert (last["name"], last["limit"], last["sort"]) == (name, 3, "executor")
    executor.shutdown()

"""Callback groups and executors as plain data for display."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from rclpy.executors import Executor
from rclpy.impl.deadlock.groups import called, is_exclusive, threads_of
from rclpy.impl.entities import Role, arrived, entities_of
from rclpy.impl.nodes import internals_of
from rclpy.impl.spinning import Run

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.impl.spinning import Entity
    from rclpy.node import Node


def group_rows(
    nodes: Iterable[Node], roles: Mapping[Entity, Role], runs: Collection[Run], spun: Collection[Executor]
) -> dict[str, list[dict[str, Any]]]:
    """Return the callback groups of each node, with their callbacks.

    Args:
        runs: The running callbacks.
        spun: The executors that a thread is spinning.
    """
    found: dict[str, list[dict[str, Any]]] = {}
    for node in nodes:
        rows: dict[Any, dict[str, Any]] = {}
        for entity in entities_of(node):
            role = roles[entity]
            if role.is_inner:
                continue
            row = rows.setdefault(entity.callback_group, _row(entity.callback_group, node))
            running = sum(run.entity is entity for run in runs)
            numbers = {"running": running, "waiting": arrived(entity)[1], "runs": None, "errors": 0}
            row["handlers"].append({"handler": role.handler, "kind": role.kind, **numbers})
        executor = node.executor
        if executor is not None:
            limit = threads_of(executor)
            name = f"{type(executor).__name__}{'' if executor in spun else ' (not spinning)'}"
        else:
            limit, name = 0, "no executor"
        about = {"name": name, "limit": limit, "when_full": "wait", "thread": False, "sort": "executor"}
        found[str(internals_of(node).node.full_name)] = [*rows.values(), {**about, "handlers": []}]
    return found


def _row(group: CallbackGroup, node: Node) -> dict[str, Any]:
    """Return a callback group as plain data, without callbacks."""
    about = {"name": called(group, node), "limit": 1 if is_exclusive(group) else None, "when_full": "wait"}
    return {**about, "thread": False, "sort": "callback", "handlers": list[Any]()}

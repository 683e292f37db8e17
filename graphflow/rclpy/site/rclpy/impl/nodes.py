"""Access to nodes from graphflow's own side of rclpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.impl.internals import Holdings, Internals
    from rclpy.node import Node


def internals_of(node: Holdings) -> Internals:
    """Return the internals of a node."""
    return node._graphflow


def nodes_of(life: ContextState) -> list[Node]:
    """Return a context's nodes; others may come and go meanwhile."""
    return cast("list[Node]", list(life.nodes))

"""Access to nodes, and to the internals of rclpy's objects, from graphflow's own side of rclpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, TypeVar, cast

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.node import Node

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class HasInternals(Protocol[T_co]):
    """An object of rclpy whose state is held under one name, which no program's subclass uses."""

    @property
    def _graphflow(self) -> T_co: ...


def internals_of(owner: HasInternals[T]) -> T:
    """Return the internals of a node, executor, action client or server, or transform buffer."""
    return owner._graphflow


def nodes_of(life: ContextState) -> list[Node]:
    """Return a context's nodes; others may come and go meanwhile."""
    return cast("list[Node]", list(life.nodes))

"""An adapter for the source analysis of graphflow's own nodes: an rclpy node as its subject."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, cast

from rclpy.impl.entities import Role
from rclpy.impl.nodes import internals_of

if TYPE_CHECKING:
    from graphflow.deadlock import protocols
    from rclpy.node import Node


class Runner:
    """The runner of a callback."""

    def __init__(self, role: Role) -> None:
        self.spec = role


class Subject:
    """A node as the source analysis sees it.

    Args:
        handlers: The names of the methods that its executor calls.
    """

    def __init__(self, node: Node, handlers: Iterable[str] = ()) -> None:
        self.instance, self.full_name = node, str(internals_of(node).node.full_name)
        self.runners = [Runner(Role("", handler)) for handler in handlers]
        self.tasks: set[object] = set()
        self.starting = None
        self.unopened: tuple[object, ...] = ()
        self.hooks: set[str] = set()


def subject_of(node: Node, handlers: Iterable[str] = ()) -> protocols.Subject:
    """Return a node as a subject: of the protocol, it has what the source analysis reads."""
    return cast("protocols.Subject", Subject(node, handlers))

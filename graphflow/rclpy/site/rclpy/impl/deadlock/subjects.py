"""A node of rclpy's, as the reading of its source sees it, which is made for graphflow's own nodes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rclpy.impl.entities import Role


class Runner:
    """What runs a callback."""

    def __init__(self, role: Role) -> None:
        self.spec = role


class Subject:
    """A node.

    Args:
        handlers: The names of what its executor calls.
    """

    def __init__(self, node: Any, handlers: Iterable[str] = ()) -> None:
        self.instance, self.full_name = node, str(node._graphflow.node.full_name)
        self.runners = [Runner(Role("", handler)) for handler in handlers]
        self.tasks: set[Any] = set()
        self.starting = None
        self.unopened: tuple[Any, ...] = ()
        self.hooks: set[str] = set()

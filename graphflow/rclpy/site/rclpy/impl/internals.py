"""The internals of an rclpy node, under one name that no subclass uses."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from graphflow.rclpy.context_state import ContextState
from graphflow.rclpy.node_bridge import HeldNode, NodeBell
from graphflow.runtime.node_core import core_of
from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.client import Client
from rclpy.clock import ROSClock
from rclpy.context import Context
from rclpy.guard_condition import GuardCondition
from rclpy.impl.mistakes.arguments import NotConstructed
from rclpy.impl.nodes import internals_of
from rclpy.impl.parameters import NodeParameters
from rclpy.logging import get_logger
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.time_source import TimeSource
from rclpy.timer import Timer

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.node import Node
    from rclpy.waitable import Waitable


class Internals:
    """The internals of a node, under one name that no subclass uses."""

    def __init__(self, context: Context, life: ContextState, node: HeldNode, bell: NodeBell) -> None:
        self.context, self.life, self.node, self.bell = context, life, node, bell
        self.core = core_of(node)
        self.publishers: list[Publisher] = []
        self.subscriptions: list[Subscription] = []
        self.clients: list[Client] = []
        self.services: list[Service] = []
        self.timers: list[Timer] = []
        self.guards: list[GuardCondition] = []
        self.waitables: list[Waitable] = []
        self.executor: Callable[[], Executor | None] = none
        self.begun = time.monotonic()
        self.times_added = 0
        """The number of times that the node was added to an executor."""
        self.was_spun = False
        """Whether one of those executors has looked for work since."""
        self.group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self.rate_group: CallbackGroup | None = None
        self.logger = get_logger(node.full_name[1:].replace("/", "."))
        self.clock = ROSClock()
        self.time_source: TimeSource | None = None
        self.parameters: NodeParameters
        self.events: Publisher | None = None


class Known:
    """An internal attribute of rclpy's nodes that programs read; a subclass may define its own of that name.

    Args:
        get: Returns its value from the node's internals.
    """

    def __init__(self, get: Callable[[Internals], object]) -> None:
        self._get = get

    # Without `__set__`: so an attribute of an instance has precedence, unlike over a property.
    def __get__(self, node: Node, owner: type) -> Any:
        return self if node is None else self._get(internals_of(node))


def none() -> None:
    """Return no executor."""


class Holdings:
    """The node's entities for inspection; a base class of `Node`."""

    _graphflow: Internals = NotConstructed()  # type: ignore[assignment]

    @property
    def publishers(self) -> Iterator[Publisher]:
        yield from self._graphflow.publishers

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        yield from self._graphflow.subscriptions

    @property
    def clients(self) -> Iterator[Client]:
        yield from self._graphflow.clients

    @property
    def services(self) -> Iterator[Service]:
        yield from self._graphflow.services

    @property
    def timers(self) -> Iterator[Timer]:
        yield from self._graphflow.timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        yield from self._graphflow.guards

    @property
    def waitables(self) -> Iterator[Waitable]:
        yield from self._graphflow.waitables

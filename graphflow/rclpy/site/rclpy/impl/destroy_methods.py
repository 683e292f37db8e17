"""The part of a node that destroys its entities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from rclpy.client import Client
from rclpy.exceptions import InvalidHandle
from rclpy.guard_condition import GuardCondition
from rclpy.impl.internals import Internals
from rclpy.impl.mistakes.undestroyed import warn
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.waitable import Waitable


class DestroyMethods:
    """The node's methods that destroy; a base class of `Node`. Each returns whether the entity was the node's."""

    _graphflow: Internals

    def _graphflow_recheck(self) -> None:
        """Make the executor recheck the node's entities."""
        executor = self._graphflow.executor()
        if executor is not None:
            executor.wake()

    def add_waitable(self, waitable: Waitable) -> None:
        """Add a waitable to the node's entities."""
        self._graphflow.waitables.append(waitable)
        self._graphflow_recheck()

    def remove_waitable(self, waitable: Waitable) -> None:
        """Remove a waitable from the node's entities."""
        self._graphflow.waitables.remove(waitable)
        self._graphflow.bell.ready.pop(waitable, None)
        self._graphflow_recheck()

    def _graphflow_destroy(self, things: list[Any], thing: Any, call: str) -> bool:
        if thing not in things:
            warn(cast("Node", self), thing, call, depth=2)
            return False
        things.remove(thing)
        self._graphflow.bell.ready.pop(thing, None)
        for handler in getattr(thing, "event_handlers", ()):
            self.remove_waitable(handler)
        try:
            thing.destroy()
        except InvalidHandle:
            return False
        self._graphflow_recheck()
        return True

    def destroy_publisher(self, publisher: Publisher) -> bool:
        return self._graphflow_destroy(self._graphflow.publishers, publisher, "destroy_publisher")

    def destroy_subscription(self, subscription: Subscription) -> bool:
        return self._graphflow_destroy(self._graphflow.subscriptions, subscription, "destroy_subscription")

    def destroy_client(self, client: Client) -> bool:
        return self._graphflow_destroy(self._graphflow.clients, client, "destroy_client")

    def destroy_service(self, service: Service) -> bool:
        return self._graphflow_destroy(self._graphflow.services, service, "destroy_service")

    def destroy_timer(self, timer: Timer) -> bool:
        return self._graphflow_destroy(self._graphflow.timers, timer, "destroy_timer")

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        return self._graphflow_destroy(self._graphflow.guards, guard, "destroy_guard_condition")

    def destroy_rate(self, rate: Rate) -> bool:
        if rate is not None and not hasattr(rate, "_timer"):
            warn(cast("Node", self), rate, "destroy_rate", depth=1)
            return False
        timer = rate._timer
        is_known = timer in self._graphflow.timers
        if is_known:
            self._graphflow.timers.remove(timer)
            rate.destroy()
        return is_known

"""Publishers of nodes with a life cycle."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from graphflow.machines.lifecycle import LifecycleState as State
from graphflow.machines.lifecycle import commands
from rclpy._rclpy_pybind11 import TransitionCallbackReturnType as TransitionCallbackReturn
from rclpy.impl.mistakes.arguments import described
from rclpy.impl.reexports import passed_on
from rclpy.lifecycle.managed_entity import SimpleManagedEntity
from rclpy.publisher import Publisher

if TYPE_CHECKING:
    from rclpy.lifecycle.node import LifecycleState


class HasState(Protocol):
    """The holder of a node's state."""

    state: State


class LifecyclePublisher(SimpleManagedEntity, Publisher):
    """A publisher that sends only while its node is active."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

        # Weakly, since the node keeps its publishers.
        self._graphflow_node: Callable[[], Any] = _none
        self._graphflow_machine: HasState | None = None
        self._graphflow_is_late = False
        self._graphflow_has_warned = False

    def attach(self, node: Callable[[], Any], machine: HasState) -> None:
        """Set the publisher's node, by a weak reference, and the holder of its state. graphflow's own."""
        self._graphflow_node, self._graphflow_machine = node, machine
        self._graphflow_is_late = machine.state is State.ACTIVE

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Send from now on, and warn again after the next deactivation."""
        self._graphflow_has_warned = False
        return super().on_activate(state)

    def check_activated(self) -> None:
        """Warn if the node has just become active, but not the publisher: programs may ask it before they publish.

        graphflow's own.
        """
        if not self.is_activated:
            self._graphflow_tell(f"the publisher of '{self.topic_name}' is not activated, and sends nothing")

    def _graphflow_warn(self, msg: Any) -> None:
        """Warn, with rclcpp's text, that a message is not sent."""
        text = f"Trying to publish message on the topic '{self.topic_name}', but the publisher is not activated"
        self._graphflow_tell(text)

    def _graphflow_tell(self, text: str) -> None:
        """Warn with the cause; once per deactivation."""
        node, machine = self._graphflow_node(), self._graphflow_machine
        if node is None or machine is None or self._graphflow_has_warned:
            return
        self._graphflow_has_warned = True
        name, state = node.get_fully_qualified_name(), machine.state
        way = commands(name, state)
        why = f"{name} is {state.label}{f', to activate it: {way}' if way else ''}"
        if state is State.ACTIVE and self._graphflow_is_late:
            why = f"it was created while {name} was active: create it in on_configure"
        elif state is State.ACTIVE:
            why = f"{described(node.on_activate)} has to end with return super().on_activate(state), which activates it"
        node.get_logger().warning(f"{text}: {why}")

    @SimpleManagedEntity.when_enabled(when_not_enabled=_graphflow_warn)
    def publish(self, msg: Any) -> None:
        """Publish a message if the node is active."""
        Publisher.publish(self, msg)


def _none() -> None:
    """Return no node."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

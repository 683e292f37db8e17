"""Nodes with a life cycle."""

from __future__ import annotations

import traceback
import weakref
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from graphflow.machines.lifecycle import (
    TRANSITIONS,
    Outcome,
    Transition,
    after,
    asked,
    available,
)
from graphflow.machines.lifecycle import LifecycleState as State
from rclpy._rclpy_pybind11 import RCLError
from rclpy._rclpy_pybind11 import TransitionCallbackReturnType as TransitionCallbackReturn
from rclpy.impl.mistakes.arguments import described, must_return
from rclpy.impl.reexports import passed_on
from rclpy.lifecycle.managed_entity import ManagedEntity
from rclpy.lifecycle.publisher import LifecyclePublisher
from rclpy.node import Node

if TYPE_CHECKING:
    from lifecycle_msgs import srv
    from lifecycle_msgs.msg import TransitionDescription

    from rclpy.callback_groups import CallbackGroup
    from rclpy.publisher import Publisher
    from rclpy.service import Service

__all__ = ["LifecycleNode", "LifecycleNodeMixin", "LifecycleState", "TransitionCallbackReturn"]


class LifecycleState(NamedTuple):
    """A state, as callbacks receive it."""

    label: str
    state_id: int


class _StateMachine:
    """The state of a node, and its services for others."""

    def __init__(self, *, has_services: bool) -> None:
        self.state = State.UNCONFIGURED
        self.service_change_state = self.service_get_state = has_services
        self.service_get_available_states = self.service_get_available_transitions = has_services
        self.service_get_transition_graph = has_services

    @property
    def current_state(self) -> tuple[int, str]:
        return int(self.state), self.state.label

    @property
    def initialized(self) -> bool:
        return True

    @property
    def available_states(self) -> list[tuple[int, str]]:
        return [(int(state), state.label) for state in State]

    @property
    def available_transitions(self) -> list[tuple[int, str, int, str, int, str]]:
        return [_row(transition) for transition in available(self.state)]

    @property
    def transition_graph(self) -> list[tuple[int, str, int, str, int, str]]:
        return [_row(transition) for transition in TRANSITIONS]


def _row(t: Transition) -> tuple[int, str, int, str, int, str]:
    return t.id, t.label, int(t.start), t.start.label, int(t.goal), t.goal.label


class LifecycleNodeMixin(ManagedEntity):
    """The life cycle, for classes that also derive from `Node`, whose `__init__` must run first.

    Args:
        enable_communication_interface: Whether to offer the services that read and change the state.
        callback_group: The services' callback group.
    """

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        if not isinstance(enable_communication_interface, bool):
            raise TypeError("enable_communication_interface must be a bool")
        self._managed_entities: dict[ManagedEntity, None] = {}
        """A dict for its order: the entities as they were made."""
        self._state_machine = _StateMachine(has_services=enable_communication_interface)
        self._graphflow_transition_event: Publisher | None = None
        if enable_communication_interface:
            self._graphflow_open_services(callback_group)

    def _graphflow_open_services(self, group: CallbackGroup | None) -> None:
        from lifecycle_msgs import msg, srv

        node = cast("Node", self)
        group = group or node.default_callback_group
        self._graphflow_transition_event = node.create_publisher(msg.TransitionEvent, "~/transition_event", 10)

        def service(type_: type, name: str, callback: Callable[..., object]) -> Service:
            return node.create_service(type_, f"~/{name}", callback, callback_group=group)

        self._service_change_state = service(srv.ChangeState, "change_state", self._graphflow_serve_change)
        self._service_get_state = service(srv.GetState, "get_state", self._graphflow_serve_state)
        self._service_get_available_states = service(
            srv.GetAvailableStates, "get_available_states", self._graphflow_serve_states
        )
        self._service_get_available_transitions = service(
            srv.GetAvailableTransitions, "get_available_transitions", self._graphflow_serve_transitions
        )
        self._service_get_transition_graph = service(
            srv.GetAvailableTransitions, "get_transition_graph", self._graphflow_serve_graph
        )

    # transitions

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node. Raises RCLError if its state does not allow it."""
        return self._graphflow_trigger("configure")

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Clean the node up. Raises RCLError if its state does not allow it."""
        return self._graphflow_trigger("cleanup")

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut the node down. Raises RCLError if its state does not allow it."""
        return self._graphflow_trigger("shutdown")

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node. Raises RCLError if its state does not allow it."""
        return self._graphflow_trigger("activate")

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node. Raises RCLError if its state does not allow it."""
        return self._graphflow_trigger("deactivate")

    def _graphflow_trigger(self, wanted: int | str) -> TransitionCallbackReturn:
        machine = self._state_machine
        transition = asked(machine.state, wanted)
        if transition is None:
            raise RCLError(f"Transition is not registered: {wanted!r} from state {machine.state.label}")
        former = machine.state
        self._graphflow_go(transition)
        outcome = self._graphflow_run_hook(former)
        self._graphflow_go(after(machine.state, outcome))
        if machine.state is State.ACTIVE:
            for entity in self._managed_entities:
                if isinstance(entity, LifecyclePublisher):
                    entity.check_activated()
        if machine.state is State.ERRORPROCESSING:
            # `on_error` gets the state in which the transition began, not the error state.
            self._graphflow_go(after(machine.state, self._graphflow_run_hook(former)))
        return TransitionCallbackReturn(int(outcome))

    def _graphflow_run_hook(self, former: State) -> Outcome:
        name, state = self._state_machine.state.hook, LifecycleState(former.label, int(former))
        hook = getattr(self, name)
        try:
            answer = hook(state)
        except Exception as error:  # a user's callback may raise anything: the transition fails, as in ROS 2
            node = cast("Node", self)
            # A traceback of this frame alone: the call itself failed, since the hook takes other arguments.
            if isinstance(error, TypeError) and error.__traceback__ is not None and not error.__traceback__.tb_next:
                node.get_logger().error(f"{described(hook)}: {error}; write def {name}(self, state):")
                return Outcome.ERROR
            node.get_logger().error(f"{name} raised {type(error).__name__}: {error}")
            traceback.print_exc()
            return Outcome.ERROR
        if not isinstance(answer, TransitionCallbackReturn):
            raise TypeError(must_return(hook, "TransitionCallbackReturn.SUCCESS", answer))
        return Outcome(answer.value)

    def _graphflow_notify(self, name: str, state: LifecycleState) -> TransitionCallbackReturn:
        """Call a hook of each managed entity, up to the first that does not succeed."""
        for entity in list(self._managed_entities):
            hook = getattr(entity, name)
            answer = hook(state)
            if not isinstance(answer, TransitionCallbackReturn):
                raise TypeError(must_return(hook, "TransitionCallbackReturn.SUCCESS", answer))
            if answer is not TransitionCallbackReturn.SUCCESS:
                return answer
        return TransitionCallbackReturn.SUCCESS

    def _graphflow_go(self, transition: Transition) -> None:
        self._state_machine.state = transition.goal
        if self._graphflow_transition_event is None:
            return
        from lifecycle_msgs.msg import State as StateMessage
        from lifecycle_msgs.msg import Transition as TransitionMessage
        from lifecycle_msgs.msg import TransitionEvent

        event = TransitionEvent()
        event.transition = TransitionMessage(id=transition.id, label=transition.label)
        event.start_state = StateMessage(id=int(transition.start), label=transition.start.label)
        event.goal_state = StateMessage(id=int(transition.goal), label=transition.goal.label)
        node = cast("Node", self)
        if hasattr(event, "timestamp"):
            event.timestamp = node.get_clock().now().nanoseconds
        assert self._graphflow_transition_event is not None
        self._graphflow_transition_event.publish(event)

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Notify an entity of transitions, as the node's callbacks do unless a subclass replaces them without super().

        Raises:
            TypeError: It is not a ManagedEntity.
        """
        if not isinstance(entity, ManagedEntity):
            raise TypeError("Expected a rclpy.lifecycle.ManagedEntity instance.")
        self._managed_entities[entity] = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle the transition from unconfigured to inactive: notify the managed entities."""
        return self._graphflow_notify("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle the transition from inactive to unconfigured: notify the managed entities."""
        return self._graphflow_notify("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle the transition to finalized: notify the managed entities."""
        return self._graphflow_notify("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle the transition from inactive to active: notify the managed entities."""
        return self._graphflow_notify("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle the transition from active to inactive: notify the managed entities."""
        return self._graphflow_notify("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle an error; success leads to unconfigured, anything else to finalized. Notify the managed entities."""
        return self._graphflow_notify("on_error", state)

    def create_lifecycle_publisher(self, *args: Any, **kwargs: Any) -> LifecyclePublisher:
        """Create a publisher that sends only while the node is active. Arguments as for `create_publisher`."""
        if "publisher_class" in kwargs:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        node = cast("Node", self)
        made: LifecyclePublisher = node.create_publisher(*args, **kwargs, publisher_class=LifecyclePublisher)
        self._managed_entities[made] = None
        made.attach(weakref.ref(node), self._state_machine)
        return made

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher) -> bool:
        """Destroy a lifecycle publisher."""
        node = cast("Node", self)
        self._managed_entities.pop(publisher, None)
        return bool(node.destroy_publisher(publisher))

    # services for others

    def _graphflow_serve_change(self, request: srv.ChangeState.Request, response: srv.ChangeState.Response) -> object:
        wanted = request.transition
        state = self._state_machine.state
        known = asked(state, wanted.label) if wanted.label else asked(state, wanted.id)
        response.success = False
        if known is not None:
            response.success = self._graphflow_trigger(known.id) is TransitionCallbackReturn.SUCCESS
        return response

    def _graphflow_serve_state(self, request: object, response: srv.GetState.Response) -> object:
        response.current_state.id, response.current_state.label = self._state_machine.current_state
        return response

    def _graphflow_serve_states(self, request: object, response: srv.GetAvailableStates.Response) -> object:
        from lifecycle_msgs.msg import State as StateMessage

        rows = self._state_machine.available_states
        response.available_states = [StateMessage(id=number, label=label) for number, label in rows]
        return response

    def _graphflow_serve_transitions(self, request: object, response: srv.GetAvailableTransitions.Response) -> object:
        response.available_transitions = _described(available(self._state_machine.state))
        return response

    def _graphflow_serve_graph(self, request: object, response: srv.GetAvailableTransitions.Response) -> object:
        response.available_transitions = _described(TRANSITIONS)
        return response


def _described(transitions: Iterable[Transition]) -> list[TransitionDescription]:
    from lifecycle_msgs.msg import TransitionDescription

    found = []
    for transition in transitions:
        row = TransitionDescription()
        row.transition.id, row.transition.label = transition.id, transition.label
        row.start_state.id, row.start_state.label = int(transition.start), transition.start.label
        row.goal_state.id, row.goal_state.label = int(transition.goal), transition.goal.label
        found.append(row)
    return found


class LifecycleNode(LifecycleNodeMixin, Node):
    """A node with a life cycle. Arguments as for `Node`."""

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

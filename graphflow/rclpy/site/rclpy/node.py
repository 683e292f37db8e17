"""Nodes: rclpy's interface, implemented with graphflow."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Self

from graphflow.msgs import registry
from graphflow.rclpy import node_bridge
from graphflow.rclpy.context_state import ContextState
from graphflow.rclpy.messages import classes
from graphflow.rclpy.node_bridge import HeldNode, Mark, NodeBell
from graphflow.runtime.endpoints import threaded
from rclpy._rclpy_pybind11 import NodeNameNonExistentError
from rclpy.callback_groups import CallbackGroup
from rclpy.client import Client
from rclpy.clock import Clock
from rclpy.constants import S_TO_NS
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks, dispatcher
from rclpy.exceptions import NotInitializedException
from rclpy.executors import Executor
from rclpy.guard_condition import GuardCondition
from rclpy.handle import Handle
from rclpy.impl.deadlock.waiting import attend
from rclpy.impl.destroy_methods import DestroyMethods
from rclpy.impl.graph_methods import GraphMethods
from rclpy.impl.internals import Holdings, Internals, Known, none
from rclpy.impl.mistakes.arguments import explained
from rclpy.impl.mistakes.hidden_properties import refuse_hidden_properties
from rclpy.impl.name_methods import NameMethods
from rclpy.impl.node_arguments import read_arguments
from rclpy.impl.overrides import as_parameters
from rclpy.impl.parameter_methods import ParameterMethods
from rclpy.impl.parameters import NodeParameters
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.impl.reexports import passed_on
from rclpy.logging_service import LoggingService
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, qos_profile_services_default, to_graphflow, validated
from rclpy.qos_overriding_options import QoSOverridingOptions, _declare_qos_parameters
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from graphflow.runtime.endpoints.endpoint import Endpoint
    from graphflow.runtime.node_core import NodeCore


__all__ = ["HIDDEN_NODE_PREFIX", "Node", "NodeNameNonExistentError"]

HIDDEN_NODE_PREFIX = "_"


class Node(ParameterMethods, DestroyMethods, GraphMethods, NameMethods, Holdings):
    """A node with rclpy's interface, implemented by a graphflow node.

    Raises:
        NotInitializedException: The context is not initialized, or has ended.
        InvalidNodeNameException, InvalidNamespaceException: A name is illegal.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        context = get_default_context() if context is None else context
        life = context.life
        if life is None or not context.ok():
            raise NotInitializedException("cannot create node")
        refuse_hidden_properties(type(self), Node)
        given = read_arguments(life, node_name, namespace, cli_args or (), use_global=use_global_arguments)
        bell = NodeBell()
        has_rosout = enable_rosout and given.has_rosout
        node = node_bridge.open_node(life, node_name, given.namespace, given.remaps, rosout=has_rosout)
        inner = self._graphflow = Internals(context, life, node, bell)
        life.nodes[self] = partial(_destroy, weakref.ref(self))
        self._graphflow_handle_of_node = Handle(partial(_close, life, node))
        overrides = as_parameters(given.values) | {p.name: p for p in parameter_overrides or ()}
        inner.parameters = NodeParameters(
            overrides, self._graphflow_parameters_changed, allows_undeclared=allow_undeclared_parameters
        )
        inner.parameters.sources = {name: source for name, (_, source) in given.values.items()}
        attend(life)
        self._graphflow_open_parameters(start_parameter_services)
        if enable_logger_service:
            LoggingService(self)
        if automatically_declare_parameters_from_overrides:
            self._graphflow_declare_overrides()

    # what it has

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the node's callbacks."""
        return self._graphflow.executor()

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self.executor
        if current is new_executor:
            return
        if current is not None:
            current.remove_node(self)
        inner = self._graphflow
        if new_executor is None:
            inner.executor = inner.bell.executor = none
        else:
            new_executor.add_node(self)
            inner.executor = inner.bell.executor = weakref.ref(new_executor)

    @property
    def context(self) -> Context:
        return self._graphflow.context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of entities that name none: its callbacks exclude each other."""
        return self._graphflow.group

    @property
    def _default_callback_group(self) -> CallbackGroup:
        return self._graphflow.group

    @_default_callback_group.setter
    def _default_callback_group(self, group: CallbackGroup) -> None:
        self._graphflow.group = group

    _clock = Known(lambda inner: inner.clock)
    _logger = Known(lambda inner: inner.logger)

    @property
    def handle(self) -> Handle:
        return self._graphflow_handle_of_node

    @handle.setter
    def handle(self, value: object) -> None:
        raise AttributeError("handle cannot be modified after node creation")

    def get_clock(self) -> Clock:
        """Return the node's clock: wall time, or simulated time if `use_sim_time` is true."""
        return self._graphflow.clock

    def get_logger(self) -> RcutilsLogger:
        return self._graphflow.logger

    # making and destroying

    @explained
    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: Any = Publisher,
    ) -> Any:
        """Create a publisher of messages of a class. `callback_group` is that of its events."""
        qos = validated(qos_profile)
        group = callback_group or self.default_callback_group
        name = self._graphflow_topic(msg_type, topic)
        if qos_overriding_options is not None:
            _declare_qos_parameters(Publisher, self, name, qos, qos_overriding_options)
        inner = self._graphflow
        callbacks = event_callbacks or PublisherEventCallbacks()
        handlers = callbacks.create_event_handlers(group, None, topic, inner.bell)
        told = dispatcher(handlers)
        with self.handle:
            endpoint = node_bridge.add(
                inner.node, lambda core: threaded.ThreadedPublisher(core, msg_type, name, to_graphflow(qos), told)
            )
        made: Publisher = publisher_class(
            endpoint,
            msg_type,
            topic,
            qos,
            callbacks,
            group,
            life=inner.life,
            handle=self._graphflow_withdraws(endpoint),
            event_handlers=handlers,
        )
        inner.publishers.append(made)
        for handler in handlers:
            self.add_waitable(handler)
        return made

    @explained
    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Call `callback` with each message of a topic.

        Args:
            callback: Takes the message, and optionally a `MessageInfo`.
            raw: Whether it takes CDR bytes instead of the message.
        """
        qos = validated(qos_profile)
        group = callback_group or self.default_callback_group
        name = self._graphflow_topic(msg_type, topic)
        if qos_overriding_options is not None:
            _declare_qos_parameters(Subscription, self, name, qos, qos_overriding_options)
        inner = self._graphflow
        callbacks = event_callbacks or SubscriptionEventCallbacks()
        handlers = callbacks.create_event_handlers(group, None, topic, inner.bell)
        told, mark = dispatcher(handlers), Mark(inner.bell)
        with self.handle:
            endpoint = node_bridge.add(
                inner.node,
                lambda core: threaded.ThreadedSubscription(
                    core, msg_type, name, to_graphflow(qos), inner.bell, mark, told
                ),
            )
        handle = self._graphflow_withdraws(endpoint)
        made = Subscription(
            endpoint, msg_type, topic, callback, group, qos, raw, callbacks, handle=handle, event_handlers=handlers
        )
        mark.entity = made
        group.add_entity(made)
        inner.subscriptions.append(made)
        for handler in handlers:
            self.add_waitable(handler)
        mark()
        self._graphflow_recheck()
        return made

    def _graphflow_withdraws(self, endpoint: Endpoint) -> Handle:
        life = self._graphflow.life
        return Handle(partial(_remove, life, endpoint))

    @explained
    def create_client(
        self,
        srv_type: object,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Create a service client. Handling its answers needs a place in its callback group."""
        group = callback_group or self.default_callback_group
        name, inner = self._graphflow_service(srv_type, srv_name), self._graphflow
        type_ = registry.interface_class(classes.type_name(srv_type))
        mark, changed = Mark(inner.bell), dict[Any, None]()

        def servers_changed() -> None:
            for wake in list(changed):
                wake.set()

        def make(core: NodeCore) -> threaded.ThreadedClient:
            profile = to_graphflow(qos_profile)
            return threaded.ThreadedClient(core, type_, name, profile, inner.bell, mark, servers_changed)

        with self.handle:
            endpoint = node_bridge.add(inner.node, make)
        handle = self._graphflow_withdraws(endpoint)
        made = Client(
            self.context,
            endpoint,
            srv_type,
            srv_name,
            qos_profile,
            group,
            life=inner.life,
            handle=handle,
            changed=changed,
        )
        mark.entity = made
        group.add_entity(made)
        inner.clients.append(made)
        return made

    @explained
    def create_service(
        self,
        srv_type: object,
        srv_name: str,
        callback: Callable[..., object],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Answer a service's requests with `callback(request, response)`, which returns the response."""
        group = callback_group or self.default_callback_group
        name, inner = self._graphflow_service(srv_type, srv_name), self._graphflow
        type_ = registry.interface_class(classes.type_name(srv_type))
        mark = Mark(inner.bell)
        with self.handle:
            endpoint = node_bridge.add(
                inner.node,
                lambda core: threaded.ThreadedService(core, type_, name, to_graphflow(qos_profile), inner.bell, mark),
            )
        handle = self._graphflow_withdraws(endpoint)
        made = Service(endpoint, srv_type, srv_name, callback, group, qos_profile, life=inner.life, handle=handle)
        mark.entity = made
        group.add_entity(made)
        inner.services.append(made)
        mark()
        return made

    @explained
    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., object] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Call `callback` every `timer_period_sec` seconds of the node's clock, or of another."""
        group = callback_group or self.default_callback_group
        inner = self._graphflow
        period_ns = int(float(timer_period_sec) * S_TO_NS)
        made = Timer(
            callback,
            group,
            period_ns,
            clock or inner.clock,
            context=self.context,
            autostart=autostart,
            bell=inner.bell,
        )
        group.add_entity(made)
        inner.timers.append(made)
        self._graphflow_recheck()
        return made

    def create_guard_condition(
        self, callback: Callable[[], object], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Call `callback` when the guard condition is triggered."""
        group = callback_group or self.default_callback_group
        made = GuardCondition(callback, group, context=self.context, bell=self._graphflow.bell)
        group.add_entity(made)
        self._graphflow.guards.append(made)
        return made

    @explained
    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate for threads. Raises ValueError for a frequency that is not positive."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        from rclpy.callback_groups import ReentrantCallbackGroup

        inner = self._graphflow
        inner.rate_group = inner.rate_group or ReentrantCallbackGroup()
        timer = self.create_timer(1.0 / frequency, None, inner.rate_group, clock or inner.clock)
        return Rate(timer, context=self.context)

    def destroy_node(self) -> None:
        """Take the node off the network, with all its entities. Idempotent."""
        inner = self._graphflow
        if self.handle.is_destroyed:
            return
        if self.executor is not None:
            self.executor.remove_node(self)
        inner.life.leave(self)
        if inner.time_source is not None:
            inner.time_source.detach_node()
        inner.events = None
        for timer in list(inner.timers):
            self.destroy_timer(timer)
        for guard in list(inner.guards):
            self.destroy_guard_condition(guard)
        # Closing the node withdraws all its endpoints at once.
        self.handle.destroy_when_not_in_use()
        kinds: tuple[list[Any], ...] = (inner.publishers, inner.subscriptions, inner.clients, inner.services)
        for things in kinds:
            for thing in things:
                thing.handle.destroy_when_not_in_use()
            things.clear()
        inner.bell.ready.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _destroy(reference: Callable[[], Node | None]) -> None:
    node = reference()
    if node is not None:
        node.destroy_node()


def _close(life: ContextState, node: HeldNode) -> None:
    if life.is_ok:
        node_bridge.close_node(node)


def _remove(life: ContextState, endpoint: Endpoint) -> None:
    if life.is_ok and endpoint.is_open:
        node_bridge.remove(endpoint)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

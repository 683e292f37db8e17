"""The node class that users derive from, a facade over its `NodeCore`."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping, Sequence
from contextlib import AbstractAsyncContextManager, AbstractContextManager
from dataclasses import replace
from typing import Any, ClassVar, TypeVar, TypeVarTuple

from graphflow.analysis.static_entities import with_made
from graphflow.errors import DeclarationError
from graphflow.executor.activity import Activity
from graphflow.executor.clock import Clock, period_ns
from graphflow.executor.groups import HandlerGroup
from graphflow.interface import GoalPolicy, GroupChange, Interface, OnClientLoss, OnError
from graphflow.machines.goal import GoalRules
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, ServerGoalHandle, Service
from graphflow.names import Remap, Resolution, Resolver
from graphflow.qos import SERVICES, Qos
from graphflow.runtime import node_options
from graphflow.runtime.actions.client import GoalClient
from graphflow.runtime.actions.server import ActionServer
from graphflow.runtime.call_site import here
from graphflow.runtime.callables import written_at
from graphflow.runtime.context import Context
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.checks import (
    check_callback,
    check_function,
    check_group,
    check_method,
    check_on_error,
    check_plain,
    check_qos,
    check_text,
    check_type,
)
from graphflow.runtime.declarations.declare import Group, Param
from graphflow.runtime.declarations.misplaced import check_hooks, check_misplaced, check_module
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.events import OnEvent
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.runtime.endpoints.service_events import Introspection
from graphflow.runtime.endpoints.services import OFFERED_TWICE, ServiceServer
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.endpoints.timer import Timer
from graphflow.runtime.failures import ErrorBudget
from graphflow.runtime.mistakes import unrun
from graphflow.runtime.mistakes.doubled import warn_doubled
from graphflow.runtime.mistakes.other_threads import call_soon
from graphflow.runtime.mistakes.rclpy_words import OF_PARTS, AttributeHints, with_argument_hints
from graphflow.runtime.mistakes.repeats import warn_duplicate
from graphflow.runtime.mistakes.source.shadowing import check_bound_once
from graphflow.runtime.node_arguments import rules_of
from graphflow.runtime.node_core import NodeCore
from graphflow.wire.attachment import MessageInfo

M = TypeVar("M", bound=Message)
T = TypeVar("T")
Ts = TypeVarTuple("Ts")


class Node(AttributeHints):
    """A ROS 2 node as an async Python class. Subclass it, declare its endpoints and handlers, and `graphflow.run` it.

    Args:
        name: The node's name; by default the class name in snake case.
        namespace: The node's namespace: `/` or `/robot1`.
        remap: Remap rules, as objects or as text `from:=to`; the first match wins.
        overrides: Parameter values from graph files and command lines: name to (value, place that gives it).
        concurrency: Changes to the declared groups from a graph file, by group name.
        start_parameter_services, enable_rosout, enable_logger_service: False to leave out the parameter services, the
            publisher on /rosout, or the log level services.
        **params: Parameter values by name.

    Raises:
        InvalidName: The name, the namespace or a rule is invalid.
        ParameterError: A parameter value does not fit its declaration.
        DeclarationError: `concurrency` puts a handler in two groups.
    """

    default_group: ClassVar[Group | None] = None
    """The group of handlers without one of their own; with None, each handler's runs queue only behind each other."""
    error_budget: ClassVar[ErrorBudget | None] = ErrorBudget(20, per=10.0)
    """Errors in timers and subscriptions tolerated before the node ends; None for any number."""
    node_name: ClassVar[str] = ""
    """Default name of the nodes of this class; "" for the class name in snake case."""
    dynamic_names: ClassVar[bool | Sequence[str]] = False
    """Names made at run time, exempt from checks: True for any, or patterns such as `*/cmd_vel`."""
    is_managed: ClassVar[bool] = False
    """Whether nodes of the class are lifecycle nodes."""
    __firstlineno__: ClassVar[int]
    _core_class: ClassVar[type[NodeCore]] = NodeCore

    def __init__(
        self,
        name: str | None = None,
        *,
        namespace: str = "/",
        remap: Sequence[Remap | str] = (),
        overrides: Mapping[str, tuple[object, str]] | None = None,
        concurrency: Mapping[str, GroupChange] | None = None,
        start_parameter_services: bool = True,
        enable_rosout: bool = True,
        enable_logger_service: bool = True,
        **params: object,
    ) -> None:
        unrun.made(type(self))
        given = node_options.take(self)
        rules = [*given.remaps, *rules_of(remap)]
        own_name = given.name or name or declared.default_name(type(self))
        names = Resolver(own_name, namespace if given.namespace is None else given.namespace, rules)
        values = {**(overrides or {}), **{k: (v, "argument") for k, v in params.items()}, **given.overrides}
        around = given.concurrency
        self._core = self._core_class(
            self, names, values, replace(around, groups={**(concurrency or {}), **around.groups})
        )
        self.log = self._core.log
        """The node's logger (`throttle=`, `once=` and `skip_first=` as in rclpy); records go to the console and to
        /rosout."""
        self.parameters = self._core.parameters
        self._core.bind(
            parameter_services=start_parameter_services,
            rosout=enable_rosout and given.rosout,
            logger_service=enable_logger_service,
        )

    @classmethod
    def interface(cls) -> Interface:
        """Return the class's declarations, and the endpoints its methods are seen to create, without making a node."""
        check_module(cls)
        check_bound_once(cls)  # type: ignore[arg-type]
        return with_made(cls, declared.interface_of(cls))

    def __init_subclass__(cls, **kwargs: object) -> None:
        super().__init_subclass__(**kwargs)
        if "__firstlineno__" not in vars(cls):
            cls.__firstlineno__ = declared.class_line()
        check_misplaced(cls)
        check_hooks(cls)
        declared.check_attributes(cls, Node)
        unrun.defined(cls)
        declared.interface_of(cls)  # an invalid declaration fails at import, not in a later run

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.full_name}{' running' if self.is_running else ''}>"

    def _hint(self, name: str) -> str:
        core = vars(self).get("_core")
        if name in ("run", "spin", "main"):
            return f"run nodes with graphflow.run({type(self).__name__})"
        if core is None or name not in core.parameters:
            return OF_PARTS.get(name, "")
        return f'read a parameter with self.parameters.get("{name}"), or declare it in the class: {name} = Param(...)'

    def _instead_of(self, name: str) -> str:
        return f"{node_options.without_super(type(self))} first" if name in ("_core", "log", "parameters") else ""

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def namespace(self) -> str:
        return self._core.namespace

    @property
    def full_name(self) -> str:
        """Namespace and name: `/turtle1/follower`."""
        return self._core.full_name

    @property
    def derivations(self) -> Mapping[str, Resolution]:
        """The origin of each name that the node has used, by its full name before remaps."""
        return self._core.names.derivations

    def resolve_topic_name(self, name: str) -> str:
        """Return the full name of a topic after remapping. Raises InvalidName if `name` is not legal."""
        return self._core.names.resolve(name)

    def resolve_service_name(self, name: str) -> str:
        """Return the full name of a service or action after remapping. Raises InvalidName if `name` is not legal."""
        return self._core.names.resolve(name, "service")

    @property
    def context(self) -> Context:
        """The context of the node. Raises ClosedError when the node is not running."""
        return self._core.context

    @property
    def clock(self) -> Clock:
        """The clock for timers, sleeps and deadlines: simulated time while the parameter `use_sim_time` is true.

        Raises:
            ClosedError: The node is not running.
        """
        return self._core.clock

    @property
    def group(self) -> HandlerGroup:
        """The group of the running handler, for `async with self.group.released()`.

        Raises:
            RuntimeError: The current task is not a handler run in a group, but for example a `@task`.
        """
        task: object = asyncio.current_task()  # in a handler, an activity that acts as a task
        group = task.group if isinstance(task, Activity) else None
        if group is None:
            raise RuntimeError(f"{self.full_name}: the current task is not a handler that holds a slot of a group")
        return group

    @property
    def is_running(self) -> bool:
        return self._core.is_running

    @property
    def endpoints(self) -> list[Endpoint]:
        """The node's endpoints on the network; an action counts as the services and topics it consists of."""
        return self._core.endpoints

    def statistics(self) -> dict[str, dict[str, object]]:
        """Return counters since the start, by the name of each handler, endpoint and group."""
        return self._core.statistics()

    @with_argument_hints
    def create_publisher(
        self, type_: type[M], name: str, qos: Qos | int = 10, *, on_event: OnEvent | None = None
    ) -> TopicPublisher[M]:
        """Create a publisher on the remapped topic `name`; `on_event` is called with each `QosEvent`."""
        core, place = self._core, here()
        check_type(type_, Message, "create_publisher", place)
        check_text(name, "create_publisher", place)
        check_qos(qos, None, place)
        return core.add(TopicPublisher(core, type_, core.names.resolve(name), Qos.of(qos), on_event))

    @with_argument_hints
    def create_subscription(
        self,
        type_: type[M],
        name: str,
        callback: Callable[[M], object] | Callable[[M, MessageInfo], object] | None,
        qos: Qos | int = 10,
        *,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        takes_info: bool = False,
        ignore_local: bool = False,
        on_event: OnEvent | None = None,
        on_error: OnError = "budget",
    ) -> TopicSubscription[M]:
        """Create a subscription on the remapped topic `name`.

        Args:
            callback: A `def` or an `async def`, called with each message; None to iterate the subscription instead.
            qos: The QoS profile, or the queue depth.
            group: The concurrency group of the callback; by default the class's `default_group`.
            thread: Whether a `def` callback runs in a thread.
            takes_info: Whether the callback also takes a `MessageInfo`: sender, times, sequence number.
            ignore_local: Whether to skip messages that this process publishes.
            on_event: Called with each `QosEvent`.
            on_error: The policy for errors in the callback.
        """
        what, place = "create_subscription", here()
        check_type(type_, Message, what, place)
        check_text(name, what, place)
        check_qos(qos, None, place)
        check_group(group, (Group, HandlerGroup), what, place)
        check_on_error(on_error, place)
        if callback is not None:
            hint = "" if takes_info else "; with takes_info=True it is called with the message and a MessageInfo"
            check_callback(callback, range(2, 3) if takes_info else range(1, 2), what, place, hint)
            check_method(callback, type_, what, place)
        core, resolved = self._core, self._core.names.resolve(name)
        same = (part for part in core.parts if isinstance(part, TopicSubscription) and part.name == resolved)
        warn_doubled(core.log, callback, place, f"each message of {resolved}", same)
        label, call, slots = core.place(callback, f"subscription {name}", group, thread)
        made = TopicSubscription(
            *(core, type_, resolved, Qos.of(qos), call, label, slots),
            takes_info=takes_info,
            ignore_local=ignore_local,
            on_event=on_event,
            on_error=on_error,
        )
        warn_duplicate(core, core.parts, made, callback)
        return core.add(made, late=callback is not None)

    @with_argument_hints
    def create_service(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        callback: Callable[[Request], object] | Callable[[Request, Response], object],
        *,
        qos: Qos | int = SERVICES,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        introspection: Introspection = "off",
    ) -> ServiceServer[Request, Response]:
        """Create a service on the remapped `name`; `callback` takes the request and returns the response.

        As in ROS 2, it may take a second argument, an empty response to fill in and return.

        Args:
            group, thread: As for `create_subscription`.
            introspection: Content of the events on `name`/_service_event: "off", "metadata" or "contents".
        """
        what, place = "create_service", here()
        check_type(type_, Service, what, place)
        check_text(name, what, place)
        check_group(group, (Group, HandlerGroup), what, place)
        arguments = check_callback(callback, range(1, 3), what, place)
        core, resolved = self._core, self._core.names.resolve(name, "service")
        label, call, slots = core.place(callback, f"service {name}", group, thread)
        made = ServiceServer(
            *(core, type_, resolved, Qos.of(qos), call, label, slots),
            takes_response=arguments == 2,
            place=written_at(callback),
        )
        for other in core.parts:
            if isinstance(other, ServiceServer) and other.name == resolved:
                servers = [part for one in (other, made) for part in (one.handler_title, one.place)]
                core.log.warning(OFFERED_TWICE, resolved, *servers)
        made.configure_introspection(introspection)
        return core.add(made, late=True)

    @with_argument_hints
    def create_client(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        *,
        qos: Qos | int = SERVICES,
        introspection: Introspection = "off",
        group: Group | HandlerGroup | None = None,
    ) -> ServiceClient[Request, Response]:
        """Create a client of the remapped service `name`; `introspection` as for `create_service`.

        Args:
            group: The group in which responses take a slot, as in ROS 2; by default they take none.
        """
        core, place = self._core, here()
        check_type(type_, Service, "create_client", place)
        check_text(name, "create_client", place)
        check_group(group, (Group, HandlerGroup), "create_client", place)
        slots = None if group is None else core.groups.at_work(group)
        made = ServiceClient(core, type_, core.names.resolve(name, "service"), Qos.of(qos), slots)
        made.configure_introspection(introspection)
        return core.add(made)

    @with_argument_hints
    def create_action_server(
        self,
        type_: type[Action[Goal, Result, Feedback]],
        name: str,
        callback: Callable[[ServerGoalHandle[Goal, Result, Feedback]], object],
        *,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        policy: GoalPolicy = "reject",
        accept: Callable[[Goal], object] | None = None,
        cancellable: bool | Callable[[ServerGoalHandle[Goal, Result, Feedback]], bool] = True,
        on_client_loss: OnClientLoss = "continue",
        cleanup_timeout: float = 10.0,
    ) -> ActionServer[Goal, Result, Feedback]:
        """Create an action server on the remapped `name`; `callback` takes a `ServerGoalHandle` and returns the result.

        Args:
            policy: The policy for a goal that arrives while another runs.
            accept: Called with each goal message; rejects the goal by returning False or the reason as text.
            cancellable: Whether cancel requests are granted, or a function of the handle that decides.
            on_client_loss: The policy for a goal whose client has gone.
            cleanup_timeout: Seconds that a cancelled callback has for cleanup before its goal counts as aborted.
        """
        what, place = "create_action_server", here()
        check_type(type_, Action, what, place)
        check_text(name, what, place)
        check_group(group, (Group, HandlerGroup), what, place)
        check_callback(callback, range(1, 2), what, place)
        core, resolved = self._core, self._core.names.resolve(name, "service")
        label, call, slots = core.place(callback, f"action {name}", group, thread)
        rules = GoalRules(policy, on_client_loss, cleanup_timeout=cleanup_timeout)
        made = ActionServer(
            core, type_, resolved, call, label, slots, rules=rules, accept=accept, cancellable=cancellable
        )
        return core.add(made, late=True)

    @with_argument_hints
    def create_action_client(
        self, type_: type[Action[Goal, Result, Feedback]], name: str
    ) -> GoalClient[Goal, Result, Feedback]:
        """Create a client of the remapped action `name`."""
        check_type(type_, Action, "create_action_client", here())
        check_text(name, "create_action_client", here())
        return self._core.add(GoalClient(self._core, type_, self._core.names.resolve(name, "service")))

    @with_argument_hints
    def create_timer(
        self,
        period: float,
        callback: Callable[..., object],
        *,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        takes_info: bool = False,
        on_error: OnError = "budget",
    ) -> Timer:
        """Create a timer that calls `callback` every `period` seconds.

        Raises:
            ValueError: The period is not positive.
        """
        what, place = "create_timer", here()
        if callable(period):
            raise DeclarationError(f"{place}: {what}: the period comes first: create_timer(0.5, self.tick)")
        check_group(group, (Group, HandlerGroup), what, place)
        check_callback(callback, range(1, 2) if takes_info else range(1), what, place)
        nanoseconds = period_ns(period, None)
        same = (part for part in self._core.parts if isinstance(part, Timer) and part.period == nanoseconds / 1e9)
        warn_doubled(self._core.log, callback, place, "each period", same)
        label, call, slots = self._core.place(callback, "timer", group, thread)
        made = Timer(self._core, nanoseconds, call, label, slots, takes_info=takes_info, on_error=on_error)
        warn_duplicate(self._core, self._core.parts, made, callback)
        return self._core.add(made, late=True)

    @with_argument_hints
    def declare_parameter(self, name: str, default: Any, *, dynamic: bool = False, **limits: Any) -> Any:
        """Declare a parameter at run time; returns its value. `limits` as for `Param`.

        Args:
            dynamic: Whether the parameter takes values of any type and may be deleted.

        Raises:
            ParameterError: The parameter is already declared, or the override for it does not fit.
        """
        if self._core.is_running:
            self.context.refuse_other_threads("declare_parameter")
        return self.parameters.declare(Param(default, name=name, **limits).with_typing(dynamic=dynamic))

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter made by `declare_parameter`. Raises ParameterError if it is unknown or read-only."""
        self.parameters.undeclare(name)

    async def offload(self, fn: Callable[[*Ts], T], *args: *Ts) -> T:
        """Run the blocking function `fn(*args)` in a worker thread. It cannot be cancelled.

        At most 32 run at a time in a process; further calls wait.
        Raises WrongThread in another thread, which calls the function itself.
        """
        self.context.refuse_other_threads("offload")
        check_function(fn, "offload", "await self.offload(time.sleep, 0.5)")
        check_plain(fn, "offload")
        return await self.context.offload(fn, *args)

    def spawn(self, fn: Callable[[*Ts], Coroutine[object, object, object]], *args: *Ts) -> None:
        """Run the coroutine function `fn(*args)` in the background until the node stops; from any thread.

        An error in it ends the node.
        """
        check_function(fn, "spawn", "self.spawn(self.work)")
        if self.context.is_here:
            self._core.spawn(fn, *args)
        else:
            call_soon(self._core, self._core.spawn, (fn, *args))

    def call_soon(self, fn: Callable[[*Ts], object], *args: *Ts) -> None:
        """Call `fn(*args)` on the event loop from any thread, such as a driver's callback thread.

        An error in it is logged.

        Raises:
            ClosedError: The node is not running.
        """
        check_function(fn, "call_soon", "self.call_soon(self.work)")
        call_soon(self._core, fn, args)

    async def on_start(self) -> None:
        """Prepare the node; for subclasses. No handler, timer or task runs before it returns.

        Publishers and clients already work. An error in it ends the node.
        """

    async def on_shutdown(self) -> None:
        """Clean up; for subclasses. Handlers and tasks have ended; publishers and clients still work."""

    async def enter(self, manager: AbstractAsyncContextManager[T] | AbstractContextManager[T]) -> T:
        """Enter a context manager; it is exited when the node stops, last entered first, after `on_shutdown`."""
        self.context.refuse_other_threads("enter")
        if isinstance(manager, AbstractAsyncContextManager):
            return await self._core.entered.enter_async_context(manager)
        return self._core.entered.enter_context(manager)

    def shutdown(self) -> None:
        """End the node from within, from any thread; a process with nothing else to run then ends."""
        self._core.shutdown()

    async def wait_ended(self) -> None:
        """Wait until the node ends by `shutdown` or fails; raises the error it failed with."""
        await self._core.wait_ended()

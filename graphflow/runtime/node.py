"""The node: what users subclass, a facade over its `NodeCore`."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping, Sequence
from contextlib import AbstractAsyncContextManager, AbstractContextManager
from dataclasses import replace
from typing import Any, ClassVar, TypeVar

from graphflow.analysis.static_entities import with_made
from graphflow.errors import DeclarationError
from graphflow.executor.clock import Clock, period_ns
from graphflow.executor.groups import HandlerGroup
from graphflow.interface import GoalPolicy, GroupChange, Interface, OnClientLoss, OnError
from graphflow.machines.goal import GoalRules
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, Service
from graphflow.names import Remap, Resolution, Resolver
from graphflow.qos import SERVICES, Qos
from graphflow.runtime import node_options
from graphflow.runtime.actions.client import GoalClient
from graphflow.runtime.actions.server import ActionServer
from graphflow.runtime.call_site import here
from graphflow.runtime.context import Context
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.checks import (
    check_callback,
    check_function,
    check_group,
    check_on_error,
    check_plain,
    check_qos,
    check_text,
    check_type,
    written_at,
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
from graphflow.runtime.mistakes.doubled import tell_doubled
from graphflow.runtime.mistakes.other_threads import call_soon
from graphflow.runtime.mistakes.rclpy_words import OF_PARTS, SpeaksRos, in_our_words
from graphflow.runtime.mistakes.repeats import tell_same
from graphflow.runtime.mistakes.source.shadowing import check_names
from graphflow.runtime.node_arguments import rules_of
from graphflow.runtime.node_core import NodeCore
from graphflow.wire.attachment import MessageInfo

M = TypeVar("M", bound=Message)
T = TypeVar("T")


class Node(SpeaksRos):
    """A ROS 2 node as an async Python class. Subclass it, declare what it holds and does, and `graphflow.run` it.

    Args:
        name: Its name; by default the class's in snake case.
        namespace: Where it lives: `/` or `/robot1`.
        remap: Rules, first match wins; as objects or as text `from:=to`.
        overrides: Parameter values from outside with where they were written, for graph files and command lines.
        concurrency: Groups that differ from what the class declares, by name, for graph files.
        start_parameter_services, enable_rosout, enable_logger_service: False for a tool that needs no parameter
            services, no /rosout or no log level services.
        **params: Parameter values by name.

    Raises:
        InvalidName: The name, the namespace or a rule is not legal.
        ParameterError: A parameter value does not fit its declaration.
        DeclarationError: `concurrency` puts a handler in two groups.
    """

    default_group: ClassVar[Group | None] = None
    """The group of handlers that name none; None lets each queue behind itself only."""
    error_budget: ClassVar[ErrorBudget | None] = ErrorBudget(20, per=10.0)
    """Errors in timers and subscriptions that the node tolerates; None for any number."""
    node_name: ClassVar[str] = ""
    """The name of nodes that are given none; empty for the class's name in snake case."""
    dynamic_names: ClassVar[bool | Sequence[str]] = False
    """Names the class makes at run time, unknown to checks: True, or patterns such as `*/cmd_vel`."""
    is_managed: ClassVar[bool] = False
    """Whether nodes of the class have a life cycle."""
    __firstlineno__: ClassVar[int]
    _core_class: ClassVar[type[NodeCore]] = NodeCore

    def __init__(
        self,
        name: str | None = None,
        *,
        namespace: str = "/",
        remap: Sequence[Remap | str] = (),
        overrides: Mapping[str, tuple[Any, str]] | None = None,
        concurrency: Mapping[str, GroupChange] | None = None,
        start_parameter_services: bool = True,
        enable_rosout: bool = True,
        enable_logger_service: bool = True,
        **params: Any,
    ) -> None:
        unrun.made()
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
        """The node's logger; its records go to the console and to /rosout."""
        self.parameters = self._core.parameters
        self._core.bind(
            parameter_services=start_parameter_services,
            rosout=enable_rosout and given.rosout,
            logger_service=enable_logger_service,
        )

    @classmethod
    def interface(cls) -> Interface:
        """Everything the class declares, and what its methods are seen to make, as data; known without a node."""
        check_module(cls)
        check_names(cls)  # type: ignore[arg-type]
        return with_made(cls, declared.interface_of(cls))

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "__firstlineno__" not in vars(cls):
            cls.__firstlineno__ = declared.class_line()
        check_misplaced(cls)
        check_hooks(cls)
        declared.check_attributes(cls, Node)
        unrun.defined(cls)
        declared.interface_of(cls)  # a wrong declaration is an error of the import, not of a later run

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.full_name}{' running' if self.is_running else ''}>"

    def _hint(self, name: str) -> str:
        core = vars(self).get("_core")
        if name in ("run", "spin", "main"):
            return f"nodes are run by graphflow.run({type(self).__name__})"
        if core is None or name not in core.parameters:
            return OF_PARTS.get(name, "")
        return f'a parameter is read by self.parameters.get("{name}"), or declared in the class: {name} = Param(...)'

    def _instead_of(self, name: str) -> str:
        is_unmade = name in ("_core", "log", "parameters")
        return f"{type(self).__name__}.__init__ must call super().__init__(...) first" if is_unmade else ""

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
        """How each name came about that the node has used, by its full name before remaps."""
        return self._core.names.derivations

    def resolve_topic_name(self, name: str) -> str:
        """The full name of a topic that the node calls `name`, remapped."""
        return self._core.names.resolve(name)

    def resolve_service_name(self, name: str) -> str:
        """The full name of a service or action that the node calls `name`, remapped."""
        return self._core.names.resolve(name, "service")

    @property
    def context(self) -> Context:
        """The context that the node runs in. Raises ClosedError when it is not running."""
        return self._core.context

    @property
    def clock(self) -> Clock:
        """The clock for the node's timers, sleeps and deadlines: simulated time when `use_sim_time` is true.

        Raises:
            ClosedError: The node is not running.
        """
        return self._core.clock

    @property
    def group(self) -> HandlerGroup:
        """The group of the handler that is running: `async with self.group.released(): ...`.

        Raises:
            RuntimeError: What is running is not a handler in a group but, say, a task.
        """
        group = getattr(asyncio.current_task(), "group", None)
        if not isinstance(group, HandlerGroup):
            raise RuntimeError(f"{self.full_name}: what is running here is not a handler that holds a slot of a group")
        return group

    @property
    def is_running(self) -> bool:
        return self._core.is_running

    @property
    def endpoints(self) -> list[Endpoint]:
        """Everything the node has on the network; for actions, the services and topics that they consist of."""
        return self._core.endpoints

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Numbers since the start, by the name of each handler, endpoint and group."""
        return self._core.statistics()

    @in_our_words
    def create_publisher(
        self, type_: type[M], name: str, qos: Qos | int = 10, *, on_event: OnEvent | None = None
    ) -> TopicPublisher[M]:
        """A publisher on `name`, remapped; `on_event` is called with each `QosEvent`."""
        core, place = self._core, here()
        check_type(type_, Message, "create_publisher", place)
        check_text(name, "create_publisher", place)
        check_qos(qos, None, place)
        return core.add(TopicPublisher(core, type_, core.names.resolve(name), Qos.of(qos), on_event))

    @in_our_words
    def create_subscription(
        self,
        type_: type[M],
        name: str,
        callback: Callable[[M], Any] | Callable[[M, MessageInfo], Any] | None,
        qos: Qos | int = 10,
        *,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        takes_info: bool = False,
        ignore_local: bool = False,
        on_event: OnEvent | None = None,
        on_error: OnError = "budget",
    ) -> TopicSubscription[M]:
        """A subscription on `name`, remapped.

        Args:
            callback: A `def` or an `async def`, called with each message; None for a subscription to be iterated.
            takes_info: Call it with the message and a `MessageInfo`: sender, times, sequence number.
            ignore_local: Leave out what this process publishes itself.
            on_event: Called with each `QosEvent`.
            on_error: What an error in the callback means for the node.
        """
        what, place = "create_subscription", here()
        check_type(type_, Message, what, place)
        check_text(name, what, place)
        check_qos(qos, None, place)
        check_group(group, (Group, HandlerGroup), what, place)
        check_on_error(on_error, place)
        if callback is not None:
            hint = "" if takes_info else "; with takes_info=True it gets the message and a MessageInfo"
            check_callback(callback, range(2, 3) if takes_info else range(1, 2), what, place, hint)
        core, resolved = self._core, self._core.names.resolve(name)
        same = (part for part in core.parts if isinstance(part, TopicSubscription) and part.name == resolved)
        tell_doubled(core.log, callback, place, f"each message of {resolved}", same)
        label, call, slots = core.place(callback, f"subscription {name}", group, thread)
        options: dict[str, Any] = {"takes_info": takes_info, "ignore_local": ignore_local, "on_event": on_event}
        made = TopicSubscription(core, type_, resolved, Qos.of(qos), call, label, slots, on_error=on_error, **options)
        tell_same(core, core.parts, made, callback)
        return core.add(made, late=callback is not None)

    @in_our_words
    def create_service(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        callback: Callable[[Request], Any] | Callable[[Request, Response], Any],
        *,
        qos: Qos | int = SERVICES,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        introspection: Introspection = "off",
    ) -> ServiceServer[Request, Response]:
        """A service on `name`, remapped; `callback` takes the request and returns the response.

        As in ROS 2 it may take a second argument, an empty response to fill in and return.

        Args:
            introspection: What is published of each call on `name`/_service_event: nothing, its metadata, or
                request and response as well.
        """
        what, place = "create_service", here()
        check_type(type_, Service, what, place)
        check_text(name, what, place)
        check_group(group, (Group, HandlerGroup), what, place)
        arguments = check_callback(callback, range(1, 3), what, place)
        core, resolved = self._core, self._core.names.resolve(name, "service")
        label, call, slots = core.place(callback, f"service {name}", group, thread)
        takes: dict[str, Any] = {"takes_response": arguments == 2, "place": written_at(callback)}
        made = ServiceServer(core, type_, resolved, Qos.of(qos), call, label, slots, **takes)
        for other in core.parts:
            if isinstance(other, ServiceServer) and other.name == resolved:
                servers = [part for one in (other, made) for part in (one.handler_title, one.place)]
                core.log.warning(OFFERED_TWICE, resolved, *servers)
        made.configure_introspection(introspection)
        return core.add(made, late=True)

    @in_our_words
    def create_client(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        *,
        qos: Qos | int = SERVICES,
        introspection: Introspection = "off",
        group: Group | HandlerGroup | None = None,
    ) -> ServiceClient[Request, Response]:
        """A client of the service `name`, remapped; `introspection` as for `create_service`.

        Args:
            group: Responses wait for a slot of it, as in ROS 2; without a group they need none.
        """
        core, place = self._core, here()
        check_type(type_, Service, "create_client", place)
        check_text(name, "create_client", place)
        check_group(group, (Group, HandlerGroup), "create_client", place)
        slots = None if group is None else core.groups.at_work(group)
        made = ServiceClient(core, type_, core.names.resolve(name, "service"), Qos.of(qos), slots)
        made.configure_introspection(introspection)
        return core.add(made)

    @in_our_words
    def create_action_server(
        self,
        type_: type[Action[Goal, Result, Feedback]],
        name: str,
        callback: Callable[[Any], Any],
        *,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        policy: GoalPolicy = "reject",
        accept: Callable[[Goal], Any] | None = None,
        cancellable: bool | Callable[[Any], bool] = True,
        on_client_loss: OnClientLoss = "continue",
        cleanup_timeout: float = 10.0,
    ) -> ActionServer[Goal, Result, Feedback]:
        """An action on `name`, remapped; `callback` takes the goal's `ServerGoalHandle` and returns the result.

        Args:
            policy: What becomes of a goal that arrives while another is under way.
            accept: Called with each goal's message; False rejects it, and so does a text that says why.
            cancellable: Whether cancel requests are granted, or a function of the handle that decides.
            on_client_loss: What becomes of a goal whose client has gone.
            cleanup_timeout: Seconds that a cancelled body has; then its goal counts as aborted.
        """
        what, place = "create_action_server", here()
        check_type(type_, Action, what, place)
        check_text(name, what, place)
        check_group(group, (Group, HandlerGroup), what, place)
        check_callback(callback, range(1, 2), what, place)
        core, resolved = self._core, self._core.names.resolve(name, "service")
        label, call, slots = core.place(callback, f"action {name}", group, thread)
        rules = GoalRules(policy, on_client_loss, cleanup_timeout=cleanup_timeout)
        options: dict[str, Any] = {"rules": rules, "accept": accept, "cancellable": cancellable}
        return core.add(ActionServer(core, type_, resolved, call, label, slots, **options), late=True)

    @in_our_words
    def create_action_client(
        self, type_: type[Action[Goal, Result, Feedback]], name: str
    ) -> GoalClient[Goal, Result, Feedback]:
        """A client of the action `name`, remapped."""
        check_type(type_, Action, "create_action_client", here())
        check_text(name, "create_action_client", here())
        return self._core.add(GoalClient(self._core, type_, self._core.names.resolve(name, "service")))

    @in_our_words
    def create_timer(
        self,
        period: float,
        callback: Callable[..., Any],
        *,
        group: Group | HandlerGroup | None = None,
        thread: bool = False,
        takes_info: bool = False,
        on_error: OnError = "budget",
    ) -> Timer:
        """Call `callback` once a `period` (seconds).

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
        tell_doubled(self._core.log, callback, place, "each period", same)
        label, call, slots = self._core.place(callback, "timer", group, thread)
        made = Timer(self._core, nanoseconds, call, label, slots, takes_info=takes_info, on_error=on_error)
        tell_same(self._core, self._core.parts, made, callback)
        return self._core.add(made, late=True)

    @in_our_words
    def declare_parameter(self, name: str, default: Any, *, dynamic: bool = False, **limits: Any) -> Any:
        """Declare a parameter at run time; returns its value. `limits` as for `Param`.

        Args:
            dynamic: Whether it takes values of any type and may be deleted.

        Raises:
            ParameterError: The parameter exists, or the value given from outside does not fit.
        """
        return self.parameters.declare(Param(default, name=name, **limits).with_typing(dynamic=dynamic))

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter that `declare_parameter` has made. Raises ParameterError if it cannot."""
        self.parameters.undeclare(name)

    async def offload(self, fn: Callable[..., T], *args: Any) -> T:
        """Run `fn(*args)` in a worker thread, for work that would block the loop. It cannot be cancelled.

        At most 32 run at a time, those of all nodes of the process together; others wait their turn.
        """
        check_function(fn, "offload", "await self.offload(time.sleep, 0.5)")
        check_plain(fn, "offload")
        return await self.context.offload(fn, *args)

    def spawn(self, fn: Callable[..., Coroutine[Any, Any, Any]], *args: Any) -> None:
        """Run `fn(*args)` alongside everything else until the node stops; from any thread.

        An error in it ends the node.
        """
        check_function(fn, "spawn", "self.spawn(self.work)")
        if self.context.is_here:
            self._core.spawn(fn, *args)
        else:
            call_soon(self._core, self._core.spawn, (fn, *args))

    def call_soon(self, fn: Callable[..., object], *args: Any) -> None:
        """Call `fn(*args)` on the event loop: the way to it from another thread, such as that of a driver's callback.

        An error in it is logged.

        Raises:
            ClosedError: The node does not run.
        """
        check_function(fn, "call_soon", "self.call_soon(self.work)")
        call_soon(self._core, fn, args)

    async def on_start(self) -> None:
        """For subclasses: prepare. Publishers and clients work; no handler, timer or task runs before it returns.

        An error in it ends the node.
        """

    async def on_shutdown(self) -> None:
        """For subclasses: finish. Handlers and tasks have ended; publishers and clients still work."""

    async def enter(self, manager: AbstractAsyncContextManager[T] | AbstractContextManager[T]) -> T:
        """Enter a context manager that is left when the node stops, in reverse order, after `on_shutdown`."""
        if isinstance(manager, AbstractAsyncContextManager):
            return await self._core.entered.enter_async_context(manager)
        return self._core.entered.enter_context(manager)

    def shutdown(self) -> None:
        """End the node from within: the code that runs it will stop it, and a process with nothing else to run ends.

        From any thread.
        """
        self._core.shutdown()

    async def wait_ended(self) -> None:
        """Wait until the node ends itself by `shutdown`, or fails; raises the error it failed with."""
        await self._core.wait_ended()

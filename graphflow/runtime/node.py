"""The node: declarations bound to a context, the `create_*` methods beneath them, and its life."""

from __future__ import annotations

import asyncio
import concurrent.futures
import inspect
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable, Coroutine, Mapping, Sequence
from contextlib import AbstractAsyncContextManager, AbstractContextManager, AsyncExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, ClassVar, Protocol, TypeVar

from graphflow.errors import ClosedError, DeadlockError, DeclarationError, GraphflowError, ParameterError
from graphflow.interface import GoalPolicy, GroupChange, Interface, OnClientLoss, may_make
from graphflow.msgs import registry
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, Service
from graphflow.names import Remap, Resolver, did_you_mean
from graphflow.qos import CLOCK, PARAMETERS, SERVICES, Qos
from graphflow.runtime import declare, declared, races
from graphflow.runtime.action_client import GoalClient
from graphflow.runtime.actions import GoalServer
from graphflow.runtime.binding import Binding
from graphflow.runtime.clock import Clock, period_ns
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints import Endpoint
from graphflow.runtime.events import OnEvent
from graphflow.runtime.failures import ErrorBudget, Failures, OnError
from graphflow.runtime.groups import Groups, HandlerGroup
from graphflow.runtime.node_services import LoggerLevels, TypeDescriptions
from graphflow.runtime.parameter_services import ParameterEvents, ParameterServices
from graphflow.runtime.params import Change, Parameters
from graphflow.runtime.places import is_users
from graphflow.runtime.rosout import Rosout, node_logger
from graphflow.runtime.scheduler import Finished, Runner
from graphflow.runtime.service_events import Introspection
from graphflow.runtime.services import ServiceClient, ServiceServer
from graphflow.runtime.sim_time import SimClock
from graphflow.runtime.timer import Timer, TimerInfo
from graphflow.runtime.topics import TopicPublisher, TopicSubscription
from graphflow.runtime.waits import place_of
from graphflow.times import NANOSECONDS, to_ns
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

M = TypeVar("M", bound=Message)
T = TypeVar("T")

SLOW_START = 5.0
"""Seconds that `on_start` may take until it is said where it waits."""
STOP_LIMIT = 2.0
"""Seconds that cancelled handlers and tasks get for their cleanup."""


class _Openable(Protocol):
    def open(self) -> None: ...

    def close(self) -> None: ...


E = TypeVar("E", bound=_Openable)


class Node:
    """A ROS 2 node as an async Python class. Subclass it, declare what it holds and does, and `graphflow.run` it.

    Making a node sets it up and runs nothing; `start` puts it on the network.

    Args:
        name: Its name; without one, the class's in snake case.
        namespace: Where it lives: `/` or `/robot1`.
        remap: Rules, first match wins; as objects or as text `from:=to`.
        overrides: Parameter values from outside with where they were written, for graph files and command lines.
        concurrency: Groups that differ from what the class declares, by name, for graph files.
        start_parameter_services, enable_rosout, enable_logger_service: False for a tool that nobody sets parameters
            of, reads the log of, or asks to say more.
        **params: Parameter values by name.

    Raises:
        InvalidName: The name, the namespace or a rule is not legal.
        ParameterError: A parameter value does not fit its declaration.
        DeclarationError: `concurrency` puts a handler into two groups.
    """

    default_group: ClassVar[declare.Group | None] = None
    """The group of handlers that name none; None lets each queue behind itself only."""
    error_budget: ClassVar[ErrorBudget | None] = ErrorBudget(20, per=10.0)
    """Errors of timers and subscriptions that the node bears; None for any number."""
    node_name: ClassVar[str] = ""
    """The name of nodes that are given none; empty: the class's name in snake case."""
    dynamic_names: ClassVar[bool | Sequence[str]] = False
    """Names the class makes at run time, which checks cannot know: True, or patterns such as `*/cmd_vel`."""
    __firstlineno__: ClassVar[int]
    failure: BaseException | None = None
    """The error that ended the node."""
    _ended: asyncio.Future[None] | None = None
    _made: Mapping[str, Any] | None = None
    """What its own `__init__` has set."""

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
        rules = [r if isinstance(r, Remap) else Remap.parse(r) for r in remap]
        self.names = Resolver(name or declared.default_name(type(self)), namespace, rules)
        self.id = 0
        self.failure_taken = False
        """Whether somebody has waited for `failure`."""
        self.log = node_logger(self.full_name)
        """The node's logger; what it says goes to the console and to /rosout."""
        self.parameters = Parameters({**(overrides or {}), **{k: (v, "argument") for k, v in params.items()}})
        self._context: Context | None = None
        self._binding = Binding(self)
        self._openables: list[_Openable] = []
        self._late: list[_Openable] | None = []
        """What is opened once `on_start` has returned; None from then on."""
        self._entered = AsyncExitStack()
        self.tasks: set[asyncio.Task[Any]] = set()
        """What `spawn` has started and has not ended."""
        self.runners: list[Runner] = []
        """What runs its handlers."""
        self._token: Any = None
        self._own_services: set[str] = set()
        self._rosout: Rosout | None = None
        self._parameter_events: ParameterEvents | None = None
        self._sim_clock: tuple[SimClock, TopicSubscription[Any]] | None = None
        self.groups = Groups(declared.groups(type(self)), type(self).default_group, concurrency or {})
        """The node's concurrency groups."""
        self._failures = Failures(self, self._fail)
        self._made = dict(vars(self))
        self._bind_declarations(
            parameter_services=start_parameter_services, rosout=enable_rosout, logger_service=enable_logger_service
        )

    @classmethod
    def interface(cls) -> Interface:
        """Everything the class declares, as data; known without making a node."""
        return declared.interface_of(cls)

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "__firstlineno__" not in vars(cls):
            cls.__firstlineno__ = declared.class_line()
        declared.check_attributes(cls, TAKEN)
        declared.interface_of(cls)  # a wrong declaration is an error of the import, not of a later run

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.full_name}{' running' if self.is_running else ''}>"

    # who it is

    @property
    def name(self) -> str:
        return self.names.name

    @property
    def namespace(self) -> str:
        return self.names.namespace

    @property
    def full_name(self) -> str:
        """Namespace and name: `/turtle1/follower`."""
        return self.names.full_name

    @property
    def context(self) -> Context:
        """The context it runs in.

        Raises:
            ClosedError: It is not running.
        """
        if self._context is None:
            raise ClosedError(f"node {self.full_name} is not running")
        return self._context

    @property
    def clock(self) -> Clock:
        """The clock that its timers, sleeps and deadlines go by: simulated time when `use_sim_time` is true."""
        return self.context.clock if self._sim_clock is None else self._sim_clock[0]

    @property
    def group(self) -> HandlerGroup:
        """The group of the handler that is running: `async with self.group.released(): ...`.

        Raises:
            RuntimeError: What is running is no handler in a group, but a task, say.
        """
        group = getattr(asyncio.current_task(), "group", None)
        if not isinstance(group, HandlerGroup):
            raise RuntimeError(f"{self.full_name}: what is running here is no handler that holds a slot of a group")
        return group

    @property
    def is_running(self) -> bool:
        return self._context is not None

    @property
    def endpoints(self) -> list[Endpoint]:
        """Everything it has on the network; of actions, the services and topics that they are made of."""
        found: list[Endpoint] = []
        for openable in self._openables:
            if isinstance(openable, (GoalServer, GoalClient)):
                found += openable.endpoints
            elif isinstance(openable, Endpoint):
                found.append(openable)
        return found

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Numbers since the start, by the name of each handler, endpoint and group."""
        found = {f"group {name}": group.statistics() for name, group in self.groups.by_name.items()}
        for openable in self._openables:
            if isinstance(openable, (Endpoint, GoalServer, Timer)):
                found[openable.title] = openable.statistics()
        return found

    # create_*: rclpy's names and argument order

    def create_publisher(
        self, type_: type[M], name: str, qos: Qos | int = 10, *, on_event: OnEvent | None = None
    ) -> TopicPublisher[M]:
        """A publisher on `name`, remapped; `on_event` is called with each `QosEvent`."""
        return self._add(TopicPublisher(self, type_, self.names.resolve(name), Qos.of(qos), on_event))

    def create_subscription(
        self,
        type_: type[M],
        name: str,
        callback: Callable[[M], Any] | Callable[[M, MessageInfo], Any] | None,
        qos: Qos | int = 10,
        *,
        group: declare.Group | None = None,
        thread: bool = False,
        takes_info: bool = False,
        ignore_local: bool = False,
        on_event: OnEvent | None = None,
        on_error: OnError = "budget",
    ) -> TopicSubscription[M]:
        """A subscription on `name`, remapped.

        Args:
            callback: A `def` or an `async def`, called with each message; None for a subscription to be iterated.
            takes_info: Call it with the message and a `MessageInfo`: who sent it, when, its number in the row.
            ignore_local: Leave out what this process publishes itself.
            on_event: Called with each `QosEvent`.
            on_error: What an error of the callback means for the node.
        """
        label = _label(callback, f"subscription {name}")
        call, slots = (None, None) if callback is None else self._place(callback, label, group, thread)
        resolved = self.names.resolve(name)
        options: dict[str, Any] = {"takes_info": takes_info, "ignore_local": ignore_local, "on_event": on_event}
        made = TopicSubscription(self, type_, resolved, Qos.of(qos), call, label, slots, on_error=on_error, **options)
        return self._add(made, late=callback is not None)

    def create_service(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        callback: Callable[[Request], Any],
        *,
        qos: Qos | int = SERVICES,
        group: declare.Group | None = None,
        thread: bool = False,
        introspection: Introspection = "off",
    ) -> ServiceServer[Request, Response]:
        """A service on `name`, remapped; `callback` takes the request and returns the response.

        Args:
            introspection: What is published of each call on `name`/_service_event: nothing, its metadata, or
                request and response too.
        """
        resolved = self.names.resolve(name, "service")
        label = _label(callback, f"service {name}")
        call, slots = self._place(callback, label, group, thread)
        made = ServiceServer(self, type_, resolved, Qos.of(qos), call, label, slots)
        made.configure_introspection(introspection)
        return self._add(made, late=True)

    def create_client(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        *,
        qos: Qos | int = SERVICES,
        introspection: Introspection = "off",
        group: declare.Group | None = None,
    ) -> ServiceClient[Request, Response]:
        """A client of the service `name`, remapped; `introspection` as for `create_service`.

        Args:
            group: Answers wait for a slot of it, as in ROS 2; without one they need none.
        """
        slots = None if group is None else self.groups.at_work(group)
        made = ServiceClient(self, type_, self.names.resolve(name, "service"), Qos.of(qos), slots)
        made.configure_introspection(introspection)
        return self._add(made)

    def create_action_server(
        self,
        type_: type[Action[Goal, Result, Feedback]],
        name: str,
        callback: Callable[[Any], Any],
        *,
        group: declare.Group | None = None,
        thread: bool = False,
        policy: GoalPolicy = "reject",
        accept: Callable[[Goal], Any] | None = None,
        cancellable: bool | Callable[[Any], bool] = True,
        on_client_loss: OnClientLoss = "continue",
        cleanup_timeout: float = 10.0,
    ) -> GoalServer[Goal, Result, Feedback]:
        """An action on `name`, remapped; `callback` takes the goal's `Handle` and returns the result.

        Args:
            policy: What becomes of a goal that comes while another is under way.
            accept: Called with each goal's message; False rejects it.
            cancellable: Whether cancel requests are granted, or a function of the `Handle` that decides.
            on_client_loss: What becomes of a goal whose client has gone.
            cleanup_timeout: Seconds that a cancelled body gets; then its goal counts as aborted.
        """
        label = _label(callback, f"action {name}")
        call, slots = self._place(callback, label, group, thread)
        made: GoalServer[Goal, Result, Feedback] = GoalServer(
            self,
            type_,
            self.names.resolve(name, "service"),
            call,
            label,
            slots,
            policy=policy,
            accept=accept,
            cancellable=cancellable,
            on_client_loss=on_client_loss,
            cleanup_timeout=cleanup_timeout,
        )
        return self._add(made, late=True)

    def create_action_client(
        self, type_: type[Action[Goal, Result, Feedback]], name: str
    ) -> GoalClient[Goal, Result, Feedback]:
        """A client of the action `name`, remapped."""
        return self._add(GoalClient(self, type_, self.names.resolve(name, "service")))

    def create_timer(
        self,
        period: float,
        callback: Callable[..., Any],
        *,
        group: declare.Group | None = None,
        thread: bool = False,
        takes_info: bool = False,
        on_error: OnError = "budget",
    ) -> Timer:
        """Call `callback` once a `period` (seconds).

        Raises:
            ValueError: The period is not positive.
        """
        nanoseconds = period_ns(period, None)
        label = _label(callback, "timer")
        call, slots = self._place(callback, label, group, thread)

        def run(info: TimerInfo) -> Any:
            return call(info) if takes_info else call()

        return self._add(Timer(self, nanoseconds, run, label, slots, on_error), late=True)

    def declare_parameter(self, name: str, default: Any, *, dynamic: bool = False, **limits: Any) -> Any:
        """Declare a parameter at run time; returns its value. `limits` as for `Param`.

        Args:
            dynamic: Let it take values of every type, and be deleted.

        Raises:
            ParameterError: It exists, or the value given from outside does not fit.
        """
        parameter = declare.Param(default, name=name, **limits).parameter
        return self.parameters.declare(replace(parameter, dynamic=dynamic))

    def undeclare_parameter(self, name: str) -> None:
        """Take away a parameter that `declare_parameter` has made.

        Raises:
            ParameterError: There is none of that name, or it is read-only.
        """
        self.parameters.undeclare(name)

    async def offload(self, fn: Callable[..., T], *args: Any) -> T:
        """Run `fn(*args)` in a worker thread, for work that would hold the loop. It cannot be cancelled."""
        return await self.context.in_thread(fn, *args)

    def spawn(self, fn: Callable[..., Coroutine[Any, Any, Any]], *args: Any) -> None:
        """Run `fn(*args)` beside everything else until the node stops. An error in it ends the node."""
        task = self.context.loop.create_task(fn(*args), name=f"{self.full_name}.{getattr(fn, '__name__', 'task')}")
        self.tasks.add(task)
        task.add_done_callback(self._task_done)
        self.context.detector.arm()

    # its life

    def ensure_made(self) -> None:
        """See that the node was made as it should be.

        Raises:
            DeclarationError: Its `__init__` did not call `super().__init__`, or has set what every node has.
            ParameterError: A value was given for a parameter that it does not have.
        """
        if self._made is None:
            raise DeclarationError(f"{type(self).__name__}.__init__ must call super().__init__(...)")
        for attribute, value in self._made.items():
            if not attribute.startswith("_") and vars(self).get(attribute) is not value:
                text = f"self.{attribute} is something every node has; call the attribute otherwise"
                raise DeclarationError(f"{type(self).__name__}: {text}")
        unused = self.parameters.unused_overrides()
        if unused:
            raise ParameterError(f"node {self.full_name}: " + "; ".join(unused))

    async def on_start(self) -> None:
        """For subclasses: prepare. Publishers and clients work; no handler, timer or task runs before it returns.

        An error in it ends the node.
        """

    async def on_shutdown(self) -> None:
        """For subclasses: say goodbye. Handlers and tasks have ended; publishers and clients still work."""

    async def enter(self, manager: AbstractAsyncContextManager[T] | AbstractContextManager[T]) -> T:
        """Enter a context manager that is left when the node stops, in reverse order, after `on_shutdown`."""
        if isinstance(manager, AbstractAsyncContextManager):
            return await self._entered.enter_async_context(manager)
        return self._entered.enter_context(manager)

    async def start(self, context: Context) -> None:
        """Go on the network: open what is declared, announce it, start timers and tasks.

        Raises:
            GraphflowError: An override names no parameter, `concurrency` no handler, or something cannot be opened;
            nothing is left open.
            ClosedError: The node is running already, or has been stopped.
        """
        if self._ended is not None:
            state = "is running already" if self.is_running else "has been stopped; make a new one"
            raise ClosedError(f"node {self.full_name} {state}")
        self.ensure_made()
        self._context = context
        self.id = context.next_id()
        self._ended = context.loop.create_future()
        context.waits.nodes.append(self)
        if races.is_wanted():
            races.watch(self)
        try:
            node = Entity(context.domain, context.session.zid, self.id, self.id, Kind.NODE, self.namespace, self.name)
            self._token = context.session.announce(node.token)
            assert self._late is not None
            for openable in [o for o in self._openables if o not in self._late]:
                openable.open()
            if self.parameters.get("use_sim_time"):
                self._follow_sim_time()
            due_ns = context.clock.monotonic_ns() + to_ns(SLOW_START)
            slow = context.clock.call_at(due_ns, partial(self._say_slow_start, asyncio.current_task()))
            try:
                await self.on_start()
            finally:
                slow.cancel()
            self.groups.refuse_strays()
            late, self._late = self._late, None
            for openable in sorted(late, key=lambda o: isinstance(o, Timer)):
                openable.open()
        except BaseException:  # a cancellation too: nothing stays open
            await self.stop()
            raise
        self.warn_unused_remaps()
        for attribute, handler in declared.handlers(type(self)).items():
            if handler.kind == "task":
                self.spawn(getattr(self, attribute))

    def _say_slow_start(self, task: Any) -> None:
        self.log.warning(
            "on_start has not returned for %.0f s %s; this node's handlers begin when it has: what waits for them, or "
            "for nodes that wait for this one, belongs into a @task",
            SLOW_START,
            place_of(task),
        )

    def warn_unused_remaps(self) -> None:
        """Say which remap rules have matched nothing; a class that makes names at run time may use them later."""
        known = {r.given for r in self.names.derivations.values()} - self._own_services
        for rule in self.names.unused():
            if may_make(self.dynamic_names, self.names.full(rule.match)):
                continue
            if rule.match in self.parameters:
                hint = f"; to set the parameter write -p {rule}"
            else:
                hint = did_you_mean(rule.match, known)
            self.log.warning("the remap %s matches no name of this node%s", rule, hint)

    def shutdown(self) -> None:
        """End the node from within: whoever runs it will stop it, and a process with nothing else to run ends."""
        if self._ended is not None and not self._ended.done():
            self._ended.set_result(None)

    async def wait_ended(self) -> None:
        """Wait until the node ends itself by `shutdown`, or fails; raises the error it failed with."""
        assert self._ended is not None
        try:
            await asyncio.shield(self._ended)
        finally:
            self.failure_taken = True

    async def stop(self, *, withdraw: bool = True) -> None:
        """Leave the network: cancel handlers and tasks, wait for their cleanup, withdraw everything.

        Args:
            withdraw: False when the context is closed right after, which withdraws all at once and cannot be held up
                by peers that are going away too.
        """
        context = self._context
        if context is None:
            return
        ending: dict[asyncio.Future[Any], str] = {}
        for openable in self._openables:
            if isinstance(openable, Timer):
                openable.cancel()
            if isinstance(openable, GoalServer):
                openable.drop_waiting()
            runner: Runner | None = getattr(openable, "runner", None)
            if runner is not None:
                ending[runner.cancel()] = runner.name
        for runner in self._binding.stop():
            ending[runner.cancel()] = runner.name
        for task in self.tasks - {asyncio.current_task()}:
            task.cancel()
            ending[task] = task.get_name()
        try:
            if ending:
                _, stuck = await asyncio.wait(ending, timeout=STOP_LIMIT)
                if stuck:
                    names = ", ".join(ending[future] for future in stuck)
                    self.log.warning("still running %.0f s after it was cancelled: %s", STOP_LIMIT, names)
            if self._late is None:
                await self._limited("on_shutdown", self.on_shutdown)
            await self._limited("leaving what was entered", self._entered.aclose)
        finally:
            # Also when this wait is cancelled: nothing stays open.
            if self._rosout is not None:
                self._rosout.detach()
            if withdraw:
                for openable in list(reversed(self._openables)):
                    openable.close()
                if self._token is not None:
                    self._token.close()
            if self._ended is not None and not self._ended.done():
                self._ended.cancel()
            if self in context.waits.nodes:  # two may stop a node
                context.waits.nodes.remove(self)
            self._context = None

    async def _limited(self, what: str, work: Callable[[], Coroutine[Any, Any, None]]) -> None:
        """A part of stopping: it may fail or take too long, and the rest is done all the same."""
        try:
            async with asyncio.timeout(STOP_LIMIT):
                await work()
        except TimeoutError:
            self.log.warning("%s has taken more than %.0f s and was cancelled", what, STOP_LIMIT)
        except Exception as error:
            self.report_error(what, error)

    def handler_failed(self, label: str, error: BaseException, on_error: OnError | None = None) -> None:
        """An error of a handler.

        Args:
            on_error: What it means for the node; None where a caller has it, so that it is only logged.
        """
        if isinstance(error, (CancelledError, concurrent.futures.CancelledError)):  # of a coroutine, or of a thread
            return
        if on_error is None or not self.is_running:  # it has not waited for this run
            self.report_error(label, error)
        else:
            self._failures.failed(label, error, on_error)

    def report_error(self, label: str, error: BaseException) -> None:
        """Log an error: one of graphflow's own is a sentence, any other comes with its traceback."""
        if isinstance(error, GraphflowError):
            # A deadlock's own text says where.
            self.log.error("%s: %s%s", label, error, "" if isinstance(error, DeadlockError) else _place(error))
        else:
            trace = (type(error), error, users_part(error))
            self.log.error("%s: %s: %s", label, type(error).__name__, error, exc_info=trace)

    # for its declarations and endpoints

    def bound(self, fn: Callable[..., Any] | None) -> Callable[..., Any] | None:
        """A function of the class body, as a method of this node; a child class may have another of the name."""
        return None if fn is None else getattr(self, fn.__name__)

    def runner(
        self,
        label: str,
        group: HandlerGroup | None,
        items: deque[Any],
        invoke: Callable[[Any], Any],
        finished: Finished,
        refused: Callable[[Any], None] | None = None,
        kind: str = "",
    ) -> Runner:
        """A runner for one of the node's handlers; without a group it queues behind itself only."""
        name = f"{self.full_name}.{label}"
        made = Runner(self.context.loop, name, group, items, invoke, finished, refused, kind=kind)
        made.stalled = self.context.detector.arm
        self.runners[:] = [r for r in self.runners if not r.closed or r.active]
        self.runners.append(made)
        return made

    def forget(self, openable: _Openable) -> None:
        """Take an endpoint that was closed off the list."""
        if openable in self._openables:
            self._openables.remove(openable)
        if self._late and openable in self._late:
            self._late.remove(openable)

    def held(self, attribute: str) -> Any:
        """What a declaration of the class has become."""
        return self._binding.held[attribute]

    def _add(self, openable: E, *, late: bool = False) -> E:
        """Take in an endpoint or timer, and open it if the time has come: `late` ones wait for `on_start`."""
        self._openables.append(openable)
        if late and self._late is not None:
            self._late.append(openable)
        elif self._context is not None:
            openable.open()
        return openable

    def _place(
        self, callback: Callable[..., Any], label: str, group: declare.Group | None, thread: bool
    ) -> tuple[Callable[..., Any], HandlerGroup | None]:
        """A handler as it is to be called, and the group whose slots its runs take."""
        place = self.groups.place(label, group)
        threaded = thread or (place.is_threaded and not inspect.iscoroutinefunction(callback))
        return self._in_thread(callback) if threaded else callback, place.group

    def _in_thread(self, fn: Callable[..., Any]) -> Callable[..., Coroutine[Any, Any, Any]]:
        if inspect.iscoroutinefunction(fn):
            raise ValueError(f"{fn.__qualname__}: thread=True is for `def`, an `async def` runs on the loop")

        async def run(*args: Any) -> Any:
            # A thread cannot be cancelled: until it has ended the run goes on, and holds its slot.
            return await self.context.in_thread(fn, *args, stays=True)

        return run

    def _bind_declarations(self, *, parameter_services: bool, rosout: bool, logger_service: bool) -> None:
        self._binding.bind_parameters()
        self.parameters.observe(self._parameters_changed)
        if rosout:
            self._rosout = self._add(Rosout(self))
        if parameter_services:
            for name, type_name, callback in ParameterServices(self.parameters).handlers():
                self._serve(name, f"rcl_interfaces/srv/{type_name}", callback, PARAMETERS)
            self._parameter_events = self._add(ParameterEvents(self))
            if self.parameters.get("start_type_description_service"):
                descriptions = TypeDescriptions(lambda: self.endpoints)
                type_name = "type_description_interfaces/srv/GetTypeDescription"
                self._serve("get_type_description", type_name, descriptions.get, SERVICES)
        if logger_service:
            levels = LoggerLevels(self)
            self._serve("get_logger_levels", "rcl_interfaces/srv/GetLoggerLevels", levels.get, SERVICES)
            self._serve("set_logger_levels", "rcl_interfaces/srv/SetLoggerLevels", levels.set, SERVICES)
        self._binding.bind()

    def _serve(self, name: str, type_name: str, callback: Callable[[Any], Any], qos: Qos) -> None:
        """One of the services that every node has; they are there before `on_start` runs."""
        type_: Any = registry.interface_class(type_name)
        self._own_services.add(f"~/{name}")
        made = self._add(ServiceServer(self, type_, self.names.resolve(f"~/{name}", "service"), qos, callback, name))
        made.is_inner = True

    def _parameters_changed(self, changes: Mapping[str, Change]) -> None:
        if self._context is None:
            return
        if "use_sim_time" in changes:
            self._follow_sim_time()
        if self._parameter_events is not None:
            self._parameter_events.tell(changes)

    def _follow_sim_time(self) -> None:
        """Go by /clock, or by the context's clock, as the parameter `use_sim_time` says."""
        former, wanted = self._sim_clock, self.parameters.get("use_sim_time")
        if wanted and former is None:
            from graphflow.msgs.rosgraph_msgs.msg import Clock as ClockMessage

            clock, topic = SimClock(self.context.loop), self.names.resolve("/clock")

            def told(message: ClockMessage) -> None:
                clock.set_time(message.clock.sec * NANOSECONDS + message.clock.nanosec)

            heard = TopicSubscription(self, ClockMessage, topic, CLOCK, told)
            self._sim_clock = (clock, self._add(heard))
        elif not wanted and former is not None:
            self._sim_clock = None
            former[1].close()
            former[0].retire(self.clock)
        for endpoint in self.endpoints:
            endpoint.clock_changed()
        for timer in [o for o in self._openables if isinstance(o, Timer)]:
            timer.clock_changed()

    def _task_done(self, task: asyncio.Task[Any]) -> None:
        self.tasks.discard(task)
        if task.cancelled() or task.exception() is None:
            return
        if self._ended is not None and not self._ended.done():
            error = task.exception()
            assert error is not None
            self.report_error(f"task {task.get_name()}", error)
            self._fail(error)

    def _fail(self, error: BaseException) -> None:
        """End the node with an error."""
        if self._ended is not None and not self._ended.done():
            self.failure = error
            self._ended.set_exception(error)
            self._ended.exception()  # it is logged: asyncio need not complain when nobody waits for it


TAKEN = frozenset(dir(Node)) | {
    *("id", "names", "log", "parameters", "failure", "failure_taken", "groups", "runners", "tasks"),
    *("_binding", "_context", "_ended", "_entered", "_failures", "_late", "_openables", "_parameter_events"),
    *("_own_services", "_rosout", "_sim_clock", "_token"),
}
"""Attributes that no declaration may hide."""


def _label(callback: Callable[..., Any] | None, otherwise: str) -> str:
    name = getattr(callback, "__name__", "")
    return name if name and name != "<lambda>" else otherwise


_PACKAGE = str(Path(__file__).parents[1])


def users_part(error: BaseException) -> TracebackType | None:
    """An error's traceback without the frames of graphflow that it begins with; whole if there are no others."""
    rest = error.__traceback__
    while rest is not None and rest.tb_frame.f_code.co_filename.startswith(_PACKAGE):
        rest = rest.tb_next
    return rest or error.__traceback__


def _place(error: BaseException) -> str:
    """The last line of the user's own code that an error passed through, to be put behind its text."""
    place, trace = "", error.__traceback__
    while trace is not None:
        if is_users(trace.tb_frame.f_code.co_filename):
            place = f" ({trace.tb_frame.f_code.co_filename}:{trace.tb_lineno})"
        trace = trace.tb_next
    return place

"""The node: declarations bound to a context, the `create_*` methods beneath them, and its life."""

from __future__ import annotations

import asyncio
import inspect
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable, Coroutine, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, ClassVar, Protocol, TypeVar

from graphflow.errors import ClosedError, DeclarationError, GraphflowError, ParameterError
from graphflow.interface import Interface, may_make
from graphflow.machines.group import GroupState
from graphflow.msgs.base import Message, Request, Response, Service
from graphflow.names import Remap, Resolver, did_you_mean
from graphflow.qos import PARAMETERS, SERVICES, Qos
from graphflow.runtime import declare, declared
from graphflow.runtime.clock import Clock, period_ns
from graphflow.runtime.context import Context
from graphflow.runtime.events import OnEvent
from graphflow.runtime.params import Parameters, ParameterServices
from graphflow.runtime.rosout import Rosout, node_logger
from graphflow.runtime.scheduler import Finished, Runner
from graphflow.runtime.services import ServiceClient, ServiceServer
from graphflow.runtime.timer import Timer, TimerInfo
from graphflow.runtime.topics import TopicPublisher, TopicSubscription
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

M = TypeVar("M", bound=Message)
T = TypeVar("T")

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
        start_parameter_services, enable_rosout: False for a tool that nobody sets parameters of or reads the log of.
        **params: Parameter values by name.

    Raises:
        InvalidName: The name, the namespace or a rule is not legal.
        ParameterError: A parameter value does not fit its declaration.
    """

    default_group: ClassVar[declare.Group | None] = None
    """The group of handlers that name none; None lets each queue behind itself only."""
    node_name: ClassVar[str] = ""
    """The name of nodes that are given none; empty: the class's name in snake case."""
    dynamic_names: ClassVar[bool | Sequence[str]] = False
    """Names the class makes at run time, which checks cannot know: True, or patterns such as `*/cmd_vel`."""
    __firstlineno__: ClassVar[int]
    failure: BaseException | None = None
    """The error that ended the node."""
    _made = False

    def __init__(
        self,
        name: str | None = None,
        *,
        namespace: str = "/",
        remap: Sequence[Remap | str] = (),
        overrides: Mapping[str, tuple[Any, str]] | None = None,
        start_parameter_services: bool = True,
        enable_rosout: bool = True,
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
        self._held: dict[str, Any] = {}
        self._openables: list[_Openable] = []
        self._tasks: set[asyncio.Task[Any]] = set()
        self._ended: asyncio.Future[None] | None = None
        self._token: Any = None
        self._rosout: Rosout | None = None
        self._groups: dict[declare.Group, GroupState[Runner]] = {}
        self._handler_timers: list[tuple[declare.Rate, Timer]] = []
        self._made = True
        self._bind_declarations(start_parameter_services, enable_rosout)

    @classmethod
    def interface(cls) -> Interface:
        """Everything the class declares, as data; known without making a node."""
        return declared.interface_of(cls)

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "__firstlineno__" not in vars(cls):
            cls.__firstlineno__ = declared.class_line()
        declared.check_attributes(cls, _TAKEN)
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
        return self.context.clock

    @property
    def is_running(self) -> bool:
        return self._context is not None

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
    ) -> TopicSubscription[M]:
        """A subscription on `name`, remapped.

        Args:
            callback: A `def` or an `async def`, called with each message; None for a subscription to be iterated.
            takes_info: Call it with the message and a `MessageInfo`: who sent it, when, its number in the row.
            ignore_local: Leave out what this process publishes itself.
            on_event: Called with each `QosEvent`.
        """
        slot = self._slots(group) if callback is not None else None
        call = self._in_thread(callback) if thread and callback is not None else callback
        label = _label(callback, f"subscription {name}")
        resolved = self.names.resolve(name)
        options: dict[str, Any] = {"takes_info": takes_info, "ignore_local": ignore_local, "on_event": on_event}
        return self._add(TopicSubscription(self, type_, resolved, Qos.of(qos), call, label, slot, **options))

    def create_service(
        self,
        type_: type[Service[Request, Response]],
        name: str,
        callback: Callable[[Request], Any],
        *,
        qos: Qos | int = SERVICES,
        group: declare.Group | None = None,
        thread: bool = False,
    ) -> ServiceServer[Request, Response]:
        """A service on `name`, remapped; `callback` takes the request and returns the response."""
        resolved = self.names.resolve(name, "service")
        call = self._in_thread(callback) if thread else callback
        label = _label(callback, f"service {name}")
        return self._add(ServiceServer(self, type_, resolved, Qos.of(qos), call, label, self._slots(group)))

    def create_client(
        self, type_: type[Service[Request, Response]], name: str, *, qos: Qos | int = SERVICES
    ) -> ServiceClient[Request, Response]:
        """A client of the service `name`, remapped."""
        return self._add(ServiceClient(self, type_, self.names.resolve(name, "service"), Qos.of(qos)))

    def create_timer(
        self,
        period: float,
        callback: Callable[..., Any],
        *,
        group: declare.Group | None = None,
        thread: bool = False,
        takes_info: bool = False,
    ) -> Timer:
        """Call `callback` once a `period` (seconds).

        Raises:
            ValueError: The period is not positive.
        """
        nanoseconds = period_ns(period, None)
        call = self._in_thread(callback) if thread else callback

        def run(info: TimerInfo) -> Any:
            return call(info) if takes_info else call()

        return self._add(Timer(self, nanoseconds, run, _label(callback, "timer"), self._slots(group)))

    def declare_parameter(self, name: str, default: Any, **limits: Any) -> Any:
        """Declare a parameter at run time; returns its value. `limits` as for `Param`.

        Raises:
            ParameterError: It exists, or the value given from outside does not fit.
        """
        return self.parameters.declare(declare.Param(default, name=name, **limits).parameter)

    async def offload(self, fn: Callable[..., T], *args: Any) -> T:
        """Run `fn(*args)` in a worker thread, for work that would hold the loop. It cannot be cancelled."""
        return await self.context.in_thread(fn, *args)

    def spawn(self, fn: Callable[..., Coroutine[Any, Any, Any]], *args: Any) -> None:
        """Run `fn(*args)` beside everything else until the node stops. An error in it ends the node."""
        task = self.context.loop.create_task(fn(*args), name=f"{self.full_name}.{getattr(fn, '__name__', 'task')}")
        self._tasks.add(task)
        task.add_done_callback(self._task_done)

    # its life

    def ensure_made(self) -> None:
        """See that the node was made as it should be.

        Raises:
            DeclarationError: Its `__init__` did not call `super().__init__`.
            ParameterError: A value was given for a parameter that it does not have.
        """
        if not self._made:
            raise DeclarationError(f"{type(self).__name__}.__init__ must call super().__init__(...)")
        unused = self.parameters.unused_overrides()
        if unused:
            raise ParameterError(f"node {self.full_name}: " + "; ".join(unused))

    async def start(self, context: Context) -> None:
        """Go on the network: open what is declared, announce it, start timers and tasks.

        Raises:
            GraphflowError: An override names no parameter, or something cannot be opened; nothing is left open.
            ClosedError: The node is running already, or has been stopped.
        """
        self.ensure_made()
        if self._ended is not None:
            state = "is running already" if self.is_running else "has been stopped; make a new one"
            raise ClosedError(f"node {self.full_name} {state}")
        self._context = context
        self.id = context.next_id()
        self._ended = context.loop.create_future()
        try:
            node = Entity(context.domain, context.session.zid, self.id, self.id, Kind.NODE, self.namespace, self.name)
            self._token = context.session.announce(node.token)
            timers = [o for o in self._openables if isinstance(o, Timer)]
            for openable in [o for o in self._openables if not isinstance(o, Timer)] + timers:
                openable.open()
        except BaseException:  # a cancellation too: nothing stays open
            await self.stop()
            raise
        self.warn_unused_remaps()
        for attribute, handler in declared.handlers(type(self)).items():
            if handler.kind == "task":
                self.spawn(getattr(self, attribute))

    def warn_unused_remaps(self) -> None:
        """Say which remap rules have matched nothing; a class that makes names at run time may use them later."""
        own = {f"~/{name}" for name, _, _ in ParameterServices(self.parameters).handlers()}
        known = {r.given for r in self.names.derivations.values()} - own
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
            runner: Runner | None = getattr(openable, "runner", None)
            if runner is not None:
                ending[runner.cancel()] = runner.name
        for task in self._tasks - {asyncio.current_task()}:
            task.cancel()
            ending[task] = task.get_name()
        try:
            if ending:
                _, stuck = await asyncio.wait(ending, timeout=STOP_LIMIT)
                if stuck:
                    names = ", ".join(ending[future] for future in stuck)
                    self.log.warning("still running %.0f s after it was cancelled: %s", STOP_LIMIT, names)
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
            self._context = None

    def handler_failed(self, label: str, error: BaseException) -> None:
        """Report an error of a timer or subscription; the node goes on."""
        if not isinstance(error, CancelledError):
            self.report_error(label, error)

    def report_error(self, label: str, error: BaseException) -> None:
        """Log an error: one of graphflow's own is a sentence, any other comes with its traceback."""
        if isinstance(error, GraphflowError):
            self.log.error("%s: %s%s", label, error, _place(error))
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
        group: GroupState[Runner] | None,
        items: deque[Any],
        invoke: Callable[[Any], Any],
        finished: Finished,
    ) -> Runner:
        """A runner for one of the node's handlers; without a group it queues behind itself only."""
        slots: GroupState[Runner] = group if group is not None else GroupState(1)
        return Runner(self.context.loop, f"{self.full_name}.{label}", slots, items, invoke, finished)

    def forget(self, openable: _Openable) -> None:
        """Take an endpoint that was closed off the list."""
        if openable in self._openables:
            self._openables.remove(openable)

    def _add(self, openable: E) -> E:
        self._openables.append(openable)
        if self._context is not None:
            openable.open()
        return openable

    def _slots(self, group: declare.Group | None) -> GroupState[Runner] | None:
        chosen = group if group is not None else self.default_group
        if chosen is None:
            return None
        return self._groups.setdefault(chosen, GroupState(chosen.limit))

    def _in_thread(self, fn: Callable[..., Any]) -> Callable[..., Coroutine[Any, Any, Any]]:
        if inspect.iscoroutinefunction(fn):
            raise ValueError(f"{fn.__qualname__}: thread=True is for `def`, an `async def` runs on the loop")

        async def run(*args: Any) -> Any:
            return await self.offload(fn, *args)

        return run

    def _bind_declarations(self, parameter_services: bool, rosout: bool) -> None:
        cls = type(self)
        held = declared.held(cls)
        # Parameters first: names and periods of the others may come from them.
        for attribute, item in held.items():
            if isinstance(item, declare.Param):
                self._held[attribute] = item.bind(self)
        self.parameters.check(self._check_rates)
        self.parameters.observe(self._parameter_changed)
        if rosout:
            self._rosout = self._add(Rosout(self))
        if parameter_services:
            self._open_parameter_services()
        for attribute, item in held.items():
            if not isinstance(item, declare.Param):
                self._held[attribute] = item.bind(self)
        for attribute, handler in declared.handlers(cls).items():
            self._bind_handler(getattr(self, attribute), handler)

    def _bind_handler(self, method: Callable[..., Any], handler: declare.Handler) -> None:
        options: dict[str, Any] = {"group": handler.group, "thread": handler.thread}
        if handler.kind == "subscription":
            options |= {"takes_info": handler.takes_info, "ignore_local": handler.ignore_local}
            options["on_event"] = self.bound(handler.on_event)
            self.create_subscription(handler.type, handler.name, method, handler.qos, **options)
        elif handler.kind == "service":
            self.create_service(handler.type, handler.name, method, **options)
        elif handler.rate is not None:
            period = self._period_ns(handler.rate, {}) / 1e9
            timer = self.create_timer(period, method, takes_info=handler.takes_info, **options)
            self._handler_timers.append((handler.rate, timer))

    def _period_ns(self, rate: declare.Rate, changes: Mapping[str, Any]) -> int:
        values = {name: changes[name] if name in changes else self.parameters.get(name) for name in rate.parameters()}
        try:
            return rate.period_ns(values)
        except ValueError as error:
            given = ", ".join(f"{name!r} = {value!r}" for name, value in values.items())
            raise ParameterError(f"parameter {given}: {error}") from None

    def _check_rates(self, changes: Mapping[str, Any]) -> None:
        for rate, _ in self._handler_timers:
            if changes.keys() & rate.parameters():
                self._period_ns(rate, changes)

    def _parameter_changed(self, name: str, value: Any) -> None:
        for rate, timer in self._handler_timers:
            if name in rate.parameters():
                timer.period = self._period_ns(rate, {}) / 1e9

    def _open_parameter_services(self) -> None:
        from graphflow.msgs.registry import interface_class

        for name, type_name, callback in ParameterServices(self.parameters).handlers():
            type_: Any = interface_class(f"rcl_interfaces/srv/{type_name}")
            resolved = self.names.resolve(f"~/{name}", "service")
            self._add(ServiceServer(self, type_, resolved, PARAMETERS, callback, name))

    def _task_done(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if task.cancelled() or task.exception() is None:
            return
        if self._ended is not None and not self._ended.done():
            error = task.exception()
            assert error is not None
            self.report_error(f"task {task.get_name()}", error)
            self.failure = error
            self._ended.set_exception(error)
            self._ended.exception()  # it is logged: asyncio need not complain when nobody waits for it


_TAKEN = frozenset(dir(Node)) | {
    *("id", "names", "log", "parameters", "failure", "failure_taken"),
    *("_context", "_ended", "_groups", "_handler_timers", "_held", "_openables", "_rosout", "_tasks", "_token"),
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
        if not trace.tb_frame.f_code.co_filename.startswith(_PACKAGE):
            place = f" ({trace.tb_frame.f_code.co_filename}:{trace.tb_lineno})"
        trace = trace.tb_next
    return place

"""What a node class says of itself. Capital: something a node holds. Lower case: something it does.

A declaration is checked when the class is made and turned into data (`graphflow.interface`); nothing runs. When a
node is made each declaration becomes a call of the `create_*` method that a node could also have called itself.
"""

from __future__ import annotations

import inspect
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Generic, Literal, Self, TypeVar, get_args, overload

from graphflow.errors import DeclarationError, GraphflowError, InvalidName, ParameterError, Place
from graphflow.interface import GoalPolicy, HandlerKind, OnClientLoss, Parameter, WhenFull, type_of
from graphflow.msgs import base
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, Service
from graphflow.names import expand
from graphflow.qos import Qos
from graphflow.runtime.clock import period_ns
from graphflow.runtime.failures import OnError
from graphflow.runtime.service_events import Introspection

if TYPE_CHECKING:
    from graphflow.runtime.action_client import GoalClient
    from graphflow.runtime.groups import HandlerGroup
    from graphflow.runtime.node import Node
    from graphflow.runtime.services import ServiceClient
    from graphflow.runtime.topics import TopicPublisher, TopicSubscription

M = TypeVar("M", bound=Message)
V = TypeVar("V", bool, int, float, str, bytes, list[bool], list[int], list[float], list[str])
F = TypeVar("F", bound=Callable[..., Any])

MARK = "__graphflow__"
_NUMBERS = ("int", "float", "list[int]", "list[float]")


def _here(depth: int = 2) -> Place:
    frame = sys._getframe(depth)
    return Place(frame.f_code.co_filename, frame.f_lineno)


def _check_type(type_: Any, kind: type, what: str, place: Place) -> None:
    if not (isinstance(type_, type) and issubclass(type_, kind)):
        hint = ""
        if kind is base.Service and isinstance(type_, type) and issubclass(type_, Message):
            hint = "; give the service's class, as in AddTwoInts, not its Request"
        elif isinstance(type_, str):
            hint = "; the type comes first, then the name"
        raise DeclarationError(f"{place}: {what} needs a {kind.__name__.lower()} class, not {type_!r}{hint}")


def _check_name(name: Any, what: str, place: Place) -> None:
    if not isinstance(name, str):
        raise DeclarationError(f"{place}: {what}: the type comes first, then the name; {name!r} is no name")
    try:
        expand(name, "/", "node")
    except InvalidName as error:
        raise DeclarationError(f"{place}: {what}: {error}") from None


def _qos(qos: Qos | int, depth: int | None, place: Place) -> Qos:
    asked = qos if depth is None else depth
    if not isinstance(asked, (Qos, int)):
        raise DeclarationError(f"{place}: give a Qos or a queue depth such as 10, not {asked!r}")
    try:
        return Qos.of(asked)
    except ValueError as error:
        raise DeclarationError(f"{place}: {error}") from None


def _check_on_event(on_event: Any, what: str, place: Place) -> None:
    if on_event is not None and not inspect.isfunction(on_event):
        raise DeclarationError(
            f"{place}: {what}: on_event= takes a method defined above it, `def noticed(self, event): ...`, "
            f"not {on_event!r}"
        )


def _check_group(group: Any, what: str, place: Place) -> None:
    if group is not None and not isinstance(group, Group):
        raise DeclarationError(f"{place}: {what}: group= takes a Group, not {group!r}; declare one: io = Group(1)")


def _check_on_error(on_error: Any, place: Place) -> None:
    if on_error not in get_args(OnError):
        raise DeclarationError(f"{place}: on_error is one of {', '.join(get_args(OnError))}, not {on_error!r}")


class Group:
    """A concurrency group: how many of its handlers' runs there may be at one time. On a node, its `HandlerGroup`.

    Args:
        limit: 1 excludes one another (ROS 2's MutuallyExclusive), None sets no limit (Reentrant).
        when_full: What becomes of work that finds the group full: see `WhenFull`.
        thread: Run its `def` handlers in threads, where one that blocks holds its slot and not the loop.
        name: If it is not that of the attribute.
    """

    def __init__(
        self, limit: int | None = 1, when_full: WhenFull = "wait", *, thread: bool = False, name: str = ""
    ) -> None:
        if limit is not None and (not isinstance(limit, int) or isinstance(limit, bool) or limit < 1):
            raise DeclarationError(f"{_here()}: a group's limit is 1 or more, or None for no limit, not {limit!r}")
        if when_full not in get_args(WhenFull):
            words = ", ".join(get_args(WhenFull))
            raise DeclarationError(f"{_here()}: when_full is one of {words}, not {when_full!r}")
        self.limit, self.when_full, self.thread, self.name = limit, when_full, thread, name

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = self.name or name

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Node, owner: type) -> HandlerGroup: ...
    @overload
    def __get__(self, node: object, owner: type) -> Self: ...
    def __get__(self, node: Any, owner: type) -> Any:
        return node.groups.at_work(self) if hasattr(node, "groups") else self

    def __repr__(self) -> str:
        return f"Group({self.name or 'unnamed'}, limit={self.limit})"


class Held(ABC):
    """A declaration that is an attribute of the class; on a node it gives what the node holds."""

    attribute = ""
    place: Place

    def __set_name__(self, owner: type, name: str) -> None:
        self.attribute = name

    @abstractmethod
    def bind(self, node: Node) -> Any:
        """Make, for one node, what is declared."""


class Publisher(Held, Generic[M]):
    """A topic the node publishes.

    Args:
        type: The message class.
        name: The topic: relative, absolute or `~/private`.
        qos: A profile, or a queue depth.
        depth: The same as a number for `qos`.
        on_event: A method defined above it, called with each `QosEvent`.
    """

    def __init__(
        self,
        type: type[M],  # noqa: A002
        name: str,
        qos: Qos | int = 10,
        *,
        depth: int | None = None,
        on_event: Callable[..., Any] | None = None,
    ) -> None:
        self.place = _here()
        _check_type(type, Message, "Publisher", self.place)
        _check_name(name, "Publisher", self.place)
        _check_on_event(on_event, "Publisher", self.place)
        self.type, self.name, self.qos = type, name, _qos(qos, depth, self.place)
        self.on_event = on_event

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Node, owner: type) -> TopicPublisher[M]: ...
    def __get__(self, node: Node | None, owner: type) -> Any:
        return self if node is None else node.held(self.attribute)

    def bind(self, node: Node) -> TopicPublisher[M]:
        return node.create_publisher(self.type, self.name, self.qos, on_event=node.bound(self.on_event))


class Subscription(Held, Generic[M]):
    """A topic the node listens to by iterating: `async for message in self.chatter`. Arguments as `Publisher`.

    Args:
        ignore_local: Leave out what this process publishes itself.
    """

    def __init__(
        self,
        type: type[M],  # noqa: A002
        name: str,
        qos: Qos | int = 10,
        *,
        depth: int | None = None,
        ignore_local: bool = False,
        on_event: Callable[..., Any] | None = None,
    ) -> None:
        self.place = _here()
        _check_type(type, Message, "Subscription", self.place)
        _check_name(name, "Subscription", self.place)
        _check_on_event(on_event, "Subscription", self.place)
        self.type, self.name, self.qos = type, name, _qos(qos, depth, self.place)
        self.ignore_local, self.on_event = ignore_local, on_event

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Node, owner: type) -> TopicSubscription[M]: ...
    def __get__(self, node: Node | None, owner: type) -> Any:
        return self if node is None else node.held(self.attribute)

    def bind(self, node: Node) -> TopicSubscription[M]:
        on_event = node.bound(self.on_event)
        return node.create_subscription(
            self.type, self.name, None, self.qos, ignore_local=self.ignore_local, on_event=on_event
        )


class Client(Held, Generic[Request, Response]):
    """A service the node calls: `await self.adder.call(AddTwoInts.Request(a=1, b=2))`.

    Args:
        introspection: What is published of each call on `name`/_service_event.
        group: Answers wait for a slot of it, as in ROS 2, where that is a way into a deadlock; without one they need
            none.
    """

    def __init__(
        self,
        type: type[Service[Request, Response]],  # noqa: A002
        name: str,
        *,
        introspection: Introspection = "off",
        group: Group | None = None,
    ) -> None:
        self.place = _here()
        _check_group(group, "Client", self.place)
        _check_type(type, Service, "Client", self.place)
        _check_name(name, "Client", self.place)
        self.type, self.name, self.introspection, self._group = type, name, introspection, group

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Node, owner: type) -> ServiceClient[Request, Response]: ...
    def __get__(self, node: Node | None, owner: type) -> Any:
        return self if node is None else node.held(self.attribute)

    def bind(self, node: Node) -> ServiceClient[Request, Response]:
        return node.create_client(self.type, self.name, introspection=self.introspection, group=self._group)


class ActionClient(Held, Generic[Goal, Result, Feedback]):
    """An action whose goals the node sends: `async with self.fibonacci.send(Fibonacci.Goal(order=10)) as goal`."""

    def __init__(self, type: type[Action[Goal, Result, Feedback]], name: str) -> None:  # noqa: A002
        self.place = _here()
        _check_type(type, Action, "ActionClient", self.place)
        _check_name(name, "ActionClient", self.place)
        self.type, self.name = type, name

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Node, owner: type) -> GoalClient[Goal, Result, Feedback]: ...
    def __get__(self, node: Node | None, owner: type) -> Any:
        return self if node is None else node.held(self.attribute)

    def bind(self, node: Node) -> GoalClient[Goal, Result, Feedback]:
        return node.create_action_client(self.type, self.name)


class Param(Held, Generic[V]):
    """A parameter. On a node it reads as its value; `ros2 param` and `graphflow param` see and set it.

    Args:
        default: Its value when nobody sets it; decides the type. A bool, int, float, str, bytes, or list of one.
        unit: For readers, as in `Hz` or `m/s`.
        doc: One sentence.
        ge, le, gt, lt: Limits: at least, at most, more than, less than.
        read_only: Settable only from outside and at the start.
        step: Distance between allowed values, counted from `ge`, or from 0.
        name: If it is not that of the attribute.
    """

    def __init__(
        self,
        default: V,
        *,
        unit: str = "",
        doc: str = "",
        ge: float | None = None,
        le: float | None = None,
        gt: float | None = None,
        lt: float | None = None,
        read_only: bool = False,
        step: float = 0.0,
        name: str = "",
    ) -> None:
        self.place = _here()
        self._name = name
        limits: dict[str, Any] = {"ge": ge, "le": le, "gt": gt, "lt": lt, "step": step}
        try:
            self.parameter = Parameter(
                name or "unnamed", type_of(default), default, self.place, unit, doc, read_only=read_only, **limits
            )
            self.parameter.fit(default)
            if (self.parameter.range_text() or step) and self.parameter.type not in _NUMBERS:
                raise ParameterError(f"limits are for numbers, and {default!r} is none")
            if step < 0 or (step % 1 and self.parameter.type in ("int", "list[int]")):
                raise ParameterError(f"a step of {step} cannot be")
        except GraphflowError as error:
            text = str(error).replace("parameter 'unnamed'", "the default")
            raise DeclarationError(f"{self.place}: {text}") from None

    def __set_name__(self, owner: type, name: str) -> None:
        super().__set_name__(owner, name)
        self.parameter = replace(self.parameter, name=self._name or name)

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Node, owner: type) -> V: ...
    def __get__(self, node: Node | None, owner: type) -> Any:
        return self if node is None else node.parameters.get(self.parameter.name)

    def __set__(self, node: Node, value: V) -> None:
        node.parameters.set({self.parameter.name: value}, source="node")

    def bind(self, node: Node) -> Any:
        return node.parameters.declare(self.parameter)

    def check(self, fn: F) -> F:
        """Have the method called with each new value before it is set; a ValueError that it raises refuses the value.

        rclpy's add_on_set_parameters_callback.
        """
        if inspect.iscoroutinefunction(fn):
            raise DeclarationError(f"{_here()}: {fn.__name__}: a check decides at once; make it a `def`")
        return _mark_hook(fn, "check", self, ("self", "value"), _here())

    def on_change(self, fn: F) -> F:
        """Have the method, `def` or `async def`, called with the old and the new value after each change.

        rclpy's add_post_set_parameters_callback.
        """
        return _mark_hook(fn, "on_change", self, ("self", "old", "new"), _here())


# What a node does: decorators leave a mark on the function and return it as it was.


@dataclass(frozen=True)
class Handler:
    """A decorated method."""

    kind: HandlerKind
    place: Place
    group: Group | None = None
    thread: bool = False
    type: Any = None
    name: str = ""
    qos: Qos = field(default_factory=Qos)
    takes_info: bool = False
    ignore_local: bool = False
    on_event: Callable[..., Any] | None = None
    introspection: Introspection = "off"
    rate: Rate | None = None
    on_error: OnError = "budget"
    action: ActionOptions | None = None


@dataclass(frozen=True)
class ActionOptions:
    """How an action treats its goals: see `Node.create_action_server`. Functions are methods of the class body."""

    policy: GoalPolicy
    accept: Callable[..., Any] | None
    cancellable: bool | Callable[..., Any]
    on_client_loss: OnClientLoss
    cleanup_timeout: float


class Rate:
    """How often a timer runs: a period in seconds or a frequency, perhaps from a parameter."""

    def __init__(self, period: float | Param[Any] | None, hz: float | Param[Any] | None) -> None:
        self._sources = (period, hz)

    def parameters(self) -> list[str]:
        """The parameters it is read from."""
        return [source.parameter.name for source in self._sources if isinstance(source, Param)]

    def period_ns(self, values: Mapping[str, Any] | None = None) -> int:
        """The period with these values of its parameters, or with their defaults.

        Raises:
            ValueError: as `clock.period_ns`.
        """

        def plain(source: float | Param[Any] | None) -> float | None:
            if not isinstance(source, Param):
                return None if source is None else float(source)
            return float(source.parameter.default if values is None else values[source.parameter.name])

        period, hz = self._sources
        return period_ns(plain(period), plain(hz))


HookKind = Literal["check", "on_change"]


@dataclass(frozen=True)
class ParamHook:
    """A method that follows a parameter."""

    kind: HookKind
    param: Param[Any]
    place: Place


HOOK_MARK = "__graphflow_hook__"


def _mark_hook(fn: F, kind: HookKind, param: Param[Any], words: tuple[str, ...], place: Place) -> F:
    if not inspect.isfunction(fn):
        raise DeclarationError(f"{place}: .{kind} goes on a method, not on {fn!r}")
    if len(inspect.signature(fn).parameters) != len(words):
        raise DeclarationError(f"{place}: {fn.__name__} must take ({', '.join(words)})")
    setattr(fn, HOOK_MARK, ParamHook(kind, param, place))
    return fn


def _mark(fn: F, handler: Handler, arguments: range) -> F:
    name = getattr(fn, "__name__", repr(fn))
    if not inspect.isfunction(fn):
        raise DeclarationError(f"{handler.place}: @{handler.kind} goes on a method, not on {fn!r}")
    other = getattr(fn, MARK, None)
    if isinstance(other, Handler):
        kinds = f"@{other.kind} and @{handler.kind}"
        raise DeclarationError(f"{handler.place}: {name} is declared twice, as {kinds}; make it two methods")
    if inspect.isgeneratorfunction(fn) or inspect.isasyncgenfunction(fn):
        raise DeclarationError(f"{handler.place}: {name} has a yield in it, so that its body would never run")
    if handler.thread and inspect.iscoroutinefunction(fn):
        raise DeclarationError(f"{handler.place}: {name}: thread=True is for `def`, an `async def` runs on the loop")
    positional = [
        p
        for p in inspect.signature(fn).parameters.values()
        if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) and p.default is p.empty
    ]
    if len(positional) not in arguments:
        wanted = " or ".join(["self", "self and one argument", "self and two arguments"][n - 1] for n in arguments)
        has = f"({', '.join(p.name for p in positional)})"
        hint = "; it gets the request only, and returns a new response" if handler.kind == "service" else ""
        raise DeclarationError(f"{handler.place}: {name} must take {wanted}, not {has}{hint}")
    place = Place(fn.__code__.co_filename, fn.__code__.co_firstlineno)
    takes_info = (handler.kind, len(positional)) in (("timer", 2), ("subscription", 3))
    object.__setattr__(handler, "place", place)
    object.__setattr__(handler, "takes_info", takes_info)
    setattr(fn, MARK, handler)
    return fn


def subscription(
    type: type[M],  # noqa: A002
    name: str,
    qos: Qos | int = 10,
    *,
    depth: int | None = None,
    group: Group | None = None,
    thread: bool = False,
    ignore_local: bool = False,
    on_event: Callable[..., Any] | None = None,
    on_error: OnError = "budget",
) -> Callable[[F], F]:
    """Have the method called with each message of a topic: `async def heard(self, msg: String) -> None`.

    With a third argument, `info: MessageInfo`, it is told too who sent the message, when, and its number in the row.

    Args:
        ignore_local: Leave out what this process publishes itself.
        on_event: A method defined above it, called with each `QosEvent`.
        on_error: What an error of it means for the node.
    """
    place = _here()
    _check_on_error(on_error, place)
    _check_type(type, Message, "@subscription", place)
    _check_name(name, "@subscription", place)
    _check_group(group, "@subscription", place)
    _check_on_event(on_event, "@subscription", place)
    profile = _qos(qos, depth, place)
    options: dict[str, Any] = {"ignore_local": ignore_local, "on_event": on_event, "on_error": on_error}
    handler = Handler("subscription", place, group, thread, type, name, profile, **options)
    return lambda fn: _mark(fn, handler, range(2, 4))


def timer(
    period: float | Param[Any] | None = None,
    *,
    hz: float | Param[Any] | None = None,
    group: Group | None = None,
    thread: bool = False,
    on_error: OnError = "budget",
) -> Callable[[F], F]:
    """Have the method called once a period (seconds) or `hz` times a second; a parameter may stand for either.

    Missed periods are skipped and the phase is kept. The method may take a `TimerInfo`.

    Args:
        on_error: What an error of it means for the node.
    """
    place = _here()
    _check_on_error(on_error, place)
    if callable(period) and not isinstance(period, Param):
        raise DeclarationError(f"{place}: write @timer(0.5) or @timer(hz=2.0), with a period")
    _check_group(group, "@timer", place)
    try:
        rate = Rate(period, hz)
        rate.period_ns()
    except (ValueError, TypeError) as error:
        raise DeclarationError(f"{place}: @timer: {error}") from None
    handler = Handler("timer", place, group, thread, rate=rate, on_error=on_error)
    return lambda fn: _mark(fn, handler, range(1, 3))


def service(
    type: type[Service[Request, Response]],  # noqa: A002
    name: str,
    *,
    group: Group | None = None,
    thread: bool = False,
    introspection: Introspection = "off",
) -> Callable[[F], F]:
    """Have the method answer a service: `async def add(self, request: X.Request) -> X.Response`.

    Args:
        introspection: What is published of each call on `name`/_service_event.
    """
    place = _here()
    _check_type(type, Service, "@service", place)
    _check_name(name, "@service", place)
    _check_group(group, "@service", place)
    handler = Handler("service", place, group, thread, type, name, introspection=introspection)
    return lambda fn: _mark(fn, handler, range(2, 3))


def action(
    type: type[Action[Goal, Result, Feedback]],  # noqa: A002
    name: str,
    *,
    group: Group | None = None,
    thread: bool = False,
    policy: GoalPolicy = "reject",
    accept: Callable[..., Any] | None = None,
    cancellable: bool | Callable[..., Any] = True,
    on_client_loss: OnClientLoss = "continue",
    cleanup_timeout: float = 10.0,
) -> Callable[[F], F]:
    """Have the method carry out goals: `async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result`.

    Returning a result succeeds, raising `Abort` or any other error aborts. A goal that is cancelled gets
    `CancelledError` at its next `await`; its client then has what `goal.partial` held.

    Args:
        policy: What becomes of a goal that comes while another is under way: `reject`, `queue`, `preempt`, `parallel`.
        accept: A method defined above it, called with each goal's message; False rejects the goal.
        cancellable: Whether cancel requests are granted; or a method, called with the handle, that decides.
        on_client_loss: What becomes of a goal whose client has gone: `continue` or `cancel`.
        cleanup_timeout: Seconds that a cancelled body gets; then its goal counts as aborted.
    """
    place = _here()
    _check_type(type, Action, "@action", place)
    _check_name(name, "@action", place)
    _check_group(group, "@action", place)
    for word, value, allowed in (("policy", policy, GoalPolicy), ("on_client_loss", on_client_loss, OnClientLoss)):
        if value not in get_args(allowed):
            raise DeclarationError(f"{place}: {word} is one of {', '.join(get_args(allowed))}, not {value!r}")
    for word, hook in (("accept", accept), ("cancellable", cancellable)):
        if not (hook is None or isinstance(hook, bool) or inspect.isfunction(hook)):
            raise DeclarationError(f"{place}: @action: {word}= takes a method defined above it, not {hook!r}")
    options = ActionOptions(policy, accept, cancellable, on_client_loss, cleanup_timeout)
    handler = Handler("action", place, group, thread, type, name, action=options)
    return lambda fn: _mark(fn, handler, range(2, 3))


def task(fn: F) -> F:
    """Run the method once the node is up, beside everything else it does. An error in it ends the node."""
    place = _here()
    if not inspect.iscoroutinefunction(fn):
        raise DeclarationError(f"{place}: @task goes on an `async def` method, without parentheses")
    return _mark(fn, Handler("task", place), range(1, 2))

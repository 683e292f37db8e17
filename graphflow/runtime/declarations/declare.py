"""Declarations of a node's attributes: publishers, clients, parameters and groups. Its methods are in `handlers`.

A declaration is checked when the class is created and becomes data (`graphflow.interface`); nothing runs. For each node
of the class, each declaration becomes a call of the `create_*` method that the node could also call itself.
"""

from __future__ import annotations

import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Generic, Literal, NoReturn, Protocol, Self, TypeVar, get_args, overload

from graphflow.errors import DeclarationError, GraphflowError, ParameterError, Place
from graphflow.executor.groups import Groups, HandlerGroup
from graphflow.interface import EndpointInfo, Parameter, WhenFull, type_of
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, Service
from graphflow.qos import Qos
from graphflow.runtime.call_site import here
from graphflow.runtime.declarations.checks import check_group, check_name, check_on_event, check_qos, check_type
from graphflow.runtime.declarations.creator import Maker
from graphflow.runtime.endpoints.service_events import Introspection
from graphflow.runtime.mistakes.rclpy_words import MadeByNodes, with_argument_hints
from graphflow.runtime.parameters.params import Parameters

if TYPE_CHECKING:
    from graphflow.runtime.actions.client import GoalClient
    from graphflow.runtime.endpoints.publishers import TopicPublisher
    from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.runtime.endpoints.subscriptions import TopicSubscription

M = TypeVar("M", bound=Message)
V = TypeVar("V", bool, int, float, str, bytes, list[bool], list[int], list[float], list[str])
F = TypeVar("F", bound=Callable[..., object])

_NUMBERS = ("int", "float", "list[int]", "list[float]")


class _Core(Protocol):
    """A node's runtime objects, as its declarations read them."""

    @property
    def objects(self) -> Mapping[str, object]:
        """Endpoints and parameter values, by attribute."""

    @property
    def parameters(self) -> Parameters: ...

    @property
    def groups(self) -> Groups: ...


class Bound(Protocol):
    """A node, as the declarations of its class see it."""

    @property
    def _core(self) -> _Core: ...


class Group:
    """A concurrency group: limits how many of its handlers run at a time. On a node, a `HandlerGroup`.

    Args:
        limit: 1 for mutual exclusion (ROS 2's MutuallyExclusive), None for no limit (Reentrant).
        when_full: The policy for work that arrives while the group is full: see `WhenFull`.
        thread: Whether `def` handlers run in threads, where a blocking one occupies its slot but not the loop.
        name: Its name; by default the attribute's.

    Raises:
        DeclarationError: The limit or the policy is invalid.
    """

    @with_argument_hints
    def __init__(
        self, limit: int | None = 1, when_full: WhenFull = "wait", *, thread: bool = False, name: str = ""
    ) -> None:
        if limit is not None and (not isinstance(limit, int) or isinstance(limit, bool) or limit < 1):
            raise DeclarationError(f"{here()}: a group's limit must be 1 or more, or None for no limit, not {limit!r}")
        if when_full not in get_args(WhenFull):
            words = ", ".join(get_args(WhenFull))
            raise DeclarationError(f"{here()}: when_full must be one of {words}, not {when_full!r}")
        if limit is None and when_full != "wait":
            raise DeclarationError(
                f"{here()}: a group without a limit is never full; when_full={when_full!r} needs one"
            )
        self.limit, self.when_full, self.thread, self.name = limit, when_full, thread, name

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = self.name or name

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> HandlerGroup: ...
    @overload
    def __get__(self, node: object, owner: type) -> Self: ...
    def __get__(self, node: Any, owner: type) -> Any:
        return node._core.groups.at_work(self) if hasattr(node, "_core") else self

    def __repr__(self) -> str:
        return f"Group({self.name or 'unnamed'}, limit={self.limit})"


class Declaration(MadeByNodes, ABC):
    """A declaration as a class attribute; on a node, its runtime object."""

    attribute = ""
    place: Place

    def __set_name__(self, owner: type, name: str) -> None:
        self.attribute = name

    def endpoints(self) -> Sequence[EndpointInfo]:
        """Return the endpoints it declares, as data."""
        return ()

    @abstractmethod
    def create(self, maker: Maker) -> object:
        """Create the runtime object of one node."""

    def on(self, node: Bound) -> object:
        """Return the runtime object on a node.

        Raises:
            DeclarationError: The object is not a node.
        """
        try:
            return node._core.objects[self.attribute]
        except AttributeError:
            cls = type(node)
            if any(base.__module__ == "graphflow.runtime.node" for base in cls.__mro__):
                raise
            text = f"{cls.__name__} is not a node, so that nothing opens its {type(self).__name__} {self.attribute!r}"
            way = f"declare it in the node's class, and pass it on: {cls.__name__}(self.{self.attribute})"
            raise DeclarationError(f"{self.place}: {text}; {way}") from None


class Publisher(Declaration, Generic[M]):
    """A publisher of the node.

    Args:
        type: The message class.
        name: The topic: relative, absolute or `~/private`.
        qos: A profile, or a queue depth.
        depth: The queue depth, as an alternative to `qos`.
        on_event: A method defined above it, called with each `QosEvent`.

    Raises:
        DeclarationError: The type is not a message class, or another argument is invalid.
    """

    MAKER = 'create_publisher(Type, "topic", 10), or declare Publisher(Type, "topic") in the class'

    @with_argument_hints
    def __init__(
        self,
        type: type[M],  # noqa: A002
        name: str,
        qos: Qos | int = 10,
        *,
        depth: int | None = None,
        on_event: Callable[..., object] | None = None,
    ) -> None:
        self.place = here()
        check_type(type, Message, "Publisher", self.place)
        check_name(name, "Publisher", self.place)
        check_on_event(on_event, "Publisher", self.place)
        self.type, self.name, self.qos = type, name, check_qos(qos, depth, self.place)
        self.on_event = on_event

    def endpoints(self) -> Sequence[EndpointInfo]:
        return [EndpointInfo("publisher", self.name, self.type.SCHEMA.name, self.attribute, self.place)]

    def create(self, maker: Maker) -> object:
        return maker.node.create_publisher(self.type, self.name, self.qos, on_event=maker.method(self.on_event))

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> TopicPublisher[M]: ...
    def __get__(self, node: Bound | None, owner: type) -> object:
        return self if node is None else self.on(node)


class Subscription(Declaration, Generic[M]):
    """A subscription that the node iterates: `async for message in self.chatter`. Arguments as for `Publisher`.

    Args:
        ignore_local: Whether to skip messages that this process publishes.
    """

    MAKER = 'create_subscription(Type, "topic", self.heard, 10), or declare @subscription(Type, "topic") on the method'

    @with_argument_hints
    def __init__(
        self,
        type: type[M],  # noqa: A002
        name: str,
        qos: Qos | int = 10,
        *,
        depth: int | None = None,
        ignore_local: bool = False,
        on_event: Callable[..., object] | None = None,
    ) -> None:
        self.place = here()
        check_type(type, Message, "Subscription", self.place)
        check_name(name, "Subscription", self.place)
        check_on_event(on_event, "Subscription", self.place)
        self.type, self.name, self.qos = type, name, check_qos(qos, depth, self.place)
        self.ignore_local, self.on_event = ignore_local, on_event

    def __call__(self, method: object) -> NoReturn:
        """Raise DeclarationError: the declaration was written as a decorator."""
        raise DeclarationError(f"{here()}: on a method write @subscription(...), lower-case")

    def endpoints(self) -> Sequence[EndpointInfo]:
        return [EndpointInfo("subscription", self.name, self.type.SCHEMA.name, self.attribute, self.place)]

    def create(self, maker: Maker) -> object:
        options = {"ignore_local": self.ignore_local, "on_event": maker.method(self.on_event)}
        return maker.node.create_subscription(self.type, self.name, None, self.qos, **options)

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> TopicSubscription[M]: ...
    def __get__(self, node: Bound | None, owner: type) -> object:
        return self if node is None else self.on(node)


class Client(Declaration, Generic[Request, Response]):
    """A client of a service: `await self.adder.call(AddTwoInts.Request(a=1, b=2))`.

    Args:
        introspection: Content of the events on `name`/_service_event: "off", "metadata" or "contents".
        group: The group in which responses take a slot, as in ROS 2, where this is a common cause of deadlocks; by
            default they take none.
    """

    MAKER = 'create_client(Type, "name"), or declare Client(Type, "name") in the class'

    @with_argument_hints
    def __init__(
        self,
        type: type[Service[Request, Response]],  # noqa: A002
        name: str,
        *,
        introspection: Introspection = "off",
        group: Group | None = None,
    ) -> None:
        self.place = here()
        check_group(group, Group, "Client", self.place)
        check_type(type, Service, "Client", self.place)
        check_name(name, "Client", self.place)
        self.type, self.name, self.introspection, self.group = type, name, introspection, group

    def endpoints(self) -> Sequence[EndpointInfo]:
        group = "" if self.group is None else self.group.name
        return [EndpointInfo("client", self.name, self.type.NAME, self.attribute, self.place, group)]

    def create(self, maker: Maker) -> object:
        return maker.node.create_client(self.type, self.name, introspection=self.introspection, group=self.group)

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> ServiceClient[Request, Response]: ...
    def __get__(self, node: Bound | None, owner: type) -> object:
        return self if node is None else self.on(node)


class ActionClient(Declaration, Generic[Goal, Result, Feedback]):
    """A client of an action: `async with self.fibonacci.send(Fibonacci.Goal(order=10)) as goal`."""

    MAKER = 'create_action_client(Type, "name"), or declare ActionClient(Type, "name") in the class'

    @with_argument_hints
    def __init__(self, type: type[Action[Goal, Result, Feedback]], name: str) -> None:  # noqa: A002
        self.place = here()
        check_type(type, Action, "ActionClient", self.place)
        check_name(name, "ActionClient", self.place)
        self.type, self.name = type, name

    def endpoints(self) -> Sequence[EndpointInfo]:
        return [EndpointInfo("action client", self.name, self.type.NAME, self.attribute, self.place)]

    def create(self, maker: Maker) -> object:
        return maker.node.create_action_client(self.type, self.name)

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> GoalClient[Goal, Result, Feedback]: ...
    def __get__(self, node: Bound | None, owner: type) -> object:
        return self if node is None else self.on(node)


class Param(Declaration, Generic[V]):
    """A parameter. On a node it reads as its value; `ros2 param` and `graphflow param` read and set it.

    Args:
        default: The value until it is set, which determines the type: bool, int, float, str, bytes, or a non-empty list
            of bool, int, float or str.
        unit: The unit, for people, such as `Hz` or `m/s`.
        doc: A description in one sentence.
        ge, le, gt, lt: Limits: at least, at most, more than, less than.
        read_only: Whether the value is fixed once the node is made.
        step: Distance between allowed values, counted from `ge`, or from 0.
        choices: The allowed values; for a list, of its elements.
        name: Its name; by default the attribute's.

    Raises:
        DeclarationError: The default has no parameter type, or does not fit its limits.
    """

    @with_argument_hints
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
        choices: Sequence[object] | None = None,
        name: str = "",
    ) -> None:
        self.place = here()
        self._name = name
        try:
            if isinstance(default, (list, tuple)) and not default:
                raise ParameterError("an empty list has no type: give it an element, as in [0.0]")
            self.parameter = Parameter(
                *(name or "unnamed", type_of(default), default, self.place, unit, doc),
                ge=ge,
                le=le,
                gt=gt,
                lt=lt,
                step=step,
                read_only=read_only,
            )
            if choices is not None:
                self.parameter = replace(self.parameter, choices=self._choices(choices))
            if ge is not None and le is not None and ge > le:
                raise ParameterError(f"ge={ge!r} is more than le={le!r}, so that no value fits")
            self.parameter.fit(default)
            if (self.parameter.range_text() or step) and self.parameter.type not in _NUMBERS:
                raise ParameterError(f"limits are for numbers, and {default!r} is not a number")
            if step < 0 or (step % 1 and self.parameter.type in ("int", "list[int]")):
                raise ParameterError(f"a step cannot be {step}")
        except GraphflowError as error:
            text = str(error).replace("parameter 'unnamed'", "the default")
            raise DeclarationError(f"{self.place}: {text}") from None

    def __repr__(self) -> str:
        return f"<Param {self.parameter.default!r} of {self.place}>"

    def _choices(self, choices: Sequence[object]) -> tuple[object, ...]:
        """Convert the choices to the declared type. Raises ParameterError if they do not fit it."""
        if not isinstance(choices, (list, tuple)):
            raise ParameterError(f"choices= takes a list of values, not {choices!r}")
        if not choices:
            raise ParameterError(f"choices=[] would allow no value: write choices=[{self.parameter.default!r}, ...]")
        is_list = self.parameter.type.startswith("list[")
        return tuple(self.parameter.fit([value])[0] if is_list else self.parameter.fit(value) for value in choices)

    def __set_name__(self, owner: type, name: str) -> None:
        super().__set_name__(owner, name)
        self.parameter = replace(self.parameter, name=self._name or name)

    def create(self, maker: Maker) -> object:
        return maker.owner.parameters.declare(self.parameter)

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> V: ...
    def __get__(self, node: Bound | None, owner: type) -> object:
        return self if node is None else node._core.parameters.get(self.parameter.name)

    def __set__(self, node: Bound, value: V) -> None:
        node._core.parameters.set({self.parameter.name: value}, source="node")

    def with_typing(self, *, dynamic: bool) -> Parameter:
        """Return the declaration; with `dynamic`, its parameter takes values of any type and can be deleted."""
        return replace(self.parameter, dynamic=dynamic)

    def check(self, fn: F) -> F:
        """Call the method with each new value before it is set; its ValueError refuses the value.

        rclpy's equivalent: add_on_set_parameters_callback.
        """
        if inspect.iscoroutinefunction(fn):
            raise DeclarationError(f"{here()}: {fn.__name__}: a check must decide at once; make it a `def`")
        return _mark_hook(fn, "check", self, ("self", "value"), here())

    def on_change(self, fn: F) -> F:
        """Call the method, `def` or `async def`, with the old and the new value after each change.

        rclpy's equivalent: add_post_set_parameters_callback.
        """
        return _mark_hook(fn, "on_change", self, ("self", "old", "new"), here())


HookKind = Literal["check", "on_change"]


@dataclass(frozen=True)
class ParamHook:
    """The mark on a method that checks or follows a parameter."""

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

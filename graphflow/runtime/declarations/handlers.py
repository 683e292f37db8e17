"""Declarations of a node's methods: handlers of timers, messages, requests and goals, and tasks.

A decorator sets a mark on the method and returns the method itself.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias, TypeVar, get_args

from graphflow.errors import DeclarationError, Place
from graphflow.executor.clock import period_ns
from graphflow.interface import GoalPolicy, HandlerKind, OnClientLoss, OnError
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, Service
from graphflow.qos import Qos
from graphflow.runtime.call_site import here
from graphflow.runtime.declarations.checks import (
    check_annotations,
    check_group,
    check_hook,
    check_name,
    check_on_error,
    check_on_event,
    check_qos,
    check_returned,
    check_type,
)
from graphflow.runtime.declarations.declare import HOOK_MARK, Group, Param, ParamHook
from graphflow.runtime.endpoints.service_events import Introspection
from graphflow.runtime.mistakes.rclpy_words import with_argument_hints

M = TypeVar("M", bound=Message)
F = TypeVar("F", bound=Callable[..., object])

Number: TypeAlias = "float | Param[float] | Param[int]"
"""A period or a frequency, or the parameter with it."""

MARK = "__graphflow__"


@dataclass(frozen=True)
class Handler:
    """The mark on a decorated method."""

    kind: HandlerKind
    place: Place
    group: Group | None = None
    thread: bool = False
    type: Any = None
    name: str = ""
    qos: Qos = field(default_factory=Qos)
    takes_info: bool = False
    ignore_local: bool = False
    on_event: Callable[..., object] | None = None
    introspection: Introspection = "off"
    rate: Rate | None = None
    on_error: OnError = "budget"
    action: ActionOptions | None = None


@dataclass(frozen=True)
class ActionOptions:
    """An action's policies: see `Node.create_action_server`. Functions are methods of the class body."""

    policy: GoalPolicy
    accept: Callable[..., object] | None
    cancellable: bool | Callable[..., object]
    on_client_loss: OnClientLoss
    cleanup_timeout: float


class Rate:
    """The rate of a timer: a period in seconds or a frequency in Hz, either of which may be a parameter."""

    def __init__(self, period: Number | None, hz: Number | None) -> None:
        self._sources = (period, hz)

    def parameters(self) -> list[str]:
        """Return the names of the parameters that determine the rate."""
        return [source.parameter.name for source, _ in self.sources()]

    def sources(self) -> Iterator[tuple[Param[Any], Literal["s", "Hz"]]]:
        """List the parameters that determine the rate, each with the unit that its value is taken in."""
        period, hz = self._sources
        if isinstance(period, Param):
            yield period, "s"
        if isinstance(hz, Param):
            yield hz, "Hz"

    def period_ns(self, values: Mapping[str, Any] | None = None) -> int:
        """Return the period in nanoseconds, with these parameter values or with the defaults.

        Raises:
            ValueError: As for `clock.period_ns`.
        """

        def plain(source: Number | None) -> float | None:
            if not isinstance(source, Param):
                if source is not None and not isinstance(source, (int, float)):
                    hook = getattr(source, HOOK_MARK, None)
                    if isinstance(hook, ParamHook):
                        raise TypeError(
                            f"{source.__name__!r} is now the method of {hook.place}, which has replaced the "
                            f"Param of {hook.param.place}; rename the method"
                        )
                    raise TypeError(f"a period or frequency is a number or a Param, not {source!r}")
                return None if source is None else float(source)
            return float(source.parameter.default if values is None else values[source.parameter.name])

        period, hz = self._sources
        return period_ns(plain(period), plain(hz))


def _mark(fn: F, handler: Handler, arguments: range) -> F:
    if not inspect.isfunction(fn):
        raise DeclarationError(f"{handler.place}: @{handler.kind} goes on a method, not on {fn!r}")
    name = fn.__name__
    other = getattr(fn, MARK, None)
    if isinstance(other, Handler):
        kinds = f"@{other.kind} and @{handler.kind}"
        raise DeclarationError(f"{handler.place}: {name} is declared twice, as {kinds}; split it into two methods")
    if inspect.isgeneratorfunction(fn) or inspect.isasyncgenfunction(fn):
        raise DeclarationError(f"{handler.place}: {name} contains yield, so its body would never run")
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
        raise DeclarationError(f"{handler.place}: {name} must take {wanted}, not {has}")
    check_annotations(fn, _expected(handler), f"@{handler.kind}", handler.place)
    if (part := _RETURNED.get(handler.kind)) is not None:
        called = f"{handler.type.__name__}.{part}"
        check_returned(fn, called, getattr(handler.type, part), f"@{handler.kind}", handler.place)
    place = Place(fn.__code__.co_filename, fn.__code__.co_firstlineno)
    takes_info = (handler.kind, len(positional)) in (("timer", 2), ("subscription", 3))
    # A copy, since the decorator of `every = timer(1.0)` may be applied to several methods.
    setattr(fn, MARK, replace(handler, place=place, takes_info=takes_info))
    return fn


_RETURNED = {"service": "Response", "action": "Result"}
"""The part of an interface that a handler returns."""


def _expected(handler: Handler) -> dict[str, type]:
    """Return the message classes that a handler receives, by name."""
    parts = {"service": ("Request", "Response"), "action": ("Handle",)}.get(handler.kind, ())
    if handler.kind == "subscription":
        return {handler.type.__name__: handler.type}
    return {f"{handler.type.__name__}.{part}": getattr(handler.type, part) for part in parts}


@with_argument_hints
def subscription(
    type: type[M],  # noqa: A002
    name: str,
    qos: Qos | int = 10,
    *,
    depth: int | None = None,
    group: Group | None = None,
    thread: bool = False,
    ignore_local: bool = False,
    on_event: Callable[..., object] | None = None,
    on_error: OnError = "budget",
) -> Callable[[F], F]:
    """Call the method with each message on a topic: `async def heard(self, msg: String) -> None`.

    With a third argument, `info: MessageInfo`, it also receives the sender, the times and the sequence number.

    Args:
        type: The message class.
        name: The topic: relative, absolute or `~/private`.
        qos: A QoS profile, or a queue depth.
        depth: The queue depth, as an alternative to `qos`.
        group: The concurrency group; by default the class's `default_group`.
        thread: Whether the method, a `def`, runs in a thread.
        ignore_local: Whether to skip messages that this process publishes.
        on_event: A method defined above it, called with each `QosEvent`.
        on_error: The policy for errors in the method.

    Raises:
        DeclarationError: An argument is invalid, or the method does not take a message of the type.
    """
    place = here()
    check_on_error(on_error, place)
    check_type(type, Message, "@subscription", place)
    check_name(name, "@subscription", place)
    check_group(group, Group, "@subscription", place)
    check_on_event(on_event, "@subscription", place)
    profile = check_qos(qos, depth, place)
    handler = Handler(
        *("subscription", place, group, thread, type, name, profile),
        ignore_local=ignore_local,
        on_event=on_event,
        on_error=on_error,
    )
    return lambda fn: _mark(fn, handler, range(2, 4))


@with_argument_hints
def timer(
    period: Number | None = None,
    *,
    hz: Number | None = None,
    group: Group | None = None,
    thread: bool = False,
    on_error: OnError = "budget",
) -> Callable[[F], F]:
    """Call the method every period (seconds), or `hz` times a second; either may be a parameter.

    Missed periods are skipped and the phase is kept. The method may take a `TimerInfo`.

    Args:
        on_error: The policy for errors in the method.

    Raises:
        DeclarationError: The period is not positive, or the method takes other arguments.
    """
    place = here()
    check_on_error(on_error, place)
    if callable(period) and not isinstance(period, Param):
        raise DeclarationError(f"{place}: write @timer(0.5) or @timer(hz=2.0), with a period")
    check_group(group, Group, "@timer", place)
    try:
        rate = Rate(period, hz)
        rate.period_ns()
    except (ValueError, TypeError) as error:
        raise DeclarationError(f"{place}: @timer: {error}") from None
    handler = Handler("timer", place, group, thread, rate=rate, on_error=on_error)
    return lambda fn: _mark(fn, handler, range(1, 3))


@with_argument_hints
def service(
    type: type[Service[Request, Response]],  # noqa: A002
    name: str,
    *,
    group: Group | None = None,
    thread: bool = False,
    introspection: Introspection = "off",
) -> Callable[[F], F]:
    """Answer a service's requests with the method: `async def add(self, request: X.Request) -> X.Response`.

    As in ROS 2, it may take a second argument, an empty response to fill in and return.

    Args:
        introspection: Content of the events on `name`/_service_event: "off", "metadata" or "contents".
    """
    place = here()
    check_type(type, Service, "@service", place)
    check_name(name, "@service", place)
    check_group(group, Group, "@service", place)
    handler = Handler("service", place, group, thread, type, name, introspection=introspection)
    return lambda fn: _mark(fn, handler, range(2, 4))


@with_argument_hints
def action(
    type: type[Action[Goal, Result, Feedback]],  # noqa: A002
    name: str,
    *,
    group: Group | None = None,
    thread: bool = False,
    policy: GoalPolicy = "reject",
    accept: Callable[..., object] | None = None,
    cancellable: bool | Callable[..., object] = True,
    on_client_loss: OnClientLoss = "continue",
    cleanup_timeout: float = 10.0,
) -> Callable[[F], F]:
    """Execute an action's goals with the method: `async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result`.

    The goal succeeds if the method returns a result, and is aborted if it raises `Abort` or any other error. A
    cancelled goal raises `CancelledError` at its next `await`; its client then receives `goal.partial`.

    Args:
        policy: The policy for a goal that arrives while another runs: `reject`, `queue`, `preempt`, `parallel`.
        accept: A method defined above it, called with each goal message; rejects the goal by returning False or the
            reason as text.
        cancellable: Whether cancel requests are granted; or a method, called with the handle, that decides.
        on_client_loss: The policy for a goal whose client has gone: `continue` or `cancel`.
        cleanup_timeout: Seconds that a cancelled method has for cleanup before its goal counts as aborted.
    """
    place = here()
    check_type(type, Action, "@action", place)
    check_name(name, "@action", place)
    check_group(group, Group, "@action", place)
    for word, value, allowed in (("policy", policy, GoalPolicy), ("on_client_loss", on_client_loss, OnClientLoss)):
        if value not in get_args(allowed):
            raise DeclarationError(f"{place}: {word} must be one of {', '.join(get_args(allowed))}, not {value!r}")
    for word, hook in (("accept", accept), ("cancellable", cancellable)):
        if not (hook is None or isinstance(hook, bool) or inspect.isfunction(hook)):
            raise DeclarationError(f"{place}: @action: {word}= takes a method defined above it, not {hook!r}")
        check_hook(hook, word, "goal", "@action", place)
    if not cleanup_timeout > 0:
        raise DeclarationError(f"{place}: cleanup_timeout must be more than 0 seconds, not {cleanup_timeout!r}")
    options = ActionOptions(policy, accept, cancellable, on_client_loss, cleanup_timeout)
    handler = Handler("action", place, group, thread, type, name, action=options)
    return lambda fn: _mark(fn, handler, range(2, 3))


@with_argument_hints
def task(fn: F) -> F:
    """Run the method in the background once the node is up. An error in it ends the node."""
    place = here()
    is_async = inspect.iscoroutinefunction(fn)
    if not is_async:
        raise DeclarationError(f"{place}: @task goes on an `async def` method, without parentheses")
    return _mark(fn, Handler("task", place), range(1, 2))

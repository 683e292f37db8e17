"""Application of a class's declarations to one node: endpoints, handlers and parameter hooks."""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from dataclasses import dataclass
from types import MethodType
from typing import Any, ClassVar, Protocol

from graphflow.errors import ParameterError
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.interface import COMMON_PARAMETERS, Interface
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.creator import Creator, Owner
from graphflow.runtime.declarations.declare import Param
from graphflow.runtime.declarations.handlers import Handler, Rate
from graphflow.runtime.endpoints.timer import Timer
from graphflow.runtime.failures import ErrorBudget
from graphflow.runtime.parameters.params import ParameterChange, Parameters
from graphflow.runtime.part import Host
from graphflow.times import to_ns

CHAIN = 100
"""Limit of parameter changes in a second that each result from a hook on the change before."""


class Instance(declared.NodeClass, Creator, Protocol):
    """The user's node object, as its core sees it."""

    error_budget: ClassVar[ErrorBudget | None]

    @classmethod
    def interface(cls) -> Interface: ...

    async def on_start(self) -> None: ...

    async def on_shutdown(self) -> None: ...


class Binding:
    """The runtime objects of one node's declarations.

    Attributes:
        objects: Endpoints and parameter values, by attribute.
        node, owner: The node, and its core.
    """

    def __init__(self, node: Creator, owner: Owner, parameters: Parameters) -> None:
        self.objects: dict[str, object] = {}
        self.node, self.owner, self._parameters = node, owner, parameters
        self._class = type(node)
        self._timers: list[tuple[Rate, Timer]] = []
        self._hooks = declared.param_hooks(self._class)
        self._followers: dict[str, _Follower] = {}
        self._settled = {*COMMON_PARAMETERS}
        """Parameters whose uses need no check when they are set, or have had it."""
        self._of_class = set[str]()
        """Parameters that the class declares."""

    def bind_parameters(self) -> None:
        """Declare the parameters; they come first, since the periods of timers may refer to them."""
        for parameter in COMMON_PARAMETERS.values():
            self._parameters.declare(parameter)
        for attribute, item in declared.declarations(self._class).items():
            if isinstance(item, Param):
                self.objects[attribute] = item.create(self)
                self._of_class.add(item.parameter.name)
        self._parameters.check(self._check)
        self._parameters.observe(self._changed)

    def bind(self) -> None:
        """Create the endpoints, handlers and timers."""
        for attribute, item in declared.declarations(self._class).items():
            if not isinstance(item, Param):
                self.objects[attribute] = item.create(self)
        for attribute, handler in declared.handlers(self._class).items():
            self._bind_handler(getattr(self.node, attribute), handler)

    def method(self, fn: object) -> object:
        """Return a function of the class body as the node's method, which a subclass may have overridden.

        A function that is not an attribute of the class, such as a lambda, is bound as it is.
        """
        if not inspect.isfunction(fn):
            return fn
        return getattr(self.node, fn.__name__) if hasattr(self._class, fn.__name__) else MethodType(fn, self.node)

    def _bind_handler(self, method: Callable[..., object], handler: Handler) -> None:
        node = self.node
        options: dict[str, object] = {"group": handler.group, "thread": handler.thread}
        if handler.kind == "subscription":
            options |= {"takes_info": handler.takes_info, "ignore_local": handler.ignore_local}
            options |= {"on_event": self.method(handler.on_event), "on_error": handler.on_error}
            node.create_subscription(handler.type, handler.name, method, handler.qos, **options)
        elif handler.kind == "service":
            node.create_service(handler.type, handler.name, method, introspection=handler.introspection, **options)
        elif handler.action is not None:
            options |= {"accept": self.method(handler.action.accept), "policy": handler.action.policy}
            options["cancellable"] = self.method(handler.action.cancellable)
            options["on_client_loss"] = handler.action.on_client_loss
            options["cleanup_timeout"] = handler.action.cleanup_timeout
            node.create_action_server(handler.type, handler.name, method, **options)
        elif handler.rate is not None:
            period = self._period_ns(handler.rate, {}) / 1e9
            options |= {"takes_info": handler.takes_info, "on_error": handler.on_error}
            timer = node.create_timer(period, method, **options)
            self._timers.append((handler.rate, timer))

    def _period_ns(self, rate: Rate, values: Mapping[str, Any]) -> int:
        get = self._parameters.get
        used = {name: values[name] if name in values else get(name) for name in rate.parameters()}
        try:
            return rate.period_ns(used)
        except ValueError as error:
            given = ", ".join(f"{name!r} = {value!r}" for name, value in used.items())
            raise ParameterError(f"parameter {given}: {error}") from None

    def check_given(self) -> None:
        """Refuse values from outside that a check of the class does not accept; they were set before its `__init__`.

        Raises:
            ParameterError: A check refuses one; the text has the place that gives it.
        """
        for name in self._of_class:
            if (source := self._parameters.source(name)) not in ("default", "node"):
                try:
                    self._check({name: self._parameters.get(name)})
                except ParameterError as error:
                    raise ParameterError(f"{error} (from {source})") from None

    def _check(self, values: Mapping[str, Any]) -> None:
        """Refuse values that a timer or a check of the class does not accept."""
        for rate, _ in self._timers:
            if values.keys() & rate.parameters():
                self._period_ns(rate, values)
        for attribute, hook in self._hooks.items():
            name = hook.param.parameter.name
            if hook.kind == "check" and name in values:
                try:
                    answer = getattr(self.node, attribute)(values[name])
                except ValueError as error:
                    raise ParameterError(f"parameter {name!r} = {values[name]!r}: {error}") from None
                if answer is not None and answer is not True:
                    text = "a check refuses by raising ValueError(why), and accepts by returning nothing"
                    raise ParameterError(f"parameter {name!r} is not set: {attribute} returned {answer!r}; {text}")

    def _changed(self, changes: Mapping[str, ParameterChange]) -> None:
        for name, (old, new) in changes.items() if self.owner.is_running else ():
            if old is not None and old != new and name not in self._settled:
                self._settled.add(name)
                from graphflow.runtime.mistakes.source.copies import kept  # most nodes never need them
                from graphflow.runtime.mistakes.source.read_once import without_effect

                text = kept(self.node, name, old, new) if name not in self._of_class else ""
                if text or (text := without_effect(self._class, name)):
                    self.owner.log.warning("%s", text)
        for rate, timer in self._timers:
            if changes.keys() & rate.parameters():
                timer.period = self._period_ns(rate, {}) / 1e9
        for attribute, hook in self._hooks.items():
            change = changes.get(hook.param.parameter.name)
            if hook.kind == "on_change" and change is not None and self.owner.is_running:
                if attribute not in self._followers:
                    name = hook.param.parameter.name
                    self._followers[attribute] = _Follower(self.owner, getattr(self.node, attribute), name)
                self._followers[attribute].follow(change)

    def runners(self) -> list[Runner]:
        """Return the runners of `on_change` methods, which the node stops."""
        return [follower.runner for follower in self._followers.values()]


@dataclass(slots=True)
class _Turn:
    """One call of an `on_change` method.

    Attributes:
        length: Number of `on_change` calls before it in the chain, each of which set a parameter.
        began_ns: When the first call of the chain was due.
    """

    change: ParameterChange
    length: int
    began_ns: int
    is_over: bool = False


_turn: ContextVar[_Turn | None] = ContextVar("turn", default=None)
"""The `on_change` call that the current code runs in."""


class _Follower:
    """The calls of one `on_change` method, one at a time."""

    def __init__(self, host: Host, method: Callable[[object, object], Any], parameter: str) -> None:
        self._host, self._method, self._parameter = host, method, parameter
        self._turns: deque[_Turn] = deque()
        spec = RunnerSpec(method.__name__, self._invoke, self._finished, host.full_name)
        self.runner = host.runner(spec, self._turns)

    def follow(self, change: ParameterChange) -> None:
        turn, now = _turn.get(), self._host.clock.monotonic_ns()
        length, began_ns = (0, now) if turn is None or turn.is_over else (turn.length + 1, turn.began_ns)
        if length >= CHAIN and now - began_ns < to_ns(1.0):
            text = "%s follows %r, and each change causes another, %d in a row: further changes are not followed; "
            text += "set a parameter there only if it differs, as in `if new > 2.0: self.%s = 2.0`"
            self._host.log.error(text, self._method.__name__, self._parameter, CHAIN, self._parameter)
            return
        self._turns.append(_Turn(change, length, began_ns))
        if inspect.iscoroutinefunction(self._method):
            # The first step must not run inside the code that set the parameter, which may itself be a handler.
            self._host.context.loop.call_soon(self.runner.wake)
        else:
            self.runner.wake()

    def _invoke(self, turn: _Turn) -> object:
        if inspect.iscoroutinefunction(self._method):
            return self._invoke_async(turn)
        token = _turn.set(turn)
        try:
            return self._method(turn.change.old, turn.change.new)
        finally:
            _turn.reset(token)

    async def _invoke_async(self, turn: _Turn) -> None:
        _turn.set(turn)
        await self._method(turn.change.old, turn.change.new)

    def _finished(self, turn: _Turn, result: object, error: BaseException | None) -> None:
        turn.is_over = True  # tasks it has started inherit the context variable, and start a new chain
        if error is not None:
            self._host.handler_failed(self._method.__name__, error)

"""A class's declarations at work on one node: endpoints made, handlers attached, parameters followed."""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from graphflow.errors import ParameterError
from graphflow.interface import COMMON_PARAMETERS
from graphflow.runtime import declare, declared
from graphflow.runtime.params import Change
from graphflow.runtime.scheduler import Runner
from graphflow.runtime.timer import Timer

if TYPE_CHECKING:
    from graphflow.runtime.node import Node


class Binding:
    """What the declarations of a node's class have become.

    Attributes:
        held: What the node holds, by attribute.
    """

    def __init__(self, node: Node) -> None:
        self.held: dict[str, Any] = {}
        self._node = node
        self._class = type(node)
        self._timers: list[tuple[declare.Rate, Timer]] = []
        self._hooks = declared.param_hooks(self._class)
        self._followers: dict[str, _Follower] = {}

    def bind_parameters(self) -> None:
        """Declare the parameters: names and periods of everything else may come from them."""
        for parameter in COMMON_PARAMETERS.values():
            self._node.parameters.declare(parameter)
        for attribute, item in declared.held(self._class).items():
            if isinstance(item, declare.Param):
                self.held[attribute] = item.bind(self._node)
        self._node.parameters.check(self._check)
        self._node.parameters.observe(self._changed)

    def bind(self) -> None:
        """Make endpoints, handlers and timers."""
        for attribute, item in declared.held(self._class).items():
            if not isinstance(item, declare.Param):
                self.held[attribute] = item.bind(self._node)
        for attribute, handler in declared.handlers(self._class).items():
            self._bind_handler(getattr(self._node, attribute), handler)

    def _bind_handler(self, method: Callable[..., Any], handler: declare.Handler) -> None:
        node = self._node
        options: dict[str, Any] = {"group": handler.group, "thread": handler.thread}
        if handler.kind == "subscription":
            options |= {"takes_info": handler.takes_info, "ignore_local": handler.ignore_local}
            options |= {"on_event": node.bound(handler.on_event), "on_error": handler.on_error}
            node.create_subscription(handler.type, handler.name, method, handler.qos, **options)
        elif handler.kind == "service":
            node.create_service(handler.type, handler.name, method, introspection=handler.introspection, **options)
        elif handler.action is not None:
            options |= {"accept": node.bound(handler.action.accept), "policy": handler.action.policy}
            cancellable = handler.action.cancellable
            options["cancellable"] = cancellable if isinstance(cancellable, bool) else node.bound(cancellable)
            options["on_client_loss"] = handler.action.on_client_loss
            options["cleanup_timeout"] = handler.action.cleanup_timeout
            node.create_action_server(handler.type, handler.name, method, **options)
        elif handler.rate is not None:
            period = self._period_ns(handler.rate, {}) / 1e9
            options |= {"takes_info": handler.takes_info, "on_error": handler.on_error}
            timer = node.create_timer(period, method, **options)
            self._timers.append((handler.rate, timer))

    def _period_ns(self, rate: declare.Rate, values: Mapping[str, Any]) -> int:
        get = self._node.parameters.get
        used = {name: values[name] if name in values else get(name) for name in rate.parameters()}
        try:
            return rate.period_ns(used)
        except ValueError as error:
            given = ", ".join(f"{name!r} = {value!r}" for name, value in used.items())
            raise ParameterError(f"parameter {given}: {error}") from None

    def _check(self, values: Mapping[str, Any]) -> None:
        """Refuse values that a timer or a check of the class cannot take."""
        for rate, _ in self._timers:
            if values.keys() & rate.parameters():
                self._period_ns(rate, values)
        for attribute, hook in self._hooks.items():
            name = hook.param.parameter.name
            if hook.kind == "check" and name in values:
                try:
                    getattr(self._node, attribute)(values[name])
                except ValueError as error:
                    raise ParameterError(f"parameter {name!r} = {values[name]!r}: {error}") from None

    def _changed(self, changes: Mapping[str, Change]) -> None:
        for rate, timer in self._timers:
            if changes.keys() & rate.parameters():
                timer.period = self._period_ns(rate, {}) / 1e9
        for attribute, hook in self._hooks.items():
            change = changes.get(hook.param.parameter.name)
            if hook.kind == "on_change" and change is not None and self._node.is_running:
                if attribute not in self._followers:
                    self._followers[attribute] = _Follower(self._node, getattr(self._node, attribute))
                self._followers[attribute].follow(change)

    def stop(self) -> list[Runner]:
        """The runners of methods that follow parameters, for the node to end."""
        return [follower.runner for follower in self._followers.values()]


class _Follower:
    """Calls a method with the changes of a parameter, one after the other."""

    def __init__(self, node: Node, method: Callable[[Any, Any], Any]) -> None:
        self._node, self._method = node, method
        self._changes: deque[Change] = deque()
        self.runner = node.runner(method.__name__, None, self._changes, self._invoke, self._finished)

    def follow(self, change: Change) -> None:
        self._changes.append(change)
        if inspect.iscoroutinefunction(self._method):
            # Its first step must not run inside whoever set the parameter, which may be a handler itself.
            self._node.context.loop.call_soon(self.runner.wake)
        else:
            self.runner.wake()

    def _invoke(self, change: Change) -> Any:
        return self._method(change.old, change.new)

    def _finished(self, change: Change, result: Any, error: BaseException | None) -> None:
        if error is not None:
            self._node.handler_failed(self._method.__name__, error)

"""Arguments that do not fit, explained in terms of the call itself; ROS 2 reports a later symptom.

An error keeps the class that ROS 2 raises.
"""

from __future__ import annotations

import inspect
import logging
import sys
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from itertools import combinations, permutations
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.msgs import registry
from graphflow.msgs.homes import homes
from graphflow.msgs.registry import KINDS
from rclpy.impl.callers import caller
from rclpy.impl.mistakes import repeats
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSPolicyEnum, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from rclpy.node import Node


P = ParamSpec("P")
T = TypeVar("T")
logger = logging.getLogger("graphflow")


def _is_callback(value: object) -> bool:
    return callable(value) and not isinstance(value, type)


def _is_interface(*parts: str) -> Callable[[object], bool]:
    return lambda value: isinstance(value, type) and all(hasattr(value, part) for part in parts)


_PARAMETERS: dict[str, tuple[str, Callable[[object], bool]]] = {
    "node": ("a node", lambda value: hasattr(value, "default_callback_group")),
    "msg_type": ("a message class", _is_interface("SCHEMA")),
    "srv_type": ("a service class", _is_interface("Request")),
    "action_type": ("an action class", _is_interface("Goal")),
    "qos_profile": ("a QoSProfile or a depth", lambda value: isinstance(value, (QoSProfile, int))),
    "timer_period_sec": ("a number of seconds", lambda value: isinstance(value, (int, float))),
    "frequency": ("a number of hertz", lambda value: isinstance(value, (int, float))),
    "parameter_list": ("a list of parameters", lambda value: isinstance(value, Iterable)),
    **dict.fromkeys(("topic", "srv_name", "action_name"), ("a name", lambda value: isinstance(value, str))),
    **dict.fromkeys(("callback", "execute_callback"), ("a function or method", _is_callback)),
}
"""The types of values that calls take, by parameter."""
_WRITTEN = {"parameter_list": "[Parameter('name', value=...)]", "qos_profile": "10"}
"""Arguments as they are written in a call, where that differs from the parameter's name."""


def explained(call: Callable[P, T]) -> Callable[P, T]:
    """Decorate a function so that its errors name the wrong argument and show the right call."""
    signature = inspect.signature(call)
    name = call.__qualname__.partition(".")[0] if call.__name__ == "__init__" else call.__name__
    needed = [p.name for p in list(signature.parameters.values())[1:] if p.default is p.empty]

    @wraps(call)
    def checked(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            made = call(*args, **kwargs)
        except (TypeError, AttributeError, RuntimeError) as error:
            try:
                given = signature.bind_partial(*args, **kwargs).arguments
            except TypeError:
                raise error.with_traceback(None) from None
            fault = _hiding(name, args[0], given.get("callback"))
            fault = fault or _fault(name, {word: given[word] for word in needed if word in given}, needed)
            fault = fault or _no_group(name, given.get("callback_group"))
            if not fault:
                raise
            kind = next(kind for kind in (TypeError, AttributeError, RuntimeError) if isinstance(error, kind))
            raise kind(fault) from None
        if "callback" in needed:
            _check_callback(name, args[0], signature.bind(*args, **kwargs).arguments["callback"])
        if "qos_profile" in signature.parameters:
            _check_depth(name, signature.bind(*args, **kwargs).arguments.get("qos_profile"))
        repeats.count(cast("Node", args[0]), name, made)
        return made

    return checked


def _fault(name: str, given: Mapping[str, object], needed: list[str]) -> str:
    """Describe the fault in a call's arguments; empty if their types are right."""
    for words in combinations(needed, len(given)) if len(given) < len(needed) else ():
        if all(map(_fits, words, given.values())):
            values = dict(zip(words, map(_shown, given.values()), strict=True))
            missing = " and ".join(word for word in needed if word not in words)
            written = ", ".join(values.get(word, _WRITTEN.get(word, word)) for word in needed)
            return f"{name} needs {missing}, too: {name}({written})"
    wrong = [word for word, value in given.items() if not _fits(word, value)]
    if not wrong:
        return ""
    for order in permutations(given.values()) if len(given) == len(needed) else ():
        if all(map(_fits, needed, order)):
            return f"the arguments of {name} are in the wrong order: {name}({', '.join(map(_shown, order))})"
    if any("callback" in word for word in wrong):
        return _no_callback(name, next(given[word] for word in wrong if "callback" in word))
    word = wrong[0]
    way = _class_advice(word, given[word])
    if way:
        return f"{word} of {name} must be {_PARAMETERS[word][0]}, got {_shown(given[word])}: {way}"
    expected = f"{name}({', '.join(_WRITTEN.get(word, word) for word in needed)})"
    return f"{word} of {name} must be {_PARAMETERS[word][0]}, got {_shown(given[word])}: write {expected}"


def _class_advice(word: str, value: object) -> str:
    """Show how to pass the class of an interface instead of something else; empty if unknown."""
    if not word.endswith("_type"):
        return ""
    if isinstance(value, str):
        caller = users_frame(sys._getframe())
        if caller is not None and isinstance(caller.f_globals.get(value), type):
            return f"write {value}, without quotes"
        names = [f"{p}/{kind}/{n}" for p in registry.packages() for kind in KINDS for n in registry.names_in(p, kind)]
        found = next((n for n in names if value in (n, n.replace("/", "."), n.rpartition("/")[2])), "")
        package, _, base = found.replace("/", ".").rpartition(".")
        return f"give the class: from {package} import {base}" if found else ""
    name, ending = value.__name__ if isinstance(value, type) else "", _ENDINGS.get(word, "")
    if home := next((home for home in homes(name) if home.endswith(ending)), ""):
        return f"write from {home} import {name}"
    for part, (kind, calls) in _USES.items():
        if isinstance(value, type) and hasattr(value, part):
            return f"{value.__name__} is {kind}: use {calls}"
    return ""


_ENDINGS = {"msg_type": ".msg", "srv_type": ".srv", "action_type": ".action"}
"""The ends of the modules with the interfaces that a parameter takes."""
_USES = {
    "Goal": ("an action", "ActionServer or ActionClient"),
    "Request": ("a service", "create_service or create_client"),
    "SCHEMA": ("a message", "create_publisher or create_subscription"),
}
"""The kinds of interface classes, by an attribute that only they have, and the calls that take them."""


def _no_callback(name: str, value: object) -> str:
    given = "None" if value is None else _shown(value)
    return (
        f"{name} was given {given} as its callback: pass the method itself, without parentheses, as in self.method; "
        "self.method() calls it at once and passes its result"
    )


def _no_group(name: str, value: object) -> str:
    """Describe the fault of an argument that is not a callback group; empty if it is one, or None."""
    if value is None or (hasattr(value, "beginning_execution") and not isinstance(value, type)):
        return ""
    if isinstance(value, (int, QoSProfile)):
        thing = name.removeprefix("create_")
        return f"a {thing} has no depth: leave out {_shown(value)}, which is read as its callback group"
    made = value.__name__ if isinstance(value, type) else "MutuallyExclusiveCallbackGroup"
    given = f"the class {made}" if isinstance(value, type) else repr(value)
    return f"callback_group of {name} must be a callback group, got {given}: make one, as in {made}()"


def _fits(word: str, value: object) -> bool:
    return word not in _PARAMETERS or _PARAMETERS[word][1](value)


def _shown(value: object) -> str:
    """Format a value as in source code."""
    if inspect.ismethod(value):
        return f"self.{value.__name__}"
    if isinstance(value, type) or inspect.isfunction(value):
        return value.__name__
    if isinstance(value, (str, int, float)):
        return repr(value)
    return "qos_profile" if isinstance(value, QoSProfile) else "self" if _fits("node", value) else type(value).__name__


def _check_callback(name: str, node: object, value: object) -> None:
    """Warn of None as a callback, and refuse anything else that cannot be called; ROS 2 accepts both.

    ROS 2 fails when it calls the callback. A rate of its own has None.

    Raises:
        TypeError: The value is neither None nor a function.
    """
    if callable(value):
        return
    if value is not None:
        raise TypeError(_hiding(name, node, value) or _no_callback(name, value))
    asked = caller(2)
    if asked is not None:
        logger.warning("%s (%s)", _hiding(name, node, None) or _no_callback(name, None), asked.place)


def _hiding(name: str, node: object, value: object) -> str:
    """Describe a callback that is an attribute with the name of a method; empty if it is none."""
    if callable(value):
        return ""
    own = getattr(node, "__dict__", {})
    hidden = {word: getattr(type(node), word, None) for word, kept in own.items() if kept is value}
    for word, method in hidden.items():
        if inspect.isfunction(method):
            place = short_place(method.__code__.co_filename, method.__code__.co_firstlineno)
            text = f"{name} was given self.{word}, which is {value!r} and hides the method {word} ({place})"
            return f"{text}: give the attribute or the method another name"
    return ""


_POLICIES = {DurabilityPolicy: "durability", HistoryPolicy: "history", ReliabilityPolicy: "reliability"}


def _check_depth(name: str, qos: object) -> None:
    """Warn that a policy was passed as the depth, where ROS 2 takes its number."""
    asked = caller(2) if isinstance(qos, QoSPolicyEnum) else None
    if asked is not None and isinstance(qos, QoSPolicyEnum):
        policy = f"{type(qos).__name__}.{qos.name}"
        text = "%s takes %s for a depth of %d: write QoSProfile(depth=10, %s=%s) (%s)"
        word = _POLICIES.get(type(qos), "liveliness")
        logger.warning(text, name, policy, int(qos), word, policy, asked.place)


class NotConstructed:
    """The class-level value of a node's internals, which `Node.__init__` replaces."""

    def __get__(self, node: Node, owner: type) -> Any:
        if node is None:
            return self
        code = getattr(owner.__init__, "__code__", None)  # type: ignore[misc]  # any class will do
        place = f" ({short_place(code.co_filename, code.co_firstlineno)})" if code is not None else ""
        name = owner.__name__
        raise AttributeError(
            f"{name} is not a node yet: {name}.__init__{place} must call super().__init__('node_name') first"
        )


def must_return(callback: object, what: str, value: object) -> str:
    """Return the sentence for a callback that returned something other than `what`."""
    given = "None" if value is None else type(value).__name__
    if isinstance(value, type):
        name = value.__name__.replace("_", ".")
        given = f"the class {name}: write {name}()"
    return f"{described(callback)} must return {what}, and returned {given}"


def described(callback: object) -> str:
    """Format a callback with its line: `tick (lamp.py:12)`."""
    code = getattr(callback, "__code__", None)
    place = f" ({short_place(code.co_filename, code.co_firstlineno)})" if code is not None else ""
    return f"{getattr(callback, '__name__', type(callback).__name__)}{place}"

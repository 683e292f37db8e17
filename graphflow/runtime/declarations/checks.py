"""Checks of declarations at class creation; each error has the place and the correct form.

Every check raises DeclarationError.
"""

from __future__ import annotations

import dis
import inspect
import re
from collections.abc import Callable, Mapping
from typing import get_args

from graphflow.analysis.user_code import is_users
from graphflow.errors import DeclarationError, InvalidName, Place
from graphflow.interface import OnError
from graphflow.msgs import base
from graphflow.msgs.base import Message
from graphflow.msgs.instead import instead_of_rclpys
from graphflow.names import expand
from graphflow.qos import Durability, History, Liveliness, Qos, Reliability
from graphflow.runtime.callables import code_of
from graphflow.runtime.declarations.params_in_names import refuse_param

DEPTH = 10
"""Default depth of a queue."""
_WAITING = ("GET_AWAITABLE", "GET_AITER")
"""Bytecode of `await`, `async with` and `async for`."""
SHORTEST_NS = 10_000
"""A shorter deadline, lifespan or lease is a number of another unit: a message takes longer even within a process."""


def check_node(node: object) -> None:
    """Check that an object passed to `run` is a node."""
    if isinstance(node, type):
        raise DeclarationError(f"{node.__name__} is a class; create a node: {node.__name__}()")
    if isinstance(node, (list, tuple)):
        raise DeclarationError("pass nodes as separate arguments, as in running(talker, listener) or running(*nodes)")
    if inspect.iscoroutine(node) or inspect.iscoroutinefunction(node):
        call = f"{node.__name__}()"
        if inspect.iscoroutine(node):
            node.close()  # or Python warns that it was never awaited, too
        raise DeclarationError(f"{call} is a coroutine of your own, and not a node: run it by asyncio.run({call})")
    if not hasattr(type(node), "_core_class"):
        raise DeclarationError(f"{node!r} is not a node: an object of a class that derives from graphflow.Node")


def check_type(type_: object, kind: type, what: str, place: Place) -> None:
    """Check that `type_` is a message, service or action class."""
    if not (isinstance(type_, type) and issubclass(type_, kind)):
        hint = _text_hint(type_) if isinstance(type_, str) else _kind_hint(type_, kind)
        wanted = f"{'an' if kind is base.Action else 'a'} {kind.__name__.lower()} class"
        raise DeclarationError(f"{place}: {what} needs {wanted}, not {type_!r}{hint}")


def _text_hint(text: str) -> str:
    """Return a hint for a type given as text, as `ros2` takes it, or for swapped arguments."""
    found = re.fullmatch(r"(\w+)[/.](msg|srv|action)[/.](\w+)", text)
    if found is None:
        return "; the type comes first, then the name"
    package, kind, name = found.groups()
    return f"; write from graphflow.msgs.{package}.{kind} import {name}, and then {name} without quotes"


def _kind_hint(type_: object, kind: type) -> str:
    """Return a hint for a class of another kind of interface."""
    if not isinstance(type_, type):
        return ""
    if way := instead_of_rclpys(type_):
        return f"; {way}"
    whole, _, part = type_.__name__.rpartition("_")
    if part in ("Request", "Response", "Goal", "Result", "Feedback") and whole:
        kind_of = "action" if part in ("Goal", "Result", "Feedback") else "service"
        return f"; give the {kind_of}'s class, as in {whole}, not its {part}"
    examples: dict[type, str] = {Message: "String", base.Service: "AddTwoInts", base.Action: "Fibonacci"}
    other = next((other for other in examples if issubclass(type_, other)), None)
    if other is None:
        return ""
    return (
        f"; that is a {other.__name__.lower()} class; an example of a {kind.__name__.lower()} class is {examples[kind]}"
    )


def check_text(name: object, what: str, place: Place) -> str:
    """Return the argument `name` if it is text."""
    if not isinstance(name, str):
        refuse_param(name, what, place)
        raise DeclarationError(f"{place}: {what}: the type comes first, then the name; {name!r} is not a name")
    return name


def check_name(name: object, what: str, place: Place) -> None:
    """Check that a name is legal."""
    text = check_text(name, what, place)
    refuse_param(text, what, place)
    try:
        expand(text, "/", "node")
    except InvalidName as error:
        raise DeclarationError(f"{place}: {what}: {error}") from None


def check_qos(qos: Qos | int, depth: int | None, place: Place) -> Qos:
    """Return the requested profile, from either `qos` or `depth`."""
    if depth is not None and qos != DEPTH:
        raise DeclarationError(f"{place}: give a Qos or a depth, not both: Qos(depth={depth!r}, ...) is both in one")
    asked = qos if depth is None else depth
    if isinstance(asked, (Durability, History, Liveliness, Reliability)):
        policy = f"{type(asked).__name__}.{asked.name}"
        few = "depth=1, " if asked is Durability.TRANSIENT_LOCAL else ""
        way = f"as in Qos({few}{type(asked).__name__.lower()}={policy})"
        raise DeclarationError(f"{place}: give a Qos or a queue depth such as 10, not {policy}, {way}")
    if not isinstance(asked, (Qos, int)):
        hint = "; a callback goes under @subscription" if callable(asked) else ""
        if isinstance(asked, str):
            hint = ", as in Qos(reliability=Reliability.BEST_EFFORT)" if not asked.isdecimal() else ", without quotes"
        raise DeclarationError(f"{place}: give a Qos or a queue depth such as 10, not {asked!r}{hint}")
    try:
        profile = Qos.of(asked)
    except ValueError as error:
        raise DeclarationError(f"{place}: {error}") from None
    for name in ("deadline_ns", "lifespan_ns", "lease_ns"):
        # Commands take on the profiles of publishers, whatever these are.
        if (value := getattr(profile, name)) < SHORTEST_NS and is_users(place.file):
            way = f"for {value} ms write {name}={value * 1_000_000:_}"
            raise DeclarationError(f"{place}: {name}={value} is in nanoseconds, too short for any message; {way}")
    return profile


def positional(fn: Callable[..., object]) -> tuple[list[str], int] | None:
    """Return the required positional arguments' names and the most accepted; None if there is no limit."""
    try:
        parameters = inspect.signature(fn).parameters.values()
    except (TypeError, ValueError):
        return None
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return None
    taken = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    return [p.name for p in taken if p.default is p.empty], len(taken)


def check_function(fn: object, what: str, example: str) -> None:
    """Check that `fn` is a function rather than the result of a call, as in `spawn(self.work())`.

    Args:
        example: The correct call.
    """
    if callable(fn):
        return
    shown = repr(fn)
    if inspect.iscoroutine(fn):
        fn.close()  # or Python warns that it was never awaited, too
        shown = f"what {fn.__qualname__}(...) returns"
    raise DeclarationError(f"{what} takes the function itself, then its arguments: {example}, not {shown}")


def check_plain(fn: object, what: str) -> None:
    """Check that a function for a thread is a `def`."""
    if inspect.iscoroutinefunction(fn):
        name, code = fn.__name__, code_of(inspect.unwrap(fn))
        is_waiting = code is None or any(step.opname in _WAITING for step in dis.get_instructions(code))
        way = f"await {name}(...) directly" if is_waiting else f"it awaits nothing, so write def {name}"
        raise DeclarationError(f"{what} runs a `def` in a thread, but {name} is an `async def`: {way}")


def check_callback(callback: object, arguments: range, what: str, place: Place, hint: str = "") -> int:
    """Check that a handler accepts one of these numbers of arguments; returns the number."""
    if not callable(callback):
        if inspect.iscoroutine(callback):
            callback.close()
        hint = "" if isinstance(callback, str) else "; pass the method itself, as in self.tick, without parentheses"
        raise DeclarationError(f"{place}: {what} needs a function to call, not {callback!r}{hint}")
    takes = positional(callback)
    if takes is None:
        return arguments[0]
    needed, most = takes
    fitting = [n for n in arguments if len(needed) <= n <= most]
    if not fitting:
        wanted = " or ".join(["no argument", "one argument", "two arguments"][n] for n in arguments)
        called = getattr(callback, "__qualname__", repr(callback))
        raise DeclarationError(
            f"{place}: {what}: {called} is called with {wanted}, but takes ({', '.join(needed)}){hint}"
        )
    return fitting[0]


def check_annotations(fn: Callable[..., object], expected: Mapping[str, type], what: str, place: Place) -> None:
    """Check that a function's annotations agree with the messages that it receives.

    Args:
        fn: A function of a class, or a method of a node.
        expected: The classes of its arguments, after `self`, by their names in error texts.

    Annotations other than message classes are not checked.
    """
    parameters = list(inspect.signature(fn).parameters.values())[0 if inspect.ismethod(fn) else 1 :]
    for parameter, (called, wanted) in zip(parameters, expected.items(), strict=False):
        found = _annotated(fn, parameter.annotation)
        if isinstance(found, type) and issubclass(found, Message) and not issubclass(wanted, found):
            raise DeclarationError(
                f"{place}: {what}: {fn.__name__} is given {called}, and its argument "
                f"{parameter.name!r} is annotated {found.__name__.replace('_', '.')}; use the same type in both"
            )


def check_method(callback: Callable[..., object], type_: type, what: str, place: Place) -> None:
    """Check that a method's annotation agrees with the messages that it receives; other callables are not checked."""
    if inspect.ismethod(callback):
        check_annotations(callback, {type_.__name__: type_}, what, place)


def check_returned(fn: Callable[..., object], called: str, wanted: type, what: str, place: Place) -> None:
    """Check that a handler's return annotation agrees with the type that it must return.

    Args:
        called: The name of the wanted class in error texts.
    """
    annotation = inspect.signature(fn).return_annotation
    found = _annotated(fn, annotation)
    wrong: type | None = next((kind for kind in _PLAIN if annotation in (kind, kind.__name__)), None)
    if wrong is None and isinstance(found, type) and issubclass(found, Message) and not issubclass(wanted, found):
        wrong = found
    if wrong is not None:
        name = wrong.__name__.replace("_", ".")
        raise DeclarationError(f"{place}: {what}: {fn.__name__} returns {called}, but is annotated to return {name}")


_PLAIN = (str, int, float, bool, bytes, list, dict, tuple)


def _annotated(fn: Callable[..., object], annotation: object) -> object:
    """Return the class that an annotation names; None for text that the function's module does not define."""
    if not isinstance(annotation, str):
        return annotation
    first, *others = annotation.strip("'\"").split(".")
    found = fn.__globals__.get(first)
    for name in others:
        found = getattr(found, name, None)
    return found


def check_on_event(on_event: object, what: str, place: Place) -> None:
    """Check that `on_event` is a method."""
    if on_event is not None and not inspect.isfunction(on_event):
        raise DeclarationError(
            f"{place}: {what}: on_event= takes a method defined above it, `def noticed(self, event): ...`, "
            f"not {on_event!r}"
        )
    check_hook(on_event, "on_event", "event", what, place)


def check_hook(hook: object, word: str, argument: str, what: str, place: Place) -> None:
    """Check that a hook, a method called outside of any handler, accepts its arguments."""
    if not inspect.isfunction(hook):
        return
    takes = positional(hook)
    if takes is not None and not len(takes[0]) <= 2 <= takes[1]:
        has = ", ".join(takes[0])
        raise DeclarationError(f"{place}: {what}: {word}= calls {hook.__name__}(self, {argument}), which takes ({has})")


def check_group(group: object, kind: type | tuple[type, ...], what: str, place: Place) -> None:
    """Check that `group` is a declared group."""
    if group is not None and not isinstance(group, kind):
        way = "declare one: io = Group(1)"
        if isinstance(group, str) and group.isidentifier():
            way = f"write group={group}, without quotes, below {group} = Group(1)"
        raise DeclarationError(f"{place}: {what}: group= takes a Group, not {group!r}; {way}")


def check_on_error(on_error: object, place: Place) -> None:
    """Check that `on_error` is a known policy."""
    if on_error not in get_args(OnError):
        raise DeclarationError(f"{place}: on_error must be one of {', '.join(get_args(OnError))}, not {on_error!r}")

"""Next steps for call errors: callbacks that graphflow called, and rclpy functions that the program called."""

from __future__ import annotations

import inspect
import linecache
import re
import sys
from collections.abc import Callable, Iterator
from functools import partial
from types import FrameType
from typing import Any

from graphflow.analysis.user_code import is_ours, is_users, short_place
from graphflow.names import nearest
from graphflow.rclpy.hints.frames import PATH, is_defined_by_user, line_of, named, own
from graphflow.rclpy.hints.tables import CALLS, GIVEN
from graphflow.rclpy.messages.classes import StrictMessage
from graphflow.system import SITE

_TAKERS = "add_done_callback|create_timer|create_subscription|create_service|ActionServer|add_\\w+_callback|Thread"
"""Calls that take callbacks."""
_RATES = ("hz", "rate", "freq", "frequency")
_MISCALLED = re.compile(r"^([\w.<>]+)\(\) (takes|got|missing)")


def wrong_call(error: BaseException, frames: list[FrameType]) -> str:
    """Describe the right call of a callback, or of an rclpy function."""
    last = frames[-1] if frames else None
    if last is None or not isinstance(error, (TypeError, RuntimeError)):
        return ""
    if re.match(r"Expected <class '.*>, got ", str(error)):
        return ""  # the argument is wrong, and not the call
    if " must return its response, " in str(error):
        return "set the fields of response, and return response"
    if " must return TransitionCallbackReturn" in str(error):
        return ""  # it says all
    miscalled = _MISCALLED.match(str(error))
    users = own(frames)
    if last.f_code.co_name == "checked" and users and miscalled is not None:
        return _of_rclpy(miscalled[1], str(error), last.f_locals.get("args", ()), last.f_locals.get("kwargs", {}))
    if last.f_code.co_qualname == "Spinning.next":  # whose first argument is compared with a number
        return "it takes seconds, spin_once(timeout_sec=0.1), and its nodes by executor.add_node(node)"
    if is_ours(last.f_code.co_filename):
        return _of_callback(str(error), last, miscalled[1] if miscalled is not None else "")
    if miscalled is None:
        return ""
    name = miscalled[1]
    if _is_users_own(name, last):
        return _of_users(name, str(error), line_of(frames))
    unmade = _not_constructed(name, last) if "missing 1 required positional argument" in str(error) else ""
    return unmade or _of_message(name, last) or _of_rclpy(name, str(error), (), {})


def called_value(error: BaseException, frames: list[FrameType]) -> str:
    """Name the value to use where a value is called: `.value()`, `is_cancel_requested()`."""
    found = re.match(r"^'(\w+)' object is not callable", str(error))
    users = own(frames)
    if not isinstance(error, TypeError) or found is None or not users or users[-1] is not frames[-1]:
        return ""
    if found[1] in _METHODS:
        paths = re.findall(r"([A-Za-z_][\w.]*)\(", line_of(frames))
        meant = next((path for path in paths if type(named(path, users[-1])).__name__ == found[1]), "")
        return f"write {meant}.{_METHODS[found[1]]}" if meant else ""
    called = re.findall(r"((?:\b[A-Za-z_]\w*|(?<=\)))(?:\.[A-Za-z_]\w*)*)\(\)", line_of(frames))
    fits = [path for path in called if type(named(path, users[-1])).__name__ == found[1]]
    fits = fits or [path for path in called if path.rpartition(".")[2] in _VALUES]
    fits = fits or (called if len(called) == 1 else [])
    if not fits:
        return ""
    return f"{fits[0].lstrip('.')} is not a function: remove the parentheses after it"


_METHODS = {
    "Publisher": "publish(msg)",
    "Client": "call_async(request)",
    "ActionClient": "send_goal_async(goal)",
}
"""Methods that are meant where an object of rclpy is called itself, by class."""
_VALUES = ("value", "is_cancel_requested", "is_active", "request", "status", "nanoseconds", "goal_id")
"""Properties of rclpy that are often called like methods."""


def _of_users(name: str, text: str, line: str) -> str:
    """Show how to define a function of the program, or that it is called too early."""
    if "." in name and " takes 0 positional arguments " in text:
        return f"self is missing: write def {name.rpartition('.')[2]}(self):"
    return _called_at_once(name, line) if " missing " in text else ""


def _called_at_once(name: str, line: str) -> str:
    """Advise where a callback is called instead of passed; empty if that is not the mistake."""
    found = re.search(rf"\b({_TAKERS})\((?:.*[(,=])?\s*((?:\w+\.)*{name.rpartition('.')[2]})\(\)", line)
    return f"give {found[1]} the method itself, without parentheses: {found[2]}" if found is not None else ""


def _of_rclpy(name: str, text: str, args: tuple[Any, ...], kwargs: dict[str, object]) -> str:
    """Describe the right call of a function of rclpy or of a package beside it.

    Args:
        args, kwargs: The arguments, the object first, where they are known.
    """
    for known, sentence in CALLS.items():
        if name == known or name.startswith(f"{known}."):
            return sentence
    function = _function(name)
    if function is None:
        return ""
    parameters = [p for p in inspect.signature(function).parameters.values() if p.name != "self"]
    shown = f"{name.removesuffix('.__init__').rpartition('.')[2]}({', '.join(_written(p) for p in parameters)})"
    wrong = re.search(r"unexpected keyword argument '(\w+)'", text)
    if wrong is not None:
        names = [p.name for p in parameters]
        if wrong[1] in _RATES and "timer_period_sec" in names:
            return f"a timer has a period in seconds: create_timer(1.0 / {kwargs.get(wrong[1], wrong[1])}, callback)"
        near = next((n for n in names if wrong[1] in n), None) or nearest(wrong[1], names)
        return f"it is {near}=" if near is not None else f"it is called as {shown}"
    places = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    extra = ", ".join(map(repr, args[len(places) + 1 :])) if "positional argument" in text else ""
    return f"leave out {extra}, it is called as {shown}" if extra else f"it is called as {shown}"


def _written(parameter: inspect.Parameter) -> str:
    """Format a parameter as in a call: `name`, or `name=` if it is optional or keyword-only."""
    if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
        return "..."
    goes_by_name = parameter.default is not parameter.empty or parameter.kind is parameter.KEYWORD_ONLY
    return f"{parameter.name}=" if goes_by_name else parameter.name


def _is_users_own(name: str, frame: FrameType) -> bool:
    """Whether user code defines a function or class of that name."""
    return is_defined_by_user((frame.f_locals | frame.f_globals).get(name.partition(".")[0]))


def _not_constructed(name: str, frame: FrameType) -> str:
    """Show how to create the object where a method was called on its class."""
    method = name.rpartition(".")[2]
    line = linecache.getline(frame.f_code.co_filename, frame.f_lineno)
    for path in PATH.findall(line):
        owner, _, called = path.rpartition(".")
        cls = named(owner, frame) if called == method != "__init__" else None
        if isinstance(cls, type):
            return f"{cls.__name__} is a class: create an instance, {cls.__name__}()"
    return ""


def _of_message(name: str, frame: FrameType) -> str:
    """Show how to create a message."""
    cls = (frame.f_locals | frame.f_globals).get(name.removesuffix(".__init__"))
    if not (isinstance(cls, type) and issubclass(cls, StrictMessage)):
        return ""
    return f"fields are keyword arguments: {cls.__name__}({', '.join(f'{f.name}=...' for f in cls.SCHEMA.fields)})"


def _function(name: str) -> Callable[..., object] | None:
    """Return a function of rclpy or of a package beside it, by qualified name."""
    for module in [m for m in list(sys.modules.values()) if str(getattr(m, "__file__", "")).startswith(SITE)]:
        found: Any = module
        for part in name.split("."):
            found = getattr(found, part, None) if found is not None else None
        if inspect.isfunction(found) and found.__qualname__ == name:
            return found
    return None


def _of_callback(text: str, frame: FrameType, name: str) -> str:
    """Describe how graphflow calls the callback whose call failed."""
    if text.endswith("object is not callable") and frame.f_code.co_qualname == "Task._step":
        return "pass the callback as the function itself: add_done_callback(self.done), without parentheses"
    found = next(((fn, args) for fn, args in _callbacks(frame) if name in ("", fn.__qualname__)), None)
    if found is None or not is_users(found[0].__code__.co_filename):
        return ""
    function, args = found
    code = function.__code__
    given = GIVEN.get(frame.f_code.co_qualname)
    if given is None:
        messages = frame.f_locals.get("msg", ()) if frame.f_code.co_name == "signalMessage" else ()
        given = ", ".join(map(_argument_name, (*args, *messages, *frame.f_locals.get("args", ()))))
    is_method = "." in function.__qualname__ and not function.__qualname__.rpartition(".")[0].endswith("<locals>")
    place = short_place(code.co_filename, code.co_firstlineno)
    taken = ", ".join(word for word in ("self" if is_method else "", given) if word)
    if function.__name__ == "<lambda>":
        return f"the lambda of {place} is called with ({given}): lambda {given}: ..."
    if function.__name__ == "main" and not given:
        return f"main ({place}) is called with (): def main(args=None)"
    return f"{function.__name__} ({place}) is called with ({given}): def {function.__name__}({taken})"


def _argument_name(argument: object) -> str:
    """Return the name that a callback would give an argument."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", type(argument).__name__).lower().replace("run", "future")


def _callbacks(frame: FrameType) -> Iterator[tuple[Any, tuple[Any, ...]]]:
    """Yield the functions visible in a frame, and its object's methods, with the number of bound arguments."""
    own = frame.f_locals.get("self")
    for value in (*frame.f_locals.values(), *getattr(own, "__dict__", {}).values()):
        inner: Any = value
        bound: tuple[Any, ...] = ()
        while isinstance(inner, partial):
            inner, bound = inner.func, (*inner.args, *bound)
        inner = getattr(inner, "__func__", inner)
        if inspect.isfunction(inner):
            yield inner, bound

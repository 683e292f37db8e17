"""The next step for errors of rclpy programs, looked up only when an error is shown.

The errors keep ROS 2's types and texts; a sentence is added here. Most sentences are rows of two tables, by
attribute and by text; the others are derived from the message's fields, the call's arguments or the callback.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Callable
from contextlib import suppress
from types import FrameType
from typing import Any

from graphflow.analysis.hiding import hidden
from graphflow.analysis.mistakes.calls.called_early import results_passed
from graphflow.analysis.syntax import syntax_of
from graphflow.analysis.user_code import is_users, parts_of
from graphflow.names import nearest
from graphflow.rclpy.hints.calls import called_value, wrong_call
from graphflow.rclpy.hints.fields import (
    message_as_value,
    missing_field,
    no_message,
    swapped_arguments,
    timer_info,
    wrong_value,
)
from graphflow.rclpy.hints.frames import PATH, is_defined_by_user, lacking, line_of, named, own
from graphflow.rclpy.hints.names import (
    missing_name,
    misspelt_init,
    module_as_class,
    severity,
    unknown_name,
    unset,
    without_value,
)
from graphflow.rclpy.hints.pending import early_result
from graphflow.rclpy.hints.tables import ATTRIBUTES, TEXTS
from graphflow.rclpy.messages.classes import StrictMessage
from graphflow.runtime.mistakes.errors.indices import advise_on_index
from graphflow.runtime.mistakes.errors.no_terminal import advise_on_input


def hint(error: BaseException) -> str:
    """Return the next step; empty if there is none to add."""
    frames = [part.tb_frame for part in parts_of(error.__traceback__)]
    for rule in _RULES:
        # Rules look at the program's objects, whose attributes and texts may raise; the error itself must be shown.
        with suppress(Exception):
            if found := rule(error, frames):
                return found
    return ""


def _text(error: BaseException, _: list[FrameType]) -> str:
    for pattern, sentence in TEXTS.items():
        found = re.search(pattern, str(error))
        if found is not None:
            return sentence.format(*(group for group in found.groups() if group is not None))
    return ""


def _missing_module(error: BaseException, frames: list[FrameType]) -> str:
    if not isinstance(error, ModuleNotFoundError):
        return ""
    from graphflow.rclpy.hints.missing_modules import missing_module  # with the workspace, which few errors need

    return missing_module(error, frames)


def _seconds(error: BaseException, frames: list[FrameType]) -> str:
    """Show how the difference of two times in the line becomes a number."""
    numbers = r"(operand|between).*('(Time|Duration)' and '(float|int)'|'(float|int)' and '(Time|Duration)')"
    if not isinstance(error, TypeError) or not own(frames) or not re.search(numbers, str(error)):
        return ""
    line = line_of(frames).strip()
    line = re.sub(r"^(?:el)?(?:if|while)\b(.*):$", r"\1", line).strip()
    for node in ast.walk(ast.parse(line)):
        match node:
            case ast.BinOp(left=now, op=ast.Sub(), right=past) if ast.unparse(now).endswith("now()"):
                for part in ast.walk(past):
                    if isinstance(part, ast.Attribute) and part.attr == "nanoseconds":
                        past = part.value
                        break
                span = f"({ast.unparse(now)} - {ast.unparse(past)})"
                return f"the difference is a Duration: write {span}.nanoseconds / 1e9"
    return ""


def _stamp(error: BaseException, frames: list[FrameType]) -> str:
    """Show how to convert a message's stamp where it is used in arithmetic."""
    users = own(frames)
    if (
        not isinstance(error, TypeError)
        or not users
        or not re.search(r"(operand|between).*'(Time|Duration)'", str(error))
    ):
        return ""
    for path in PATH.findall(line_of(frames)):
        thing = named(path, users[-1])
        if isinstance(thing, StrictMessage) and type(thing).__name__ in ("Time", "Duration"):
            kind = type(thing).__name__
            return f"{path} is a message: write rclpy.{kind.lower()}.{kind}.from_msg({path})"
    for path in PATH.findall(line_of(frames)):
        thing = named(path, users[-1])
        if f"{type(thing).__module__}.{type(thing).__name__}" == "rclpy.duration.Duration":
            return f"{path} is a Duration: write ({path}.nanoseconds / 1e9), its seconds"
    return ""


def _attribute(error: BaseException, frames: list[FrameType]) -> str:
    found = lacking(error, frames)
    if found is None:
        return ""
    thing, name = found
    words = [f"{cls.__name__}.{name}" for cls in type(thing).__mro__ if not is_defined_by_user(cls)]
    words += [f"T.{name}"] if hasattr(type(thing), "default_callback_group") else []
    for known, sentence in ATTRIBUTES.items():
        if not set(words).isdisjoint(known.split()):
            return sentence
    if isinstance(thing, list) and thing and type(thing[0]).__name__ == "Parameter":
        return f"that is a list of parameters: for parameter in parameters, and parameter.{name}"
    if thing is None and ".result()" in line_of(frames):
        return "future.result() is None until the future is done: add_done_callback(...), or spin until it is"
    if type(thing).__name__ in ("Future", "Run", "Task") and not is_defined_by_user(type(thing)):
        users = own(frames)
        if users and users[-1].f_code.co_flags & inspect.CO_COROUTINE:
            return f"it is in the answer: write await before the call that returns the future, and .{name} of that"
        return f"it is in the answer: future.result().{name}, once the future is done: add_done_callback(...)"
    if type(thing).__name__ in ("ServerGoalHandle", "ClientGoalHandle") and not is_defined_by_user(type(thing)):
        return _of_goal(type(thing), name, frames)
    if error.__class__ is AttributeError and type(thing).__module__ == "rclpy.qos":
        near = nearest(name, [word for word in dir(thing) if not word.startswith("_")])
        return f"did you mean {near!r}?" if near is not None else ""
    return ""


def _of_publisher(error: BaseException, frames: list[FrameType]) -> str:
    """Show how to fill a message where its field was read or set on the publisher."""
    found = lacking(error, frames)
    if found is None or type(found[0]).__name__ != "Publisher" or is_defined_by_user(type(found[0])):
        return ""
    msg_type: Any = vars(found[0])["msg_type"]
    if found[1] not in [field.name for field in msg_type.SCHEMA.fields]:
        return ""
    way = f"fill a message, msg = {msg_type.__name__}(), msg.{found[1]} = ..., and publish(msg)"
    return f"that is the publisher: {way}"


def _of_goal(cls: type, name: str, frames: list[FrameType]) -> str:
    """Show where a field of a goal or of its result is, instead of in its handle."""
    if cls.__name__ == "ServerGoalHandle":
        return f"it is in the goal: goal_handle.request.{name}"
    end = "" if name in ("result", "get_result") else f".{name}"
    near = nearest(name, [word for word in dir(cls) if not word.startswith("_")]) if end else None
    if near is not None:
        return f"did you mean {near!r}?"
    users = own(frames)
    if users and "self" not in users[-1].f_locals:  # the program's main function, where nothing else spins
        ways = "result_future = goal_handle.get_result_async(), rclpy.spin_until_future_complete(node, result_future)"
        return f"this is the goal's handle, and the result comes later: {ways}, result_future.result().result{end}"
    got = "goal_handle = future.result(), " if "future.result()." in line_of(frames) else ""
    return (
        f"this is the goal's handle, and the result comes later: {got}"
        "goal_handle.get_result_async().add_done_callback(self.on_result); what uses the result, and rclpy.shutdown(), "
        f"moves into a new method on_result(self, future), where it is future.result().result{end}"
    )


def _hidden(error: BaseException, _: list[FrameType]) -> str:
    return hidden(error)


def _index(error: BaseException, frames: list[FrameType]) -> str:
    users = own(frames)
    return advise_on_index(error, line_of(frames), lambda path: named(path, users[-1]) if users else None)


def _without_terminal(error: BaseException, _: list[FrameType]) -> str:
    return advise_on_input(error)


def _called_early(error: BaseException, _: list[FrameType]) -> str:
    """Explain an error in a callback that was called where it should have been passed."""
    for part in parts_of(error.__traceback__):
        file = part.tb_frame.f_code.co_filename
        if is_users(file):
            early = dict(results_passed(syntax_of(file).module, is_of_threads=False))
            if found := early.get(part.tb_lineno):
                return found
    return ""


def _no_argument(error: BaseException, frames: list[FrameType]) -> str:
    if not isinstance(error, IndexError) or "sys.argv[" not in line_of(frames):
        return ""
    count = len(sys.argv) - 1
    given = "no argument" if not count else "1 argument" if count == 1 else f"{count} arguments"
    return f"the program was given {given}: write more behind its name, as in graphflow run PACKAGE PROGRAM 2 3"


_RULES: tuple[Callable[[BaseException, list[FrameType]], str], ...] = (
    _hidden,
    _called_early,
    swapped_arguments,
    missing_field,
    timer_info,
    wrong_value,
    no_message,
    _of_publisher,
    _attribute,
    missing_name,
    _missing_module,
    unknown_name,
    early_result,
    unset,
    without_value,
    misspelt_init,
    module_as_class,
    severity,
    wrong_call,
    called_value,
    _stamp,
    _seconds,
    _text,
    message_as_value,
    _without_terminal,
    _no_argument,
    _index,
)
"""The rules, in order of precedence."""

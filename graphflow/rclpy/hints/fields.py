"""Next steps for errors about messages: unknown fields, and values that do not fit."""

from __future__ import annotations

import ast
import re
import reprlib
import sys
from collections.abc import Iterator
from contextlib import suppress
from types import FrameType
from typing import Any

from graphflow.names import nearest
from graphflow.rclpy.hints.frames import PATH, lacking, line_of, named, own
from graphflow.rclpy.messages import values
from graphflow.rclpy.messages.classes import StrictMessage, described

_FIELD = re.compile(r"The '(\w+)' field must be (?:a sub message )?of type '(\w+)'")
_ELEMENTS = re.compile(r" (?:set|sequence).* of type '(int|float|str|bool)'")
_OF_TIMES = ("to_sec", "to_nsec", "secs", "nsecs", "nanoseconds", "seconds")
"""Attributes of rclpy's times, and of ROS 1's."""
_PLAIN = (bool, int, float, str)
_RECKONED = re.compile(r"operand|can only concatenate|not supported between|argument must be|required, not")
_RANGE_OR_LIST = re.compile(r"The '\w+' field must be (an? |string value)")


def missing_field(error: BaseException, frames: list[FrameType]) -> str:
    """List the fields of a message that lacks the requested one."""
    absent = lacking(error, frames)
    if absent is not None and isinstance(absent[0], StrictMessage):
        kind = type(absent[0]).__name__
        if kind in ("Time", "Duration") and absent[1] in _OF_TIMES:
            way = f"{kind}.from_msg(...).nanoseconds / 1e9, with {kind} from rclpy.{kind.lower()}"
            return f"it is a message; write {way}"
        return _fields(type(absent[0]), absent[1])
    found = re.match(r"Invalid arguments passed to constructor: (\w+)", str(error))
    made = [frame.f_locals["SELF"] for frame in frames if "SELF" in frame.f_locals]
    if found is not None and made:
        return _fields(type(made[-1]), found[1])
    return ""


def swapped_arguments(error: BaseException, frames: list[FrameType]) -> str:
    """Show the order of a service callback's arguments where they are named the other way round."""
    absent, users = lacking(error, frames), own(frames)
    if absent is None or not users:
        return ""
    code, held = users[-1].f_code, users[-1].f_locals
    names = code.co_varnames[: code.co_argcount]
    if names[-2:] != ("response", "request") or not any(held[name] is absent[0] for name in names[-2:]):
        return ""
    if not all(type(held[n]).__name__.endswith(part) for n, part in zip(names[-2:], _PARTS, strict=True)):
        return ""
    way = f"def {code.co_name}({', '.join((*names[:-2], 'request', 'response'))})"
    return f"a service's callback receives the request first: {way}"


_PARTS = ("_Request", "_Response")
"""The ends of the names of the messages that a service's callback receives, in their order."""


def timer_info(error: BaseException, frames: list[FrameType]) -> str:
    """Explain a callback's argument that was meant to be a number, and is the TimerInfo that a timer gives it."""
    held = [f.f_locals.get("value") for f in frames if f.f_code.co_filename == values.__file__]
    is_set = isinstance(error, AssertionError) and any(type(value).__name__ == "TimerInfo" for value in held)
    is_used = isinstance(error, TypeError) and re.search(r"\bTimerInfo'?(?: and |$)", str(error)) is not None
    is_read = isinstance(error, AttributeError) and type(error.obj).__name__ == "TimerInfo"
    return _TIMER_INFO if is_set or is_used or is_read else ""


_TIMER_INFO = (
    "a timer calls a callback that has an argument with a TimerInfo: leave the argument out, or give it a value by "
    "functools.partial(self.callback, value)"
)


def wrong_value(error: BaseException, frames: list[FrameType]) -> str:
    """Show how to set a field to which a value of another type was assigned."""
    found = _FIELD.match(str(error))
    checks = [f.f_locals for f in frames if f.f_code.co_filename == values.__file__ and "value" in f.f_locals]
    if not isinstance(error, AssertionError) or not checks:
        return ""
    if found is None:
        return _wrong_element(checks, str(error)) if _RANGE_OR_LIST.match(str(error)) else ""
    name, kind = found.groups()
    value, cls = checks[-1]["value"], checks[-1].get("cls")
    set_ = re.match(rf"\s*([\w.\[\]]*\b{name})\s*=(?!=)\s*([^#;]+)", line_of(frames))
    target, given = (set_[1], set_[2].strip()) if set_ is not None else (name, "...")
    if type(value).__name__ == "Parameter":
        return f"a parameter's value is in .value: {target} = {given}.value"
    if type(value).__name__ == "ParameterValue":
        return f"write {target} = get_parameter('name').value in place of .get_parameter_value()"
    if isinstance(cls, type) and issubclass(cls, StrictMessage):
        return _part(target, given, value, cls)
    if isinstance(value, StrictMessage) and hasattr(value, "data"):
        return f"{given} is a message: write {target} = {given}.data"
    if kind in ("int", "float"):
        return _of_number(target, given, value, kind)
    if kind == "str" and value is not None:
        return f"write {target} = str({given})"
    return f"it was given {reprlib.repr(value)}: write True or False" if kind == "bool" else ""


def _of_number(target: str, given: str, value: object, kind: str) -> str:
    """Show how to set a field that is a number."""
    if isinstance(shape := getattr(value, "shape", None), tuple):
        return _of_array(target, given, kind, shape)
    if kind == "float" and isinstance(value, int):
        if isinstance(value, bool):
            return f"{target} is a float, and was given {value}"
        if given == "...":  # an argument of the message's constructor
            return f"write {target}={value}.0, or {target}=float(...)"
        return f"{target} is a float: write {value}.0" if given == str(value) else f"write {target} = float({given})"
    if isinstance(value, float):
        if target.rpartition(".")[2] == "sec":
            nanoseconds = round(value % 1 * 1e9)
            return f"the fraction has a field of its own: write sec={int(value)}, nanosec={nanoseconds:_}"
        return f"{target} is an int: write int(...){' or //' if '/' in given else ''}"
    if not isinstance(value, str):
        return ""
    if not _can_be(kind, value):
        return f"{target} is {'an int' if kind == 'int' else 'a float'}, and {reprlib.repr(value)} is no number"
    return f"write {target} = {kind}({given})"


def _can_be(kind: str, value: object) -> bool:
    """Whether `int(value)` or `float(value)` gives a number; every other kind is taken to accept the value."""
    if kind not in ("int", "float") or not isinstance(value, str):
        return True
    try:
        (int if kind == "int" else float)(value)
    except ValueError:
        return False
    return True


def _of_array(target: str, given: str, kind: str, shape: tuple[int, ...]) -> str:
    """Show how to convert a NumPy scalar or array to plain numbers."""
    if not shape:
        return f"write {target} = {kind}({given})"
    whole = given if PATH.fullmatch(given) else f"({given})"
    what = f"{target} is {'an int' if kind == 'int' else 'a float'}, got an array of shape {shape}"
    is_one = all(size == 1 for size in shape)
    way = (
        f"{kind}({whole}[{', '.join('0' for _ in shape)}])" if is_one else f"one of its elements, {kind}({whole}[...])"
    )
    return f"{what}: write {way}"


def _wrong_element(checks: list[dict[str, Any]], text: str) -> str:
    """Show a value that is out of range, or a list with an element of the wrong type."""
    last, kind = checks[-1], _ELEMENTS.search(text)
    if "items" in last:
        if dimensions := getattr(last["item"], "ndim", 0):
            flat = "tobytes()" if last["item"].dtype.itemsize == 1 else "ravel().tolist()"
            return f"the array has {dimensions + 1} dimensions, and the field one: write array.{flat}"
        if kind is not None and type(last["item"]).__name__ == kind[1]:
            return f"one of its elements is {reprlib.repr(last['item'])}, which is out of range"
        is_made = kind is not None and isinstance(last["item"], _PLAIN) and _can_be(kind[1], last["item"])
        way = f": write [{kind[1]}(v) for v in ...]" if kind is not None and is_made else ""
        return f"one of its elements is {described(last['item'])}{way}"
    value = last["value"]
    way = f": a list is expected, write [{value!r}]" if kind is not None and type(value).__name__ == kind[1] else ""
    return f"it was given {reprlib.repr(value)}{way}"


def _part(target: str, given: str, value: object, cls: type[StrictMessage]) -> str:
    """Show how to set a field that is itself a message."""
    if type(value).__module__ in ("rclpy.time", "rclpy.duration") and type(value).__name__ == cls.__name__:
        return f"write {target} = {given}.to_msg()"
    if cls.__name__ == "Time" and isinstance(value, float) and "time.time()" in given:
        return f"write {target} = self.get_clock().now().to_msg()"
    if value is cls:
        return f"that is a class, not a message: write {target} = {cls.__name__}()"
    fields = cls.SCHEMA.fields
    if isinstance(value, StrictMessage) or not fields:
        return f"{target} is a {cls.__name__}, and was given a {type(value).__name__}"
    return f"{target} is a {cls.__name__}: set its fields, as in {target}.{fields[0].name} = ..."


def no_message(error: BaseException, frames: list[FrameType]) -> str:
    """Show how to create a message where its class was passed."""
    found = re.fullmatch(r"Expected <class '[\w.]*\.(\w+)'>, got the class \w+", str(error))
    if found is not None:
        return f"that is a class, not a message: write {found[1].replace('_', '.')}()"
    last = frames[-1].f_locals if frames else {}
    cls, given = getattr(last.get("self"), "msg_type", None), last.get("msg")
    is_plain = isinstance(given, (bool, int, float, str)) and str(error).startswith("Expected <class ")
    if is_plain and isinstance(cls, type) and issubclass(cls, StrictMessage):
        fields = cls.SCHEMA.fields
        if len(fields) == 1 and isinstance(getattr(cls(), fields[0].name), type(given)):
            return f"write {cls.__name__}({fields[0].name}={_published(line_of(frames)) or '...'})"
    return ""


def _published(line: str) -> str:
    """Return the expression that a line publishes; empty if it is not on the line alone."""
    with suppress(SyntaxError):
        for node in ast.walk(ast.parse(line.strip())):
            match node:
                case ast.Call(func=ast.Attribute(attr="publish"), args=[given]):
                    return ast.unparse(given)
    return ""


def message_as_value(error: BaseException, frames: list[FrameType]) -> str:
    """Name the field to use where a message was treated as a plain value."""
    users = own(frames)
    if not isinstance(error, (AttributeError, TypeError)) or not users:
        return ""
    if "'property'" in str(error) or "'member_descriptor'" in str(error):
        return _class_as_message(line_of(frames), users[-1])
    if not isinstance(error, TypeError) or not _RECKONED.search(str(error)):
        return ""
    if "'ParameterValue'" in str(error) and ".get_parameter_value()" in line_of(frames):
        return "a parameter's value is in .value: write that in place of .get_parameter_value()"
    for path in PATH.findall(line_of(frames)):
        thing = named(path, users[-1])
        name = type(thing).__name__
        if not isinstance(thing, StrictMessage) or not re.search(rf"['\"]{name}['\"]", str(error)):
            continue
        if name == "ParameterValue":
            return f"{path} is a ParameterValue: write get_parameter('name').value in place of .get_parameter_value()"
        fields = thing.SCHEMA.fields
        if fields:
            return f"{path} is a {name}, a message: take its field, {path}.{fields[0].name}"
    return ""


def _class_as_message(line: str, frame: FrameType) -> str:
    """Show how to create a message where a line reads a field of its class."""
    owners = (".".join(path.split(".")[:end]) for path in PATH.findall(line) for end in range(1, path.count(".") + 1))
    for owner in owners:
        cls = named(owner, frame)
        if isinstance(cls, type) and issubclass(cls, StrictMessage):
            is_kept = owner != cls.__name__
            return (
                f"{owner} is {'the' if is_kept else 'a'} class{f' {cls.__name__}' if is_kept else ''}, not a message: "
                + (
                    f"write {owner} = {cls.__name__}()"
                    if is_kept
                    else f"write {cls.__name__}(), or use a message object"
                )
            )
    return ""


def _fields(cls: type[StrictMessage], name: str) -> str:
    names = [field.name for field in cls.SCHEMA.fields]
    below = next(_paths(cls, name), "")
    if below:
        return f"it is in a nested message: .{below}"
    near = nearest(name, names)
    listed = ", ".join(names) or "no fields"
    hint = _elsewhere(cls, name) or (f"; did you mean {near!r}?" if near is not None else "")
    return f"{cls.__name__} has {listed}{hint}"


def _elsewhere(cls: type[StrictMessage], name: str) -> str:
    """Return a hint if another part of the service or action has the field; empty otherwise."""
    whole, _, own = cls.__name__.rpartition("_")
    of_type = getattr(sys.modules.get(cls.__module__.rpartition(".")[0]), whole, None)
    for order in (("Request", "Response"), ("Goal", "Result", "Feedback")):
        for part in order if own in order else ():
            other = getattr(of_type, part, None)
            if other is not None and any(field.name == name for field in other.SCHEMA.fields):
                text = f"; {name} is in {whole}.{part}: use that, or correct the order of the definition"
                return f"{text}, {' --- '.join(order).lower()}"
    return ""


def _paths(cls: type[StrictMessage], name: str) -> Iterator[str]:
    """Return the paths to a field of that name in a message's nested messages, two levels deep."""
    for field in cls.SCHEMA.fields:
        if field.type.is_primitive or field.type.array:
            continue
        part = type(getattr(cls(), field.name))
        if any(inner.name == name for inner in part.SCHEMA.fields):
            yield f"{field.name}.{name}"
        yield from (f"{field.name}.{path}" for path in _paths(part, name))

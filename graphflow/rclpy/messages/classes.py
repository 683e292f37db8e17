"""Message classes as rosidl generates them for Python: properties reject values that do not fit the field's type.

Unlike graphflow's own, they do not widen: an integer is not a float, sequences of numbers are `array.array`, a
byte is a `bytes` of length one. Code that runs here runs on ROS 2.

Source: rosidl_generator_py of Jazzy. Its checks are on here unless ROS_PYTHON_CHECK_FIELDS is 0: where they are off,
ROS 2 aborts the process when such a message is published; here publishing raises an error.
"""

from __future__ import annotations

import os
import re
import reprlib
from array import array
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, ClassVar, NoReturn

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.rclpy.messages.values import SEQUENCE_CODES, Check, checker, lenient, rosidl_type
from graphflow.rclpy.per_name import made_once
from graphflow.wire.cdr.codec import Codec
from graphflow.wire.cdr.codegen import Types
from graphflow.wire.profile import wire_profile, wire_type
from graphflow.wire.schema import INTEGER_RANGES, Action, Constant, Field, FieldType, Message, Service

CHECKS = os.environ.get("ROS_PYTHON_CHECK_FIELDS") != "0"
"""Whether fields check values on assignment, and not only when the message is sent."""


class _Generated(type):
    """The metaclass of message classes, with rosidl's type support protocol."""

    _TYPE_SUPPORT: ClassVar[object] = object()

    @classmethod
    def __import_type_support__(cls) -> None:
        """Do nothing: the codec is compiled on first use."""


class StrictMessage(metaclass=_Generated):
    """The base class of all message classes."""

    __slots__ = ()
    SCHEMA: ClassVar[Message]

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return the types of the fields by name, in rosidl's notation: `double`, `sequence<geometry_msgs/Point>`."""
        return {f.name: rosidl_type(f.type) for f in cls.SCHEMA.fields}

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return False
        return all(_same(getattr(self, f.name), getattr(other, f.name)) for f in self.SCHEMA.fields)

    __hash__ = None  # type: ignore[assignment]  # messages can change

    def __repr__(self) -> str:
        values = ", ".join(f"{f.name}={_text(getattr(self, f.name))}" for f in self.SCHEMA.fields)
        package, kind, _ = type(self).__module__.split(".")
        return f"{package}.{kind}.{type(self).__name__}({values})"


class _NoInstances(_Generated):
    def __call__(cls, *_: object, **__: object) -> NoReturn:
        kind, parts = ("Action", ("Goal", "Result")) if hasattr(cls, "Goal") else ("Service", ("Request", "Response"))
        ways = " or ".join(f"a {part.lower()} with {cls.__name__}.{part}()" for part in parts)
        raise NotImplementedError(f"{kind} classes can not be instantiated: create {ways}")


def what_came(value: object) -> str:
    """Return the type of a value for an error, or the class that was passed in place of an instance."""
    return f"the class {value.__name__}" if isinstance(value, type) else str(type(value))


def _same(a: Any, b: Any) -> bool:
    return bool((a == b).all()) if hasattr(a, "dtype") else bool(a == b)


def _text(value: Any) -> str:
    return repr(value.tolist()) if isinstance(value, array) else repr(value)


@made_once
def message_class(name: str) -> type[StrictMessage]:
    """Return the class of a message, including those derived from services and actions (`.../srv/Spawn_Request`).

    Raises:
        UnknownInterface, InterfaceError: As for `registry.interface`.
    """
    on_wire = wire_type(name, wire_profile())
    if on_wire != name:
        return message_class(on_wire)
    schema = registry.message_schema(name)
    package, kind, base = name.split("/")
    names: dict[str, Any] = {"ABSENT": _ABSENT, "REFUSE": _refuse}
    body: dict[str, object] = {
        "__slots__": tuple(f"_{f.name}" for f in schema.fields),
        "__module__": _module(package, kind, base),
        "__doc__": f"{name}: {', '.join(f'{f.type} {f.name}' for f in schema.fields) or 'no fields'}.",
        "SCHEMA": schema,
        **{constant.name: constant_value(constant) for constant in schema.constants},
    }
    lines = [f"def __init__({', '.join(['SELF', '*', *(f'{f.name}=ABSENT' for f in schema.fields), '**OTHERS'])}):"]
    lines[0] = lines[0].replace("*, **OTHERS", "**OTHERS")
    lines.append("    if OTHERS: REFUSE(OTHERS)")
    for i, field in enumerate(schema.fields):
        check = checker(field.name, field.type, _class_of(field.type))
        check = check if CHECKS else lenient(check)
        names[f"K{i}"], names[f"M{i}"] = check, default(field)
        lines.append(f"    SELF._{field.name} = M{i}() if {field.name} is ABSENT else K{i}({field.name})")
        body[field.name] = _property(name, field.name, check)
    exec(compile("\n".join(lines), f"<{name}>", "exec"), names)  # noqa: S102 - written above from a checked schema
    body["__init__"] = names["__init__"]
    names["__init__"].__qualname__ = f"{base}.__init__"
    made: Any = _Generated(base, (StrictMessage,), body)
    cls: type[StrictMessage] = made
    return cls


def constant_value(constant: Constant) -> object:
    """Return a constant's value: for a byte, as its fields take it."""
    value = constant.value
    return bytes([value]) if constant.type == "byte" and isinstance(value, int) else value


def _module(package: str, kind: str, name: str) -> str:
    """Return the name of rosidl's module for a class: `std_srvs.srv._set_bool` for `SetBool` and `SetBool_Request`."""
    return f"{package}.{kind}._{snake(name.partition('_')[0])}"


def snake(name: str) -> str:
    """Convert `LaserScan` to rosidl's module name `laser_scan`."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


def _class_of(type_: FieldType) -> type | None:
    return None if type_.is_primitive else message_class(type_.base)


def _property(type_: str, name: str, check: Check) -> property:
    slot = f"_{name}"
    space: dict[str, Any] = {"CHECK": check}
    source = f"def get(SELF): return SELF.{slot}\ndef put(SELF, VALUE): SELF.{slot} = CHECK(VALUE)"
    exec(compile(source, f"<{type_}.{name}>", "exec"), space)  # noqa: S102 - a field's name is an identifier
    return property(space["get"], space["put"])


class _Absent:
    def __repr__(self) -> str:
        return "<default>"


_ABSENT = _Absent()


def _refuse(others: dict[str, Any]) -> None:
    others.pop("check_fields", None)  # rosidl's, which could turn the checks off
    if others:
        raise AssertionError(f"Invalid arguments passed to constructor: {', '.join(sorted(others))}")


def default(field: Field) -> Callable[[], object]:
    """Return a factory for a field's default value."""
    type_, given = field.type, field.default
    if not type_.array:
        if not type_.is_primitive:
            return message_class(type_.base)
        value = given if given is not None else _zero(type_.base)
        value = bytes([value]) if type_.base == "byte" and isinstance(value, int) else value
        return lambda: value
    count = type_.size if type_.array == "fixed" else 0
    items: Any = given if isinstance(given, list) else None
    if type_.base in SEQUENCE_CODES and type_.array != "fixed":
        code = SEQUENCE_CODES[type_.base]
        return lambda: array(code, items or ())
    if type_.base in SEQUENCE_CODES:
        return lambda: _numpy(type_.base, items if items is not None else [0] * count)
    if not type_.is_primitive:
        cls = message_class(type_.base)
        return lambda: [cls() for _ in range(count)]
    if type_.base == "byte" and items is not None:
        items = [bytes([item]) for item in items]
    zero = b"\0" if type_.base == "byte" else _zero(type_.base)
    return lambda: list(items) if items is not None else [zero] * count


def _zero(base: str) -> object:
    if base == "byte":
        return b"\0"
    return 0 if base in INTEGER_RANGES else {"string": "", "wstring": "", "bool": False}.get(base, 0.0)


def _numpy(base: str, items: list[object]) -> object:
    import numpy as np

    from graphflow.wire.cdr.arrays import DTYPES

    return np.array(items, DTYPES[base])


@made_once
def codec(name: str) -> Codec:
    """Return the codec of a message class by type name."""
    return Codec(registry.message_schema(name), Types(registry.message_schema, message_class, _checked, "rosidl"))


def encode(message: Any) -> bytes:
    """Encode a message as CDR.

    Raises:
        EncodeError: A part that was changed in place no longer fits; the text names the field.
    """
    if isinstance(message, StrictMessage):
        return codec(message.SCHEMA.name).encode(message)
    return bytes(message.to_bytes())  # one of graphflow's own


def decode(cls: Any, payload: bytes) -> Any:
    """Decode a message of a class, strict or graphflow's own. Raises DecodeError."""
    return codec(cls.SCHEMA.name).decode(payload) if issubclass(cls, StrictMessage) else cls.from_bytes(payload)


def _checked(message: StrictMessage) -> StrictMessage:
    """Raise an EncodeError that names the part of a message that does not fit."""
    for field in message.SCHEMA.fields:
        value = getattr(message, field.name)
        try:
            setattr(message, field.name, value)
        except AssertionError as error:
            text = f"{type(message).__name__}.{field.name}: {error}{_odd_element(field, value)}"
            raise EncodeError(text) from None
        for part in value if field.type.array and not field.type.is_primitive else [value]:
            if isinstance(part, StrictMessage):
                _checked(part)
    return message


def _odd_element(field: Field, value: object) -> str:
    """Describe the first element of a list that does not fit, for example because it was appended."""
    if not isinstance(value, list):
        return ""
    cls = None if field.type.is_primitive else message_class(field.type.base)
    fits = checker(field.name, field.type._replace(array="", size=0), cls)
    for number, item in enumerate(value):
        try:
            fits(item)
        except AssertionError:
            return f"; element {number} is {described(item)}{_within(cls, item)}"
    return ""


def described(value: object) -> str:
    """Describe a value in a few words: `a Pose`, or a number or text itself."""
    return f"a {type(value).__name__}" if isinstance(value, StrictMessage) else reprlib.repr(value)


def _within(cls: type[StrictMessage] | None, item: object) -> str:
    """Show how to make a message of another in it: a PoseStamped of a Pose."""
    if cls is None or not isinstance(item, StrictMessage):
        return ""
    fields = (f.name for f in cls.SCHEMA.fields if f.type.base == item.SCHEMA.name and not f.type.array)
    name = next(fields, "")
    return f": write {cls.__name__}({name}=...)" if name else ""


@made_once
def service_class(name: str) -> type:
    """Return the class of a service, with `Request`, `Response` and `Event`."""
    schema = registry.service_schema(name)
    package, kind, base = name.split("/")
    parts = {"Request": schema.request, "Response": schema.response, "Event": schema.event}
    body = {word: message_class(part.name) for word, part in parts.items()}
    return _NoInstances(base, (), {"__module__": _module(package, kind, base), "NAME": name, **body})


@made_once
def action_class(name: str) -> type:
    """Return the class of an action, with `Goal`, `Result`, `Feedback`, and the carrier types in `Impl`."""
    schema = registry.interface(name)
    assert isinstance(schema, Action)
    package, kind, base = name.split("/")
    carriers = SimpleNamespace(
        SendGoalService=service_class(schema.send_goal.name),
        GetResultService=service_class(schema.get_result.name),
        FeedbackMessage=message_class(schema.feedback_message.name),
        CancelGoalService=service_class("action_msgs/srv/CancelGoal"),
        GoalStatusMessage=message_class("action_msgs/msg/GoalStatusArray"),
    )
    parts = {"Goal": schema.goal, "Result": schema.result, "Feedback": schema.feedback}
    body: dict[str, object] = {word: message_class(part.name) for word, part in parts.items()}
    body |= {"__module__": _module(package, kind, base), "NAME": name, "Impl": carriers}
    return _NoInstances(base, (), body)


def interface_class(name: str) -> type:
    """Return the class of `package/kind/Name`, or of a part of one.

    Raises:
        UnknownInterface, InterfaceError: As for `registry.interface`.
    """
    if "/msg/" in name or "_" in name.rpartition("/")[2]:
        return message_class(name)
    return service_class(name) if isinstance(registry.interface(name), Service) else action_class(name)


def type_name(cls: Any) -> str:
    """Return the `package/kind/Name` of a message, service or action class. Raises AttributeError for anything else."""
    return str(cls.SCHEMA.name if hasattr(cls, "SCHEMA") else cls.NAME)

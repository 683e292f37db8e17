"""Makes Python classes from schemas.

A class's constructor is written for its fields, so that the usual case (floats where floats belong) costs one type
test per field; everything else goes through `values.convert`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from graphflow.msgs import base
from graphflow.msgs.values import Nested, convert
from graphflow.msgs.views import VIEWS
from graphflow.times import DurationFields, TimeFields
from graphflow.wire import schema
from graphflow.wire.schema import INTEGER_RANGES, Field, Message

if TYPE_CHECKING:
    from graphflow.wire.cdr import Codec

Classes = Callable[[str], type]
"""Finds the class of `package/kind/Name`."""

ARITHMETIC = {"builtin_interfaces/msg/Time": (TimeFields,), "builtin_interfaces/msg/Duration": (DurationFields,)}
"""Message types that can be added, subtracted and compared."""
_EXACT = {"bool": bool, "float64": float, "string": str}
"""Types whose values need no further check when their Python type is exactly this and they have no bound."""


def message_class(message: Message, classes: Classes, codec: Callable[[], Codec]) -> type[base.Message]:
    """The class of one message type.

    Args:
        classes: Finds the classes of nested types.
        codec: Finds the codec of the type, when it is first needed.
    """
    package, kind, name = message.name.split("/")
    nested: Nested = {f.type.base: classes(f.type.base) for f in message.fields if not f.type.is_primitive}
    has_arrays = any(f.type.array and f.type.base in schema.NUMERIC for f in message.fields)
    namespace: dict[str, Any] = {
        "__slots__": (*(f.name for f in message.fields), *(["_lent"] if has_arrays else [])),
        "__module__": f"graphflow.msgs.{package}.{kind}",
        "__doc__": f"{message.name}: {', '.join(f'{f.type} {f.name}' for f in message.fields) or 'no fields'}.",
        "SCHEMA": message,
        "NESTED": nested,
        "CODEC": staticmethod(codec),
        "__init__": _constructor(message, nested),
        **{c.name: c.value for c in message.constants},
    }
    if message.name in VIEWS:
        namespace["to_numpy"] = VIEWS[message.name]
    return type(name, (*ARITHMETIC.get(message.name, ()), base.Message), namespace)


def service_class(service: schema.Service, classes: Classes) -> type[base.Service[Any, Any]]:
    """The class that holds a service's message classes."""
    package, kind, name = service.name.split("/")
    return type(
        name,
        (base.Service,),
        {
            "__module__": f"graphflow.msgs.{package}.{kind}",
            "NAME": service.name,
            "Request": classes(service.request.name),
            "Response": classes(service.response.name),
            "Event": classes(service.event.name),
        },
    )


def action_class(action: schema.Action, classes: Classes) -> type[base.Action[Any, Any, Any]]:
    """The class that holds an action's message classes."""
    package, kind, name = action.name.split("/")
    parts = {"Goal": action.goal, "Result": action.result, "Feedback": action.feedback}
    return type(
        name,
        (base.Action,),
        {
            "__module__": f"graphflow.msgs.{package}.{kind}",
            "NAME": action.name,
            "Handle": base.ServerGoalHandle,
            **{word: classes(part.name) for word, part in parts.items()},
        },
    )


def _constructor(message: Message, nested: Nested) -> Callable[..., None]:
    # No field can have a name in capitals, so none hides what the constructor refers to.
    names: dict[str, Any] = {"CONVERT": convert, "ABSENT": _ABSENT, "REFUSE": _refuse}
    parameters, lines = [], []
    for i, field in enumerate(message.fields):
        name, type_ = field.name, field.type
        names[f"F{i}"] = field
        if type_.is_primitive and not type_.array:
            names[f"D{i}"] = default = _scalar_default(field)
            parameters.append(f"{name}=D{i}")
            exact = _EXACT.get(type_.base) if not type_.string_bound else None
            if exact is not None and type(default) is exact:
                names[f"E{i}"] = exact
                lines.append(f"SELF.{name} = {name} if {name}.__class__ is E{i} else CONVERT(F{i}, {name}, SELF)")
            else:
                lines.append(f"SELF.{name} = {name} if {name} is D{i} else CONVERT(F{i}, {name}, SELF)")
        else:
            parameters.append(f"{name}=ABSENT")
            names[f"M{i}"] = make = _factory(field, nested)
            if not type_.is_primitive and not type_.array:
                names[f"E{i}"] = make
                lines.append(f"if {name} is ABSENT: SELF.{name} = M{i}()")
                lines.append(f"elif {name}.__class__ is E{i}: SELF.{name} = {name}")
                lines.append(f"else: SELF.{name} = CONVERT(F{i}, {name}, SELF)")
            else:
                lines.append(f"SELF.{name} = M{i}() if {name} is ABSENT else CONVERT(F{i}, {name}, SELF)")
    head = f"def __init__({', '.join(['SELF, /, *ARGUMENTS', *parameters, '**OTHERS'])}):"
    source = "\n    ".join([head, "if ARGUMENTS or OTHERS: REFUSE(SELF, OTHERS)", *lines])
    exec(compile(source, f"<{message.name}>", "exec"), names)  # noqa: S102 - written above from a checked schema
    init: Callable[..., None] = names["__init__"]
    return init


def _refuse(message: base.Message, others: dict[str, Any]) -> None:
    """Raise TypeError for arguments that are no fields."""
    cls = type(message)
    if not others:
        example = f"{cls.SCHEMA.fields[0].name}=..." if cls.SCHEMA.fields else ""
        raise TypeError(f"{base.name_of(cls)} takes its fields by name: {cls.__name__.rpartition('_')[2]}({example})")
    raise TypeError(base.no_field(cls, next(iter(others))))


class _Absent:
    def __repr__(self) -> str:
        return "<default>"


_ABSENT = _Absent()


def _scalar_default(field: Field) -> Any:
    if field.default is not None:
        return field.default
    if field.type.base in INTEGER_RANGES:
        return 0
    return {"string": "", "wstring": "", "bool": False}.get(field.type.base, 0.0)


def _factory(field: Field, nested: Nested) -> Callable[[], Any]:
    """Makes the default of an array or a nested message."""
    type_ = field.type
    if not type_.is_primitive and not type_.array:
        return nested[type_.base]
    if type_.base in schema.NUMERIC:
        default, count = field.default, type_.size if type_.array == "fixed" else 0

        def make_array() -> Any:
            from graphflow.wire.arrays import as_array, zeros

            return zeros(type_.base, count) if default is None else as_array(default, type_.base).copy()

        return make_array
    if isinstance(field.default, list):
        return field.default.copy
    if type_.array != "fixed":
        return list
    if type_.is_primitive:
        return lambda: [""] * type_.size
    cls = nested[type_.base]
    return lambda: [cls() for _ in range(type_.size)]

"""The builder of Python classes from schemas.

A message is a struct of msgspec, created in C. Its check is generated for its fields, so that the usual case (floats
where floats belong) costs one type test per field; all other values go through `values.convert`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from msgspec import defstruct
from msgspec import field as struct_field

from graphflow.msgs import base
from graphflow.msgs.values import Nested, convert
from graphflow.msgs.views import VIEWS
from graphflow.times import DurationFields, TimeFields
from graphflow.wire import schema
from graphflow.wire.cdr.unchecked import LENT
from graphflow.wire.schema import INTEGER_RANGES, Field, FieldType, Message

if TYPE_CHECKING:
    from graphflow.wire.cdr.codec import Codec

Classes = Callable[[str], type]
"""Returns the class of `package/kind/Name`."""

ARITHMETIC = {"builtin_interfaces/msg/Time": (TimeFields,), "builtin_interfaces/msg/Duration": (DurationFields,)}
"""Message types with arithmetic and comparison."""


def message_class(message: Message, classes: Classes, codec: Callable[[], Codec]) -> type[base.Message]:
    """Build the class of a message type.

    Args:
        classes: Returns the classes of nested types.
        codec: Returns the codec of the type, when it is first needed.
    """
    package, kind, name = message.name.split("/")
    nested: Nested = {f.type.base: classes(f.type.base) for f in message.fields if not f.type.is_primitive}
    has_arrays = any(f.type.array and f.type.base in schema.NUMERIC for f in message.fields)
    namespace: dict[str, Any] = {
        "__doc__": f"{message.name}: {', '.join(f'{f.type} {f.name}' for f in message.fields) or 'no fields'}.",
        "SCHEMA": message,
        "NESTED": nested,
        "CODEC": staticmethod(codec),
        **{c.name: c.value for c in message.constants},
    }
    if message.fields:
        namespace["__post_init__"] = _check(message, nested)
    if has_arrays:
        namespace |= {"__getattr__": base.lent_or_missing, "__copy__": base.copy_of_arrays}
    if message.name in VIEWS:
        namespace["to_numpy"] = VIEWS[message.name]
    fields = [(f.name, Any, _default(f, nested)) for f in message.fields]
    made: Any = defstruct(
        name,
        [*fields, (LENT, Any, None)] if has_arrays else fields,
        bases=(*ARITHMETIC.get(message.name, ()), base.Message),
        module=f"graphflow.msgs.{package}.{kind}",
        namespace=namespace,
        kw_only=True,
        eq=False,
    )
    cls: type[base.Message] = made
    return cls


def service_class(service: schema.Service, classes: Classes) -> type[base.Service[Any, Any]]:
    """Build the class with a service's message classes."""
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
    """Build the class with an action's message classes."""
    package, kind, name = action.name.split("/")
    parts = {"Goal": action.goal, "Result": action.result, "Feedback": action.feedback}
    return type(
        name,
        (base.Action,),
        {
            "__module__": f"graphflow.msgs.{package}.{kind}",
            "NAME": action.name,
            "Handle": base.ServerGoalHandle,
            **{name: classes(part.name) for name, part in parts.items()},
        },
    )


def _check(message: Message, nested: Nested) -> Callable[[base.Message], None]:
    """Generate `__post_init__`, which checks and converts the constructor's arguments."""
    # Names in capitals: no field can have one that hides a name of the function.
    names: dict[str, Any] = {"CONVERT": convert, "CONVERT_ALL": _convert_all, "ABSENT": _ABSENT}
    tests, lines, single = [], [], []
    for i, field in enumerate(message.fields):
        value = f"SELF.{field.name}"
        if field.type.array:
            names[f"F{i}"], names[f"M{i}"] = field, _array_factory(field, nested)
            lines.append(f"{value} = M{i}() if {value} is ABSENT else CONVERT(F{i}, {value}, SELF)")
        else:
            single.append(field)
            names[f"C{i}"] = nested.get(field.type.base)
            tests.append(_fits(field.type, value) if field.type.is_primitive else f"{value}.__class__ is C{i}")
    if tests:
        names["FIELDS"] = tuple(single)
        lines.insert(0, f"if not ({' and '.join(tests)}): CONVERT_ALL(FIELDS, SELF)")
    source = "\n    ".join(["def __post_init__(SELF):", *lines])
    exec(compile(source, f"<{message.name}>", "exec"), names)  # noqa: S102 - written above from a checked schema
    check: Callable[[base.Message], None] = names["__post_init__"]
    return check


def _fits(type_: FieldType, value: str) -> str:
    """Return an expression that is true for the usual values of a type, and false for all that need conversion."""
    match type_.base:
        case "bool":
            return f"{value}.__class__ is bool"
        case "float64":
            return f"{value}.__class__ is float"
        case "float32":
            # Well below the largest float32: `convert` decides beyond that.
            return f"{value}.__class__ is float and -1e38 < {value} < 1e38"
        case "string" if not type_.string_bound:
            return f"{value}.__class__ is str"
        case "string" | "wstring":
            # The bound counts bytes or UTF-16 code units, of which ASCII has as many as characters.
            bound = f" and len({value}) <= {type_.string_bound}" if type_.string_bound else ""
            return f"{value}.__class__ is str and {value}.isascii(){bound}"
        case integer:
            low, high = INTEGER_RANGES[integer]
            return f"{value}.__class__ is int and {low} <= {value} <= {high}"


def _convert_all(fields: tuple[Field, ...], message: base.Message) -> None:
    for field in fields:
        setattr(message, field.name, convert(field, getattr(message, field.name), message))


class _Absent:
    def __repr__(self) -> str:
        return "<default>"


_ABSENT = _Absent()


def _default(field: Field, nested: Nested) -> object:
    """Return the default of a field for msgspec; that of an array is created by `__post_init__`."""
    if field.type.array:
        return _ABSENT
    if not field.type.is_primitive:
        cls: Any = nested[field.type.base]
        is_flat = all(f.type.is_primitive and not f.type.array for f in cls.SCHEMA.fields)
        # If all defaults are constants, a copy equals a new message, and needs no check.
        return struct_field(default_factory=cls().__copy__ if is_flat else cls)
    if field.default is not None:
        return field.default
    if field.type.base in INTEGER_RANGES:
        return 0
    return {"string": "", "wstring": "", "bool": False}.get(field.type.base, 0.0)


def _array_factory(field: Field, nested: Nested) -> Callable[[], object]:
    """Return the factory of an array's default."""
    type_ = field.type
    if type_.base in schema.NUMERIC:
        default, count = field.default, type_.size if type_.array == "fixed" else 0

        def make_array() -> object:
            from graphflow.wire.cdr.arrays import as_array, zeros

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

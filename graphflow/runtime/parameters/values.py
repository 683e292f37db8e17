"""Conversion of parameter values to rcl_interfaces/msg/ParameterValue and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graphflow.errors import ParameterError
from graphflow.interface import TYPE_NAMES

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces import msg as rcl

VALUE_FIELDS = (
    "",
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "byte_array_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
)
"""The field of ParameterValue for each type number."""


def to_message(value: Any, type_: int) -> rcl.ParameterValue:
    """Convert a value to a message.

    Args:
        type_: A type number of rcl_interfaces/msg/ParameterType.
    """
    from graphflow.msgs.rcl_interfaces.msg import ParameterValue

    return ParameterValue(type=type_, **{VALUE_FIELDS[type_]: value}) if type_ else ParameterValue()


def from_message(message: rcl.ParameterValue) -> Any:
    """Convert a message to a Python value; None if it is not set.

    Raises:
        ParameterError: The type number is not one of ROS 2's.
    """
    if message.type == 0:
        return None
    if message.type >= len(VALUE_FIELDS):
        raise ParameterError(f"{message.type} is not a parameter type")
    value = getattr(message, VALUE_FIELDS[message.type])
    if message.type == 5:
        return bytes(value)
    return value.tolist() if hasattr(value, "tolist") else value


def type_word(type_: int) -> str:
    """Return the start of `param get`'s output: `Integer value is`, `Double values are`."""
    name = TYPE_NAMES[type_]
    word = name.removesuffix(" array").capitalize()
    return f"{word} values are" if name.endswith("array") else f"{word} value is"

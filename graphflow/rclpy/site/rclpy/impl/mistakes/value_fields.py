"""Fields of a parameter's value that do not match its type: `get_parameter_value().double_value` of an integer.

They have their defaults, 0.0 here; ROS 2 does not report it.
"""

from __future__ import annotations

import logging
from types import CodeType
from typing import TYPE_CHECKING

from rclpy.impl.callers import Caller, caller

if TYPE_CHECKING:
    from rcl_interfaces.msg import ParameterValue

    from rclpy.parameter import Parameter


FIELDS = (
    *("", "bool_value", "integer_value", "double_value", "string_value", "byte_array_value", "bool_array_value"),
    *("integer_array_value", "double_array_value", "string_array_value"),
)
"""The field for each type, by the numbers of rcl_interfaces/msg/ParameterType."""
_EXAMPLES = ("", False, 0, 0.0, "", [b"\0"], [False], [0], [0.0], [""])
_seen: set[tuple[CodeType, int, int]] = set()
"""The calls that have been checked, each with a type."""
SEEN_BOUND = 1000
"""The number of calls to remember; further ones, as of a program that keeps compiling code, are not checked."""
logger = logging.getLogger("graphflow")


def check(parameter: Parameter, message: ParameterValue) -> None:
    """Warn, once per line and type, if the code that gets a value reads a field that does not match its type.

    Args:
        message: The value, as rcl_interfaces/msg/ParameterValue.
    """
    asked = caller(2)
    if asked is None or len(_seen) >= SEEN_BOUND:
        return
    call = (asked.frame.f_code, asked.frame.f_lasti, message.type)
    if call not in _seen:
        _seen.add(call)
        _warn(asked, parameter, message)


def _warn(asked: Caller, parameter: Parameter, message: ParameterValue) -> None:
    read, own = asked.reads, FIELDS[message.type]
    if "type" in read or own in read:  # the code distinguishes types itself
        return
    for field in sorted(read & set(FIELDS[1:])):
        value = getattr(message, field)
        value = list(value) if field.endswith("_array_value") else value
        if own:
            text = f"{parameter.name} is {_a(parameter.type_.name)}: .{own} has the value, .{field} is {value!r}"
        else:
            example = f"declare_parameter({parameter.name!r}, {_EXAMPLES[FIELDS.index(field)]!r})"
            text = f"{parameter.name} has no value, so that .{field} is {value!r}: give it one, as in {example}"
        logger.warning("%s: %s", asked.place, text)


def _a(type_name: str) -> str:
    words = type_name.lower().replace("_", " ")
    return f"an {words}" if words.startswith("i") else f"a {words}"

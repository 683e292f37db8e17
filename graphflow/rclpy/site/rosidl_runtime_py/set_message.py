"""Assignment of message fields from plain data, as read from YAML."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from graphflow.rclpy.messages.classes import StrictMessage, message_class


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Callable[..., None]]:
    """Set fields of a message; nested messages are given as mappings.

    Args:
        expand_header_auto: Whether a header may be `auto`.
        expand_time_now: Whether a time may be `now`.

    Returns:
        Functions that set such stamps to a time.

    Raises:
        AttributeError: The message has no such field.
        TypeError, ValueError, AssertionError: A value is not of the field's type.
    """
    stamps: list[Callable[..., None]] = []
    _set(msg, values, stamps, expand_header_auto, expand_time_now)
    return stamps


def _set(msg: Any, values: object, stamps: list[Callable[..., None]], auto: bool, now: bool) -> None:
    if not isinstance(values, Mapping):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    types = {field.name: field.type for field in msg.SCHEMA.fields}
    for name, given in values.items():
        held = getattr(msg, name)
        if isinstance(held, StrictMessage):
            schema = held.SCHEMA.name
            if schema == "std_msgs/msg/Header" and given == "auto" and auto:
                stamps.append(partial(setattr, held, "stamp"))
            elif schema == "builtin_interfaces/msg/Time" and given == "now" and now:
                stamps.append(partial(setattr, msg, name))
            elif isinstance(given, type(held)):
                setattr(msg, name, given)
            else:
                _set(held, given, stamps, auto, now)
        elif types[name].array and not types[name].is_primitive:
            cls = message_class(types[name].base)
            made = [cls() for _ in given]
            for message, part in zip(made, given, strict=True):
                _set(message, part, stamps, auto, now)
            setattr(msg, name, made)
        else:
            setattr(msg, name, _converted(held, given))


def _converted(held: Any, given: Any) -> object:
    """Convert a value to the type that the field holds."""
    if isinstance(held, array):
        return array(held.typecode, given)
    if isinstance(held, np.ndarray):
        return np.array(given, dtype=held.dtype)
    return given if type(given) is type(held) else type(held)(given)

"""`header: auto` and `stamp: now` in messages on the command line: the time of publication, as in ROS 2."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from graphflow.msgs import registry

if TYPE_CHECKING:
    from graphflow.msgs.base import Message

HEADER, TIME = "std_msgs/msg/Header", "builtin_interfaces/msg/Time"
Path = tuple[str, ...]


def split_stamps(type_name: str, values: object) -> tuple[object, list[Path]]:
    """Remove `auto` and `now` from the values of a message; return the rest and the fields to stamp.

    Args:
        type_name: The message's type.
        values: The parsed YAML.
    """
    if not isinstance(values, dict):
        return values, []
    types = {f.name: f.type for f in registry.message_schema(type_name).fields}
    kept, stamps = {}, list[Path]()
    for name, value in values.items():
        type_ = types.get(name)
        if type_ is None or type_.array or type_.is_primitive:
            kept[name] = value
        elif value == "auto" and type_.base == HEADER:
            stamps.append((name, "stamp"))
        elif value == "now" and type_.base == TIME:
            stamps.append((name,))
        else:
            kept[name], inner = split_stamps(type_.base, value)
            stamps += [(name, *path) for path in inner]
    return kept, stamps


def stamp(message: Message, paths: Iterable[Path], time_ns: int) -> None:
    """Set fields of a message to a time."""
    for path in paths:
        field: Any = message
        for name in path:
            field = getattr(field, name)
        field.sec, field.nanosec = divmod(time_ns, 10**9)

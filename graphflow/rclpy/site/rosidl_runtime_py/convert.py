"""Conversion of messages to plain data, YAML and comma-separated values.

Source: rosidl_runtime_py.convert, including its notation for omitted and truncated values.
"""

from __future__ import annotations

import sys
from array import array
from collections import OrderedDict
from typing import Any

import numpy as np
import yaml

from graphflow.rclpy.messages.values import WORDS
from graphflow.wire.schema import FieldType


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Convert a message to mappings, lists and scalars.

    Args:
        truncate_length: The number of elements or characters to keep of long arrays and texts.
        no_arr: Whether arrays are shown by type and length alone.
        no_str: Whether texts are shown by length alone.
    """

    def plain(value: Any, type_: FieldType | None = None) -> Any:
        if isinstance(value, bytes):
            return cut(value.decode("latin-1"))
        if isinstance(value, str):
            return f"<string length: <{len(value)}>>" if no_str else cut(value)
        if isinstance(value, (list, tuple, array, np.ndarray)):
            if no_arr and type_ is not None:
                return _array_info(value, type_)
            kept = [plain(item) for item in value[:truncate_length]]
            return [*kept, "..."] if len(kept) < len(value) else kept
        if isinstance(value, np.number):
            return value.item()
        return value if isinstance(value, (bool, float, int)) else whole(value)

    def cut(text: str) -> str:
        return text[:truncate_length] + "..." if truncate_length is not None and len(text) > truncate_length else text

    def whole(message: Any) -> OrderedDict[str, Any]:
        fields = message.SCHEMA.fields
        return OrderedDict((field.name, plain(getattr(message, field.name), field.type)) for field in fields)

    return whole(msg)


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Convert a message to YAML. Arguments as for `message_to_ordereddict`."""
    data = message_to_ordereddict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    return yaml.dump(
        data, Dumper=_Dumper, allow_unicode=True, width=sys.maxsize, default_flow_style=flow_style, sort_keys=False
    )


class _Dumper(yaml.Dumper):
    def ignore_aliases(self, data: Any) -> bool:
        return True


_Dumper.add_representer(OrderedDict, lambda dumper, data: dumper.represent_dict(data.items()))


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Convert a message to comma-separated values. Arguments as for `message_to_ordereddict`."""

    def words(value: Any, type_: FieldType | None = None) -> str:
        if isinstance(value, (list, tuple, array, np.ndarray)):
            if no_arr and type_ is not None:
                return _array_info(value, type_)
            kept = [words(item) for item in value[:truncate_length]]
            return ",".join([*kept, "..."] if len(kept) < len(value) else kept)
        if isinstance(value, str) and no_str:
            value = f"<string length: <{len(value)}>>"
        if isinstance(value, (bytes, str)) and truncate_length is not None and len(value) > truncate_length:
            value = value[:truncate_length] + (b"..." if isinstance(value, bytes) else "...")  # type: ignore[operator]
        if hasattr(value, "SCHEMA"):
            return ",".join(words(getattr(value, field.name), field.type) for field in value.SCHEMA.fields)
        return str(value)

    return words(msg)


def _array_info(value: Any, type_: FieldType) -> str:
    base = WORDS.get(type_.base, type_.base)
    match type_.array:
        case "fixed":
            return f"<array type: {base}[{type_.size}]>"
        case "bounded":
            return f"<sequence type: {base}[{type_.size}], length: {len(value)}>"
    return f"<sequence type: {base}, length: {len(value)}>"

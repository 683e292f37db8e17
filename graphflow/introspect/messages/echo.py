"""Messages as text: YAML blocks and flow style as `ros2 topic echo` prints them, plain values for JSON."""

from __future__ import annotations

import math
from typing import Any

from graphflow.msgs.base import Message

TRUNCATE = 128
"""Elements and characters shown of long arrays and strings."""


def plain(value: Any, limit: int | None = None) -> Any:
    """Convert a message to dicts, lists and scalars.

    Args:
        limit: Elements of lists that will be shown; one more is kept, by which `truncated` sees that there are more.
            Without it, an image would become a list of eight bytes per byte.
    """
    kept = None if limit is None else limit + 1
    if isinstance(value, Message):
        return {f.name: plain(getattr(value, f.name), limit) for f in value.SCHEMA.fields}
    if hasattr(value, "tolist"):
        return value[:kept].tolist() if getattr(value, "ndim", 0) else value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(item, limit) for item in value[:kept]]
    return value


def truncated(value: object, limit: int | None = TRUNCATE) -> Any:
    """Cut long lists and strings in plain data; cuts are marked by `...`."""
    if limit is None:
        return value
    if isinstance(value, dict):
        return {k: truncated(v, limit) for k, v in value.items()}
    if isinstance(value, list):
        cut = [truncated(v, limit) for v in value[:limit]]
        return [*cut, "..."] if len(value) > limit else cut
    if isinstance(value, str) and len(value) > limit:
        return value[:limit] + "..."
    return value


def block(data: object, indent: int = 0) -> str:
    """Format plain data as YAML in block style."""
    pad = "  " * indent
    if isinstance(data, dict):
        if not data:
            return f"{pad}{{}}"
        return "\n".join(_entry(f"{pad}{key}:", value, indent) for key, value in data.items())
    if isinstance(data, list):
        return "\n".join(_item(value, indent) for value in data) or f"{pad}[]"
    return pad + scalar(data)


def _entry(head: str, value: object, indent: int) -> str:
    if isinstance(value, dict) and value:
        return f"{head}\n{block(value, indent + 1)}"
    if isinstance(value, list) and value:
        return f"{head}\n{block(value, indent)}"
    return f"{head} {flow(value)}"


def _item(value: object, indent: int) -> str:
    pad = "  " * indent
    if isinstance(value, (dict, list)) and value:
        return f"{pad}- {block(value, indent + 1).lstrip()}"
    return f"{pad}- {flow(value)}"


def flow(data: object) -> str:
    """Format plain data as YAML on one line."""
    if isinstance(data, dict):
        return "{" + ", ".join(f"{k}: {flow(v)}" for k, v in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(flow(v) for v in data) + "]"
    return scalar(data)


def scalar(value: object) -> str:
    """Format one value as YAML that parses to the same value."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str):
        return _string(value)
    return str(value)


def _number(value: float) -> str:
    if math.isnan(value):
        return ".nan"
    if math.isinf(value):
        return ".inf" if value > 0 else "-.inf"
    return repr(value)


def _string(text: str) -> str:
    from graphflow.markup.source import scalar as read

    plain_safe = (
        text
        and text == text.strip()
        and text.isprintable()
        and not any(c in text for c in '"\\#{}[],&*|>%@`')
        and ": " not in text
        and not text.endswith(":")
        and text[0] not in "!?-':"
        and isinstance(read(text), str)
    )
    # The mark of `truncated` is no text of the message, and has no quotes.
    if plain_safe or text == "...":
        return text
    if text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    return '"' + text.encode("unicode_escape").decode().replace('"', '\\"') + '"'


def csv(data: object) -> str:
    """Format the leaves of plain data, separated by commas."""
    if isinstance(data, dict):
        return ",".join(csv(v) for v in data.values())
    if isinstance(data, list):
        return ",".join(csv(v) for v in data)
    return str(data)

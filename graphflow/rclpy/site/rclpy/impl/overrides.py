"""Parameter values from the command line and from files, and their notation for a parameter's type."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rclpy.parameter import Parameter

Kind = Parameter.Type
_SINGLE = {
    Kind.BOOL_ARRAY: Kind.BOOL,
    Kind.INTEGER_ARRAY: Kind.INTEGER,
    Kind.DOUBLE_ARRAY: Kind.DOUBLE,
    Kind.STRING_ARRAY: Kind.STRING,
}
"""The types of the elements of arrays."""
_TRUTHS = {"1": "true", "true": "true", "0": "false", "false": "false"}


def as_parameters(values: Mapping[str, tuple[object, str]]) -> dict[str, Parameter]:
    """Convert values, each with its source, to parameters.

    Raises:
        TypeError: No parameter can have such a value; a note gives its source.
    """
    found: dict[str, Parameter] = {}
    for name, (value, source) in values.items():
        try:
            found[name] = Parameter(name, value=value)
        except TypeError as error:
            kind = Kind.DOUBLE_ARRAY if isinstance(value, list) else Kind.STRING
            error.add_note(f"note: {remark(name, value, source, kind)}")
            raise
    return found


def remark(name: str, value: Any, source: str, kind: Parameter.Type) -> str:
    """Describe the source of a value, and its notation for a parameter of some type."""
    written = _written(value, kind)
    if source == "command line":
        way = f'-p "{name}:={written}"' if set(written) & set(" '[") else f"-p {name}:={written}"
        where = "on the command line"
    else:
        way, where = f"{name.rpartition('.')[2]}: {written}", f"in {Path(source).name}"
    return f"{name} is set {where}" + (f": write {way}" if written else "")


def _written(value: Any, kind: Parameter.Type) -> str:
    """Return a value in YAML notation for a type; empty if it cannot be of that type."""
    if kind in _SINGLE:
        items = value if isinstance(value, list) else str(value).strip("()").replace(";", ",").split(",")
        parts = [_written(item.strip() if isinstance(item, str) else item, _SINGLE[kind]) for item in items]
        return f"[{', '.join(parts)}]" if all(parts) else ""
    text = str(value)
    try:
        match kind:
            case Kind.BOOL:
                return _TRUTHS.get(text.lower(), "")
            case Kind.INTEGER:
                return str(int(float(text))) if float(text).is_integer() else ""
            case Kind.DOUBLE:
                return str(float(text.replace(",", ".")))
            case Kind.STRING:
                return "" if isinstance(value, (list, dict)) else f"'{text}'"
    except ValueError:  # it is no number
        return ""
    return ""

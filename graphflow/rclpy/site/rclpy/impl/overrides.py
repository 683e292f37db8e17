"""Parameter values from the command line and from files, and their notation for a parameter's type."""

from __future__ import annotations

import linecache
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from graphflow.markup.substitution_words import as_argument
from rclpy.parameter import Parameter

Kind = Parameter.Type
_SINGLE = {
    Kind.BOOL_ARRAY: Kind.BOOL,
    Kind.INTEGER_ARRAY: Kind.INTEGER,
    Kind.DOUBLE_ARRAY: Kind.DOUBLE,
    Kind.STRING_ARRAY: Kind.STRING,
}
"""The types of the elements of arrays."""
_PYTHON = {Kind.BOOL: "bool", Kind.INTEGER: "int", Kind.DOUBLE: "float", Kind.STRING: "str"}
_TRUE_PYTHON = {"true": "True", "false": "False"}
_NEEDED = {Kind.BOOL: "true or false", Kind.INTEGER: "an integer, such as 2", Kind.DOUBLE: "a number, such as 2.0"}
_FOLLOWING = 20
"""Lines after the first one of a node in which a launch file may set its parameters."""
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
        where, way = "on the command line", f"-p {name}:={written}"
        if set(written) & set(" '["):
            way = f'-p "{name}:={written}"'
    else:
        where, way = f"in {Path(source).name}", _in_file(name, written, source, kind)
    if isinstance(value, str) and _is_argument(value, source):
        way = as_argument(value, source.partition(":")[0])
        return f"{name} is set {where} to the text {value!r}: for the argument of that name write {way}"
    if not written and kind in _NEEDED:
        of_double = f", or, for a double, declare_parameter({name!r}, 1.0)" if isinstance(value, float) else ""
        return f"{name} is set {where}: it needs {_NEEDED[kind]}{of_double}"
    other = f", or declare it as declare_parameter({name!r}, {value})" if isinstance(value, bool) else ""
    return f"{name} is set {where}" + (f": write {way}{other}" if written and way else "")


def _is_argument(text: str, source: str) -> bool:
    """Whether a text is the name of an argument of the launch file that sets it, and no substitution made it."""
    lines = linecache.getlines(source.partition(":")[0])
    begin = r"""(DeclareLaunchArgument\(\s*(name=)?|<arg\s+name=|\barg:\s*\{?\s*name:\s*)["']?"""
    declares = re.compile(rf"{begin}{re.escape(text)}\b")
    return text.isidentifier() and ".launch." in source and declares.search("".join(lines)) is not None


def _in_file(name: str, written: str, source: str, kind: Parameter.Type) -> str:
    """Return a parameter in the form of the file that sets it; empty if a substitution there makes its value."""
    file, _, place = source.partition(":")
    last = name.rpartition(".")[2]
    lines = linecache.getlines(file)
    number = int(place.partition(":")[0] or 1) if place[:1].isdecimal() else 1
    if file.endswith(".py"):  # the line is that of the node, whose parameters follow
        quoted = (f'"{name}"', f"'{name}'")
        line = next((line for line in lines[number - 1 : number + _FOLLOWING] if any(q in line for q in quoted)), "")
        if "LaunchConfiguration(" in line and kind in _PYTHON:
            return f"ParameterValue(LaunchConfiguration(...), value_type={_PYTHON[kind]})"
        return "" if "(" in line.partition(":")[2] else f'"{name}": {_TRUE_PYTHON.get(written, written)}'
    line = lines[number - 1] if number <= len(lines) else ""
    if (argument := re.search(r"\$\(var (\w+)\)", line)) is not None and written:
        is_xml = file.endswith((".xml", ".launch"))
        kinds = _PYTHON.get(kind, "str")
        there = f'type="{kinds}"' if is_xml else f"type: {kinds}"
        return f"{argument[1]}:={written}" + (f", or add there {there}" if is_xml or ".launch." in file else "")
    if "$(" in line:
        return ""
    if file.endswith((".xml", ".launch")):
        return f'value="{written}"'
    return f"value: {written}" if ".launch." in file else f"{last}: {written}"


def _written(value: Any, kind: Parameter.Type) -> str:
    """Return a value in YAML notation for a type; empty if it cannot be of that type."""
    if kind in _SINGLE:
        items = value if isinstance(value, list) else str(value).strip("()").replace(";", ",").split(",")
        parts = [_written(item.strip() if isinstance(item, str) else item, _SINGLE[kind]) for item in items]
        return f"[{', '.join(parts)}]" if all(parts) else ""
    text = str(value).lower() if isinstance(value, bool) else str(value)
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

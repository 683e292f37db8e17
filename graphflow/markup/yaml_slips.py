"""Corrections for lines that YAML reads otherwise than they are meant."""

from __future__ import annotations

import re
from collections.abc import Sequence

_CLASS = re.compile(r"\b(class\s*:\s*)([A-Za-z_][\w./-]*):\s+([A-Za-z_]\w*)")
"""A class with a space in it: `class: nodes.base: Base`."""
_KEYS = "class|pkg|exec|command|params|remap|env|template|call|goal|delay|log|default|namespace|file"
_OPENED = re.compile(rf"\s*(?:- +)?([\w/.-]+): +({_KEYS}): +([^\s{{\[#][^#]*?)\s*(?:#.*)?")
"""A key after a key: `/base: class: nodes.base:Base`."""
_UNSPACED = re.compile(r"( *(?:- +)?)([A-Za-z_/][\w/.-]*):(?!//)[^\s:#][^\s{}\[\],]*(?:\s+#.*)?")
"""A key without a space after its colon, which YAML reads as the beginning of a text: `class:nodes.base:Base`."""
_SEVERAL = re.compile(r"\s*(- +)?(\w+): +([^\s:{}\[\]]+),? +(\w+): +([^\s:{}\[\]]+)\s*")
"""Two keys on a line: `pkg: turtlesim exec: turtlesim_node`."""
_TUPLE = re.compile(r"\(([^(){}\[\]]*,[^(){}\[\]]*)\)")
"""A list in parentheses: `(1.0, 2.0)`."""

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_BARE = re.compile(rf"([\w./-]+)\s*:\s*({_NUMBER}(?:\s*,\s*{_NUMBER})+)\s*(?=[,}}])")
"""A list without brackets within braces: `{via: 2.0, 5.0, 8.0}`."""


def of_line(line: str) -> str:
    """Return the correction of a line that YAML refuses; empty if none is known."""
    if found := _CLASS.search(line):
        return f"write {found[1]}{found[2]}:{found[3]} without the space"
    if found := _SEVERAL.fullmatch(line):
        keys = f"{found[2]}: {found[3]}, {found[4]}: {found[5]}"
        return f"write each key on a line of its own, or {{{keys}}}"
    if found := _OPENED.fullmatch(line):
        return f"write {found[1]}: {{{found[2]}: {found[3]}}}, or {found[2]}: on a line of its own, indented"
    return ""


def unspaced_key(lines: Sequence[str], refused: int) -> tuple[int, int, str] | None:
    """Find the keys without a space after their colon above a line that YAML refuses for it.

    YAML reads such a line and the next as one text, in which another colon cannot be.

    Args:
        refused: Index of the refused line.

    Returns:
        Line and column of the first such key, counted from 1, and the key; None if there is none right above.
    """
    first = None
    for number in range(refused, 0, -1):
        line = lines[number - 1]
        if line.strip() and not line.lstrip().startswith("#"):
            if (found := _UNSPACED.fullmatch(line.rstrip())) is None:
                break
            first = number, len(found[1]) + 1, found[2]
    return first


def of_key(key: str, line: str) -> str:
    """Return the correction for a key that is the end of a list in parentheses; empty for others."""
    found = _TUPLE.search(line)
    if found is None or not key.endswith(")") or "(" in key or not found[0].endswith(key):
        return ""
    return as_list(found[0])


def of_number(line: str, column: int) -> str:
    """Return the correction for a key that is a number within a list without brackets; empty for others."""
    for found in _BARE.finditer(line):
        if found.start(2) < column < found.end(2):
            items = ", ".join(item.strip() for item in found[2].split(","))
            return f"a list is written with brackets: {found[1]}: [{items}]"
    return ""


def as_list(text: str) -> str:
    """Return the correction for a text that is meant as a list, `(1.0, 2.0)` or `1.0, 2.0`; empty for others."""
    inner = found[1] if (found := _TUPLE.fullmatch(text)) else text
    items = [item.strip() for item in inner.split(",")]
    if found is None and (
        len(items) < 2 or not all(re.fullmatch(r"[-+]?[\d.]+(?:[eE][-+]?\d+)?", item) for item in items)
    ):
        return ""
    return f"a list is written with brackets: [{', '.join(filter(None, items))}]"

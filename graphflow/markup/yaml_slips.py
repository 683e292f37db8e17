"""Lines that YAML does not read as they are meant, with what to write."""

from __future__ import annotations

import re

_CLASS = re.compile(r"\b(class\s*:\s*)([A-Za-z_][\w./-]*):\s+([A-Za-z_]\w*)")
"""A class with a space in it: `class: nodes.base: Base`."""
_KEYS = "class|pkg|exec|command|params|remap|env|template|call|goal|delay|log|default|namespace|file"
_OPENED = re.compile(rf"\s*(?:- +)?([\w/.-]+): +({_KEYS}): +([^\s{{\[#][^#]*?)\s*(?:#.*)?")
"""A key behind a key: `/base: class: nodes.base:Base`."""
_SEVERAL = re.compile(r"\s*(- +)?(\w+): +([^\s:{}\[\]]+),? +(\w+): +([^\s:{}\[\]]+)\s*")
"""Two keys one after the other: `pkg: turtlesim exec: turtlesim_node`."""
_TUPLE = re.compile(r"\(([^(){}\[\]]*,[^(){}\[\]]*)\)")
"""A list in parentheses: `(1.0, 2.0)`."""

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_BARE = re.compile(rf"([\w./-]+)\s*:\s*({_NUMBER}(?:\s*,\s*{_NUMBER})+)\s*(?=[,}}])")
"""A list within braces, without brackets: `{via: 2.0, 5.0, 8.0}`."""


def of_line(line: str) -> str:
    """What to write for a line that YAML refuses; empty if that is not known."""
    if found := _CLASS.search(line):
        return f"write {found[1]}{found[2]}:{found[3]} without the space"
    if found := _SEVERAL.fullmatch(line):
        keys = f"{found[2]}: {found[3]}, {found[4]}: {found[5]}"
        return f"write each key on a line of its own, or {{{keys}}}"
    if found := _OPENED.fullmatch(line):
        return f"write {found[1]}: {{{found[2]}: {found[3]}}}, or {found[2]}: on a line of its own, indented"
    return ""


def of_key(key: str, line: str) -> str:
    """What to write where a word that was read as a key is the end of a list; empty for others."""
    found = _TUPLE.search(line)
    if found is None or not key.endswith(")") or "(" in key or not found[0].endswith(key):
        return ""
    return as_list(found[0])


def of_number(line: str, column: int) -> str:
    """What to write where a number that was read as a key goes on a list without brackets; empty for others."""
    for found in _BARE.finditer(line):
        if found.start(2) < column < found.end(2):
            items = ", ".join(item.strip() for item in found[2].split(","))
            return f"a list is written with brackets: {found[1]}: [{items}]"
    return ""


def as_list(text: str) -> str:
    """How a list is written that a text is meant as: `(1.0, 2.0)` or `1.0, 2.0`; empty for other texts."""
    inner = found[1] if (found := _TUPLE.fullmatch(text)) else text
    items = [item.strip() for item in inner.split(",")]
    if found is None and (
        len(items) < 2 or not all(re.fullmatch(r"[-+]?[\d.]+(?:[eE][-+]?\d+)?", item) for item in items)
    ):
        return ""
    return f"a list is written with brackets: [{', '.join(filter(None, items))}]"

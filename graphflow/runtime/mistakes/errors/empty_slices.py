"""Slices across the end of a list, `scan.ranges[-20:20]`, which are empty where both ends of a scan were meant."""

from __future__ import annotations

import re

_EMPTY = re.compile(
    "^(min|max)\\(\\) (arg is an empty sequence|iterable argument is empty)|^zero-size array to reduction operation"
)
_ACROSS = re.compile(r"(?P<list>\b[A-Za-z_][\w.]*)\[-(?P<last>\d+) *: *(?P<first>\d+)\]")


def empty_slice(error: BaseException, line: str) -> str:
    """Return how to write a slice that is empty since it wraps around the end; "" if that is not the error.

    Args:
        line: The user's line that raised the error.
    """
    found = _ACROSS.search(line) if isinstance(error, ValueError) and _EMPTY.search(str(error)) else None
    if found is None:
        return ""
    name, last, first = found["list"], found["last"], found["first"]
    return f"{found[0]} is empty, since slices do not wrap: write [*{name}[-{last}:], *{name}[:{first}]]"

"""Indices of lists: no whole number, as in `ranges[len(ranges) / 2]`, or beyond the end, and slices across the end.

Such a slice, as `scan.ranges[-20:20]`, is empty, where both ends of a scan were meant.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable
from typing import cast

_EMPTY = re.compile(
    "^(min|max)\\(\\) (arg is an empty sequence|iterable argument is empty)|^zero-size array to reduction operation"
)
_ACROSS = re.compile(r"(?P<list>\b[A-Za-z_][\w.]*)\[-(?P<last>\d+) *: *(?P<first>\d+)\]")
_INDEXED = re.compile(r"\b([A-Za-z_][\w.]*)\[")
_FRACTION = re.compile(r" indices must be integers(?: or slices, not float|, not 'float'|$)")
_HALVED = re.compile(r"\[ *len\([\w.]+\) */ *\d+ *\]")
_READ = 1000
"""Characters of a line that are read."""


def advise_on_index(error: BaseException, line: str, named: Callable[[str], object]) -> str:
    """Return how to write an index or a slice that has raised an error; "" for other errors.

    Args:
        line: The user's line that raised the error.
        named: Returns the object of a dotted name in that line.
    """
    return _fraction(error, line) or _beyond(error, line, named) or _empty_slice(error, line)


def _beyond(error: BaseException, line: str, named: Callable[[str], object]) -> str:
    paths = set(_INDEXED.findall(line[:_READ]))
    if not isinstance(error, IndexError) or "index out of range" not in str(error) or len(paths) != 1:
        return ""
    path = paths.pop()
    thing = named(path)
    if type(thing) not in (list, tuple, array):  # `len` of a subclass may be the user's
        return ""
    count = len(cast("list[object]", thing))
    if count == 0:
        return f"{path} is empty"
    return f"{path} has {count} value{'s' * (count > 1)}, [0] to [{count - 1}]"


def _fraction(error: BaseException, line: str) -> str:
    if not isinstance(error, TypeError) or not _FRACTION.search(str(error)):
        return ""
    way = "write // in place of /" if _HALVED.search(line[:_READ]) else "convert it with int(...)"
    return f"an index is a whole number: {way}"


def _empty_slice(error: BaseException, line: str) -> str:
    found = _ACROSS.search(line) if isinstance(error, ValueError) and _EMPTY.search(str(error)) else None
    if found is None:
        return ""
    name, last, first = found["list"], found["last"], found["first"]
    return f"{found[0]} is empty, since slices do not wrap: write [*{name}[-{last}:], *{name}[:{first}]]"

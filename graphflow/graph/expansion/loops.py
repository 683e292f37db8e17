"""The values of a loop of a graph file: a list, or a span such as `1..3`."""

from __future__ import annotations

import re
from collections.abc import Sequence

from graphflow.graph.checks.validation import Problems
from graphflow.markup.source import Data
from graphflow.markup.tree import Item

_SPAN = re.compile(r"(-?\d{1,9})\.\.(-?\d{1,9})\Z")


def values_of(over: Item, problems: Problems, *, is_written_out: bool) -> Sequence[Data]:
    """Return the values of a loop; none, with a problem added, if `in:` is no list or span, or has a value twice.

    Args:
        over: The value of `in:`, its substitutions made.
        is_written_out: Whether it had no substitutions, so that an empty span is a mistake.
    """
    values = over.plain()
    span = _SPAN.match(values) if isinstance(values, str) else None
    if span:
        first, last = int(span[1]), int(span[2])
        if first > last and is_written_out:
            problems.add(over.place, f"in: {values} is empty, as a span counts up; write {last}..{first}")
        return range(first, last + 1)
    if not isinstance(values, list):
        problems.add(over.place, f"in: expected a list or a span such as 1..10, got {values!r}")
        return ()
    taken: set[str] = set()
    for value, item in zip(values, over.items, strict=True):
        if repr(value) in taken and over.place.file not in problems.launch_files:
            problems.add(item.place, f"in: {value!r} is in the list twice; remove one")
            return ()
        taken.add(repr(value))
    return values

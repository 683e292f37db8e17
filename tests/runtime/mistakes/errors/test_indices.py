"""Indices that are no whole numbers, and slices that wrap around the end of a list."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from graphflow.runtime.mistakes.errors.indices import advise_on_index

NOTE = "scan.ranges[-20:20] is empty, since slices do not wrap: write [*scan.ranges[-20:], *scan.ranges[:20]]"


def advise(error: BaseException, line: str, thing: object = None) -> str:
    return advise_on_index(error, line, lambda path: thing if path == "scan.ranges" else None)


def raised(fn: Callable[[], object]) -> Exception:
    with pytest.raises((ValueError, TypeError, IndexError), match=r".") as caught:
        fn()
    return caught.value


@pytest.mark.parametrize("fn", [lambda: min([]), lambda: max([]), lambda: np.zeros(0).min(), lambda: np.max([])])
def test_a_slice_across_the_end(fn: Callable[[], object]) -> None:
    """Python's and NumPy's errors have the way to write it."""
    assert advise(raised(fn), "front = min(scan.ranges[-20:20])") == NOTE


@pytest.mark.parametrize(
    "line", ["front = min(scan.ranges[20:-20])", "min(self.found)", "min(scan.ranges[-20:])", "min(ranges[a:b])"]
)
def test_other_lists_that_are_empty(line: str) -> None:
    """There is no advice on them, nor on other errors."""
    assert advise(raised(lambda: min([])), line) == ""
    assert advise(raised(lambda: int("x")), "int(x[-20:20])") == ""


@pytest.mark.parametrize("things", [[1, 2], (1, 2), array("f", [1, 2]), "ab"])
def test_an_index_with_a_fraction(things: Any) -> None:
    """A division has a way of its own; a text as an index is another error, but for arrays, whose text is the same."""
    error = raised(lambda: things[1.0])
    start = "an index is a whole number: "
    assert advise(error, "x = ranges[len(ranges) / 2]") == f"{start}write // in place of /"
    assert advise(error, "x = ranges[self.half] / 2") == f"{start}convert it with int(...)"
    for line in ("x = ranges[n // 2 * 0.5]", "x = ranges[math.radians(30) / scan.angle_increment]"):
        assert advise(error, line) == f"{start}convert it with int(...)"
    if not isinstance(things, array):
        assert advise(raised(lambda: things["a"]), "x = ranges[len(ranges) / 2]") == ""


@pytest.mark.parametrize(
    ("things", "told"),
    [
        ([1, 2], "scan.ranges has 2 values, [0] to [1]"),
        ([1], "scan.ranges has 1 value, [0] to [0]"),
        (array("f"), "scan.ranges is empty"),
        ({}, ""),
    ],
)
def test_an_index_beyond_the_end(things: Any, told: str) -> None:
    """It comes with the number of values; of what is no list, nothing is known."""
    error = raised(lambda: [][360])
    assert advise(error, "front = scan.ranges[360] / scan.ranges[0]", things) == told
    assert advise(error, "front = self.near[0] + scan.ranges[360]", things) == ""  # either may be meant
    assert advise(raised(lambda: [].pop()), "front = scan.ranges[0] = self.near.pop()", things) == ""
    assert advise(error, "front = scan.ranges", things) == ""

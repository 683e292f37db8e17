"""Slices that wrap around the end of a list."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from graphflow.runtime.mistakes.errors.empty_slices import empty_slice

NOTE = "scan.ranges[-20:20] is empty, since slices do not wrap: write [*scan.ranges[-20:], *scan.ranges[:20]]"


def raised(fn: Callable[[], object]) -> ValueError:
    with pytest.raises(ValueError, match=r".") as caught:
        fn()
    return caught.value


@pytest.mark.parametrize("fn", [lambda: min([]), lambda: max([]), lambda: np.zeros(0).min(), lambda: np.max([])])
def test_a_slice_across_the_end(fn: Callable[[], object]) -> None:
    """Python's and NumPy's errors have the way to write it."""
    assert empty_slice(raised(fn), "front = min(scan.ranges[-20:20])") == NOTE


@pytest.mark.parametrize(
    "line", ["front = min(scan.ranges[20:-20])", "min(self.found)", "min(scan.ranges[-20:])", "min(ranges[a:b])"]
)
def test_other_lists_that_are_empty(line: str) -> None:
    """There is no advice on them, nor on other errors."""
    assert empty_slice(raised(lambda: min([])), line) == ""
    assert empty_slice(raised(lambda: int("x")), "int(x[-20:20])") == ""

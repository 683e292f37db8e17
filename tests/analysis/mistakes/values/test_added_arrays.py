"""Slices that are added."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.added_arrays import added_arrays


def test_two_slices() -> None:
    """The sentence has the function that joins them."""
    [(_, text)] = added_arrays(ast.parse("front = m.ranges[:30] + m.ranges[-30:]"))
    assert text.endswith("to join them write numpy.concatenate([m.ranges[:30], m.ranges[-30:]])")


@pytest.mark.parametrize(
    "line", ["a = m.ranges[0] + m.ranges[1]", "a = xs[:3] + xs[3:]", "a = m.ranges[:3] + m.offsets[:3]"]
)
def test_other_sums(line: str) -> None:
    """Numbers, lists and other fields are left alone."""
    assert not list(added_arrays(ast.parse(line)))

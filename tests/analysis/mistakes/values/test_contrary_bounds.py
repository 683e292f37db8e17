"""Conditions on one value that contradict each other."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.contrary_bounds import contrary_bounds


@pytest.mark.parametrize(
    ("condition", "told"),
    [
        ("pose.x > 9.0 and pose.x < 2.0", "pose.x > 9.0 and pose.x < 2.0 is never true; did you mean or?"),
        ("a and x <= 1 and b and x >= 2", "x <= 1 and x >= 2 is never true; did you mean or?"),
        ("self.x > 2.0 or self.x < 9.0", "self.x > 2.0 or self.x < 9.0 is always true; did you mean and?"),
    ],
)
def test_conditions_that_are_always_the_same(condition: str, told: str) -> None:
    """The word that was meant is the other one."""
    assert list(contrary_bounds(ast.parse(f"if {condition}: go()"))) == [(1, told)]


@pytest.mark.parametrize(
    "condition",
    [
        "x > 2.0 and x < 9.0",
        "x > 9.0 or x < 2.0",
        "x > 9.0 and y < 2.0",
        "x > 9.0 and x > 2.0",
        "read() > 9.0 and read() < 2.0",
        "x > 2 and x < 2",
        "x > high and x < low",
        "x != 9.0 and x == 2.0",
    ],
)
def test_other_conditions(condition: str) -> None:
    """Ranges, other values, and calls, which may return something else the second time."""
    assert list(contrary_bounds(ast.parse(f"if {condition}: go()"))) == []

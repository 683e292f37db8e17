"""Comparisons of a battery's charge with percentages."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.wrong_scale import wrong_scale

SOURCE = """
def got(self, message: {type}):
    if {condition}:
        self.get_logger().warning("low")
"""


@pytest.mark.parametrize(("condition", "value"), [("message.percentage < 20", "0.2"), ("15.0 >= m.percentage", "0.15")])
def test_a_percentage(condition: str, value: str) -> None:
    """The sentence has the fraction."""
    [(line, text)] = wrong_scale(ast.parse(SOURCE.format(type="BatteryState", condition=condition)))
    assert line == 3
    assert text.endswith(f"write {value}")


@pytest.mark.parametrize(
    ("type_", "condition"),
    [("BatteryState", "message.percentage < 0.2"), ("Progress", "message.percentage < 20")],
)
def test_fractions_and_other_messages(type_: str, condition: str) -> None:
    """A fraction, and a field of a message with its own scale, are left alone."""
    assert not list(wrong_scale(ast.parse(SOURCE.format(type=type_, condition=condition))))

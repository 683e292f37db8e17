"""Nanoseconds of a stamp without its seconds."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.lone_nanoseconds import lone_nanoseconds

WAY = "write {0}.sec + {0}.nanosec * 1e-9"


@pytest.mark.parametrize(
    ("line", "stamp"),
    [
        ("t = m.header.stamp.nanosec * 1e-9", "m.header.stamp"),
        ("t = m.header.stamp.nanosec / 1e9", "m.header.stamp"),
        ("t = float(stamp.nanosec) / 10**9", "stamp"),
        ("dt = m.stamp.nanosec - self.last.nanosec", "m.stamp"),
        ("dt = now - m.stamp.nanosec", "m.stamp"),
    ],
)
def test_a_part_of_a_second(line: str, stamp: str) -> None:
    """The sentence has the whole time."""
    [(found, text)] = lone_nanoseconds(ast.parse(f"def got(self, m):\n    {line}"))
    assert found == 2
    assert text.endswith(WAY.format(stamp))


def test_a_division_by_both() -> None:
    """The sentence has the parentheses that are missing; with them, nothing is told."""
    [(_, text)] = lone_nanoseconds(ast.parse("k = self.kd * error / dt.nanoseconds / 1e9"))
    assert text.endswith("in parentheses they are seconds: self.kd * error / (dt.nanoseconds / 1e9)")
    assert [*lone_nanoseconds(ast.parse("k = error / (dt.nanoseconds / 1e9)"))] == []


@pytest.mark.parametrize(
    "line",
    [
        "t = m.stamp.sec + m.stamp.nanosec * 1e-9",
        "t = Time.from_msg(m.stamp); n = m.stamp.nanosec / 1e9",
        "print(m.stamp.nanosec)",
        "ms = m.stamp.nanosec / 1e6",
        "t = m.stamp.nanosec * factor",
    ],
)
def test_other_uses(line: str) -> None:
    """A whole time, and what is not a time in seconds, are left alone."""
    assert not list(lone_nanoseconds(ast.parse(f"def got(self, m):\n    {line}")))

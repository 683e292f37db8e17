"""Counters that nothing counts."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.lasting_counters import lasting_counters

PROGRAM = """\
class Talker(Node):
    {}
    def __init__(self):
        super().__init__("talker")
        {}
    def tick(self):
        {}
"""


def _told(in_class: str, first: str, line: str, rest: str = "") -> list[tuple[int, str]]:
    return list(lasting_counters(ast.parse(PROGRAM.format(in_class, first, line) + rest)))


@pytest.mark.parametrize("name", ["i", "n", "count", "_counter", "lap_count", "tick", "ticks", "index"])
def test_a_counter_that_stays(name: str) -> None:
    """It is told once, in the first line that reads it, wherever it is set to 0."""
    told = [(7, f"self.{name} stays 0, since no line changes it: write self.{name} += 1")]
    line = f"self.say(self.{name}, self.{name})"
    assert _told("pass", f"self.{name} = 0", line) == told
    assert _told(f"{name} = 0", "pass", line) == told


def test_the_first_line_of_a_counter() -> None:
    """It may be in a block."""
    [(line, _)] = _told("pass", "self.count = 0", "if True:\n            print(self.count)\n        print(self.count)")
    assert line == 8
    [(line, _)] = _told("pass", "self.count = 0", "print(self.count)\n        print(self.count)")
    assert line == 7


@pytest.mark.parametrize(
    ("in_class", "first", "line", "rest"),
    [
        ("pass", "self.count = 0", "self.count += 1", ""),
        ("pass", "self.count = 0", "print(self.count); self.count = 3", ""),
        ("count = 0", "self.count = 5", "print(self.count)", ""),
        ("count = 0", "pass", "Talker.count += 1; print(self.count)", ""),
        ("pass", "self.count = 0", "print(self.count)", "talker.count = 2\n"),
        ("pass", "self.count = 0", "print(self.count)", "setattr(talker, name, 2)\n"),
        ("pass", "self.count = 0", "print(self.__dict__, self.count)", ""),
        ("pass", "self.count = 10", "print(self.count)", ""),
        ("pass", "self.speed = 0", "print(self.speed)", ""),
        ("pass", "self.count = 0", "pass", ""),
        ("pass", "other.count = 0", "print(self.count)", ""),
    ],
)
def test_what_may_change(in_class: str, first: str, line: str, rest: str) -> None:
    """Or is no counter, or is not read."""
    assert _told(in_class, first, line, rest) == []


def test_a_class_without_a_base() -> None:
    """It may be a part of something else, and is left alone."""
    source = PROGRAM.format("pass", "self.count = 0", "print(self.count)").replace("(Node)", "")
    assert list(lasting_counters(ast.parse(source))) == []

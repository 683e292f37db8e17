"""Statements without effect."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.ineffective import ineffective


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ('self.state == "MOVE"', "self.state == 'MOVE' compares without effect; write = to set it"),
        ("if pose.x > 9:\n        state == 1", "state == 1 compares without effect; write = to set it"),
        ("self.goals[0] == pose", "self.goals[0] == pose compares without effect; write = to set it"),
        ("self.ticks =+ 1", "self.ticks =+ 1 sets it to 1; write self.ticks += 1"),
        ("self.x=+ self.step", "self.x =+ self.step sets it to self.step; write self.x += self.step"),
        ("self.count + 1", "self.count + 1 computes without effect; write self.count += 1"),
        (
            "try:\n        self.state == 1\n        self.go()\n    finally:\n        pass",
            "self.state == 1 compares without effect; write = to set it",
        ),
    ],
)
def test_lines_without_an_effect(line: str, told: str) -> None:
    """Each is reported with its correction, in methods and functions."""
    source = ast.parse(f"class A:\n  def tick(self):\n    {line}\n")
    assert [text for _, text in ineffective(source)] == [told]


@pytest.mark.parametrize(
    "source",
    [
        "def tick(self):\n    self.state = 'MOVE'",
        "def tick(self):\n    self.sign = +1",
        "def tick(self):\n    self.sign=+1",
        "def tick(self):\n    self.sign = + 0.5",
        "def tick(self):\n    self.sign =- 1",
        "def tick(self):\n    return self.state == 'MOVE'",
        "def tick(self):\n    assert self.state == 'MOVE'",
        "def tick(self):\n    self.model.add(self.x == 1)",
        "def tick(self):\n    'self.state == 1'",
        "def tick(self):\n    1 == self.check()",
        "def tick(self):\n    first >> 2",
        "def test_raises(self):\n    a == b",
        "def tick(self):\n    with raises(TypeError):\n        a == b",
        "def tick(self):\n    try:\n        a == b\n    except TypeError:\n        pass",
        "x = 1\nx == 1",
        "class A:\n    x == 1",
    ],
)
def test_what_has_an_effect(source: str) -> None:
    """Or is shown, as the last line of a notebook's cell; or is there for its error, as in a test."""
    assert list(ineffective(ast.parse(source))) == []

"""Attributes under two names."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.two_names import two_names

PROGRAM = """\
class Robot(Node):
    def __init__(self):
        self.pose = {}
        self.create_timer(0.1, self.drive)
    def on_pose(self, message):
        {}
    def drive(self):
        {}
"""
READS = "if self.pose is not None: print(self.pose)"


def test_one_is_set_and_the_other_is_read() -> None:
    """The line that sets it is told, with the name that is read."""
    text = "nothing reads self.pos, and self.pose stays what line 3 sets: write self.pose"
    assert list(two_names(ast.parse(PROGRAM.format(None, "self.pos = message", READS)))) == [(6, text)]


@pytest.mark.parametrize(
    ("first", "sets", "reads"),
    [
        ("None", "self.pose = message", READS),
        ("None", "self.pos = self.pose = message", READS),
        ("None", "self.pos = message", f"{READS}; use(self.pos)"),
        ("None", "self.pos = message", f"{READS}; use(self, 'pos')"),
        ("None", "self.pos = message", "pass"),
        ("None", "self.goal = message", READS),
        ("Pose()", "self.pos = message", READS),
        ("None; self.pos = None", "self.pos = message", READS),
    ],
)
def test_attributes_that_may_be_meant(first: str, sets: str, reads: str) -> None:
    """Both are used, or their names are not alike, or what is read is an object that may change."""
    assert list(two_names(ast.parse(PROGRAM.format(first, sets, reads)))) == []

"""Conditions that always have the same value."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.conditions import constant_conditions

ROBOT = """
class Robot(Node):
    state = "FORWARD"
    handler = None

    def __init__(self):
        self.color = "red"

    def near_wall(self):
        return self.x > 9.0

    async def arrived(self, goal):
        return goal == self.x

    def on_done(self):
        '''For subclasses.'''

    @property
    def ready(self):
        return True

    def replaced(self):
        return 1

    def turn(self):
        self.state = "TURN" if self.ready else "FORWARD"
        other.replaced = None

    def step(self):
        {}
"""


def _told(line: str) -> list[str]:
    return [text for _, text in constant_conditions(ast.parse(ROBOT.format(line)))]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("if self.near_wall: pass", "self.near_wall is a method, and so always true; write self.near_wall()"),
        (
            "while x and not self.arrived: pass",
            "self.arrived is a method, and so always true; write await self.arrived(...)",
        ),
        ("return 1 if self.near_wall else 2", "self.near_wall is a method, and so always true; write self.near_wall()"),
        (
            "if x.mode == 'STOP' or 'WAIT': pass",
            "x.mode == 'STOP' or 'WAIT' does not compare x.mode with 'WAIT', which is always true; "
            "write x.mode in ('STOP', 'WAIT')",
        ),
        (
            "if n != 1 and 2: pass",
            "n != 1 and 2 does not compare n with 2, which is always true; write n not in (1, 2)",
        ),
        (
            "if self.state == 'TURNING': pass",
            "self.state is set to 'TURN', and never to 'TURNING'; did you mean 'TURN'?",
        ),
        (
            "if self.state in ('FORWARD', 'TURNING'): pass",
            "self.state is set to 'TURN', and never to 'TURNING'; did you mean 'TURN'?",
        ),
    ],
)
def test_constant_conditions(line: str, told: str) -> None:
    """Each is told with its correction."""
    assert _told(line) == [told]


@pytest.mark.parametrize(
    "line",
    [
        "if self.near_wall(): pass",
        "if self.ready: pass",
        "if self.handler: pass",
        "if self.on_done: pass",
        "if self.replaced: pass",
        "if self.inherited: pass",
        "near = self.near_wall or other",
        "if x.mode in ('STOP', 'WAIT'): pass",
        "if x.mode == 'STOP' or x.mode == 'WAIT': pass",
        "word = n == 1 and 'yes' or 'no'",
        "if n == 1 or True: pass",
        "if self.state == 'TURN' or self.state == 'TURNING': pass",
        "if self.state == 'TURN': pass",
        "if self.state == 'BATTERY': pass",
        "self.state = given\n        if self.state == 'TURNING': pass",
        "self.state, x = given\n        if self.state == 'TURNING': pass",
        "other.state = given\n        if self.state == 'TURNING': pass",
        "setattr(self, name, 1)\n        if self.state == 'TURNING': pass",
        "self.state += 'ING'\n        if self.state == 'TURNING': pass",
        "if self.mode == 'TURNING': pass",
    ],
)
def test_conditions_that_vary(line: str) -> None:
    """Hooks, the old form of a conditional expression, and attributes with other values are not told."""
    assert _told(line) == []

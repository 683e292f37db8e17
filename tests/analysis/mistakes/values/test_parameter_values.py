"""Comparisons of parameters."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.parameter_values import parameter_values

PROGRAM = """\
class Lamp(Node):
    def __init__(self):
        self.declare_parameter("enabled", True)
        self.declare_parameter("mode", "auto")
        self.declare_parameter("rate", 2.0)
        self.declare_parameter("other", make())
        self.declare_parameter("twice", 1)
        self.declare_parameter("twice", "one")
    def tick(self):
        {}
"""


def _told(line: str) -> list[str]:
    return [text for _, text in parameter_values(ast.parse(PROGRAM.format(line)))]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (
            "if self.get_parameter('enabled'): pass",
            "self.get_parameter('enabled') is a Parameter, and so always true; write self.get_",
        ),
        (
            "p = self.get_parameter('enabled')\n        if not p: pass",
            "p is a Parameter, and so always true; write p.value",
        ),
        ("while self.get_parameter('x'): pass", "self.get_parameter('x') is a Parameter, and so always true; "),
        (
            "self.get_parameter('mode') == 'auto'",
            "self.get_parameter('mode') is a Parameter, which never equals 'auto'",
        ),
        (
            "self.get_parameter('enabled').value == 'true'",
            "self.get_parameter('enabled').value is a bool, as it is declared, and never 'true'; compare it with",
        ),
        (
            "self.get_parameter('mode').value is True",
            "self.get_parameter('mode').value is a text, as it is declared, and never True; declare it as "
            "declare_parameter('mode', True)",
        ),
        ("self.get_parameter('rate').value == '2'", "self.get_parameter('rate').value is a double, as it is declared"),
        (
            "future.result().status == 'SUCCEEDED'",
            "future.result().status is a number; write GoalStatus.STATUS_SUCCEEDED, from action_msgs.msg",
        ),
    ],
)
def test_comparisons_that_never_hold(line: str, told: str) -> None:
    """Each is told with its correction."""
    [text] = _told(line)
    assert text.startswith(told)


@pytest.mark.parametrize(
    "line",
    [
        "if self.get_parameter('enabled').value: pass",
        "if self.has_parameter('enabled'): pass",
        "self.get_parameter('mode').value == 'manual'",
        "self.get_parameter('rate').value == 2",
        "self.get_parameter('enabled').value == 1",
        "self.get_parameter('other').value == 'a'",
        "self.get_parameter('twice').value == 1",
        "self.get_parameter('twice').value == 'one'",
        "self.get_parameter('unknown').value == 'a'",
        "self.get_parameter('mode').value is None",
        "self.get_parameter(name) == 'a'.upper()",
        "p = self.get_parameter('enabled')\n        p = 1\n        if p: pass",
        "msg.status == 'ok'",
        "future.result().status == 4",
    ],
)
def test_comparisons_that_may_hold(line: str) -> None:
    """Values of the declared type, or of a type that is not known."""
    assert _told(line) == []

"""Checks of parameters that return a verdict."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.returning_checks import returning_checks

CLASS = """
class Cruise(Node):
    @{decorator}
    def in_range(self, speed):
        {body}
"""


def _told(decorator: str, body: str) -> list[tuple[int, str]]:
    definition = ast.parse(CLASS.format(decorator=decorator, body=body)).body[0]
    assert isinstance(definition, ast.ClassDef)
    return list(returning_checks(definition))


@pytest.mark.parametrize(
    ("value", "way"),
    [
        ("0.0 <= speed <= 2.0", "if not (0.0 <= speed <= 2.0): "),
        ("False", ""),
        ("speed < 2", "if not (speed < 2): "),
        ("1", ""),
    ],
)
def test_a_check_that_returns_its_verdict(value: str, way: str) -> None:
    """The line is told with the form that refuses a value."""
    [(line, text)] = _told("speed.check", f"return {value}")
    assert line == 5
    assert text == (
        f'in_range is a check, which refuses a value by raising: {way}raise ValueError("why"), in place of return'
    )


@pytest.mark.parametrize(
    ("decorator", "body"),
    [
        ("speed.check", "return"),
        ("speed.check", "return None"),
        ("speed.check", "return True"),
        ("speed.check", "if speed > 2: raise ValueError('fast')"),
        ("speed.check", "limit = lambda: 2.0\n        def f(): return 1"),
        ("speed.on_change", "return 1"),
        ("self.speed.check", "return 1"),
        ("check", "return 1"),
    ],
)
def test_other_methods(decorator: str, body: str) -> None:
    """They return nothing that matters, or are no checks."""
    assert _told(decorator, body) == []

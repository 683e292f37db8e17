"""Values that names and attributes are bound to."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.bindings import Bindings
from graphflow.analysis.syntax import walk

SOURCE = """
import os.path
LIMIT = 1

class A:
    rate = 2
    first, second = 1, 2

    def set(self, given):
        self.x = 3
        self.y, _ = pair
        x = y = 4
        for i in range(3):
            x += 1
        with open(name) as file: pass
        if (n := 5): pass
        self.z: int = 6
        other.w = 7
        self.w = 8

    def use(self):
        USED

def far():
    x = 9
"""


@pytest.mark.parametrize(
    ("used", "values"),
    [
        ("self.x", ["3"]),
        ("self.rate", ["2"]),
        ("self.first", [None]),
        ("self.y", [None]),
        ("self.z", ["6"]),
        ("self.w", []),
        ("self.missing", []),
        ("LIMIT", ["1"]),
        ("x", []),
        ("os", [None]),
        ("far", [None]),
        ("given", []),
        ("other.x", []),
    ],
)
def test_values_seen_in_another_method(used: str, values: list[str | None]) -> None:
    """Those of the class and of the module; None for what is not assigned as a whole."""
    assert _values(SOURCE.replace("USED", used), used) == values


@pytest.mark.parametrize(
    ("used", "values"),
    [("x", ["4", None]), ("y", ["4"]), ("given", [None]), ("i", [None]), ("file", [None]), ("n", ["5"])],
)
def test_values_of_a_function(used: str, values: list[str | None]) -> None:
    """Its own, with those that loops and arguments bind."""
    source = SOURCE.replace("self.w = 8", f"print({used})").replace("USED", "pass")
    assert _values(source, used) == values


def _values(source: str, used: str) -> list[str | None]:
    module = ast.parse(source)
    named, parents = next(
        (node, parents)
        for node, parents in walk(module)
        if isinstance(node, ast.expr)
        and isinstance(getattr(node, "ctx", None), ast.Load)
        and ast.unparse(node) == used
        and isinstance(parents[-1], (ast.Expr, ast.Call))
    )
    found = [value.expression for value in Bindings(module).of(named, parents)]
    return [ast.unparse(value) if value is not None else None for value in found]

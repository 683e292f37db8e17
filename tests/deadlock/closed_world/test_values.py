"""Values and scopes: what the source shows of the changes of what a name stands for."""

from __future__ import annotations

import array
import ast
import math
from enum import Enum
from typing import Any

import numpy as np
import pytest

from graphflow.deadlock.closed_world.values import NO_NAMES, Scope, arrays, bindings, holds_plain, is_plain
from graphflow.msgs.std_msgs.msg import String


class Colour(Enum):
    RED = 1


def expression(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


@pytest.mark.parametrize("value", [1, "a", None, Colour.RED, (1, ("b",)), frozenset({1}), String()])
def test_plain(value: object) -> None:
    """A value that cannot change, or a message."""
    assert is_plain(value)
    assert holds_plain([value])
    assert holds_plain({"key": value})


@pytest.mark.parametrize("value", [[], {}, object(), (1, [])])
def test_not_plain(value: object) -> None:
    """A value that can change, or has a part that can."""
    assert not is_plain(value)
    assert not holds_plain([value])


def test_arrays_hold_numbers() -> None:
    """An array of objects may have parts that change."""
    assert arrays() == (array.array, np.ndarray)
    assert holds_plain(np.zeros(3))
    assert holds_plain(array.array("d"))
    assert not holds_plain(np.array([object()]))
    assert not holds_plain(3)


def test_bindings() -> None:
    """Each with its expression, if it has one of its own."""
    [function] = ast.parse(
        "def f(x):\n    a, (b, *c) = 1, x\n    for d in x: pass\n    with x as e: pass\n    a = (g := 2)\n"
    ).body
    assert isinstance(function, ast.FunctionDef)
    found = {name: [value and ast.unparse(value) for _, value in pairs] for name, pairs in bindings(function).items()}
    assert found == {"a": ["1", "(g := 2)"], "b": [None], "c": [None], "d": [None], "e": [None], "g": ["2"]}


@pytest.mark.parametrize(
    ("text", "is_constant"),
    [("kept", True), ("LIMIT", True), ("Colour.RED", True), ("math.pi", True), ("local", False), ("points", False)],
)
def test_constants(text: str, is_constant: bool) -> None:
    """Names that keep their value, and attributes of modules and classes."""
    names: dict[str, Any] = {"LIMIT": 3, "Colour": Colour, "math": math, "points": [1]}
    scope = Scope({"local": [None]}, frozenset({"kept"}), names, set())
    assert scope.is_constant(expression(text)) is is_constant
    assert scope.is_of_module("points")
    assert not NO_NAMES.is_constant(expression(text))


def test_functions() -> None:
    """Functions of `math` are known, and built-in ones unless the module has its own."""
    scope = Scope({}, frozenset(), {"math": math, "sum": print}, set())
    found = [scope.is_mathematics(expression(text)) for text in ("math.hypot", "abs", "sum", "open")]
    assert found == [True, True, False, False]

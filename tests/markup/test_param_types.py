"""The types of parameters in launch files."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.markup.param_types import as_type


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("yaml", "10", 10),
        ("yaml", "", ""),
        ("yaml", "'10'", "10"),
        ("yaml", "['a', 'b']", ["a", "b"]),
        ("yaml", "<a b='c: d'/>", "<a b='c: d'/>"),
        ("yaml", "a: b", "a: b"),
        ("yaml", 2.5, 2.5),
        ("yaml", "[1, 2.5]", [1.0, 2.5]),
        ("str", "0042", "0042"),
        ("str", True, "true"),
        ("int", "0042", 42),
        ("float", "10", 10.0),
        ("float", 10, 10.0),
        ("bool", "1", True),
        ("bool", "False", False),
        ("list_of_float", "[1, 2.5]", [1.0, 2.5]),
        ("list_of_str", [1, "a"], ["1", "a"]),
    ],
)
def test_values(name: str, value: Any, expected: Any) -> None:
    """A text is read as what is asked for; a mapping is no parameter, so that XML in a text stays one."""
    found = as_type(name, value)
    assert (found, type(found)) == (expected, type(expected))


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("int", "1.5", "expected an integer, got '1.5'"),
        ("int", True, "expected an integer, got True"),
        ("bool", "maybe", "expected true or false, got 'maybe'"),
        ("list_of_int", "1", "expected a list such as [1, 2], got '1'"),
        ("yaml", "[1, a]", "expected values of one type, got [1, 'a']"),
        ("yaml", [True, 1], "expected values of one type, got [True, 1]"),
        ("list_of_int", "[a]", "expected an integer, got 'a'"),
        ("double", "1", "there is no type 'double'"),
    ],
)
def test_values_of_other_types(name: str, value: Any, message: str) -> None:
    """It is said what was expected."""
    with pytest.raises(ValueError) as caught:
        as_type(name, value)
    assert message in str(caught.value)

"""Values of parameters as people type them."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.cli.param import read_value
from graphflow.errors import UsageFault
from graphflow.interface import TYPE_IDS


@pytest.mark.parametrize(
    ("text", "type_", "value"),
    [
        ("200", "int", 200),
        ("-1", "int", -1),
        ("1.5", "int", 1.5),
        ("2", "float", 2.0),
        ("-2", "float", -2.0),
        ("2.5", "float", 2.5),
        ("1e3", "float", 1000.0),
        ("true", "float", True),
        ("fast", "float", "fast"),
        ("true", "bool", True),
        ("False", "bool", False),
        ("on", "bool", True),
        ("Off", "bool", False),
        ("yes", "bool", True),
        ("NO", "bool", False),
        ("1", "bool", 1),
        ("hello", "str", "hello"),
        ("hello world", "str", "hello world"),
        ("'quoted'", "str", "quoted"),
        ('"on"', "str", "on"),
        ("on", "str", "on"),
        ("200", "str", "200"),
        ("true", "str", "true"),
        ("{no: yaml", "str", "{no: yaml"),
        ("a: b", "str", "a: b"),
        ("", "str", ""),
        ("[1, 2]", "list[int]", [1, 2]),
        ("[1, 2.5]", "list[float]", [1.0, 2.5]),
        ("[a, b]", "list[str]", ["a", "b"]),
        ("[true, false]", "list[bool]", [True, False]),
        ("[]", "list[float]", []),
        ("[0, 255]", "bytes", b"\x00\xff"),
        ("[0, 256]", "bytes", [0, 256]),
        ("[true]", "bytes", [True]),
    ],
)
def test_a_value_is_read_as_the_declared_type_wants_it(text: str, type_: Any, value: Any) -> None:
    """Texts need no quotes, whole numbers widen to doubles, bools have their usual words; the node judges the rest."""
    found = read_value(text, TYPE_IDS[type_])
    assert (found, type(found)) == (value, type(value))
    if isinstance(value, list):
        assert [type(item) for item in found] == [type(item) for item in value]


@pytest.mark.parametrize("text", ["{a: 1", "[1, 2", "*a", "'x"])
def test_what_is_no_yaml_is_wrong_usage(text: str) -> None:
    """Half a list is told as such, before anybody is asked."""
    with pytest.raises(UsageFault, match="character"):
        read_value(text, TYPE_IDS["list[int]"])

"""Parameter values as messages."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import ParameterError
from graphflow.interface import TYPE_IDS, TYPE_NAMES, ParamType
from graphflow.msgs.rcl_interfaces.msg import ParameterType, ParameterValue
from graphflow.runtime.parameters.values import VALUE_FIELDS, from_message, to_message, type_word

VALUES: list[tuple[ParamType, Any]] = [
    ("bool", True),
    ("int", -(2**63)),
    ("float", 0.5),
    ("str", "grüß"),
    ("bytes", b"\x00\xff"),
    ("list[bool]", [True, False]),
    ("list[int]", [1, 2**63 - 1]),
    ("list[float]", [1.0, -0.5]),
    ("list[str]", ["a", ""]),
    ("list[int]", []),
    ("bytes", b""),
]


@pytest.mark.parametrize(("type_", "value"), VALUES)
def test_a_value_comes_back_as_it_was(type_: ParamType, value: Any) -> None:
    """Over the wire too, with its Python type."""
    message = ParameterValue.from_bytes(to_message(value, TYPE_IDS[type_]).to_bytes())

    assert message.type == TYPE_IDS[type_]
    back = from_message(message)
    assert back == value
    assert type(back) is type(value)
    if isinstance(value, list):
        assert [type(item) for item in back] == [type(item) for item in value]


def test_a_value_that_is_not_set() -> None:
    """ROS 2's NOT_SET is None."""
    assert from_message(ParameterValue()) is None


def test_a_type_number_that_is_none() -> None:
    """A peer's unknown type is an error of its own name."""
    with pytest.raises(ParameterError, match="10 is not a parameter type"):
        from_message(ParameterValue(type=10))


def test_the_numbers_are_rcl_interfaces() -> None:
    """Types, names and fields agree with the interface definition."""
    constants = {name.lower(): value for name, value in vars(ParameterType).items() if name.startswith("PARAMETER_")}

    words = {n: name.replace("boolean", "bool").replace(" ", "_") for n, name in TYPE_NAMES.items()}

    assert constants == {f"parameter_{word}": n for n, word in words.items()}
    assert set(VALUE_FIELDS[1:]) == {f.name for f in ParameterValue.SCHEMA.fields} - {"type"}


@pytest.mark.parametrize(
    ("type_", "words"),
    [(2, "Integer value is"), (3, "Double value is"), (9, "String values are"), (5, "Byte values are")],
)
def test_words_for_types(type_: int, words: str) -> None:
    """As `ros2 param get` begins its line."""
    assert type_word(type_) == words

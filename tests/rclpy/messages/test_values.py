"""What fields of strict messages take."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np
import pytest

from graphflow.rclpy.messages.values import checker, lenient, rosidl_type
from graphflow.wire.schema import FieldType


@pytest.mark.parametrize(
    ("base", "good", "wrong", "text"),
    [
        ("float64", 1.5, 1, "The 'x' field must be of type 'float'"),
        ("float32", 1.5, 1e39, "The 'x' field must be a float in [-3.402823466e+38, 3.402823466e+38]"),
        ("int8", -128, 128, "The 'x' field must be an integer in [-128, 127]"),
        ("uint8", 255, -1, "The 'x' field must be an unsigned integer in [0, 255]"),
        ("int32", 5, 5.0, "The 'x' field must be of type 'int'"),
        ("bool", True, 1, "The 'x' field must be of type 'bool'"),
        ("string", "a", b"a", "The 'x' field must be of type 'str'"),
        ("byte", b"a", 97, "The 'x' field must be of type 'bytes' or 'ByteString' with length 1"),
    ],
)
def test_a_value_of_another_type_is_refused(base: str, good: Any, wrong: Any, text: str) -> None:
    """In rosidl's words; nothing is widened."""
    check = checker("x", FieldType(base), None)
    assert check(good) == good
    with pytest.raises(AssertionError) as refused:
        check(wrong)
    assert str(refused.value) == text


def test_numpys_float_is_one_and_its_float32_is_none() -> None:
    """As in Python itself."""
    check = checker("x", FieldType("float64"), None)
    assert check(np.float64(2.0)) == 2.0
    with pytest.raises(AssertionError):
        check(np.float32(2.0))


@pytest.mark.parametrize("given", [[1.0, 2.0], (1.0, 2.0), np.array([1.0, 2.0]), array("d", [1.0, 2.0])])
def test_a_sequence_of_numbers_becomes_an_array(given: Any) -> None:
    """Of the code of its type; an array that is one already is kept, to be changed by whoever has it."""
    kept = checker("x", FieldType("float64", array="unbounded"), None)(given)
    assert kept == array("d", [1.0, 2.0])
    assert (kept is given) == isinstance(given, array)


@pytest.mark.parametrize(
    ("type_", "given", "kept"),
    [
        (FieldType("float64", array="unbounded"), [1, True, np.float32(0.5)], array("d", [1.0, 1.0, 0.5])),
        (FieldType("float64", array="unbounded"), array("f", [1.0]), array("d", [1.0])),
        (FieldType("float64", array="unbounded"), np.array([1, 2], np.int8), array("d", [1.0, 2.0])),
        (FieldType("float32", array="bounded", size=2), (1, 2.5), array("f", [1.0, 2.5])),
        (FieldType("int8", array="unbounded"), np.array([1, -2]), array("b", [1, -2])),
        (FieldType("uint8", array="unbounded"), np.zeros(2, np.uint8), array("B", [0, 0])),
        (FieldType("float64", array="fixed", size=2), [0, 1], np.array([0.0, 1.0])),
        (FieldType("float64", array="fixed", size=2), np.ones(2, np.float32), np.array([1.0, 1.0])),
        (FieldType("float32", array="fixed", size=2), np.arange(2), np.array([0.0, 1.0], np.float32)),
    ],
)
def test_a_sequence_takes_what_numbers_can_be_made_of(type_: FieldType, given: Any, kept: Any) -> None:
    """As ROS 2 does, where an integer among floats is a float."""
    made: Any = checker("x", type_, None)(given)
    assert type(made) is type(kept)
    assert made.tolist() == kept.tolist()
    assert getattr(made, "dtype", None) == getattr(kept, "dtype", None)


def test_checks_may_be_left_to_sending() -> None:
    """Then what does not fit is kept, and what fits is converted as ever."""
    keep = lenient(checker("x", FieldType("float64", array="unbounded"), None))
    assert keep([1]) == array("d", [1.0])
    assert keep("12") == "12"


@pytest.mark.parametrize(
    ("type_", "given"),
    [
        (FieldType("float64", array="unbounded"), [1.0, "2"]),
        (FieldType("float64", array="unbounded"), b"12345678"),
        (FieldType("float32", array="unbounded"), [1e39]),
        (FieldType("float64", array="unbounded"), np.zeros((2, 2))),
        (FieldType("float64", array="unbounded"), "12"),
        (FieldType("int8", array="unbounded"), [1, 200]),
        (FieldType("int8", array="unbounded"), [1, True, 2.0]),
        (FieldType("uint8", array="bounded", size=2), b"abc"),
        (FieldType("string", array="unbounded"), ["a", 1]),
        (FieldType("bool", array="fixed", size=2), [True]),
        (FieldType("float64", array="fixed", size=2), np.zeros(3)),
        (FieldType("int32", array="fixed", size=2), np.zeros(2)),
        (FieldType("uint8", array="fixed", size=2), [1, 300]),
        (FieldType("float64", array="fixed", size=2), [[1.0], [2.0, 3.0]]),
        (FieldType("float64", array="unbounded"), [[1.0], [2.0, 3.0]]),
        (FieldType("float64", array="unbounded"), np.float64(1.0)),
        (FieldType("float64", array="unbounded"), np.array(1.0)),
    ],
)
def test_a_sequence_that_does_not_fit_is_refused(type_: FieldType, given: Any) -> None:
    """For one element, for its length, or for what it is."""
    with pytest.raises(AssertionError, match="'x'"):
        checker("x", type_, None)(given)


def test_bytes_are_numbers_too() -> None:
    """Of uint8, at one look."""
    assert checker("x", FieldType("uint8", array="unbounded"), None)(b"\x01\x02") == array("B", [1, 2])


@pytest.mark.parametrize(
    ("type_", "word"),
    [
        (FieldType("float64"), "double"),
        (FieldType("float32", array="fixed", size=36), "float[36]"),
        (FieldType("geometry_msgs/msg/Point", array="unbounded"), "sequence<geometry_msgs/Point>"),
        (FieldType("string", 5, "bounded", 10), "sequence<string<5>, 10>"),
        (FieldType("byte"), "octet"),
        (FieldType("bool"), "boolean"),
    ],
)
def test_types_have_rosidls_names(type_: FieldType, word: str) -> None:
    """As `get_fields_and_field_types` gives them."""
    assert rosidl_type(type_) == word

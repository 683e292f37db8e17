"""Numeric arrays of messages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from graphflow.wire.cdr.arrays import DTYPES, as_array, view, zeros
from graphflow.wire.cdr.codegen import FORMATS
from graphflow.wire.schema import INTEGER_RANGES


def test_every_number_has_a_dtype_of_its_size() -> None:
    """Each numeric type has a numpy type as large as its CDR form."""
    sizes = {"?": 1, "b": 1, "B": 1, "h": 2, "H": 2, "i": 4, "I": 4, "q": 8, "Q": 8, "f": 4, "d": 8}
    assert {name: dtype.itemsize for name, dtype in DTYPES.items()} == {n: sizes[f] for n, f in FORMATS.items()}


@pytest.mark.parametrize(
    "value",
    [
        [1, 2, 3],
        (1, 2, 3),
        range(1, 4),
        np.array([1, 2, 3]),
        np.array([[1, 2, 3]], np.uint8),
        np.array([1, 2, 3], np.float32),
    ],
)
def test_sequences_become_arrays(value: Any) -> None:
    """Lists, tuples, ranges and arrays of other types and shapes become one-dimensional arrays of the type."""
    array = as_array(value, "float64")
    assert array.dtype == np.float64
    assert array.tolist() == [1.0, 2.0, 3.0]
    assert array.flags.c_contiguous


def test_an_array_of_the_type_is_not_copied() -> None:
    """An array that already is right is used as it is."""
    array = np.arange(5, dtype=np.int16)
    assert np.shares_memory(as_array(array, "int16"), array)


def test_a_strided_array_becomes_contiguous() -> None:
    """Every second element of an array is copied into one piece."""
    array = as_array(np.arange(10, dtype=np.int16)[::2], "int16")
    assert array.flags.c_contiguous
    assert array.tolist() == [0, 2, 4, 6, 8]


def test_an_array_of_the_other_byte_order_is_converted() -> None:
    """A big-endian array has the same values afterwards, in this machine's order."""
    array = as_array(np.array([1.5, 2.5], ">f8"), "float64")
    assert array.dtype.isnative
    assert array.tolist() == [1.5, 2.5]


@pytest.mark.parametrize("value", [b"\x01\xff", bytearray(b"\x01\xff"), memoryview(b"\x01\xff")])
@pytest.mark.parametrize(
    ("base", "numbers"), [("uint8", [1, 255]), ("byte", [1, 255]), ("char", [1, 255]), ("int8", [1, -1])]
)
def test_bytes_are_arrays_of_bytes(value: Any, base: str, numbers: list[int]) -> None:
    """Bytes stand for arrays of any one-byte number."""
    assert as_array(value, base).tolist() == numbers


@pytest.mark.parametrize("base", DTYPES)
def test_nothing_is_an_empty_array(base: str) -> None:
    """An empty list becomes an empty array of the type."""
    array = as_array([], base)
    assert (array.size, array.dtype) == (0, DTYPES[base])


@pytest.mark.parametrize("base", INTEGER_RANGES)
def test_integers_fit_to_the_last(base: str) -> None:
    """The smallest and largest integer of a type come through exactly, together and alone."""
    low, high = INTEGER_RANGES[base]
    for numbers in ([low, high], [0, high], [high], [low]):
        assert as_array(numbers, base).tolist() == numbers


@pytest.mark.parametrize("base", INTEGER_RANGES)
def test_integers_beyond_the_range_are_refused(base: str) -> None:
    """One less than the smallest and one more than the largest are refused by value and range."""
    low, high = INTEGER_RANGES[base]
    for wrong in (low - 1, high + 1):
        with pytest.raises(ValueError, match=f"{wrong} does not fit {base}: {low} to {high}"):
            as_array([0, wrong], base)


def test_arrays_of_wider_integers_are_checked() -> None:
    """An int64 array is an int8 array if its values fit, else an error."""
    assert as_array(np.array([-128, 127]), "int8").dtype == np.int8
    with pytest.raises(ValueError, match="128 does not fit int8"):
        as_array(np.array([0, 128]), "int8")


@pytest.mark.parametrize(
    ("value", "base"),
    [
        ([1.0], "int32"),
        (np.array([1.5]), "uint8"),
        ([True], "int32"),
        ([True], "float64"),
        ([0, 1], "bool"),
        (["a"], "float64"),
        ([None], "float64"),
        ([1, None], "int64"),
        ([2**64, 0.5], "uint64"),
        ([1j], "float64"),
        ("abc", "float64"),
        ([[1], [2, 3]], "float64"),
        ({1.0, 2.0}, "float64"),
        (b"\0\1", "bool"),
    ],
)
def test_elements_of_another_kind_are_refused(value: Any, base: str) -> None:
    """Floats are no integers, numbers are no bools, and neither are strings numbers."""
    with pytest.raises(ValueError, match=r"expected|inhomogeneous"):
        as_array(value, base)


@pytest.mark.parametrize("value", [[1e39], [0.0, -1e300], np.array([3.5e38])])
def test_floats_too_large_are_refused(value: Any) -> None:
    """A double beyond float32 is refused instead of becoming infinite."""
    with pytest.raises(ValueError, match="is too large for float32"):
        as_array(value, "float32")


def test_infinity_and_nan_are_floats() -> None:
    """Infinities and NaN pass into float32."""
    array = as_array([float("inf"), float("-inf"), float("nan")], "float32")
    assert np.isinf(array[:2]).all()
    assert np.isnan(array[2])


def test_zeros_are_new_and_writable() -> None:
    """Default arrays are of the type, and no two of them share memory."""
    first, second = zeros("bool", 3), zeros("bool", 3)
    first[0] = True
    assert (first.tolist(), second.tolist()) == ([True, False, False], [False, False, False])


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_view_is_read_only_and_native(order: Any) -> None:
    """Elements read from a payload have this machine's byte order and cannot be written."""
    payload = b"????" + np.array([1, -2, 3], np.dtype("i4").newbyteorder(order)).tobytes()
    array = view(payload, np.dtype("i4").newbyteorder(order), 3, 4)
    assert array.tolist() == [1, -2, 3]
    assert array.dtype.isnative
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 5


def test_a_view_does_not_copy() -> None:
    """Elements in this machine's byte order stay in the payload."""
    payload = bytes(range(16))
    assert np.shares_memory(view(payload, np.dtype("=i4"), 3, 4), np.frombuffer(payload, np.uint8))


def test_a_view_of_bools_holds_bools() -> None:
    """Any byte but zero is true, and only True and False come out."""
    array = view(b"\0\1\2\xff", np.dtype("?"), 4, 0)
    assert array.tolist() == [False, True, True, True]
    assert array.view(np.uint8).max() == 1
    with pytest.raises(ValueError, match="read-only"):
        array[0] = True


def test_an_empty_view_is_of_the_type() -> None:
    """No elements are an empty read-only array, wherever in the payload they are."""
    array = view(b"", np.dtype(">f8"), 0, 99)
    assert (array.size, array.dtype) == (0, np.dtype("=f8"))
    assert not array.flags.writeable

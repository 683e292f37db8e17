"""Encoding values that are not quite, or not at all, what the type says."""

from __future__ import annotations

import struct
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.wire.schema import INTEGER_RANGES


def make(name: str, **fields: Any) -> Any:
    return registry.interface_class(name)(**fields)


def assigned(name: str, path: str, value: Any) -> Any:
    """A message with the field at `path` set to `value`, which is not looked at."""
    message = target = registry.example(name)
    *parents, last = path.split(".")
    for parent in parents:
        target = getattr(target, parent)
    setattr(target, last, value)
    return message


POINT = SimpleNamespace(x=1, y=2, z="three")

WRONG: list[tuple[str, str, Any, str]] = [
    ("geometry_msgs/msg/Twist", "linear.x", "abc", "Twist.linear.x: expected float64, got 'abc'"),
    ("geometry_msgs/msg/Twist", "linear.x", None, "Twist.linear.x: expected float64, got None"),
    ("geometry_msgs/msg/Twist", "linear.x", 1j, "Twist.linear.x: expected float64, got 1j"),
    ("geometry_msgs/msg/Twist", "linear.x", [1.0], "Twist.linear.x: expected float64, got [1.0]"),
    ("geometry_msgs/msg/Twist", "linear", 5, "Twist.linear: expected geometry_msgs/msg/Vector3, got 5"),
    ("geometry_msgs/msg/Twist", "angular", None, "Twist.angular: expected geometry_msgs/msg/Vector3, got None"),
    ("geometry_msgs/msg/Twist", "linear", {"x": 1, "w": 2}, "Twist.linear: geometry_msgs/msg/Vector3 has no field 'w'"),
    ("geometry_msgs/msg/Twist", "linear", POINT, "Twist.linear.z: expected float64, got 'three'"),
    (
        "geometry_msgs/msg/PoseStamped",
        "header.stamp.sec",
        2**31,
        "PoseStamped.header.stamp.sec: 2147483648 does not fit",
    ),
    (
        "geometry_msgs/msg/PoseStamped",
        "header.frame_id",
        b"map",
        "PoseStamped.header.frame_id: expected string, got b'map'",
    ),
    (
        "geometry_msgs/msg/PoseStamped",
        "header.frame_id",
        "\ud800",
        r"PoseStamped.header.frame_id: '\ud800' is not valid",
    ),
    ("std_msgs/msg/Bool", "data", 5, "Bool.data: expected bool, got 5"),
    ("std_msgs/msg/Bool", "data", "yes", "Bool.data: expected bool, got 'yes'"),
    ("std_msgs/msg/Bool", "data", None, "Bool.data: expected bool, got None"),
    ("std_msgs/msg/Bool", "data", [], "Bool.data: expected bool, got []"),
    ("std_msgs/msg/Int8", "data", 1.0, "Int8.data: expected int8, got 1.0"),
    ("std_msgs/msg/Int8", "data", 128, "Int8.data: 128 does not fit int8: -128 to 127"),
    ("std_msgs/msg/UInt8", "data", np.int64(-1), "UInt8.data: -1 does not fit uint8: 0 to 255"),
    ("std_msgs/msg/Float32", "data", 1e39, "Float32.data: 1e+39 is too large for float32"),
    ("std_msgs/msg/Float64", "data", 10**400, "is too large for float64"),
    (
        "std_msgs/msg/Float32MultiArray",
        "data",
        [1.0, 1e39],
        "Float32MultiArray.data[1]: 1e+39 is too large for float32",
    ),
    ("std_msgs/msg/Float32MultiArray", "data", ["a"], "Float32MultiArray.data[0]: expected float32, got 'a'"),
    ("std_msgs/msg/Float32MultiArray", "data", 5, "Float32MultiArray.data: expected float32[], got 5"),
    ("std_msgs/msg/Float32MultiArray", "data", "abc", "Float32MultiArray.data: expected float32[], got 'abc'"),
    ("std_msgs/msg/UInt8MultiArray", "data", [1, 256], "UInt8MultiArray.data[1]: 256 does not fit uint8: 0 to 255"),
    (
        "std_msgs/msg/Float32MultiArray",
        "layout.dim",
        [5],
        "Float32MultiArray.layout.dim[0]: expected std_msgs/msg/Multi",
    ),
    (
        "std_msgs/msg/Float32MultiArray",
        "layout.dim",
        [{}, {"size": -1}],
        "Float32MultiArray.layout.dim[1].size: -1 does not",
    ),
    ("std_msgs/msg/Float32MultiArray", "layout.dim", 7, "Float32MultiArray.layout.dim: expected std_msgs/msg/Multi"),
    ("odd_shapes/msg/Bounds", "short", "sixsix", "Bounds.short: expected at most 5 bytes of UTF-8 (string<=5), got 6"),
    ("odd_shapes/msg/Bounds", "short", "€€", "Bounds.short: expected at most 5 bytes of UTF-8 (string<=5), got 6"),
    ("odd_shapes/msg/Bounds", "wide", "four", "Bounds.wide: expected at most 3 UTF-16 code units (wstring<=3), got 4"),
    ("odd_shapes/msg/Bounds", "wide", "\N{TURTLE}\N{TURTLE}", "Bounds.wide: expected at most 3 UTF-16 code units"),
    ("odd_shapes/msg/Bounds", "wide", b"b", "Bounds.wide: expected wstring, got b'b'"),
    (
        "odd_shapes/msg/Bounds",
        "labels",
        ["a", "b", "c"],
        "Bounds.labels: expected at most 2 elements (string<=4[<=2]), got 3",
    ),
    ("odd_shapes/msg/Bounds", "labels", ["a", "bcdef"], "Bounds.labels[1]: expected at most 4 bytes"),
    ("odd_shapes/msg/Bounds", "labels", "ab", "Bounds.labels: expected string<=4[<=2], got 'ab'"),
    ("odd_shapes/msg/Bounds", "labels", {"a": 1}, "Bounds.labels: expected string<=4[<=2], got {'a': 1}"),
    ("odd_shapes/msg/Bounds", "labels", ["a", 5], "Bounds.labels[1]: expected string, got 5"),
    (
        "odd_shapes/msg/Bounds",
        "numbers",
        [1, 2, 3, 4],
        "Bounds.numbers: expected at most 3 elements (float64[<=3]), got 4",
    ),
    ("odd_shapes/msg/Bounds", "numbers", np.zeros((2, 2)), "Bounds.numbers: expected at most 3 elements"),
    ("odd_shapes/msg/Bounds", "pair", [1], "Bounds.pair: expected 2 elements (uint16[2]), got 1"),
    ("odd_shapes/msg/Bounds", "pair", np.array(1), "Bounds.pair: expected uint16[2], got array(1)"),
    ("odd_shapes/msg/Bounds", "two", ["a"], "Bounds.two: expected 2 elements (string[2]), got 1"),
    ("odd_shapes/msg/Bounds", "colors", [{}] * 3, "Bounds.colors: expected at most 2 elements"),
    ("odd_shapes/msg/Bounds", "mixed", [{}], "Bounds.mixed: expected 2 elements (odd_shapes/msg/Mixed[2]), got 1"),
    ("odd_shapes/msg/Bounds", "mixed", [{}, {"b": "x"}], "Bounds.mixed[1].b: expected int16, got 'x'"),
]


@pytest.mark.parametrize(("name", "path", "value", "text"), WRONG)
def test_a_wrong_value_is_reported_by_its_path(name: str, path: str, value: Any, text: str) -> None:
    """A value that the type cannot carry, assigned unseen, is an EncodeError beginning with the field's path."""
    message = assigned(name, path, value)
    with pytest.raises(EncodeError) as caught:
        message.to_bytes()
    assert text in str(caught.value)


@pytest.mark.parametrize(("name", "path", "value", "text"), [w for w in WRONG if "." not in w[1]])
def test_the_constructor_reports_the_same(name: str, path: str, value: Any, text: str) -> None:
    """The constructor refuses the same values with the same words."""
    with pytest.raises(EncodeError) as caught:
        make(name, **{path: value})
    assert text in str(caught.value)


def test_a_wrong_value_deep_in_a_list_is_reported_by_its_path() -> None:
    """A value assigned to a message that stands in a list is reported with its place in the list."""
    array = make("geometry_msgs/msg/PoseArray", poses=[{}, {}, {}])
    array.poses[2].position.y = "up"
    with pytest.raises(EncodeError, match=r"^PoseArray\.poses\[2\]\.position\.y: expected float64, got 'up'$"):
        array.to_bytes()


@pytest.mark.parametrize("base", sorted(INTEGER_RANGES))
def test_integers_are_checked_to_the_last(base: str) -> None:
    """Every integer type takes its smallest and largest value, and neither neighbour."""
    field = f"{base}_value"
    low, high = INTEGER_RANGES[base]
    for value in (low, high):
        message = assigned("test_msgs/msg/BasicTypes", field, value)
        assert getattr(type(message).from_bytes(message.to_bytes()), field) == value
    for value in (low - 1, high + 1):
        with pytest.raises(EncodeError, match=f"BasicTypes.{field}: {value} does not fit {base}: {low} to {high}"):
            assigned("test_msgs/msg/BasicTypes", field, value).to_bytes()


def test_integers_widen_to_floats() -> None:
    """Whole numbers are as good as floats, given or assigned, alone or in arrays."""
    vector = make("geometry_msgs/msg/Vector3", x=1)
    vector.y = 2
    vector.z = np.int16(3)
    assert vector.to_bytes() == make("geometry_msgs/msg/Vector3", x=1.0, y=2.0, z=3.0).to_bytes()
    array = assigned("std_msgs/msg/Float64MultiArray", "data", [1, 2])
    assert array.to_bytes() == make("std_msgs/msg/Float64MultiArray", data=[1.0, 2.0]).to_bytes()


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("bool_value", np.bool_(True)),
        ("byte_value", np.uint8(200)),
        ("byte_value", b"\xc8"),
        ("char_value", b"A"),
        ("int8_value", np.int64(-5)),
        ("uint16_value", np.int8(5)),
        ("uint64_value", np.uint64(2**64 - 1)),
        ("float32_value", np.float64(0.1)),
        ("float64_value", np.float32(0.5)),
        ("float64_value", np.int32(7)),
        ("float64_value", np.array(7.5)),
    ],
)
def test_numpy_scalars_and_single_bytes_are_taken(field: str, value: Any) -> None:
    """Numpy's scalars of the right kind, and one byte for a byte, are as good as Python's numbers."""
    expected = value[0] if isinstance(value, bytes) else value.item()
    plain = make("test_msgs/msg/BasicTypes", **{field: expected}).to_bytes()
    assert make("test_msgs/msg/BasicTypes", **{field: value}).to_bytes() == plain
    assert assigned("test_msgs/msg/BasicTypes", field, value).to_bytes() == plain


@pytest.mark.parametrize(
    "value",
    [
        [1, 2, 3, 4],
        (1, 2, 3, 4),
        range(1, 5),
        np.array([1, 2, 3, 4]),
        np.array([[1, 2], [3, 4]], np.float64),
        np.array([1, 2, 3, 4], ">f8"),
        np.arange(8, dtype=np.float64)[1:5],
        np.repeat(np.arange(1, 5, dtype=np.float64), 2)[::2],
        np.array([1, 2, 3, 4], np.float32),
    ],
)
def test_any_shape_of_numbers_is_an_array(value: Any) -> None:
    """Sequences and arrays of any layout, byte order and width are encoded alike, given or assigned."""
    name = "std_msgs/msg/Float64MultiArray"
    payload = bytes.fromhex("00010000 00000000 00000000 04000000 00000000") + struct.pack("<4d", 1, 2, 3, 4)
    assert assigned(name, "data", value).to_bytes() == make(name, data=value).to_bytes() == payload


def test_a_matrix_fills_a_fixed_array() -> None:
    """A 6 by 6 covariance is given as the matrix it is."""
    pose = make("geometry_msgs/msg/PoseWithCovariance", covariance=np.eye(6))
    assert pose.covariance.tolist() == np.eye(6).reshape(-1).tolist()


def test_what_was_encoded_is_not_changed() -> None:
    """Converting while encoding leaves the message with what was assigned to it."""
    message = assigned("geometry_msgs/msg/Twist", "linear", {"x": 1})
    payload = message.to_bytes()
    assert message.linear == {"x": 1}
    assert payload == make("geometry_msgs/msg/Twist", linear={"x": 1.0}).to_bytes()


def test_objects_with_the_same_fields_are_taken() -> None:
    """Another object with a nested message's fields is encoded by them."""
    twist = make("geometry_msgs/msg/Twist")
    twist.linear = SimpleNamespace(x=1.0, y=2, z=3.0)
    assert twist.to_bytes() == make("geometry_msgs/msg/Twist", linear={"x": 1, "y": 2, "z": 3}).to_bytes()


def test_a_deleted_field_is_reported() -> None:
    """A field that was deleted is an EncodeError with its path."""
    twist = make("geometry_msgs/msg/Twist")
    del twist.linear.y
    with pytest.raises(EncodeError, match=r"^Twist\.linear\.y: was deleted$"):
        twist.to_bytes()


@pytest.mark.parametrize("wrong", [5, None, "text", {}])
def test_what_is_no_message_is_refused(wrong: Any) -> None:
    """Something else in the place of a message is an EncodeError, not an error of Python's."""
    with pytest.raises(EncodeError, match="expected a message"):
        registry.codec("std_msgs/msg/String").encode(wrong)


def test_a_message_of_another_type_is_refused() -> None:
    """A message without the type's fields is an EncodeError with both types."""
    with pytest.raises(EncodeError, match=r"std_msgs/msg/String: cannot encode geometry_msgs\.msg\.Point"):
        registry.codec("std_msgs/msg/String").encode(make("geometry_msgs/msg/Point"))


def test_a_message_of_fixed_size_is_one_call() -> None:
    """A type of fixed size is written at once, and always to the same length."""
    for values in ({}, {"linear": {"x": -1e300}}, {"angular": {"z": float("nan")}}):
        assert len(make("geometry_msgs/msg/Twist", **values).to_bytes()) == 4 + 6 * 8

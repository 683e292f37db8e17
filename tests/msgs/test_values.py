"""Values put into messages: checked, converted where nothing is lost, refused by their path."""

from __future__ import annotations

from collections import OrderedDict
from types import MappingProxyType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.msgs.values import checked, from_plain
from graphflow.times import Duration, Time
from graphflow.wire.schema import INTEGER_RANGES
from tests.msgs.conftest import make


@pytest.mark.parametrize(
    "value",
    [{"x": 1, "z": 3}, OrderedDict(x=1, z=3.0), MappingProxyType({"x": 1, "z": 3}), SimpleNamespace(x=1, y=0, z=3)],
)
def test_nested_messages_from_mappings_and_objects(value: Any) -> None:
    """A nested message is given as a mapping, in which fields may be missing, or as any object with its fields."""
    twist = make("geometry_msgs/msg/Twist", linear=value)
    assert twist.linear == make("geometry_msgs/msg/Vector3", x=1.0, y=0.0, z=3.0)


def test_times_fit_their_messages() -> None:
    """A `times.Time` or `times.Duration` is taken for the message of that name."""
    header = make("std_msgs/msg/Header", stamp=Time(1_500_000_000))
    assert (header.stamp.sec, header.stamp.nanosec) == (1, 500_000_000)
    status = make("tf2_msgs/action/LookupTransform_Goal", timeout=Duration(-1))
    assert (status.timeout.sec, status.timeout.nanosec) == (-1, 999_999_999)


def test_a_nested_message_is_not_copied() -> None:
    """A message of the right class becomes part of the new one as it is."""
    vector = make("geometry_msgs/msg/Vector3")
    assert make("geometry_msgs/msg/Twist", linear=vector).linear is vector


def test_a_message_of_another_type_is_no_nested_message() -> None:
    """A message of another type is refused, though its fields have the same names."""
    with pytest.raises(
        EncodeError, match=r"^Twist\.linear: expected geometry_msgs/msg/Vector3, got geometry_msgs.msg.Po"
    ):
        make("geometry_msgs/msg/Twist", linear=make("geometry_msgs/msg/Point"))


def test_an_unknown_field_is_helped() -> None:
    """A mapping with a misspelt field is refused with the nearest one."""
    with pytest.raises(EncodeError, match=r"^Header\.stamp: .* has no field 'nanosecs'; did you mean 'nanosec'\?$"):
        make("std_msgs/msg/Header", stamp={"nanosecs": 5})


def test_the_path_leads_through_lists_and_mappings() -> None:
    """A fault deep inside what was given is reported by its whole path."""
    poses = [{"position": {"x": 1}}, {"orientation": {"w": "up"}}]
    with pytest.raises(EncodeError, match=r"^PoseArray\.poses\[1\]\.orientation\.w: expected float64, got 'up'$"):
        make("geometry_msgs/msg/PoseArray", poses=poses)


@pytest.mark.parametrize("base_type", sorted(INTEGER_RANGES))
def test_bools_and_floats_are_no_integers(base_type: str) -> None:
    """An integer field takes neither True nor 1.0, as these are likely mistakes."""
    for value in (True, 1.0, np.float64(1), np.bool_(True), "1"):
        with pytest.raises(EncodeError, match=f"expected {base_type}, got"):
            make("test_msgs/msg/BasicTypes", **{f"{base_type}_value": value})


@pytest.mark.parametrize("value", [0, 1, 1.0, "true", None])
def test_numbers_are_no_bools(value: Any) -> None:
    """A bool field takes True and False only."""
    with pytest.raises(EncodeError, match="expected bool, got"):
        make("std_msgs/msg/Bool", data=value)


def test_floats_keep_their_kind() -> None:
    """An integer or numpy scalar in a float field becomes a Python float at once."""
    for value in (1, np.int8(1), np.float32(1)):
        assert type(make("std_msgs/msg/Float32", data=value).data) is float


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan"), 3.4028234e38])
def test_every_float32_fits_float32(value: float) -> None:
    """Infinities, NaN and the largest float32 are values of float32."""
    assert repr(make("std_msgs/msg/Float32", data=value).data) == repr(value)
    make("std_msgs/msg/Float32", data=value).to_bytes()


def test_an_array_is_taken_as_it_is() -> None:
    """A numpy array of the right type is not copied."""
    array = np.zeros(5, np.float32)
    assert np.shares_memory(make("std_msgs/msg/Float32MultiArray", data=array).data, array)


def test_bounds_hold_exactly() -> None:
    """Strings and sequences may be as long as their bound."""
    message = make("odd_shapes/msg/Bounds", short="five!", wide="abc", labels=["four", ""], numbers=[1, 2, 3])
    assert type(message).from_bytes(message.to_bytes()) == message


def test_checked_copies_and_converts() -> None:
    """`checked` gives a message with every value converted, and leaves the one given alone."""
    message = make("geometry_msgs/msg/Twist")
    message.linear = {"x": 1}
    copy = checked(message)
    assert copy == make("geometry_msgs/msg/Twist", linear={"x": 1.0})
    assert message.linear == {"x": 1}
    assert copy.angular is not message.angular  # type: ignore[attr-defined]


def test_checked_names_the_first_wrong_value() -> None:
    """By its path, also where it was deleted, or stands inside a list; what is no message is refused."""
    poses: Any = make("geometry_msgs/msg/PoseArray", poses=[{}, {}])
    poses.poses[1].position.x = "far"
    with pytest.raises(EncodeError, match=r"^PoseArray\.poses\[1\]\.position\.x: expected float64, got 'far'$"):
        checked(poses)
    twist = make("geometry_msgs/msg/Twist")
    del twist.linear.y
    with pytest.raises(EncodeError, match=r"^Twist\.linear\.y: was deleted$"):
        checked(twist)
    twist.linear = make("geometry_msgs/msg/Point")
    with pytest.raises(EncodeError, match=r"^Twist\.linear: expected geometry_msgs/msg/Vector3, got geometry"):
        checked(twist)
    with pytest.raises(EncodeError, match=r"^String\.data: '\\ud800' is not valid Unicode$"):
        checked(make("std_msgs/msg/String", data="\ud800"))
    with pytest.raises(EncodeError, match=r"^expected a message, got \{\}$"):
        checked({})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "fields", "text"),
    [
        ("std_msgs/msg/String", {"data": 3}, "String.data: expected string, got 3"),
        ("std_msgs/msg/Float32", {"data": 1e39}, "Float32.data: 1e+39 is too large for float32"),
        ("std_msgs/msg/Float32", {"data": "1"}, "Float32.data: expected float32, got '1'"),
        ("std_msgs/msg/UInt8", {"data": 256}, "UInt8.data: 256 does not fit uint8: 0 to 255"),
        (
            "odd_shapes/msg/Bounds",
            {"short": "six!!!"},
            "Bounds.short: expected at most 5 bytes of UTF-8",
        ),
        (
            "odd_shapes/msg/Bounds",
            {"wide": "abcd"},
            "Bounds.wide: expected at most 3 UTF-16 code units",
        ),
        ("odd_shapes/msg/Bounds", {"labels": ["", "", ""]}, "Bounds.labels: expected at most 2 elements"),
        ("odd_shapes/msg/Bounds", {"labels": "ab"}, "Bounds.labels: expected string<=4[<=2], got 'ab'"),
        ("odd_shapes/msg/Bounds", {"numbers": [1, 2, 3, 4]}, "Bounds.numbers: expected at most 3 elements"),
        (
            "test_msgs/msg/Arrays",
            {"string_values": ["a"]},
            "Arrays.string_values: expected 3 elements",
        ),
    ],
)
def test_values_that_do_not_fit(name: str, fields: dict[str, Any], text: str) -> None:
    """The error has the field, what it takes, and what was given."""
    with pytest.raises(EncodeError) as caught:
        make(name, **fields)
    assert str(caught.value).startswith(text)


@pytest.mark.parametrize("field", ["byte_value", "char_value"])
def test_one_byte_is_a_byte(field: str) -> None:
    """ROS 2's byte and char take a number or a `bytes` of length one."""
    assert getattr(make("test_msgs/msg/BasicTypes", **{field: b"A"}), field) == 65
    with pytest.raises(EncodeError, match="expected"):
        make("test_msgs/msg/BasicTypes", **{field: b"AB"})


def test_messages_from_plain_values() -> None:
    """A mapping gives some fields, nothing gives none."""
    twist: Any = registry.interface_class("geometry_msgs/msg/Twist")

    assert from_plain(twist, {"linear": {"x": 1}}) == twist(linear={"x": 1.0})
    assert from_plain(twist, None) == twist()


@pytest.mark.parametrize(
    ("name", "data", "text"),
    [
        (
            "geometry_msgs/msg/Twist",
            [1],
            "geometry_msgs/msg/Twist is written as a mapping, for example {linear",
        ),
        (
            "std_msgs/msg/String",
            "hi",
            "std_msgs/msg/String is written with the names of its fields, as in {data: hi}; got 'hi'",
        ),
        ("std_msgs/msg/Empty", "x", "std_msgs/msg/Empty is written as a mapping, for example {}; got 'x'"),
        (
            "geometry_msgs/msg/Twist",
            {"liner": {}},
            "geometry_msgs/msg/Twist has no field 'liner'; did you mean 'linear'?",
        ),
        ("geometry_msgs/msg/Twist", {3: {}}, "geometry_msgs/msg/Twist has no field 3"),
        ("geometry_msgs/msg/Twist", {"linear": {"x": "a"}}, "Twist.linear.x: expected float64, got 'a'"),
    ],
)
def test_plain_values_that_make_no_message(name: str, data: Any, text: str) -> None:
    """The error says what was meant, or how it is written."""
    cls: Any = registry.interface_class(name)
    with pytest.raises(EncodeError) as caught:
        from_plain(cls, data)
    assert str(caught.value).startswith(text)

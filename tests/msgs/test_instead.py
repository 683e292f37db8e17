"""Advice on values that do not fit."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import pytest

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.msgs.instead import in_its_message, instead_of_rclpys, named
from graphflow.msgs.values import from_plain
from graphflow.times import Duration, Time


@pytest.mark.parametrize(
    ("type_name", "data", "text"),
    [
        ("std_msgs/msg/Float64", "2", "Float64.data: expected float64, got '2'; write 2.0"),
        ("std_msgs/msg/Float64", True, "Float64.data: expected float64, got True; write 1.0"),
        ("std_msgs/msg/Float64", [2], "Float64.data: expected float64, got [2]; write 2.0"),
        ("std_msgs/msg/Float64", [1, 2], "Float64.data: expected float64, got [1, 2]"),
        ("std_msgs/msg/Float64", "far", "Float64.data: expected float64, got 'far'"),
        ("std_msgs/msg/Float64", None, "Float64.data: expected float64, got None"),
        ("std_msgs/msg/Int32", 2.0, "Int32.data: expected int32, got 2.0; write 2"),
        ("std_msgs/msg/Int32", "2", "Int32.data: expected int32, got '2'; write 2"),
        ("std_msgs/msg/Int32", 2.5, "Int32.data: expected int32, got 2.5"),
        ("std_msgs/msg/Int32", float("nan"), "Int32.data: expected int32, got nan"),
        ("std_msgs/msg/Int32", "9" * 5000, None),
        ("std_msgs/msg/String", 5, "String.data: expected string, got 5; write '5'"),
        ("std_msgs/msg/Bool", "yes", "Bool.data: expected bool, got 'yes'; write true (in Python True)"),
        ("std_msgs/msg/Bool", 0, "Bool.data: expected bool, got 0; write false (in Python False)"),
        ("std_msgs/msg/Bool", 5, "Bool.data: expected bool, got 5"),
        ("std_msgs/msg/Float64MultiArray", 2, "Float64MultiArray.data: expected float64[], got 2; write [2.0]"),
        (
            "std_msgs/msg/Float64MultiArray",
            ["1", 2],
            "Float64MultiArray.data[0]: expected float64, got '1'; write 1.0",
        ),
        ("std_msgs/msg/Float64MultiArray", [1.0, "b"], "Float64MultiArray.data[1]: expected float64, got 'b'"),
        ("std_msgs/msg/UInt8MultiArray", [1, 300], "UInt8MultiArray.data[1]: 300 does not fit uint8: 0 to 255"),
        ("std_msgs/msg/UInt8MultiArray", 300, "UInt8MultiArray.data: expected uint8[], got 300"),
        ("std_msgs/msg/UInt8", "300", "UInt8.data: expected uint8, got '300'"),
    ],
)
def test_values_of_primitive_types(type_name: str, data: Any, text: str | None) -> None:
    """Are shown as they are written, where that is no guess."""
    with pytest.raises(EncodeError) as caught:
        from_plain(registry.interface_class(type_name), {"data": data})
    assert text is None or str(caught.value) == text


@pytest.mark.parametrize("stamp", ["now", datetime(2026, 1, 1, tzinfo=UTC)])
def test_stamps(stamp: object) -> None:
    """In a node, its clock gives them."""
    with pytest.raises(EncodeError, match=r"; write \{sec: 0, nanosec: 0\}, in Python self\.clock\.now\(\)$"):
        from_plain(registry.interface_class("std_msgs/msg/Header"), {"stamp": stamp})


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ([1, 2, 3], "got [1, 2, 3]; write {x: 1.0, y: 2.0, z: 3.0}"),
        ((1, 2, 3), "got (1, 2, 3); write Vector3(x=1.0, y=2.0, z=3.0)"),
        (2, "got 2; write {x: 2.0}, in Python Vector3(x=2.0), or z for a turn"),
        ([1, 2], "got [1, 2]; write {x: 0.0, y: 0.0, z: 0.0}"),
    ],
)
def test_messages_in_messages(value: Any, text: str) -> None:
    """Are mappings, with the numbers that were given."""
    with pytest.raises(EncodeError) as caught:
        from_plain(registry.interface_class("geometry_msgs/msg/Twist"), {"linear": value})
    assert str(caught.value) == f"Twist.linear: expected geometry_msgs/msg/Vector3, {text}"


@pytest.mark.parametrize(
    ("field", "value", "text"),
    [
        ("name", "left", "name: expected string[], got 'left'; write ['left']"),
        ("name", ["left", 2], "name[1]: expected string, got 2; write '2'"),
        ("position", 3.0, "position: expected float64[], got 3.0; write [3.0]"),
        ("header", 3.0, "header: expected std_msgs/msg/Header, got 3.0"),
        (
            "header",
            {"stamp": 1795636355.25},
            "header.stamp: expected builtin_interfaces/msg/Time, got 1795636355.25; write self.clock.now(), in a node",
        ),
        (
            "header",
            {"stamp": -1.5},
            "header.stamp: expected builtin_interfaces/msg/Time, got -1.5; write {sec: -2, nanosec: 500000000}",
        ),
    ],
)
def test_lists_and_messages_that_hold_others(field: str, value: Any, text: str) -> None:
    """An element is named by its place; fields that are messages have no number."""
    with pytest.raises(EncodeError) as caught:
        from_plain(registry.interface_class("sensor_msgs/msg/JointState"), {field: value})
    assert str(caught.value) == f"JointState.{text}"


@pytest.mark.parametrize(
    ("type_name", "data", "text"),
    [
        ("std_msgs/msg/String", "it's: me", "{data: 'it''s: me'}"),
        ("std_msgs/msg/Bool", True, "{data: true}"),
        ("std_msgs/msg/Float64", -1.5, "{data: -1.5}"),
        ("geometry_msgs/msg/Point", "1 2 3", "{x: 1, y: 2, z: 3}"),
        ("geometry_msgs/msg/Point", [1, 2.5, 3], "{x: 1, y: 2.5, z: 3}"),
        (
            "geometry_msgs/msg/Twist",
            [[1.0, 0, 0], [0, 0, 2]],
            "{linear: {x: 1.0, y: 0, z: 0}, angular: {x: 0, y: 0, z: 2}}",
        ),
        ("geometry_msgs/msg/Point", "y=1.5 x=-2", "{y: 1.5, x: -2}"),
        ("geometry_msgs/msg/Twist", [1.0, 2.0], None),
        ("geometry_msgs/msg/Point", "1 2", None),
        ("std_msgs/msg/Empty", "x", None),
        ("std_msgs/msg/String", {"a": 1}, None),
    ],
)
def test_values_without_the_names_of_their_fields(type_name: str, data: Any, text: str | None) -> None:
    """They get them in their order, if there are as many."""
    assert named(registry.interface_class(type_name), data) == text


def test_a_minus_of_slides() -> None:
    """A number with it is told with the one of the keyboard."""
    with pytest.raises(EncodeError, match=r"got '\u20131.5'; write -1.5$"):
        from_plain(registry.interface_class("std_msgs/msg/Float64"), {"data": "\u20131.5"})


@pytest.mark.parametrize("span", [Duration(5), Time(5)])
def test_times_as_numbers(span: Any) -> None:
    """They are a number of seconds, or of nanoseconds in a field for whole numbers."""
    with pytest.raises(EncodeError, match=r"expected float64, got \w+\(.*\); write \.seconds behind it$"):
        registry.interface_class("std_msgs/msg/Float64")(data=span).to_bytes()
    with pytest.raises(EncodeError, match=r"expected int64, got \w+\(.*\); write \.nanoseconds behind it$"):
        registry.interface_class("std_msgs/msg/Int64")(data=span).to_bytes()


def test_classes_of_rclpy() -> None:
    """How graphflow's own is imported is told, for a class and for a message."""
    rclpys = type("String", (), {"__module__": "std_msgs.msg._string"})
    way = "that class is rclpy's: write from graphflow.msgs.std_msgs.msg import String"
    own = registry.interface_class("std_msgs/msg/String")
    assert instead_of_rclpys(rclpys) == way
    assert in_its_message(own, rclpys()) == f"; {way}"
    assert instead_of_rclpys(own) == ""

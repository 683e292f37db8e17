"""Fields by their paths."""

from __future__ import annotations

import pytest

from graphflow.errors import UsageFault
from graphflow.introspect.messages.fields import field_path, number_path, numbers, value_at
from graphflow.msgs.geometry_msgs.msg import Point32, Polygon, Twist, Vector3


@pytest.mark.parametrize(
    ("text", "type_name", "path"),
    [
        ("linear", "geometry_msgs/msg/Twist", ["linear"]),
        ("linear.x", "geometry_msgs/msg/Twist", ["linear", "x"]),
        ("points[1].x", "geometry_msgs/msg/Polygon", ["points", 1, "x"]),
        ("double_array_value[10]", "rcl_interfaces/msg/ParameterValue", ["double_array_value", 10]),
    ],
)
def test_paths(text: str, type_name: str, path: list[str | int]) -> None:
    """A path is field names with dots, and elements in square brackets."""
    assert field_path(text, type_name) == path


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("liner.x", "geometry_msgs/msg/Twist has no field 'liner'; did you mean 'linear'?"),
        ("linear.w", "geometry_msgs/msg/Vector3 has no field 'w'; there is x, y, z"),
        ("linear.x.y", "linear.x is of type float64 and has no field 'y'"),
        ("linear[0]", "linear is of type geometry_msgs/msg/Vector3 and has no elements"),
        ("[0]", "write FIELD.FIELD or FIELD[0]"),
        ("linear[a]", "write FIELD.FIELD or FIELD[0]"),
        ("linear..x", "write FIELD.FIELD or FIELD[0]"),
        (".", "write FIELD.FIELD or FIELD[0]"),
    ],
)
def test_wrong_paths(text: str, message: str) -> None:
    """A field that the type does not have is an error before the first message comes."""
    with pytest.raises(UsageFault) as caught:
        field_path(text, "geometry_msgs/msg/Twist")
    assert message in str(caught.value)


def test_a_field_of_a_list_needs_an_element() -> None:
    """The error for a missing index shows how to write it."""
    with pytest.raises(UsageFault, match=r"points is a list; choose an element, as in points\[0\]"):
        field_path("points.x", "geometry_msgs/msg/Polygon")


def test_the_numbers_of_a_type() -> None:
    """All numbers are listed by path, including nested ones, without texts and arrays."""
    assert numbers("geometry_msgs/msg/Twist")[:4] == ["linear.x", "linear.y", "linear.z", "angular.x"]
    assert numbers("std_msgs/msg/String") == []
    assert numbers("std_msgs/msg/Bool") == ["data"]
    assert "ranges" not in numbers("sensor_msgs/msg/LaserScan")
    assert "angle_min" in numbers("sensor_msgs/msg/LaserScan")


@pytest.mark.parametrize(
    ("text", "type_name", "message"),
    [
        (
            "linear",
            "geometry_msgs/msg/Twist",
            "linear is of type geometry_msgs/msg/Vector3, not a number; choose a field",
        ),
        ("linear", "geometry_msgs/msg/Twist", "as in linear.x"),
        ("data", "std_msgs/msg/String", "data is of type string, not a number"),
        ("ranges", "sensor_msgs/msg/LaserScan", r"ranges is a list; choose an element, as in ranges\[0\]"),
        ("layout", "std_msgs/msg/Float64MultiArray", "layout.data_offset"),
        ("linear.q", "geometry_msgs/msg/Twist", "has no field 'q'"),
    ],
)
def test_what_is_no_number(text: str, type_name: str, message: str) -> None:
    """A path that is not a number is an error before the first message, with a suggestion."""
    with pytest.raises(UsageFault, match=message):
        number_path(text, type_name)


def test_values() -> None:
    """Values are found by names and indexes."""
    assert value_at(Twist(linear=Vector3(x=2.0)), number_path("linear.x", "geometry_msgs/msg/Twist")) == 2.0
    polygon = Polygon(points=[Point32(y=3.0)])
    assert value_at(polygon, number_path("points[0].y", "geometry_msgs/msg/Polygon")) == 3.0
    with pytest.raises(IndexError):
        value_at(polygon, ["points", 1, "y"])

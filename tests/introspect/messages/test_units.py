"""Units of standard messages' fields."""

from __future__ import annotations

import pytest

from graphflow.introspect.messages.fields import field_path
from graphflow.introspect.messages.units import _UNITS, unit
from graphflow.msgs import registry


@pytest.mark.parametrize(
    ("type_name", "field", "expected"),
    [
        ("geometry_msgs/msg/Twist", "linear.x", "m/s"),
        ("geometry_msgs/msg/TwistStamped", "twist.angular.z", "rad/s"),
        ("geometry_msgs/msg/PoseStamped", "pose.position.y", "m"),
        ("geometry_msgs/msg/PoseStamped", "pose.orientation.w", ""),
        ("geometry_msgs/msg/Vector3", "x", ""),
        ("sensor_msgs/msg/LaserScan", "ranges[3]", "m"),
        ("sensor_msgs/msg/LaserScan", "header.stamp.sec", "s"),
        ("std_msgs/msg/Float64", "data", ""),
    ],
)
def test_the_type_that_knows_the_unit_is_found_on_the_way(type_name: str, field: str, expected: str) -> None:
    """A vector has none of its own: a twist knows those of its vectors."""
    assert unit(field_path(field, type_name), type_name) == expected


def test_every_field_named_is_there() -> None:
    """Every field in the table exists; a misspelt one would silently have no unit."""
    for type_name, fields in _UNITS.items():
        assert {*fields} <= {f.name for f in registry.message_schema(type_name).fields}, type_name

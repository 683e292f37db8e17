"""Messages as plain data and text."""

from __future__ import annotations

import pytest
import yaml
from geometry_msgs.msg import Polygon, PoseWithCovariance
from rosidl_runtime_py import message_to_csv, message_to_ordereddict, message_to_yaml
from rosidl_runtime_py.set_message import set_message_fields
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Byte, ColorRGBA, String

SCAN = LaserScan(ranges=[1.0, 2.5, 3.0], angle_min=-1.0)
SCAN.header.frame_id = "laser_of_the_front"


def test_all_of_it() -> None:
    """In the order of the fields; what comes out can be put into another message."""
    plain = message_to_ordereddict(SCAN)
    assert list(plain)[:2] == ["header", "angle_min"]
    assert plain["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "laser_of_the_front"}
    assert (plain["ranges"], plain["angle_min"]) == ([1.0, 2.5, 3.0], -1.0)
    again = LaserScan()
    set_message_fields(again, plain)
    assert again == SCAN
    assert yaml.safe_load(message_to_yaml(SCAN)) == plain
    assert message_to_yaml(ColorRGBA(r=3.0)) == "r: 3.0\ng: 0.0\nb: 0.0\na: 0.0\n"
    assert message_to_yaml(ColorRGBA(r=3.0), flow_style=True) == "{r: 3.0, g: 0.0, b: 0.0, a: 0.0}\n"
    assert message_to_csv(SCAN) == "0,0,laser_of_the_front,-1.0,0.0,0.0,0.0,0.0,0.0,0.0,1.0,2.5,3.0,"
    assert message_to_ordereddict(Byte(data=b"a")) == {"data": "a"}


def test_what_is_long_is_cut() -> None:
    """Arrays and texts, by the same number; or they are told by type and length alone."""
    cut = message_to_ordereddict(SCAN, truncate_length=2)
    assert (cut["header"]["frame_id"], cut["ranges"]) == ("la...", [1.0, 2.5, "..."])
    assert message_to_csv(String(data="abcd"), truncate_length=3) == "abc..."
    assert message_to_csv(SCAN, truncate_length=1).endswith(",1.0,...,")
    none = message_to_ordereddict(SCAN, no_arr=True, no_str=True)
    assert none["ranges"] == "<sequence type: float, length: 3>"
    assert none["header"]["frame_id"] == "<string length: <18>>"
    assert message_to_csv(String(data="abcd"), no_str=True) == "<string length: <4>>"


@pytest.mark.parametrize(
    ("message", "info"),
    [
        (PoseWithCovariance(), "<array type: double[36]>"),
        (Polygon(), "<sequence type: geometry_msgs/msg/Point32, length: 0>"),
    ],
)
def test_types_of_arrays(message: object, info: str) -> None:
    """In rosidl's words."""
    assert list(message_to_ordereddict(message, no_arr=True).values())[-1] == info
    assert message_to_csv(message, no_arr=True).endswith(info)

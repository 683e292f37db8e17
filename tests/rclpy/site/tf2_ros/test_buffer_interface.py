"""What all buffers can do."""

from __future__ import annotations

from typing import Any

import pytest
from geometry_msgs.msg import PointStamped
from tf2_ros.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)

from rclpy.time import Time


class Mine:
    """A type of a program's own, with a header."""

    def __init__(self, value: str) -> None:
        self.value = value
        self.header = PointStamped().header
        self.header.frame_id = "laser"


class Asks(BufferInterface):
    """One whose transforms are what it was asked for."""

    def lookup_transform(self, *asked: Any) -> Any:
        return asked

    def lookup_transform_full(self, *asked: Any) -> Any:
        return asked


def test_a_programs_own_types_are_transformed_as_it_says() -> None:
    """From the frame and the time in their header."""
    buffer, mine = Asks(), Mine("a")
    with pytest.raises(TypeException, match=r"Mine.* is not loaded or supported"):
        buffer.transform(mine, "map")
    TransformRegistration().add(Mine, lambda what, found: (what.value, found[:3]))
    assert buffer.transform(mine, "map") == ("a", ("map", "laser", Time.from_msg(mine.header.stamp)))
    value, found = buffer.transform_full(mine, "map", 5, "odom")
    assert (value, found) == ("a", ("map", 5, "laser"))


def test_types_become_others_by_way_of_a_message() -> None:
    """Or at once, where somebody has said how."""
    registration = ConvertRegistration()
    registration.add_to_msg(Mine, lambda mine: PointStamped(header=mine.header))
    registration.add_from_msg(Stamped, lambda message: Stamped(None, 0, message.header.frame_id))
    assert convert(Mine("a"), Stamped).frame_id == "laser"
    registration.add_convert((Mine, str), lambda mine: mine.value)
    assert convert(Mine("a"), str) == "a"
    assert convert(5, int) == 5
    with pytest.raises(TypeException):
        convert("a", int)


def test_what_a_buffer_has_not_is_told() -> None:
    """By an exception of its own."""
    with pytest.raises(NotImplementedException):
        BufferInterface().lookup_transform("a", "b", 0)
    with pytest.raises(NotImplementedException):
        BufferInterface().can_transform("a", "b", 0)

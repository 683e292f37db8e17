"""The objects at hand in a program's own code."""

from __future__ import annotations

import sys
from typing import Any

from std_msgs.msg import Header

from graphflow.rclpy.hints.frames import named


class Node:
    """Something that would run code if its attributes were looked up."""

    def __init__(self) -> None:
        self.header = Header()

    @property
    def costly(self) -> Any:
        raise AssertionError("it must not run")


def test_named() -> None:
    """An object is found by its path as far as no code of the user's has to run for it."""
    node = Node()
    frame = sys._getframe()
    assert named("node.header.stamp", frame) is node.header.stamp
    assert (named("node.costly", frame), named("nothing.here", frame)) == (None, None)

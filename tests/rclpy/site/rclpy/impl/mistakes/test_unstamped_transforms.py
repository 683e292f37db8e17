"""Transforms that are sent without a stamp."""

from __future__ import annotations

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Header
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

from rclpy.impl.mistakes import unstamped_transforms
from rclpy.node import Node
from rclpy.parameter import Parameter


@pytest.fixture(autouse=True)
def _nothing_reported() -> None:
    unstamped_transforms._reported.clear()


def transform(frame: str, sec: int = 0) -> TransformStamped:
    return TransformStamped(header=Header(frame_id="odom", stamp=Time(sec=sec)), child_frame_id=frame)


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [message for message in caplog.messages if "no stamp" in message]


def test_the_second_without_a_stamp(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """Is reported at the line that sends it, once, with what to write."""
    moving = TransformBroadcaster(node)
    for _ in range(3):
        moving.sendTransform(transform("base"))
        moving.sendTransform([transform("other")])
    line = test_the_second_without_a_stamp.__code__.co_firstlineno + 4
    assert told(caplog) == [
        f"test_unstamped_transforms.py:{line}: the transforms of 'base' have no stamp, so that listeners take all of "
        "them for the same moment; write transform.header.stamp = self.get_clock().now().to_msg() before"
    ]


def test_transforms_with_a_stamp_or_that_are_sent_once(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """Are not reported, nor are static ones, which need none."""
    moving, still = TransformBroadcaster(node), StaticTransformBroadcaster(node)
    moving.sendTransform([transform("base"), transform("other")])
    for sec in range(1, unstamped_transforms.CHECKED):
        moving.sendTransform(transform("base", sec))
        still.sendTransform(transform("base"))
    moving.sendTransform(transform("base"))  # checked no more
    assert told(caplog) == []


def test_the_beginning_of_a_simulation(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """Has the stamp 0."""
    node.set_parameters([Parameter("use_sim_time", value=True)])
    moving = TransformBroadcaster(node)
    for _ in range(3):
        moving.sendTransform(transform("base"))
    assert told(caplog) == []

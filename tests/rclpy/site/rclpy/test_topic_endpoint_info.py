"""Endpoints of a topic."""

from __future__ import annotations

import pytest

from rclpy.qos import QoSProfile
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum


def test_it_is_filled_by_name_and_checked() -> None:
    """At the beginning and later."""
    info = TopicEndpointInfo(node_name="a", endpoint_type=1, qos_profile=QoSProfile(depth=3).to_dict())
    assert info.endpoint_type is TopicEndpointTypeEnum.PUBLISHER
    assert info.qos_profile.depth == 3
    info.topic_type = "std_msgs/msg/String"
    assert info != TopicEndpointInfo()
    with pytest.raises(AssertionError):
        info.node_name = 3
    with pytest.raises(AssertionError):
        TopicEndpointInfo(colour="red")


def test_it_can_be_read() -> None:
    """As `ros2 topic info -v` shows it."""
    shown = str(TopicEndpointInfo(endpoint_gid=[1, 255], qos_profile=QoSProfile(depth=3)))
    assert "GID: 01.ff" in shown
    assert "History (Depth): KEEP_LAST (3)" in shown
    assert "Reliability: UNKNOWN" in str(TopicEndpointInfo())

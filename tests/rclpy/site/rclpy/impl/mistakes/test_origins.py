"""The lines of user code that create entities."""

from __future__ import annotations

import inspect

from std_msgs.msg import String

from rclpy.node import Node


def test_who_creates_an_entity(node: Node) -> None:
    """The line and function of user code; none for graphflow's own entities."""
    publisher = node.create_publisher(String, "chat", 10)
    frame = inspect.currentframe()
    assert frame is not None
    origin = publisher.made_at
    assert origin is not None
    assert (origin.code, origin.name) == (frame.f_code, "/chat")
    assert origin.place.line == frame.f_code.co_firstlineno + 2
    own = next(p for p in node.publishers if p.topic_name == "/rosout" or p.topic_name == "/parameter_events")
    assert own.made_at is None

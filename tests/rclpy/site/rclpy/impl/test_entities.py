"""What entities are called."""

from __future__ import annotations

from example_interfaces.action import Fibonacci
from std_msgs.msg import String
from std_srvs.srv import Trigger

from rclpy.action import ActionClient, ActionServer
from rclpy.impl.entities import role_of
from rclpy.node import Node


def test_each_is_called_by_its_callback(node: Node) -> None:
    """Clients have none; they are called by what they ask."""

    def heard(*_: object) -> None:
        """Does nothing."""

    rate = node.create_rate(1.0)
    made = [
        (node.create_timer(1.0, heard), "timer heard"),
        (node.create_subscription(String, "news", heard, 1), "subscription heard"),
        (node.create_service(Trigger, "ask", heard), "service heard"),
        (node.create_client(Trigger, "ask"), "reply /ask"),
        (node.create_guard_condition(heard), "guard_condition heard"),
        (ActionServer(node, Fibonacci, "count", heard), "action heard"),
        (ActionClient(node, Fibonacci, "count"), "reply /count"),
        (rate._timer, "timer rate"),
    ]
    assert [role_of(entity).label for entity, _ in made] == [label for _, label in made]
    assert [role_of(entity).is_inner for entity, _ in made] == [False] * 7 + [True]

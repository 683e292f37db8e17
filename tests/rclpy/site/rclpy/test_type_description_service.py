"""Descriptions of types."""

from typing import Any

from graphflow.rclpy.context_state import LOOP
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.type_description_service import START_TYPE_DESCRIPTION_SERVICE_PARAM


def test_a_parameter_says_whether_there_is_the_service(node: Node) -> None:
    """By default there is."""
    assert node.get_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM).value is True
    services = [name for name, _ in node.get_service_names_and_types()]
    assert "/node/get_type_description" in services
    off: Parameter[Any] = Parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM, value=False)
    Node("other", parameter_overrides=[off])
    services = [name for name, _ in node.get_service_names_and_types()]
    assert "/other/get_type_description" not in services
    assert not LOOP.is_here

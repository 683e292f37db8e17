"""What a node sees of the graph."""

from __future__ import annotations

import pytest
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

from rclpy._rclpy_pybind11 import NodeNameNonExistentError
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy


def test_nodes_topics_and_services(node: Node) -> None:
    """Of all, and of one."""
    other = Node("other", namespace="/ns")
    other.create_publisher(String, "t", 1)
    node.create_subscription(String, "/ns/t", print, 1)
    other.create_service(AddTwoInts, "s", print)
    node.create_client(AddTwoInts, "/ns/s")
    assert node.get_node_names_and_namespaces() == [("node", "/"), ("other", "/ns")]
    assert node.get_node_names_and_namespaces_with_enclaves()[1] == ("other", "/ns", "/")
    assert node.get_fully_qualified_node_names() == ["/node", "/ns/other"]
    assert ("/ns/t", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
    assert ("/ns/s", ["example_interfaces/srv/AddTwoInts"]) in node.get_service_names_and_types()
    assert ("/ns/t", ["std_msgs/msg/String"]) in node.get_publisher_names_and_types_by_node("other", "/ns")
    assert node.get_subscriber_names_and_types_by_node("node", "/") == [("/ns/t", ["std_msgs/msg/String"])]
    assert node.get_client_names_and_types_by_node("node", "/") == [("/ns/s", ["example_interfaces/srv/AddTwoInts"])]
    assert ("/ns/s", ["example_interfaces/srv/AddTwoInts"]) in node.get_service_names_and_types_by_node("other", "/ns")
    assert (other.count_publishers("t"), other.count_subscribers("t")) == (1, 1)
    assert (other.count_services("s"), other.count_clients("s")) == (1, 1)
    with pytest.raises(NodeNameNonExistentError, match="/nobody"):
        node.get_publisher_names_and_types_by_node("nobody", "/")


def test_endpoints_of_a_topic(node: Node) -> None:
    """With type, hash and quality of service."""
    node.create_publisher(String, "t", QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT))
    (info,) = node.get_publishers_info_by_topic("t")
    assert (info.node_name, info.node_namespace, info.topic_type) == ("node", "/", "std_msgs/msg/String")
    assert str(info.topic_type_hash).startswith("RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021")
    assert info.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert node.get_subscriptions_info_by_topic("/t") == []
    for wrong in (3, None):
        with pytest.raises(TypeError):
            node.get_publishers_info_by_topic(wrong)  # type: ignore[arg-type]
        with pytest.raises(TypeError):
            node.count_publishers(wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="is invalid"):
        node.get_publishers_info_by_topic("4")

"""Policies from parameters."""

from __future__ import annotations

from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import HistoryPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import InvalidQosOverridesError, QoSOverridingOptions


def test_parameters_override_the_policies_that_may_be() -> None:
    """They are there to be read, for each endpoint of its own name."""
    rclpy.init()
    prefix = "qos_overrides./t.publisher"
    overrides: list[Parameter[Any]] = [
        Parameter(f"{prefix}.depth", value=7),
        Parameter(f"{prefix}.reliability", value="best_effort"),
        Parameter(f"{prefix}_other.depth", value=8),
    ]
    node = Node("node", parameter_overrides=overrides)
    options = QoSOverridingOptions.with_default_policies()
    made = node.create_publisher(String, "t", 10, qos_overriding_options=options)
    assert (made.qos_profile.depth, made.qos_profile.reliability) == (7, ReliabilityPolicy.BEST_EFFORT)
    assert node.get_parameter(f"{prefix}.history").value == "keep_last"
    other = QoSOverridingOptions([QoSPolicyKind.DEPTH, QoSPolicyKind.DEADLINE], entity_id="other")
    made = node.create_publisher(String, "t", QoSProfile(depth=1), qos_overriding_options=other)
    assert made.qos_profile.depth == 8
    again = node.create_publisher(String, "t", 10, qos_overriding_options=options)
    assert again.qos_profile.history is HistoryPolicy.KEEP_LAST


def test_a_callback_may_refuse_the_result(node: Node) -> None:
    """With its reason."""
    refused = SetParametersResult(successful=False, reason="too deep")
    options = QoSOverridingOptions.with_default_policies(callback=lambda profile: refused)
    with pytest.raises(InvalidQosOverridesError, match="too deep"):
        node.create_subscription(String, "t", print, 10, qos_overriding_options=options)

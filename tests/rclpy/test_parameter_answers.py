"""What is answered of parameters while nobody spins."""

from __future__ import annotations

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor

from graphflow.msgs.rcl_interfaces import srv
from graphflow.rclpy.parameter_answers import ParameterAnswers
from rclpy.node import Node
from rclpy.parameter import Parameter


def test_values_types_names_and_descriptions(node: Node) -> None:
    """What is unknown, or has no value yet, is not set."""
    ranges = [FloatingPointRange(from_value=0.0, to_value=9.0, step=0.5)]
    node.declare_parameter("gain", 1.5, ParameterDescriptor(description="How much.", floating_point_range=ranges))
    node.declare_parameter("names.first", ["a", "b"])
    node.declare_parameter("later", Parameter.Type.INTEGER)
    answers = ParameterAnswers(node._graphflow.parameters)
    got = answers.get(srv.GetParameters.Request(names=["gain", "names.first", "later", "unknown"])).values
    assert [value.type for value in got] == [3, 9, 0, 0]
    assert (got[0].double_value, got[1].string_array_value) == (1.5, ["a", "b"])
    assert list(answers.get_types(srv.GetParameterTypes.Request(names=["gain", "unknown"])).types) == [3, 0]
    listed = answers.list(srv.ListParameters.Request(prefixes=["names"])).result
    assert (listed.names, listed.prefixes) == (["names.first"], ["names"])
    described = answers.describe(srv.DescribeParameters.Request(names=["gain", "unknown"])).descriptors
    assert (described[0].description, described[0].floating_point_range[0].step) == ("How much.", 0.5)
    assert described[1].name == "unknown"

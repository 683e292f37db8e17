"""The parameters of other nodes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from tests.rclpy.conftest import Spinner


def test_all_that_can_be_asked(node: Node, spin: Spinner, tmp_path: Path) -> None:
    """Values, types, names, descriptions; set one by one, at once, deleted and from a file."""
    other = Node("other", allow_undeclared_parameters=True)
    other.declare_parameter("a.b", 1)
    spin.executor.add_node(other)
    client = AsyncParameterClient(node, "other")
    assert client.wait_for_services(5)
    assert client.services_are_ready()

    def told(future: Any) -> Any:
        spin(future.done)
        return future.result()

    calls: list[Any] = []
    assert told(client.get_parameters(["a.b"], calls.append)).values[0].integer_value == 1
    spin(lambda: len(calls) == 1)
    assert list(told(client.get_parameter_types(["a.b"])).types) == [2]
    assert told(client.list_parameters(["a"], 1)).result.names == ["a.b"]
    assert told(client.describe_parameters(["a.b"])).descriptors[0].name == "a.b"
    results = told(client.set_parameters([Parameter("a.b", value=2), Parameter("a.b", value="x")])).results
    assert [result.successful for result in results] == [True, False]
    both = [Parameter("a.b", value=3).to_parameter_msg(), Parameter("c", value=1)]
    assert told(client.set_parameters_atomically(both)).result.successful
    assert told(client.delete_parameters(["c"])).results[0].successful
    assert not other.has_parameter("c")
    file = tmp_path / "p.yaml"
    file.write_text("/other: {ros__parameters: {a: {b: 9}}}\n")
    assert told(client.load_parameter_file(str(file))).results[0].successful
    assert told(client.load_parameter_file_atomically(str(file))).result.successful
    assert other.get_parameter("a.b").value == 9


def test_waiting_for_a_node_that_does_not_come_ends(node: Node) -> None:
    """In time."""
    assert not AsyncParameterClient(node, "nobody").wait_for_services(0.01)


def test_changes_are_told(node: Node, spin: Spinner) -> None:
    """Those of all nodes."""
    events: list[Any] = []
    AsyncParameterClient(node, "node").on_parameter_event(events.append)
    node.declare_parameter("x", 1)
    spin(lambda: events)
    assert events[0].new_parameters[0].name == "x"

"""A node's parameters, as it and others see them."""

from __future__ import annotations

from typing import Any

import pytest
from rcl_interfaces.msg import ParameterEvent, SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically

from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.node import Node
from rclpy.parameter import Parameter
from tests.rclpy.conftest import Spinner


def test_parameters_are_got_one_by_one_and_together(node: Node) -> None:
    """With their types; or an alternative."""
    node.declare_parameters("arm", [("length", 1.5), ("name", "left")])
    assert [p.value for p in node.get_parameters(["arm.length", "arm.name"])] == [1.5, "left"]
    assert node.get_parameter_types(["arm.name"]) == [Parameter.Type.STRING]
    assert node.get_parameters_by_prefix("arm")["name"].value == "left"
    alternative: Parameter[Any] = Parameter("x", value=3)
    assert node.get_parameter_or("x", alternative) is alternative
    assert node.get_parameter_or("x").value is None
    assert node.get_parameter_or("arm.name", alternative).value == "left"
    assert [d.name for d in node.describe_parameters(["arm.name"])] == ["arm.name"]
    with pytest.raises(ParameterNotDeclaredException):
        node.get_parameter_type("x")
    with pytest.raises(TypeError):
        node.get_parameters([3])  # type: ignore[list-item]


def test_callbacks_are_added_and_removed(node: Node) -> None:
    """The newest is asked first."""
    asked: list[str] = []

    def check(name: str) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        def look(parameters: Any) -> Any:
            asked.append(name)
            return SetParametersResult(successful=True)

        return look

    node.declare_parameter("a", 1)
    old, new = check("old"), check("new")
    node.add_on_set_parameters_callback(old)
    node.add_on_set_parameters_callback(new)
    node.set_parameters([Parameter("a", value=2)])
    node.remove_on_set_parameters_callback(old)
    node.set_parameters_atomically([Parameter("a", value=3)])
    assert asked == ["new", "old", "new"]
    with pytest.raises(ValueError, match="not in list"):
        node.remove_on_set_parameters_callback(old)


def test_others_read_and_set_them(node: Node, spin: Spinner) -> None:
    """Setting is refused with the reason; what a check raises is one."""
    node.declare_parameter("a", 1)

    def call(type_: Any, name: str, **fields: Any) -> Any:
        client = node.create_client(type_, f"/node/{name}")
        assert client.wait_for_service(5)
        future = client.call_async(type_.Request(**fields))
        spin(future.done)
        return future.result()

    good, wrong = Parameter("a", value=2).to_parameter_msg(), Parameter("b", value=1).to_parameter_msg()
    results = call(SetParameters, "set_parameters", parameters=[good, wrong]).results
    assert [r.successful for r in results] == [True, False]
    assert "undeclared" in results[1].reason
    assert not call(SetParametersAtomically, "set_parameters_atomically", parameters=[good, wrong]).result.successful
    assert call(GetParameters, "get_parameters", names=["a"]).values[0].integer_value == 2


def test_changes_are_published(node: Node, spin: Spinner) -> None:
    """What is new, changed and deleted."""
    events: list[Any] = []
    node.create_subscription(ParameterEvent, "/parameter_events", events.append, 10)
    node.declare_parameter("a", 1)
    node.set_parameters([Parameter("a", value=2)])
    node.undeclare_parameter("a")
    spin(lambda: len(events) == 3)
    on_change = [(e.new_parameters, e.changed_parameters, e.deleted_parameters) for e in events]
    assert [[p.name for p in part] for event in on_change for part in event if part] == [["a"], ["a"], ["a"]]
    assert events[0].node == "/node"


def test_values_that_are_refused_while_nobody_looks(
    node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture
) -> None:
    """OnChange with the line; not where the result is used, or was asked for by another node."""
    node.declare_parameter("n", 5)
    wrong: Parameter[Any] = Parameter("n", value="seven")
    node.set_parameters([wrong])
    node.set_parameters_atomically([wrong, wrong])
    results = node.set_parameters([wrong])
    assert not results[0].successful
    asked = SetParametersAtomically.Request(parameters=[wrong.to_parameter_msg()])
    answer = node.create_client(SetParametersAtomically, "node/set_parameters_atomically").call_async(asked)
    spin(answer.done)
    line = test_values_that_are_refused_while_nobody_looks.__code__.co_firstlineno + 6
    why = "was not set, and the result that reports it is ignored: Wrong parameter type, expected 'Type.INTEGER'"
    first, second = [record.getMessage() for record in caplog.records if record.name == "graphflow"]
    assert first.startswith(f"test_parameter_methods.py:{line}: n {why}")
    assert second.startswith(f"test_parameter_methods.py:{line + 1}: n, n {why}")


def test_values_that_are_refused_without_a_reason(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """OnChange to be so."""
    node.declare_parameter("n", 5)
    node.add_on_set_parameters_callback(lambda parameters: SetParametersResult(successful=False))
    node.set_parameters([Parameter("n", value=6)])
    (text,) = [record.getMessage() for record in caplog.records if record.name == "graphflow"]
    assert text.endswith("is ignored: (the callback gave no reason)")


def test_callbacks_that_raise_for_others(node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture) -> None:
    """Are on_change in the node's own log, too, with the line; what the caller has done wrong is not."""
    node.declare_parameter("n", 5)

    def check(parameters: Any) -> Any:
        return parameters.name

    def ask(*parameters: Parameter[Any]) -> str:
        request = SetParametersAtomically.Request(parameters=[p.to_parameter_msg() for p in parameters])
        client = node.create_client(SetParametersAtomically, "node/set_parameters_atomically")
        answer: Any = client.call_async(request)
        spin(answer.done)
        return str(answer.result().result.reason)

    assert "unknown" in ask(Parameter("unknown", value=6))
    assert caplog.records == []
    node.add_on_set_parameters_callback(check)
    reason = "'list' object has no attribute 'name'"
    assert ask(Parameter("n", value=6)) == reason
    line = check.__code__.co_firstlineno + 1
    assert [record.getMessage() for record in caplog.records] == [
        f"parameters were not set: test_parameter_methods.py:{line}: AttributeError: {reason}; that is a list of "
        "parameters: for parameter in parameters, and parameter.name"
    ]
    caplog.clear()
    node.remove_on_set_parameters_callback(check)
    node.add_on_set_parameters_callback(lambda parameters: True)
    reason = ask(Parameter("n", value=6))
    assert reason.endswith("must return SetParametersResult(successful=True), of rcl_interfaces.msg, and returned bool")
    assert [record.getMessage() for record in caplog.records] == [f"parameters were not set: {reason}"]

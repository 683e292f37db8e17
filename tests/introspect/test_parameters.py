"""The parameters of a node, read and set from outside."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.errors import CallError, ParameterError, UsageFault
from graphflow.introspect.graph_view import View
from graphflow.introspect.parameters import STARTING, RemoteParameters, read_value
from graphflow.msgs.rcl_interfaces.msg import ListParametersResult, ParameterDescriptor, ParameterValue
from graphflow.msgs.rcl_interfaces.msg import SetParametersResult as Result
from graphflow.msgs.rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters

INTEGER = 2


class Robot(View):
    """A look at a graph with one node, whose parameters are integers.

    Args:
        is_strict: It answers as ROS 2's nodes do, with nothing at all when one name is unknown to it.
    """

    def __init__(self, *, is_strict: bool) -> None:
        self.is_strict = is_strict
        self.values = {"speed": 3, "gain": 5}
        self.calls: list[str] = []

    def wait_for_service(self, name: str, timeout: float, wanted: str = "") -> None:
        assert timeout == STARTING
        if not name.startswith("/robot/"):
            raise CallError(f"no node offers the service {name}")

    def call(self, name: str, type_name: str, request: Any, timeout: float = 10.0, *, plain: bool = False) -> Any:
        self.calls.append(name)
        assert timeout == 1.5
        match request:
            case ListParameters.Request():
                return ListParameters.Response(result=ListParametersResult(names=list(self.values)))
            case GetParameters.Request():
                values = [ParameterValue(type=INTEGER, integer_value=self.values[n]) if n in self.values
                          else ParameterValue() for n in request.names]  # fmt: skip
                return GetParameters.Response(values=[] if self.refuses(request.names) else values)
            case DescribeParameters.Request():
                found = [
                    ParameterDescriptor(name=n, type=INTEGER * (n in self.values), dynamic_typing=n == "unset")
                    for n in request.names
                ]
                return DescribeParameters.Response(descriptors=[] if self.refuses(request.names) else found)
            case SetParameters.Request():
                self.values |= {p.name: p.value.integer_value for p in request.parameters}
                return SetParameters.Response(results=[Result(successful=True) for _ in request.parameters])
        raise AssertionError(request)

    def refuses(self, names: Any) -> bool:
        return self.is_strict and not set(names) <= set(self.values)


@pytest.fixture(params=[False, True], ids=["graphflow", "ros2"])
def robot(request: pytest.FixtureRequest) -> Robot:
    return Robot(is_strict=request.param)


@pytest.fixture
def remote(robot: Robot) -> RemoteParameters:
    return RemoteParameters(robot, "/robot", 1.5)


def test_names(remote: RemoteParameters) -> None:
    """All of them, sorted."""
    assert remote.names() == ["gain", "speed"]


def test_get(remote: RemoteParameters, robot: Robot) -> None:
    """Values in the order of the names, by one call."""
    assert [v.integer_value for v in remote.get(["speed", "gain"])] == [3, 5]
    assert robot.calls == ["/robot/get_parameters"]


def test_get_with_one_that_is_not_there(remote: RemoteParameters) -> None:
    """A missing parameter has no type; the others have their values, whatever node answers."""
    found = remote.get(["speed", "sped", "gain"])
    assert [(v.type, v.integer_value) for v in found] == [(INTEGER, 3), (0, 0), (INTEGER, 5)]


def test_describe(remote: RemoteParameters, robot: Robot) -> None:
    """Existing parameters are described by name; an empty request makes no call."""
    assert set(remote.describe(["speed", "sped", "gain"])) == {"speed", "gain"}
    robot.calls.clear()
    assert remote.describe([]) == {}
    assert robot.calls == []


def test_a_parameter_that_is_declared_without_a_value(remote: RemoteParameters, robot: Robot) -> None:
    """A parameter declared without a value is known, but has no type yet."""
    robot.is_strict = False
    assert remote.known("unset").type == 0


def test_set(remote: RemoteParameters, robot: Robot) -> None:
    """A result for each."""
    value = ParameterValue(type=INTEGER, integer_value=7)
    assert [r.successful for r in remote.set({"gain": value, "speed": value})] == [True, True]
    assert robot.values == {"gain": 7, "speed": 7}


def test_one_that_must_be_there(remote: RemoteParameters) -> None:
    """Its declaration; or an error that names the node and the nearest."""
    assert remote.known("gain").name == "gain"
    with pytest.raises(ParameterError, match=r"^node /robot has no parameter 'gian'; did you mean 'gain'"):
        remote.known("gian")
    told = "two nodes are called /robot, and one has no parameter 'gain'; rename one"
    assert str(remote.unknown("gain")) == told  # the second answer comes from the other node


def test_a_node_without_parameter_services(robot: Robot) -> None:
    """The missing services are reported before any call."""
    with pytest.raises(CallError, match="/other/list_parameters"):
        RemoteParameters(robot, "/other", 1.5).names()
    assert robot.calls == []


def test_a_comment_as_a_value() -> None:
    """YAML reads nothing; the error has the quotes. A parameter of text takes it as it is."""
    with pytest.raises(UsageFault, match="'#ff0000' has no value, since # begins a comment in YAML"):
        read_value("#ff0000", INTEGER)
    assert read_value("#ff0000", 4) == "#ff0000"

"""How others read, set, list and follow a node's parameters."""

from __future__ import annotations

import math
from typing import Any

import pytest

from graphflow import Node, Param, RemoteError
from graphflow.interface import ParamType
from graphflow.msgs.rcl_interfaces.msg import Parameter as ParameterMessage
from graphflow.msgs.rcl_interfaces.msg import ParameterEvent, ParameterType, ParameterValue
from graphflow.msgs.rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from graphflow.runtime.parameters.services import to_descriptor
from graphflow.testing import Graph
from tests.runtime.cast import message, parameter


class Robot(Node):
    """Has one of each."""

    rate = Param(1.0, unit="Hz", gt=0.0, le=100.0, doc="How often.")
    count = Param(3, ge=0, le=255)
    title = Param("hello")
    fixed = Param(True, read_only=True)
    gains = Param([1.0, 2.0])
    arm_speed = Param(0.5, name="arm.speed")
    arm_joint = Param(1, name="arm.joint.first")
    armour = Param("thick")


def test_a_description_in_full() -> None:
    """Type, text with the unit, and whether it can be set."""
    descriptor = to_descriptor(Robot.rate.parameter)

    assert (descriptor.name, descriptor.type) == ("rate", ParameterType.PARAMETER_DOUBLE)
    assert descriptor.description == "How often. [Hz]"
    assert descriptor.additional_constraints == "more than 0 and at most 100"
    assert not descriptor.read_only
    assert to_descriptor(Robot.fixed.parameter).read_only
    assert (
        to_descriptor(Robot.title.parameter).floating_point_range
        == to_descriptor(Robot.title.parameter).integer_range
        == []
    )


@pytest.mark.parametrize(
    ("type_", "default", "limits", "expected"),
    [
        ("float", 1.0, {"ge": 0.5, "le": 2.0}, (0.5, 2.0)),
        ("float", 1.0, {"ge": 0.5}, (0.5, math.inf)),
        ("float", 1.0, {"le": 2.0}, (-math.inf, 2.0)),
        ("list[float]", [1.0], {"ge": 0.5, "le": 2.0}, (0.5, 2.0)),
        ("int", 1, {"ge": 0, "le": 255}, (0, 255)),
        ("int", 1, {"ge": 0.5, "le": 2.5}, (1, 2)),
        ("int", 1, {"ge": 0}, (0, 2**63 - 1)),
        ("list[int]", [1], {"le": 5}, (-(2**63), 5)),
    ],
)
def test_ranges_are_described(
    type_: ParamType, default: Any, limits: dict[str, float], expected: tuple[float, float]
) -> None:
    """Inclusive limits become a range of the parameter's kind; an open side is the type's own end."""
    descriptor = to_descriptor(parameter("p", type_, default, **limits))

    if "int" in type_:
        [integers] = descriptor.integer_range
        assert (integers.from_value, integers.to_value, integers.step) == (*expected, 1)
        assert descriptor.floating_point_range == []
    else:
        [floats] = descriptor.floating_point_range
        assert (floats.from_value, floats.to_value) == expected
        assert descriptor.integer_range == []
    assert descriptor.additional_constraints == ""


def test_steps_are_described() -> None:
    """The step stands in the descriptor, for whole numbers and others."""
    whole = to_descriptor(parameter("p", "int", 0, ge=0, le=10, step=2)).integer_range[0]
    assert (whole.from_value, whole.to_value, whole.step) == (0, 10, 2)
    real = to_descriptor(parameter("p", "float", 0.0, step=0.5)).floating_point_range[0]
    assert (real.from_value, real.to_value, real.step) == (-math.inf, math.inf, 0.5)


async def test_the_services_are_there(graph: Graph) -> None:
    """Under the node's name, with rcl_interfaces' types."""
    node = Robot(namespace="/a")
    await graph.start(node)

    assert {n: t for n, t in node.context.cache.services().items() if "parameter" in n} == {
        "/a/robot/describe_parameters": ["rcl_interfaces/srv/DescribeParameters"],
        "/a/robot/get_parameter_types": ["rcl_interfaces/srv/GetParameterTypes"],
        "/a/robot/get_parameters": ["rcl_interfaces/srv/GetParameters"],
        "/a/robot/list_parameters": ["rcl_interfaces/srv/ListParameters"],
        "/a/robot/set_parameters": ["rcl_interfaces/srv/SetParameters"],
        "/a/robot/set_parameters_atomically": ["rcl_interfaces/srv/SetParametersAtomically"],
    }


async def test_get_parameters(graph: Graph) -> None:
    """Values in the order requested; an unknown name is "not set" and does not affect the others."""
    await graph.start(Robot())
    request = GetParameters.Request(names=["count", "nothing", "rate", "title", "fixed", "gains"])

    values = (await graph.call(GetParameters, "/robot/get_parameters", request)).values

    assert [v.type for v in values] == [2, 0, 3, 4, 1, 8]
    assert values[0].integer_value == 3
    assert values[2].double_value == 1.0
    assert values[3].string_value == "hello"
    assert values[4].bool_value is True
    assert list(values[5].double_array_value) == [1.0, 2.0]


async def test_get_parameter_types(graph: Graph) -> None:
    """The declared types, 0 for an unknown name."""
    await graph.start(Robot())
    request = GetParameterTypes.Request(names=["rate", "count", "nothing", "gains"])

    types = (await graph.call(GetParameterTypes, "/robot/get_parameter_types", request)).types

    assert list(types) == [3, 2, 0, 8]


async def test_set_parameters_one_by_one(graph: Graph) -> None:
    """Each is taken or refused for itself, with a reason, in the order given."""
    node = Robot()
    await graph.start(node)
    request = SetParameters.Request(
        parameters=[
            message("rate", 5.0, 3),
            message("rate", 1000.0, 3),
            message("count", "seven", 4),
            message("fixed", False, 1),
            message("cuont", 4, 2),
            message("count", 4, 2),
            ParameterMessage(name="title", value=ParameterValue(type=0)),
            ParameterMessage(name="title", value=ParameterValue(type=42)),
        ]
    )

    results = (await graph.call(SetParameters, "/robot/set_parameters", request)).results

    assert [r.successful for r in results] == [True, False, False, False, False, True, False, False]
    assert [r.reason for r in results] == [
        "",
        "parameter 'rate' = 1000.0 is out of range: more than 0 and at most 100 Hz",
        "parameter 'count' is of type integer, 'seven' is not",
        "parameter 'fixed' is read-only",
        "there is no parameter 'cuont'; did you mean 'count'?",
        "",
        "parameter 'title' belongs to the node and cannot be deleted; only those with dynamic typing can",
        "42 is not a parameter type",
    ]
    assert (node.rate, node.count, node.fixed, node.title) == (5.0, 4, True, "hello")


async def test_set_parameters_atomically(graph: Graph) -> None:
    """All or none."""
    node = Robot()
    await graph.start(node)
    name = "/robot/set_parameters_atomically"
    wrong = SetParametersAtomically.Request(parameters=[message("rate", 5.0, 3), message("count", 256, 2)])
    right = SetParametersAtomically.Request(parameters=[message("rate", 5.0, 3), message("count", 255, 2)])

    result = (await graph.call(SetParametersAtomically, name, wrong)).result
    assert not result.successful
    assert result.reason == "parameter 'count' = 256 is out of range: 0 to 255"
    assert (node.rate, node.count) == (1.0, 3)

    assert (await graph.call(SetParametersAtomically, name, right)).result.successful
    assert (node.rate, node.count) == (5.0, 255)
    assert node.parameters.source("rate") == "set"


ALL = ["arm.joint.first", "arm.speed", "armour", "count", "fixed", "gains", "rate", "start_type_description_service"]


ALL += ["title", "use_sim_time"]


@pytest.mark.parametrize(
    ("prefixes", "depth", "names", "found"),
    [
        ([], 0, ALL, ["arm", "arm.joint"]),
        ([], 1, [n for n in ALL if "." not in n], []),
        ([], 2, [n for n in ALL if n != "arm.joint.first"], ["arm"]),
        (["arm"], 0, ["arm.joint.first", "arm.speed"], ["arm", "arm.joint"]),
        (["arm"], 1, ["arm.speed"], ["arm"]),
        (["arm", "arm.joint"], 1, ["arm.joint.first", "arm.speed"], ["arm", "arm.joint"]),
        (["rate"], 0, ["rate"], []),
        (["nothing"], 0, [], []),
    ],
)
async def test_list_parameters(
    graph: Graph, prefixes: list[str], depth: int, names: list[str], found: list[str]
) -> None:
    """Names below any of the prefixes, at most `depth` levels deep; 0 for any depth."""
    await graph.start(Robot())
    request = ListParameters.Request(prefixes=prefixes, depth=depth)

    result = (await graph.call(ListParameters, "/robot/list_parameters", request)).result

    assert list(result.names) == names
    assert list(result.prefixes) == found


async def test_describe_parameters(graph: Graph) -> None:
    """Descriptors in the order requested; an unknown name has one without a type."""
    await graph.start(Robot())
    request = DescribeParameters.Request(names=["count", "nothing", "rate"])

    count, nothing, rate = (await graph.call(DescribeParameters, "/robot/describe_parameters", request)).descriptors

    assert (count.name, count.type, count.integer_range[0].to_value) == ("count", 2, 255)
    assert (nothing.name, nothing.type) == ("nothing", 0)
    assert rate.description == "How often. [Hz]"
    assert rate.additional_constraints


async def test_an_observer_that_fails(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The caller that set the parameter gets the error; the node keeps running."""
    node = Robot()

    def fail(changes: object) -> None:
        raise ValueError("cannot take it")

    node.parameters.observe(fail)
    await graph.start(node)
    request = SetParameters.Request(parameters=[message("rate", 5.0, 3)])

    with pytest.raises(RemoteError, match="ValueError: cannot take it"):
        await graph.call(SetParameters, "/robot/set_parameters", request)
    types = await graph.call(GetParameterTypes, "/robot/get_parameter_types", GetParameterTypes.Request(names=["rate"]))
    assert list(types.types) == [3]


async def test_a_node_without_parameter_services(graph: Graph) -> None:
    """`start_parameter_services=False` leaves them out."""
    node = Node("tool", start_parameter_services=False, enable_logger_service=False)
    await graph.start(node)

    assert [name for name in node.context.cache.services(hidden=True) if name.startswith("/tool/")] == []


async def test_only_dynamic_parameters_can_be_deleted(graph: Graph) -> None:
    """One with dynamic typing takes every type and may go; those of the class stay; all or none."""
    node = Robot()
    node.declare_parameter("any", 1, dynamic=True)
    await graph.start(node)
    for value in (2, "text", [1.5], None):
        node.parameters.set({"any": value} if value is not None else {})
        assert node.parameters.get("any") == (value if value is not None else [1.5])

    both = [ParameterMessage(name=n, value=ParameterValue()) for n in ("any", "title")]
    request = SetParametersAtomically.Request(parameters=both)
    assert not (
        await graph.call(SetParametersAtomically, "/robot/set_parameters_atomically", request)
    ).result.successful
    assert "any" in node.parameters

    request_one = SetParameters.Request(parameters=both[:1])
    (result,) = (await graph.call(SetParameters, "/robot/set_parameters", request_one)).results
    assert result.successful
    assert "any" not in node.parameters


async def test_changes_are_published(graph: Graph) -> None:
    """New, changed and deleted ones, with stamp and node; at the start, all parameters count as new."""
    events = graph.tap(ParameterEvent, "/parameter_events")
    await graph.settle()
    node = Robot(namespace="/a")
    await graph.start(node)
    assert [p.name for p in events[0].new_parameters] == ALL
    assert (events[0].node, events[0].stamp.sec) == ("/a/robot", graph.clock.now().sec)

    node.count = 7
    node.declare_parameter("wheel", 0.5)
    node.undeclare_parameter("wheel")
    await graph.settle()
    changed, new, deleted = events.messages[1:]
    assert [(p.name, p.value.type, p.value.integer_value) for p in changed.changed_parameters] == [("count", 2, 7)]
    assert [(p.name, p.value.double_value) for p in new.new_parameters] == [("wheel", 0.5)]
    assert [p.name for p in deleted.deleted_parameters] == ["wheel"]

"""A node's parameters: declared, set together or not at all, checked and observed."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import ParameterError
from graphflow.interface import Parameter
from graphflow.runtime.params import Parameters
from tests.runtime.cast import parameter


def parameters(*declared: Parameter, **overrides: Any) -> Parameters:
    made = Parameters({name: (value, "graph.yaml:3") for name, value in overrides.items()})
    for one in declared:
        made.declare(one)
    return made


RATE = parameter("rate", "float", 1.0, unit="Hz", gt=0.0, le=100.0, doc="How often.")
COUNT = parameter("count", "int", 3, ge=0, le=255)
TITLE = parameter("title", "str", "hello")
FIXED = parameter("fixed", "bool", True, read_only=True)


def test_a_default_holds_until_something_is_set() -> None:
    """And the source says which it is."""
    made = parameters(RATE)
    assert (made.get("rate"), made.source("rate")) == (1.0, "default")

    made.set({"rate": 2.0})
    assert (made.get("rate"), made.source("rate")) == (2.0, "set")

    made.set({"rate": 3.0}, source="node")
    assert made.source("rate") == "node"


def test_read_only() -> None:
    """It takes a value from outside at the start, and none later."""
    made = parameters(FIXED, fixed=False)
    assert made.get("fixed") is False

    with pytest.raises(ParameterError, match="parameter 'fixed' is read-only"):
        made.set({"fixed": True})


def test_all_or_none() -> None:
    """One that does not fit keeps the others from changing, and nobody is told."""
    made = parameters(RATE, COUNT, FIXED)
    told: list[Any] = []
    made.observe(told.append)

    for wrong in ({"count": 256}, {"fixed": False}, {"nothing": 1}):
        with pytest.raises(ParameterError):
            made.set({"rate": 5.0, **wrong})
    assert (made.get("rate"), told) == (1.0, [])

    made.set({"rate": 5.0, "count": 4})
    assert told == [{"rate": (1.0, 5.0), "count": (3, 4)}]


def test_a_check_can_refuse() -> None:
    """What it raises refuses all the changes before any is made; it sees the values as they would be."""
    made = parameters(RATE, COUNT)
    seen: list[dict[str, Any]] = []

    def check(changes: Any) -> None:
        seen.append(dict(changes))
        if changes.get("count") == 13:
            raise ParameterError("not 13")

    made.check(check)
    with pytest.raises(ParameterError, match="not 13"):
        made.set({"rate": 2, "count": 13})
    made.set({"rate": 2})

    assert (made.get("rate"), made.get("count")) == (2.0, 3)
    assert seen == [{"rate": 2.0, "count": 13}, {"rate": 2.0}]


def test_unknown_names() -> None:
    """The error names the nearest parameter."""
    made = parameters(RATE, TITLE)

    for use in (made.get, made.describe, lambda name: made.set({name: 1})):
        with pytest.raises(ParameterError, match="there is no parameter 'rat'; did you mean 'rate'"):
            use("rat")
    assert "rat" not in made
    assert "rate" in made
    assert made.names() == ["rate", "title"]
    assert made.describe("rate") is RATE


def test_declared_twice() -> None:
    """A name is one parameter."""
    with pytest.raises(ParameterError, match="parameter 'rate' is declared twice"):
        parameters(RATE, RATE)


def test_an_override_takes_the_place_of_the_default() -> None:
    """Widened and checked like any value, with where it was written."""
    made = parameters(RATE, rate=5)

    assert made.get("rate") == 5.0
    assert made.source("rate") == "graph.yaml:3"


def test_a_wrong_override_names_its_place() -> None:
    """Whoever wrote it can go there."""
    with pytest.raises(ParameterError) as caught:
        parameters(RATE, rate=0)
    assert str(caught.value) == (
        "parameter 'rate' = 0.0 is out of range: more than 0 and at most 100 Hz (from graph.yaml:3)"
    )


def test_unused_overrides() -> None:
    """A misspelt override is said, with its place and the nearest name."""
    made = parameters(RATE, TITLE, rat=5, title="x")

    assert made.unused_overrides() == ["there is no parameter 'rat' (from graph.yaml:3); did you mean 'rate'?"]


# descriptors


def test_a_description_in_full() -> None:
    """Type, text with the unit, and whether it can be set."""
    descriptor = to_descriptor(RATE)

    assert (descriptor.name, descriptor.type) == ("rate", ParameterType.PARAMETER_DOUBLE)
    assert descriptor.description == "How often. [Hz]"
    assert descriptor.additional_constraints == "more than 0 and at most 100"
    assert not descriptor.read_only
    assert to_descriptor(FIXED).read_only
    assert to_descriptor(TITLE).floating_point_range == to_descriptor(TITLE).integer_range == []


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


# services


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


def message(name: str, value: Any, type_: int) -> ParameterMessage:
    fields = ["", "bool_value", "integer_value", "double_value", "string_value"]
    return ParameterMessage(name=name, value=ParameterValue(type=type_, **{fields[type_]: value}))


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
    """Values in the order asked for; an unknown name is not set, and does not spoil the others."""
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
        "parameter 'title' belongs to the node and cannot be deleted; those with dynamic typing can",
        "42 is no parameter type",
    ]
    assert (node.rate, node.count, node.fixed, node.title) == (5.0, 4, True, "hello")


async def test_set_parameters_atomically(graph: Graph) -> None:
    """All or nothing."""
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
    """Names under any of the prefixes and not deeper below it than asked for, 0 for any depth."""
    await graph.start(Robot())
    request = ListParameters.Request(prefixes=prefixes, depth=depth)

    result = (await graph.call(ListParameters, "/robot/list_parameters", request)).result

    assert list(result.names) == names
    assert list(result.prefixes) == found


async def test_describe_parameters(graph: Graph) -> None:
    """Descriptions in the order asked for; an unknown name has one without type."""
    await graph.start(Robot())
    request = DescribeParameters.Request(names=["count", "nothing", "rate"])

    count, nothing, rate = (await graph.call(DescribeParameters, "/robot/describe_parameters", request)).descriptors

    assert (count.name, count.type, count.integer_range[0].to_value) == ("count", 2, 255)
    assert (nothing.name, nothing.type) == ("nothing", 0)
    assert rate.description == "How often. [Hz]"
    assert rate.additional_constraints


async def test_a_set_that_a_timer_cannot_follow_is_refused(graph: Graph) -> None:
    """Who sets a rate to zero gets a reason, not a broken timer."""

    class Ticker(Node):
        rate = Param(10.0)
        ticks = 0

        @timer(hz=rate)
        async def tick(self) -> None:
            self.ticks += 1

    node = Ticker()
    await graph.start(node)
    request = SetParameters.Request(parameters=[message("rate", 0.0, 3)])
    [result] = (await graph.call(SetParameters, "/ticker/set_parameters", request)).results
    await graph.clock.advance(0.5)

    assert not result.successful
    assert result.reason == "parameter 'rate' = 0.0: hz must be a positive number, not 0.0"
    assert (node.rate, node.ticks) == (10.0, 5)


async def test_an_observer_that_fails(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Whoever set the parameter hears of it; the node goes on."""
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


# steps


@pytest.mark.parametrize(
    ("type_", "limits", "inside", "outside"),
    [
        ("int", {"ge": 0, "le": 10, "step": 3}, [0, 3, 9, 10], [1, 8]),
        ("int", {"step": 5}, [0, -5, 100], [3]),
        ("float", {"ge": 1.0, "le": 2.0, "step": 0.1}, [1.0, 1.1, 1.7000000000000002, 2.0], [1.05, 1.99]),
        ("float", {"step": 0.25}, [0.25, -1.5, math.inf], [0.3]),
        ("list[int]", {"ge": 1, "step": 2}, [[1, 3], []], [[1, 2]]),
    ],
)
def test_steps(type_: ParamType, limits: dict[str, float], inside: list[Any], outside: list[Any]) -> None:
    """Values are the lower limit and multiples of the step more; both limits are always allowed."""
    made = parameters(parameter("p", type_, inside[0], **limits))
    for value in inside:
        made.set({"p": value})
    for value in outside:
        with pytest.raises(ParameterError, match=r"is not a valid step: .* plus a multiple of"):
            made.set({"p": value})


def test_steps_are_described() -> None:
    """The step stands in the descriptor, for whole numbers and others."""
    whole = to_descriptor(parameter("p", "int", 0, ge=0, le=10, step=2)).integer_range[0]
    assert (whole.from_value, whole.to_value, whole.step) == (0, 10, 2)
    real = to_descriptor(parameter("p", "float", 0.0, step=0.5)).floating_point_range[0]
    assert (real.from_value, real.to_value, real.step) == (-math.inf, math.inf, 0.5)


# checks before and followers after a change


class Follower(Node):
    """Notes what it is told of its parameter."""

    rate = Param(1.0)
    other = Param("x")

    def __init__(self) -> None:
        super().__init__()
        self.told: list[Any] = []

    @rate.check
    def not_too_fast(self, rate: float) -> None:
        if rate > 10.0:
            raise ValueError("the listener is only human")

    @rate.on_change
    def note(self, old: float, new: float) -> None:
        self.told.append(("note", old, new))

    @rate.on_change
    async def note_slowly(self, old: float, new: float) -> None:
        await self.clock.sleep(1.0)
        self.told.append(("slowly", old, new))


async def test_a_check_of_the_class_can_refuse(graph: Graph) -> None:
    """What it raises is the reason, from inside and from outside; the old value stands."""
    node = Follower()
    await graph.start(node)
    with pytest.raises(ParameterError, match=r"parameter 'rate' = 11\.0: the listener is only human"):
        node.rate = 11.0
    request = SetParameters.Request(parameters=[message("rate", 12.0, 3)])
    (result,) = (await graph.call(SetParameters, "/follower/set_parameters", request)).results
    assert (result.successful, result.reason) == (False, "parameter 'rate' = 12.0: the listener is only human")
    assert (node.rate, node.told) == (1.0, [])


async def test_methods_follow_a_parameter(graph: Graph) -> None:
    """`def` at once, `async def` one change after the other; other parameters are none of their business."""
    node = Follower()
    node.rate = 2.0  # before it runs, nobody is told
    await graph.start(node)
    node.rate = 3.0
    node.other = "y"
    assert node.told == [("note", 2.0, 3.0)]
    node.rate = 4.0
    await graph.clock.advance(1.0)
    assert node.told[2:] == [("slowly", 2.0, 3.0)]
    await graph.clock.advance(1.0)
    assert node.told[3:] == [("slowly", 3.0, 4.0)]


async def test_a_follower_that_fails_is_logged(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The change stands, and the node goes on."""

    class Wrong(Node):
        rate = Param(1.0)

        @rate.on_change
        def fail(self, old: float, new: float) -> None:
            raise RuntimeError("cannot")

    node = Wrong()
    await graph.start(node)
    node.rate = 2.0
    assert node.rate == 2.0
    assert "fail: RuntimeError: cannot" in caplog.text
    assert node.is_running


def test_hooks_are_inherited_and_replaced() -> None:
    """A child's method of the name stands in place of its parent's, and does not touch the parent."""

    class Child(Follower):
        def not_too_fast(self, rate: float) -> None:
            if rate > 20.0:
                raise ValueError("too fast even for the child")

    child = Child()
    child.rate = 15.0
    with pytest.raises(ParameterError, match="even for the child"):
        child.rate = 25.0
    with pytest.raises(ParameterError, match="only human"):
        Follower().rate = 15.0


# deleting


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


def test_what_was_declared_at_run_time_can_be_undeclared() -> None:
    """By the node itself; a read-only one stays."""
    node = Robot()
    node.declare_parameter("wheel", 0.1)
    node.undeclare_parameter("wheel")
    assert "wheel" not in node.parameters
    with pytest.raises(ParameterError, match="read-only"):
        node.undeclare_parameter("fixed")
    with pytest.raises(ParameterError, match="no parameter 'wheel'"):
        node.undeclare_parameter("wheel")


# /parameter_events


async def test_changes_are_published(graph: Graph) -> None:
    """What is new, changed and deleted, with stamp and node; all parameters as new when the node starts."""
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


async def test_every_node_has_rclpys_two(graph: Graph) -> None:
    """use_sim_time can be set, start_type_description_service is read-only; no class may declare them anew."""
    node = Node("n")
    assert node.parameters.get("use_sim_time") is False
    with pytest.raises(ParameterError, match="read-only"):
        node.parameters.set({"start_type_description_service": False})
    with pytest.raises(DeclarationError, match="every node has the parameter 'use_sim_time'"):
        type("Bad", (Node,), {"sim": Param(True, name="use_sim_time")})

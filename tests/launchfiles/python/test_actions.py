"""What stand-ins were called with, as actions of ROS's YAML dialect."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from graphflow.launchfiles.python import actions as converter
from graphflow.launchfiles.python.actions import number_targets
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import RecordedCall
from graphflow.launchfiles.recorded import Finding


@pytest.fixture(autouse=True)
def problems() -> Iterator[list[Finding]]:
    """The problems of this test alone."""
    RECORDING.problems = []
    yield RECORDING.problems
    RECORDING.problems = []


def actions(described: object) -> list[dict[str, Any]]:
    return list(converter.actions(described))


def said(name: str, /, *args: Any, **kwargs: Any) -> RecordedCall:
    made: RecordedCall = type(name, (RecordedCall,), {"kind": name})(*args, **kwargs)
    made.line = 7
    return made


def test_an_action_and_its_condition() -> None:
    """Its attributes are texts; a condition is one of them."""
    var = said("LaunchConfiguration", "x")
    node = said("Node", package="p", executable=["e_", var], condition=said("UnlessCondition", var))
    assert actions([None, [node]]) == [{"node": {"pkg": "p", "exec": "e_$(var x)", "line": 7, "unless": "$(var x)"}}]


def test_what_comes_after_what() -> None:
    """Actions of an event handler know the number of the process, which must be given before."""
    first = said("ExecuteProcess", cmd=["ls"])
    then = [said("LogInfo", msg="over"), said("Shutdown")]
    whole = [first, said("RegisterEventHandler", said("OnProcessExit", target_action=first, on_exit=then))]
    number_targets(whole)
    ls, log, end = actions(whole)
    number = ls["executable"]["number"]
    assert "on_exit" not in ls["executable"]  # which would end all before it is said
    assert (log["log"]["after_number"], log["log"]["after_what"]) == (number, "exited")
    assert (end["shutdown"]["after_number"], end["shutdown"]["reason"]) == (number, "requested by a launch file")


def test_what_only_ends_all() -> None:
    """Is the process's own affair; a timer may end all as well."""
    first = said("ExecuteProcess", cmd=["ls"])
    ends = said("RegisterEventHandler", said("OnProcessExit", target_action=first, on_exit=[said("Shutdown")]))
    timer = said("TimerAction", period=2.0, actions=[said("EmitEvent", event=said("Shutdown", reason="late"))])
    whole = [first, ends, timer]
    number_targets(whole)
    ls, later = actions(whole)
    assert ls["executable"]["on_exit"] == "shutdown"
    assert later["timer"]["children"][0]["shutdown"]["reason"] == "late"


def test_what_follows_the_end_of_a_program() -> None:
    """OnExecutionComplete is OnProcessExit; what only says something when all ends is left out, and told."""
    first = said("ExecuteProcess", cmd=["ls"])
    handler = said("OnExecutionComplete", target_action=first, on_completion=[said("LogInfo", msg=["a", "b"])])
    ended = said("RegisterEventHandler", said("OnShutdown", on_shutdown=[said("LogInfo", msg="bye")]))
    whole = [first, said("RegisterEventHandler", handler), ended]
    number_targets(whole)
    RECORDING.remarks = []
    _, log = actions(whole)
    assert (log["log"]["message"], log["log"]["after_what"]) == ("ab", "exited")
    assert RECORDING.remarks == [{"line": 7, "message": "OnShutdown is left out: nothing is done when the graph stops"}]


def change(node: Any, number: int) -> RecordedCall:
    """The event that asks a lifecycle node for a transition."""
    matches = said("matches_action", node)
    return said("EmitEvent", event=said("ChangeState", lifecycle_node_matcher=matches, transition_id=number))


def on_state(node: RecordedCall, state: str, *then: RecordedCall) -> RecordedCall:
    handler = said("OnStateTransition", target_lifecycle_node=node, goal_state=state, entities=list(then))
    return said("RegisterEventHandler", handler)


def test_a_lifecycle_node_that_events_bring_up(problems: list[Finding]) -> None:
    """It is brought as far as they do; what follows comes after it, wherever the handlers stand."""
    node = said("LifecycleNode", package="p", executable="e")
    after = said("Node", package="p", executable="other")
    whole = [on_state(node, "inactive", change(node, 3)), on_state(node, "active", after), node, change(node, 1)]
    number_targets(whole)
    first, second = actions(whole)
    assert first["node"]["brought_to"] == "active"
    assert (second["node"]["after_number"], second["node"]["after_what"]) == (first["node"]["number"], "ready")
    assert problems == []


def test_a_lifecycle_node_that_events_bring_down() -> None:
    """By a command, since it is brought up as part of the graph."""
    node = said("LifecycleNode", package="p", executable="e", name="n", namespace="a/")
    whole = [node, change(node, 3), said("TimerAction", period=1.0, actions=[change(node, 4)]), change(node, 7)]
    number_targets(whole)
    _, timer, command = actions(whole)
    assert timer["timer"]["children"][0]["executable"]["cmd"] == ["ros2", "lifecycle", "set", "/a/n", "deactivate"]
    assert command["executable"]["cmd"][-1] == "shutdown"


def test_a_handler_before_what_it_waits_for() -> None:
    """It is described after it; one that stands behind it, where it stands."""
    first, last = said("Node", package="p", executable="first"), said("LogInfo", msg="last")
    handler = on_state(first, "inactive", said("Node", package="p", executable="then"))
    for whole, order in [
        ([handler, change(first, 1), last, first], ["log", "node first", "node then"]),
        ([first, change(first, 1), handler, last], ["node first", "node then", "log"]),
    ]:
        number_targets(whole)
        made = [next(iter(action.items())) for action in actions(whole)]
        assert [f"{name} {attributes.get('exec', '')}".strip() for name, attributes in made] == order


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (lambda node: [node, change(node, 99)], "EmitEvent has no equivalent in a graph file"),
        (lambda node: [change(None, 1)], "EmitEvent has no equivalent in a graph file"),
        (
            lambda node: [node, change(node, 1), on_state(node, "active")],
            "OnStateTransition: nothing in this file brings the node to 'active' by EmitEvent(event=ChangeState(...))",
        ),
    ],
)
def test_states_that_have_no_words(made: Any, told: str, problems: list[Finding]) -> None:
    """It is told."""
    whole = made(said("LifecycleNode", package="p", executable="e"))
    number_targets(whole)
    actions(whole)
    assert problems == [{"line": 7, "message": told}]


def test_an_end_and_another_event(problems: list[Finding]) -> None:
    """Only the event `Shutdown` ends all."""
    ends = said("Node", package="p", executable="e", on_exit=said("EmitEvent", event=said("Shutdown", reason="over")))
    goes_on = said("Node", package="p", executable="e", on_exit=change(ends, 1))
    assert [made["node"].get("on_exit") for made in actions([ends, goes_on])] == ["shutdown", None]
    assert problems == []


def test_what_a_process_says_is_done_at_its_end() -> None:
    """Comes after it, as what an event handler says does; functions are left out."""
    node = said("Node", package="p", executable="e", on_exit=[said("LogInfo", msg="over"), print])
    whole = [node]
    number_targets(whole)
    RECORDING.remarks = []
    first, log = actions(whole)
    assert (log["log"]["message"], log["log"]["after_number"]) == ("over", first["node"]["number"])
    assert [one["message"] for one in RECORDING.remarks] == [
        "on_exit: a function is left out: nothing is called while the graph runs"
    ]


def test_what_is_no_action(problems: list[Finding]) -> None:
    """It is a problem, with its line if there is one."""
    RECORDING.written_at, handler = 1, "OnProcessExit"
    assert actions(3) == []
    assert actions(dict) == []
    actions([said("TimerAction", period=1, actions=["x"])])
    actions([said("PushMatrix")])
    actions([said("OnProcessExit", target_action=None)])
    assert problems == [
        {"line": 1, "message": "3 is not an action, such as Node(...)"},
        {"line": 1, "message": "the class dict is not an action, such as Node(...)"},
        {"line": 7, "message": "'x' is not an action, such as Node(...)"},
        {"line": 7, "message": "PushMatrix has no equivalent in a graph file"},
        {
            "line": 7,
            "message": f"{handler} is an event handler, and no action: write RegisterEventHandler({handler}(...))",
        },
    ]


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"period": "abc"}, "period is a number of seconds, such as 2.0, not 'abc'"),
        ({"period": True}, "period is a number of seconds, such as 2.0, not True"),
        ({}, "period is a number of seconds, such as 2.0, not None"),
        ({"period": 2.0, "actions": said("Node")}, "actions is a list: write [ ] around Node(...)"),
    ],
)
def test_a_timer_of_other_types(given: dict[str, Any], told: str, problems: list[Finding]) -> None:
    """Is told once, by the names that launch files have."""
    actions(said("TimerAction", **given))
    assert problems == [{"line": 7, "message": f"TimerAction: {told}"}]


@pytest.mark.parametrize("period", [2, 2.5, "2.0", said("LaunchConfiguration", "x")])
def test_the_period_of_a_timer(period: Any, problems: list[Finding]) -> None:
    """Is a number, a text of one, or a substitution."""
    (made,) = actions(said("TimerAction", period=period, actions=[]))
    assert made["timer"]["period"] == ("$(var x)" if isinstance(period, RecordedCall) else period)
    assert problems == []


@pytest.mark.parametrize(
    ("given", "shown"), [(said("LaunchConfiguration", "x"), "LaunchConfiguration(...)"), ("1", "'1'")]
)
def test_a_condition_that_is_none(given: Any, shown: str, problems: list[Finding]) -> None:
    """Is answered with the one around it."""
    actions(said("LogInfo", msg="x", condition=given))
    assert problems == [{"line": 7, "message": f"condition: write IfCondition({shown}) or UnlessCondition(...)"}]


def test_a_text_that_is_set_for_all_stays_one() -> None:
    """Unless it has substitutions."""
    settings = [said("SetParameter", "a", value) for value in ("0042", said("LaunchConfiguration", "x"), 2)]
    found = [action["set_parameter"] for action in actions(settings)]
    assert [(one["value"], one.get("type")) for one in found] == [("0042", "str"), ("$(var x)", None), (2, None)]


def test_arguments_that_are_no_pairs(problems: list[Finding]) -> None:
    """A dict is refused with the way to pass it, as ROS 2 fails on it; its items are pairs."""
    source = "other.launch.py"
    expected = [{"include": {"file": source, "arg": [{"name": "x", "value": "6.0"}], "line": 7}}]
    right = said("IncludeLaunchDescription", source, launch_arguments={"x": "6.0"}.items())
    wrong = said("IncludeLaunchDescription", source, launch_arguments={"x": "6.0"})
    assert actions([right]) == expected
    actions([said("IncludeLaunchDescription", source)])
    assert problems == []
    actions([wrong])
    [problem] = problems
    assert problem["message"].endswith("launch_arguments is a list of pairs: write .items() behind the dict")


@pytest.mark.parametrize(
    ("value", "is_refused"),
    [([1, [3, 4]], True), ([[1, 2], [3, 4]], True), ({1, 2}, True), (object(), True), ([1, 2], False), ("a", False)],
)
def test_values_that_are_no_parameters(problems: list[Finding], value: object, is_refused: bool) -> None:
    """Lists in lists and other objects are refused, as by launch, which knows them too late to name the line."""
    actions([said("Node", package="p", executable="e", parameters=[{"gains": value}])])
    assert [p["message"].startswith("parameters: 'gains' has ") for p in problems] == ([True] if is_refused else [])


def test_substitutions_in_a_list_of_values(problems: list[Finding]) -> None:
    """A list of texts and substitutions in a list is a text."""
    parts = [[said("LaunchConfiguration", "n"), "1"], "b"]
    [made] = actions([said("Node", package="p", executable="e", parameters=[{"names": parts}])])
    assert made["node"]["param"][0]["value"] == ["$(var n)1", "b"]
    assert problems == []


def test_configurations_of_a_group() -> None:
    """They hold for its actions alone."""
    inner = [said("LogInfo", msg=said("LaunchConfiguration", "ns"))]
    [made] = actions([said("GroupAction", inner, launch_configurations={"ns": "inner"})])
    let, log = made["group"]["children"]
    assert let["let"] == {"name": "ns", "value": "inner", "line": 7}
    assert log["log"]["message"] == "$(var ns)"

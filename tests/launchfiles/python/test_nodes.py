"""Attributes of nodes, processes and parameters."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from graphflow.launchfiles.python import actions as converter
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


def test_where_components_are_loaded() -> None:
    """By a container, or by a name that is a substitution; each may have a condition."""
    x = said("LaunchConfiguration", "x")
    node = said("ComposableNode", package="p", plugin="p::P", condition=said("UnlessCondition", x))
    for target in ("box", said("ComposableNodeContainer", name="box"), x):
        load = said("LoadComposableNodes", target_container=target, composable_node_descriptions=[node])
        [action] = actions([load])
        found = action["load_composable_node"]
        assert found["target"] == ("$(var x)" if target is x else "box")
        assert found["composable_node"] == [{"pkg": "p", "plugin": "p::P", "unless": "$(var x)"}]


@pytest.mark.parametrize(
    ("given", "said_of_it"),
    [
        ({"parameters": {"rate": 2.0}}, "parameters: expected a list, such as [{'rate': 2.0}], got {'rate': 2.0}"),
        ({"arguments": "--fast"}, "arguments: expected a list, such as ['--fast'], got '--fast'"),
        ({"output": "scren"}, "Node: output: 'scren' is not one of launch's; did you mean 'screen'?"),
        (
            {"parameters": [{"rate"}]},
            "parameters: {'rate'} is neither a dictionary nor a file; write {'name': value}, with a colon",
        ),
        ({"parameters": [2]}, "parameters: 2 is neither a dictionary nor a file; write [{'name': value}]"),
        ({"remappings": ["a"]}, "remappings: expected pairs, such as [('from', 'to')], got ['a']"),
    ],
)
def test_what_a_node_cannot_be_given(given: dict[str, Any], said_of_it: str, problems: list[Finding]) -> None:
    """It is told with the line; ROS would have failed, or done something else."""
    actions([said("Node", package="p", executable="e", **given)])
    assert problems == [{"line": 7, "message": said_of_it}]


def test_what_a_node_must_be_given() -> None:
    """Nothing is made up in its place."""
    assert actions([said("Node", package="p")]) == [{"node": {"pkg": "p", "line": 7}}]


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (said("ParameterValue", said("LaunchConfiguration", "x"), value_type=float), ("$(var x)", "float")),
        (said("ParameterValue", value="0042", value_type=str), ("0042", "str")),
        (said("ParameterValue", "[1]", value_type=list[int]), ("[1]", "list_of_int")),
        (said("ParameterValue", 3), (3, None)),
        (said("TextSubstitution", text="[1]"), ("[1]", "yaml")),
        ([[said("TextSubstitution", text="1")], ["2"]], (["1", "2"], "yaml")),
        (["1", "2"], (["1", "2"], None)),
        ([["a", said("LaunchConfiguration", "x")], ["b"]], (["a$(var x)", "b"], None)),
    ],
)
def test_types_of_parameters(value: Any, expected: tuple[Any, str | None]) -> None:
    """They are written down by the names that launch files have for them."""
    given = [{"rate": value}, said("Parameter", "rate", value)]
    found = [actions(said("Node", package="p", executable="e", parameters=[one]))[0]["node"]["param"] for one in given]
    assert [(param["value"], param.get("type")) for [param] in found] == [expected, expected]


def test_files_of_parameters() -> None:
    """In which substitutions are made where that is asked for."""
    files = ["a", said("ParameterFile", "b"), said("ParameterFile", param_file="c", allow_substs=True)]
    [action] = actions([said("Node", package="p", executable="e", parameters=files)])
    assert action["node"]["param"] == [{"from": "a"}, {"from": "b"}, {"from": "c", "allow_substs": "True"}]


@pytest.mark.parametrize(
    ("executable", "words", "is_told"),
    [
        ("e", ["speed:=2"], True),
        ("e", ["--ros-args", "-p", "speed:=2"], False),
        ("e", ["--rate", "2", "__name:=x"], False),
        ("xacro", ["speed:=2"], False),
    ],
)
def test_parameters_among_a_programs_own_arguments(executable: str, words: list[str], is_told: bool) -> None:
    """A remark shows where they belong; xacro reads such arguments."""
    RECORDING.remarks = []
    actions([said("Node", package="p", executable=executable, arguments=words)])
    text = "arguments: nothing reads 'speed:=2'; write parameters=[{'speed': 2}], or remappings=[('speed', '2')]"
    assert RECORDING.remarks == ([{"line": 7, "message": text}] if is_told else [])


def test_two_ros_arguments_in_one_word() -> None:
    """A remark parts them."""
    RECORDING.remarks = []
    actions([said("Node", package="p", executable="e", ros_arguments=["-p speed:=2", "-r", "a:=b"])])
    text = "ros_arguments: '-p speed:=2' is one word; write '-p', 'speed:=2'"
    assert RECORDING.remarks == [{"line": 7, "message": text}]


def test_a_command_in_one_text(problems: list[Finding]) -> None:
    """The words are those of a shell."""
    actions([said("ExecuteProcess", cmd="echo 'it is up'"), said("ExecuteProcess", cmd="echo it's")])
    shown = [problem["message"].partition(", got")[0] for problem in problems]
    words = ("['echo', 'it is up']", "['echo', \"it's\"]")
    assert shown == [f"cmd: expected a list of words, such as {each}" for each in words]

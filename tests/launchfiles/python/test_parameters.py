"""What classes of ROS's launch packages can be given."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.launchfiles.python.names import NAMES
from graphflow.launchfiles.python.parameters import PARAMETERS, not_texts, wrong


@pytest.mark.parametrize(
    ("kind", "given", "names", "expected"),
    [
        ("Node", [], ["nam"], "Node has no argument 'nam'; did you mean 'name'?"),
        ("Node", [], ["node_name"], "Node has no argument 'node_name'; it is called 'name' now"),
        (
            "Node",
            ["tools"],
            [],
            "Node takes nothing without a name, and not 'tools'; write package=..., executable=...",
        ),
        ("Node", [], ["exec"], "Node has no argument 'exec'; write executable="),
        ("Node", [], ["wheels"], "Node has no argument 'wheels'"),
        ("DeclareLaunchArgument", ["x"], ["default"], "has no argument 'default'; did you mean 'default_value'?"),
        ("DeclareLaunchArgument", ["x", "1"], [], "takes 1 without a name, and not '1'; write default_value='1'"),
        ("LogInfo", ["hello"], [], "LogInfo takes nothing without a name, and not 'hello'; write msg='hello'"),
        ("PathJoinSubstitution", ["a", "b"], [], "PathJoinSubstitution takes a list: write [ ] around 'a', 'b'"),
        ("AndSubstitution", ["a", "b", "c"], [], "AndSubstitution takes 2 without a name, and not 'c'"),
    ],
)
def test_what_is_wrong(kind: str, given: list[Any], names: list[str], expected: str) -> None:
    """It is told what to write."""
    [message] = wrong(kind, given, names)
    assert message.endswith(expected)


@pytest.mark.parametrize(
    ("kind", "given", "named", "expected"),
    [
        ("DeclareLaunchArgument", ["x"], {"default_value": 5}, "default_value takes texts, and not 5; write '5'"),
        ("DeclareLaunchArgument", ["x"], {"choices": ["a", 2.5]}, "choices takes texts, and not 2.5; write '2.5'"),
        ("SetEnvironmentVariable", ["x", 1], {}, "value takes texts, and not 1; write '1'"),
        ("IfCondition", [True], {}, "predicate_expression takes texts, and not True; write 'true'"),
        ("Node", [], {"arguments": ["-n", 3]}, "arguments takes texts, and not 3; write '3'"),
        ("Node", [], {"additional_env": {"N": 3}}, "additional_env takes texts, and not 3; write '3'"),
        ("IncludeLaunchDescription", ["f"], {"launch_arguments": {"n": 3}.items()}, "arguments takes texts, and not 3"),
    ],
)
def test_numbers_that_launch_refuses(kind: str, given: list[Any], named: dict[str, Any], expected: str) -> None:
    """Are texts there, in a list or mapping, too."""
    [message] = not_texts(kind, given, named)
    assert message.startswith(f"{kind}: ")
    assert expected in message


def test_numbers_that_launch_takes() -> None:
    """As values of parameters, and wherever it makes texts of them."""
    assert list(not_texts("Node", [], {"parameters": [{"rate": 2.0}], "respawn": True, "respawn_delay": 2.0})) == []
    assert list(not_texts("SetParameter", ["rate", 2.0], {})) == []
    assert list(not_texts("DeclareLaunchArgument", ["x"], {"default_value": None})) == []


@pytest.mark.parametrize(
    ("kind", "given", "names"),
    [
        ("GroupAction", [[]], ["condition", "scoped"]),
        ("ComposableNodeContainer", [], ["package", "composable_node_descriptions"]),
        ("AllSubstitution", ["a", "b", "c"], []),
        ("OfAFilesOwn", [1], ["x"]),
    ],
)
def test_what_is_right(kind: str, given: list[Any], names: list[str]) -> None:
    """By place and by name; of others nothing is known."""
    assert list(wrong(kind, given, names)) == []


def test_there_are_such_classes() -> None:
    """Those that are listed are the packages' own."""
    elsewhere = ["ComposableNode", "ParameterFile", "ParameterValue", "OnStateTransition", "PathSubstitution"]
    elsewhere += ["XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"]
    assert set(PARAMETERS) <= {*" ".join(NAMES.values()).split(), *elsewhere}

"""A node that is to join a running graph."""

from __future__ import annotations

import pytest

from graphflow.errors import InvalidName
from graphflow.runtime.args import parse_ros_args
from graphflow.supervisor.launching.joining import check_component, planned_component
from nodes.talker import Talker

TALKER = Talker.interface()


def test_a_node_as_a_graph_file_would_plan_it() -> None:
    """Name, parameters and remaps come from words."""
    ros = parse_ros_args(["--ros-args", "-r", "chatter:=/news", "-p", "rate:=2"])
    node = planned_component(TALKER, "t", "/room", ros, "warn")
    assert (node.name, node.class_path, node.log_level) == ("/room/t", "nodes.talker:Talker", "warn")
    assert node.params["rate"].value == 2
    assert [str(rule.remap()) for rule in node.remaps] == ["chatter:=/news"]
    assert check_component(node, TALKER) == []


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["-p", "rat:=2"], "Talker has no parameter 'rat'; did you mean 'rate'?"),
        (["-p", "rate:=-1"], "parameter 'rate' = -1"),
        (["-r", "chater:=a"], "Talker has no topic or service 'chater'; did you mean 'chatter'?"),
    ],
)
def test_mistakes_are_those_of_a_graph_file(words: list[str], told: str) -> None:
    """And are found before anything is started."""
    node = planned_component(TALKER, "t", "/", parse_ros_args(["--ros-args", *words]), "")
    (problem,) = check_component(node, TALKER)
    assert told in problem.message


@pytest.mark.parametrize(("name", "namespace"), [("a b", "/"), ("t", "/ro om"), ("", "/")])
def test_names_are_checked(name: str, namespace: str) -> None:
    """As everywhere."""
    with pytest.raises(InvalidName):
        planned_component(TALKER, name, namespace, parse_ros_args([]), "")

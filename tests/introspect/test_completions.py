"""Completions of a command line's arguments."""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher, service
from graphflow.introspect import completions
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph


class Robot(Node):
    node_name = "robot"
    words = Publisher(String, "words")
    hidden = Publisher(String, "_hidden")

    @service(Empty, "rest")
    def rest(self, request: Empty.Request) -> None: ...


@pytest.mark.parametrize(
    ("place", "given", "name", "is_there"),
    [
        ("NODE", [], "/robot", True),
        ("nodes", [], "/robot", True),
        ("TOPIC", [], "/words", True),
        ("TOPIC", [], "/_hidden", False),
        ("SERVICE", [], "/rest", True),
        ("TYPE", ["/words"], "std_msgs/msg/String", True),
        ("TYPE", ["/_hidden"], "std_msgs/msg/String", True),
        ("TYPE", ["/rest"], "std_srvs/srv/Empty", True),
        ("TYPE", [], "std_msgs/msg/String", False),
        ("ACTION", [], "/words", False),
        ("FILE", [], "/words", False),
    ],
)
async def test_names(graph: Graph, place: str, given: list[str], name: str, is_there: bool) -> None:
    """Each in its place, hidden ones only by their types."""
    robot = Robot()
    await graph.start(robot)
    assert (name in completions.names_for(place, given, robot.context.cache)) is is_there


@pytest.mark.parametrize(
    ("type_name", "mark", "found"),
    [
        ("std_msgs/msg/String", "'", ["'{data: ''}'"]),
        ("std_msgs/String", '"', ["\"{data: ''}\""]),
        ("example_interfaces/srv/AddTwoInts", "'", ["'{a: 0, b: 0}'"]),
        ("no/msg/Type", "'", []),
        ("nothing", "'", []),
    ],
)
def test_messages(type_name: str, mark: str, found: list[str]) -> None:
    """With all their fields, between quotation marks."""
    assert completions.message(type_name, mark) == found

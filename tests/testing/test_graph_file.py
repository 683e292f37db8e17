"""Graph files in tests: whole graphs in memory, on the clock of the test."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from graphflow.errors import CallError, GraphFileError, GraphflowError
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import PROJECT

GRAPHS = PROJECT / "graphs"


async def test_nodes_parameters_and_arguments(graph: Graph) -> None:
    """Each node has its name, its parameters and its remaps."""
    nodes = await graph.up(GRAPHS / "talker_listener.yaml", rate=4.0)
    with pytest.raises(KeyError, match="no node 'talker' has been started; did you mean '/talker'"):
        nodes["talker"]
    heard = graph.tap(String, "/chatter")
    await graph.clock.advance(1.0)
    assert sorted(nodes) == ["/listener", "/talker"]
    assert len(heard) == 4


@slow
@pytest.mark.parametrize(
    ("arguments", "distance"), [({}, 0.5), ({"target": "carrot1"}, 2.2), ({"target": "carrot1", "moves": True}, 99.0)]
)
async def test_the_tf2_tutorial(graph: Graph, arguments: dict[str, object], distance: float) -> None:
    """A step spawns the second turtle, which then follows the first, or a frame beside it."""
    nodes = await graph.up(GRAPHS / "turtle_tf2.yaml", **arguments)
    await graph.clock.advance(20.0)
    found = nodes["/turtle2/listener"].tf.get("turtle2", "turtle1")  # type: ignore[attr-defined]
    assert math.hypot(*found.translation) < distance
    assert len(nodes) == 5


@slow
async def test_time_travel(graph: Graph) -> None:
    """With a delay the second turtle drives to where the first was."""
    from graphflow.msgs.geometry_msgs.msg import Twist, Vector3

    await graph.up(GRAPHS / "turtle_tf2.yaml", delay=5.0)
    drive = graph.publisher(Twist, "/turtle1/cmd_vel")
    first, second = graph.tap(Pose, "/turtle1/pose"), graph.tap(Pose, "/turtle2/pose")
    for _ in range(60):
        drive.publish(Twist(linear=Vector3(x=0.5), angular=Vector3(z=0.2)))
        await graph.clock.advance(0.5)
    gap = math.hypot(first.latest.x - second.latest.x, first.latest.y - second.latest.y)
    assert 1.0 < gap < 4.0  # the first drives 2.5 m in the five seconds


async def test_a_step_that_takes_time(graph: Graph, tmp_path: Path) -> None:
    """Nodes that come after it start when it is done."""
    file = tmp_path / "g.yaml"
    file.write_text(
        "nodes:\n  /a: {class: nodes.talker:Talker}\n  /b: {class: nodes.talker:Talker, after: pause}\n"
        "steps:\n  pause: {after: /a, delay: 3.0}\n"
    )
    (tmp_path / "pyproject.toml").touch()
    nodes = await graph.up(file)
    assert list(nodes) == ["/a"]
    await graph.clock.advance(4.0)
    assert list(nodes) == ["/a", "/b"]


@pytest.mark.parametrize(
    ("text", "kind", "said"),
    [
        ("nodes:\n  /a: {clas: nodes.talker:Talker}\n", GraphFileError, "clas"),
        ("nodes:\n  /a: {class: nodes.talkr:Talker}\n", GraphflowError, "talkr"),
        ("nodes:\n  /a: {command: [sleep, '1']}\n", GraphflowError, r"g.yaml:2.*: /a is a program \(sleep 1\)"),
        (
            "nodes:\n  /a: {class: nodes.talker:Talker}\nsteps:\n  s: {call: /nothing, request: {}, timeout: 0.0001}\n",
            (CallError, GraphflowError),
            "nothing",
        ),
    ],
)
async def test_what_fails(graph: Graph, tmp_path: Path, text: str, kind: type[Exception], said: str) -> None:
    """The test gets the error of the file, the node or the step."""
    file = tmp_path / "g.yaml"
    file.write_text(text)
    (tmp_path / "pyproject.toml").touch()
    with pytest.raises(kind, match=said):
        await graph.up(file)
        await graph.clock.advance(20.0)
        graph.raise_failed()

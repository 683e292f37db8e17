"""The graphs of the simulated robot, on the test's clock."""

from __future__ import annotations

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import PROJECT


@slow
async def test_two_robots(graph: Graph) -> None:
    """Each drives by its own scanner, and they do not meet."""
    nodes = await graph.up(PROJECT / "graphs" / "tb_two.yaml")
    await graph.clock.advance(20.0)
    robots = nodes["/simulator"].simulation.robots.values()  # type: ignore[attr-defined]
    assert [robot.collisions for robot in robots] == [0, 0]
    assert all(robot.charge.share < 1.0 for robot in robots)


@slow
@pytest.mark.parametrize("style", ["EventDriven", "TimeDriven"])
@pytest.mark.parametrize("world", ["hexagon", "house"])
async def test_it_drives_and_touches_nothing(graph: Graph, world: str, style: str) -> None:
    """For a minute among obstacles it gets about, turns, and never collides."""
    nodes = await graph.up(PROJECT / "graphs" / "tb_avoid.yaml", world=world, style=style)
    states = graph.tap(String, "/control/state")
    robot = nodes["/simulator"].simulation.robots[""]  # type: ignore[attr-defined]
    places = []
    for _ in range(6):
        await graph.clock.advance(10.0)
        places.append(robot.pose)
    assert robot.collisions == 0
    assert robot.trouble == ""
    assert {"drive"} < {state.data for state in states}
    assert max(abs(a.x - b.x) + abs(a.y - b.y) for a in places for b in places) > 1.0

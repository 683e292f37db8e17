"""The graphs of the simulated robot, on the test's clock."""

from __future__ import annotations

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.conftest import PROJECT


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

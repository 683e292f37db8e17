"""Turtles spawned through the service, driven by publishers that are made at run time."""

from __future__ import annotations

from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.ten_turtles import TenTurtles
from nodes.turtlesim import TurtleSim
from tests.cases import slow


@slow
async def test_ten_turtles_drive_in_circles(graph: Graph) -> None:
    """Each gets a name from the simulator, moves on, and turns."""
    await graph.start(TurtleSim(), TenTurtles())
    names = [f"turtle{i}" for i in range(2, 12)]
    taps = {name: graph.tap(Pose, f"/{name}/pose", 1000) for name in names}
    await graph.clock.advance(2.0)

    for name, tap in taps.items():
        assert tap.latest.linear_velocity == 1.0, name
        assert tap.latest.angular_velocity >= 1.0, name
        assert tap[0].theta != tap.latest.theta


async def test_how_many_is_a_parameter(graph: Graph) -> None:
    """And the simulator need not be there first."""
    import asyncio

    node = TenTurtles(count=3)
    starting = asyncio.ensure_future(graph.start(node))
    await graph.settle()
    assert not starting.done()
    await graph.start(TurtleSim())
    await starting
    assert [p.name for p in node.cmd_vel] == ["/turtle2/cmd_vel", "/turtle3/cmd_vel", "/turtle4/cmd_vel"]

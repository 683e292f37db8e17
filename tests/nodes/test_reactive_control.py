"""Decisions of the reactive controllers; whole runs are in tests/graphs/test_tb_graphs.py."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Header
from graphflow.testing import Graph
from nodes.reactive_control import EventDriven, State, TimeDriven, nearest


def scan(**walls: float) -> LaserScan:
    """A scan of 360 beams with walls ahead, to the left and to the right, each 60 degrees wide."""
    ranges = np.full(360, math.inf, np.float32)
    for side, middle in (("ahead", 0), ("left", 60), ("right", -60)):
        for degree in range(middle - 30, middle + 30):
            ranges[degree % 360] = min(ranges[degree % 360], walls.get(side, math.inf))
    return LaserScan(angle_increment=math.tau / 360, angle_max=math.tau, range_min=0.12, range_max=3.5, ranges=ranges)


def test_nearest() -> None:
    """Directions are angles, whichever way round they are written."""
    seen = scan(ahead=1.0, left=2.0)
    assert nearest(seen, 0.0, 0.5) == pytest.approx(1.0)
    assert nearest(seen, math.tau, 0.5) == pytest.approx(1.0)
    assert nearest(seen, math.radians(80), 0.2) == pytest.approx(2.0)
    assert nearest(seen, math.pi, 1.0) == math.inf


@pytest.mark.parametrize(
    ("walls", "state"),
    [
        ({}, State.DRIVE),
        ({"ahead": 0.3, "left": 1.0, "right": 0.5}, State.TURN_LEFT),
        ({"ahead": 0.3, "left": 0.5, "right": 1.0}, State.TURN_RIGHT),
    ],
)
async def test_decisions(graph: Graph, walls: dict[str, float], state: State) -> None:
    """It turns to the freer side."""
    node = EventDriven()
    await graph.start(node)
    commands = graph.tap(Twist, "/cmd_vel")
    graph.publisher(LaserScan, "/scan").publish(scan(**walls))
    await graph.settle()
    assert node.state is state
    assert (commands.latest.linear.x > 0) is (state is State.DRIVE)


async def test_a_turn_goes_on_until_the_way_is_free(graph: Graph) -> None:
    """It does not waver between the sides."""
    node = EventDriven()
    await graph.start(node)
    scans = graph.publisher(LaserScan, "/scan")
    for walls, state in (
        ({"ahead": 0.3, "left": 1.0, "right": 0.5}, State.TURN_LEFT),
        ({"ahead": 0.5, "right": 1.0}, State.TURN_LEFT),
        ({"ahead": 0.6}, State.DRIVE),
    ):
        scans.publish(scan(**walls))
        await graph.settle()
        assert node.state is state


async def test_a_sensor_that_falls_silent(graph: Graph) -> None:
    """The time-driven form stops."""
    node = TimeDriven()
    await graph.start(node)
    seen = scan()
    seen.header = Header(stamp=graph.clock.now())
    graph.publisher(LaserScan, "/scan").publish(seen)
    await graph.clock.advance(0.2)
    states = [node.state]
    await graph.clock.advance(1.0)
    assert [*states, node.state] == [State.DRIVE, State.STOP]

"""The graphs of the simulated robot, on the test's clock."""

from __future__ import annotations

import math

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import SENSOR_DATA
from graphflow.testing import Graph
from nodes.reactive_control import nearest
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


@slow
async def test_driven_by_hand(graph: Graph) -> None:
    """A velocity drives the robot for as long as commands come, and it stops by itself."""
    nodes = await graph.up(PROJECT / "graphs" / "tb_teleop.yaml")
    robot = nodes["/simulator"].simulation.robots[""]  # type: ignore[attr-defined]
    keys, start = graph.publisher(Twist, "/cmd_vel"), robot.pose
    for _ in range(10):
        keys.publish(Twist(linear=Vector3(x=0.2)))
        await graph.clock.advance(0.1)
    assert 0.1 < robot.pose.x - start.x < 0.25
    await graph.clock.advance(2.0)
    stopped = robot.pose
    await graph.clock.advance(1.0)
    assert robot.pose.x == pytest.approx(stopped.x, abs=1e-3)


@slow
@pytest.mark.parametrize("world", ["house", "maze"])
async def test_along_the_wall(graph: Graph, world: str) -> None:
    """It finds a wall, follows it at about the distance that was asked for, and touches nothing."""
    nodes = await graph.up(PROJECT / "graphs" / "tb_wall.yaml", world=world, distance=0.35)
    states, scans = graph.tap(String, "/control/state"), graph.tap(LaserScan, "/scan", SENSOR_DATA)
    robot = nodes["/simulator"].simulation.robots[""]  # type: ignore[attr-defined]
    beside = []
    for second in range(60):
        await graph.clock.advance(1.0)
        if second > 20:
            beside.append(nearest(scans.latest, -math.pi / 2, 1.0))
    assert robot.collisions == 0
    assert {state.data for state in states} >= {"follow the wall"}
    assert sorted(beside)[len(beside) // 2] == pytest.approx(0.35, abs=0.1)


@slow
@pytest.mark.timeout(300)  # half a minute on an idle machine
@pytest.mark.parametrize("seed", [0, 1])
async def test_mapping(graph: Graph, seed: int) -> None:
    """After a tour through the house, the robot knows its place within 5 cm and 2 degrees; the odometry does not."""
    nodes = await graph.up(PROJECT / "graphs" / "tb_map.yaml", seed=seed)
    robot, tf = nodes["/simulator"].simulation.robots[""], nodes["/mapper"].tf  # type: ignore[attr-defined]
    start = robot.pose
    for _ in range(60):
        await graph.clock.advance(5.0)
        if not nodes["/driver"].ways:  # type: ignore[attr-defined]
            break
    else:
        pytest.fail("the tour did not end within five minutes")
    found, odometry = tf.get("map", "base_footprint"), tf.get("odom", "base_footprint")
    dx, dy = robot.pose.x - start.x, robot.pose.y - start.y  # the map begins at the robot, which looks along x
    assert robot.collisions == 0
    assert math.hypot(found.translation[0] - dx, found.translation[1] - dy) < 0.05
    assert abs(math.remainder(found.yaw - (robot.pose.yaw - start.yaw), math.tau)) < math.radians(2.0)
    assert math.hypot(odometry.translation[0] - dx, odometry.translation[1] - dy) > 0.1
    cells = nodes["/mapper"].map.map()  # type: ignore[attr-defined]
    assert cells.size == pytest.approx((10.2, 8.2), abs=0.5)
    assert cells.at(0.0, 0.0) < 20  # free where it started
    assert max(cells.at(x, 0.0) for x in (-0.78, -0.80, -0.82, -0.84)) > 80  # the wall behind, within a cell

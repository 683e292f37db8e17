"""The simulator's cost: CPU seconds for a simulated second, of the bare physics, and of the node with a listener.

One burger, then ten, among the nine pillars of the hexagon; each scans 360 beams 5 times a second. Goal: ten in real
time on one core, so at most 1 s a second; with room for other programs, at most 0.5.
"""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path
from unittest.mock import patch

from benchmarks.rounds import compare, goal
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.qos import SENSOR_DATA
from graphflow.simulator import Simulation, World
from graphflow.simulator.files import find, read_robot, read_world
from graphflow.testing import Graph
from nodes.robot_simulator import RobotSimulator

SECONDS = 5.0


def world(robots: int) -> World:
    """The hexagon with some robots along its walls."""
    base, _ = read_world(find("hexagon", "worlds", Path()))
    placed = [{"name": f"r{i}", "at": [-1.9 + 0.42 * i, 0.55 * (-1) ** i]} for i in range(robots)]
    return World.model_validate({**base.model_dump(exclude={"robots"}), "robots": placed})


def physics(robots: int) -> float:
    """CPU seconds for a simulated second of driving robots, each scanned 5 times."""
    burger = read_robot(find("burger", "robots", Path()))
    simulation = Simulation(world(robots), {"burger": burger})
    start = time.process_time()
    for tick in range(round(SECONDS / simulation.tick_seconds)):
        if tick % 40 == 0:
            for robot in simulation.robots.values():
                robot.command(0.1, 0.3)
                robot.scan()
        simulation.tick()
    return (time.process_time() - start) / SECONDS


async def run(robots: int) -> float:
    """The same with the node, on a network in memory."""
    graph = Graph()
    node = RobotSimulator()
    burger = read_robot(find("burger", "robots", Path()))
    made = Simulation(world(robots), {"burger": burger})
    with patch("nodes.robot_simulator.simulate", lambda *_: made):
        await graph.start(node)
    taps = [graph.tap(LaserScan, f"/r{i}/scan", SENSOR_DATA) for i in range(robots)]
    commands = [graph.publisher(Twist, f"/r{i}/cmd_vel") for i in range(robots)]
    start = time.process_time()
    for _ in range(round(SECONDS / 0.2)):
        for publisher in commands:
            publisher.publish(Twist(linear=Vector3(x=0.1), angular=Vector3(z=0.3)))
        await graph.clock.advance(0.2)
    used = (time.process_time() - start) / SECONDS
    assert all(len(tap) >= SECONDS * 5 - 1 for tap in taps)
    await graph.close()
    return used


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    found = compare(
        {
            "1 robot, physics": lambda: physics(1),
            "10 robots, physics": lambda: physics(10),
            "1 robot, node": lambda: asyncio.run(run(1)),
            "10 robots, node": lambda: asyncio.run(run(10)),
        },
        rounds,
        "CPU s/s",
        "1 robot, physics",
    )
    goal("ten robots, CPU seconds a second", found["10 robots, node"][0], 0.5)


if __name__ == "__main__":
    main()

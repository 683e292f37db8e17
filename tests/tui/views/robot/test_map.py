"""A robot from above: found by its scan, placed by its transforms, driven by keys."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow import Node, Publisher, Time
from graphflow.msgs.geometry_msgs.msg import Twist, TwistStamped
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Header
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Robot(Node):
    """Stands where it is told, and sees a wall around it."""

    tf = Transforms(listen=False)
    scan = Publisher(LaserScan, "scan", 10)

    def show(self, x: float, second: int, *, placed: bool = True) -> None:
        stamp = Time(second * 10**9)
        if placed:
            self.tf.send(Transform.of("odom", "base_scan", (x, 0.0, 0.0), stamp=stamp))
        ranges = np.full(360, 1.5, np.float32)
        header = Header(stamp=stamp, frame_id="base_scan")
        self.scan.publish(
            LaserScan(header=header, angle_increment=math.tau / 360, range_min=0.1, range_max=3.5, ranges=ranges)
        )


@slow
async def test_a_robot_is_drawn(graph: Graph) -> None:
    """Its scan is around it, and its place in the title; a simulation that begins again starts a new drawing."""
    robot = Robot()
    await graph.start(robot)
    async with stage(Content("map"), graph=graph, size=(60, 30)) as s:
        await s.until("waiting for a robot" if not s.view.hub.live else lambda: True)
        await graph.settle()
        for second in range(10, 14):
            robot.show((second - 10) * 0.5, second)
            await graph.settle()
            await s.look()
        await s.until("x 1.50  y 0.00     0°  in odom")
        await s.until("▶")
        assert sum("⠀" < c <= "⣿" for c in s.text) > 40
        drawing = s.view._drawing  # type: ignore[attr-defined]
        before = len(drawing.trail)
        assert before == 4
        robot.show(0.0, 1)
        await graph.settle()
        assert len(drawing.trail) <= 1


@slow
async def test_without_transforms(graph: Graph) -> None:
    """The scanner is the middle of everything, and the title says what is missing."""
    robot = Robot()
    await graph.start(robot)
    async with stage(Content("map"), graph=graph, size=(110, 30)) as s:
        await graph.settle()
        await s.look()
        robot.show(0.0, 5, placed=False)
        await graph.settle()
        await s.until("odom -> base_scan: there is no frame 'odom'")
        await s.until(lambda: any("⠀" < c <= "⣿" for c in s.text), "the scan is drawn")


@slow
@pytest.mark.parametrize(("key", "linear", "angular"), [("up", 0.15, 0.0), ("left", 0.0, 0.8), ("space", 0.0, 0.0)])
@pytest.mark.parametrize("kind", [Twist, TwistStamped])
async def test_keys_drive(
    key: str, linear: float, angular: float, kind: type[Twist | TwistStamped], graph: Graph
) -> None:
    """Each press is one command of the type that the robot takes; the equivalent command is shown."""
    robot, driven = Robot(), graph.tap(kind, "/cmd_vel")
    await graph.start(robot)
    async with stage(Content("map"), graph=graph) as s:
        await s.until(lambda: s.view._topic == "/scan")  # type: ignore[attr-defined]
        await graph.settle()
        await s.press(key)
        await s.until("$ graphflow topic pub --once /cmd_vel geometry_msgs/msg/Twist")
        await graph.settle()
        latest = driven.latest
        twist = latest.twist if isinstance(latest, TwistStamped) else latest
        assert (twist.linear.x, twist.angular.z) == (linear, angular)


async def test_without_a_robot() -> None:
    """The view says what it waits for."""
    async with stage(Content("map")) as s:
        assert "waiting for a robot: no node publishes a laser scan yet" in s.text

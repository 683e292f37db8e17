"""What else a robot's map shows, and the places that are chosen on it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from graphflow import Node, Publisher, Time
from graphflow.maps import GridMap
from graphflow.msgs.geometry_msgs.msg import (
    Point,
    Point32,
    Polygon,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Twist,
)
from graphflow.msgs.nav_msgs.msg import OccupancyGrid, Path
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Header
from graphflow.qos import LATCHED
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from graphflow.tui.panes import Content
from graphflow.tui.views.robot import layers
from graphflow.tui.widgets.map_canvas import RobotDrawing
from tests.cases import slow
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def at(x: float, y: float) -> PoseStamped:
    return PoseStamped(header=Header(frame_id="odom"), pose=Pose(position=Point(x=x, y=y)))


class Robot(Node):
    """Stands at (1, 0) in the map, with everything that a map shows."""

    tf = Transforms(listen=False)
    scan = Publisher(LaserScan, "scan", 10)
    grid = Publisher(OccupancyGrid, "map", LATCHED)
    plan = Publisher(Path, "plan", LATCHED)
    outline = Publisher(PolygonStamped, "local_costmap/published_footprint", LATCHED)

    def show(self) -> None:
        self.tf.send_static(
            Transform.of("map", "odom", (1.0, 0.0, 0.0)), Transform.of("map", "two/base_link", (2.0, 1.0, 0.0))
        )
        self.tf.send(Transform.of("odom", "base_scan", stamp=Time(10**9)))
        header = Header(stamp=Time(10**9), frame_id="base_scan")
        ranges = np.full(36, 1.5, np.float32)
        self.scan.publish(
            LaserScan(header=header, angle_increment=math.tau / 36, range_min=0.1, range_max=3.5, ranges=ranges)
        )
        cells = np.zeros((20, 20), np.int8)
        cells[0] = 100
        self.grid.publish(GridMap(cells, 0.1, (-1.0, -1.0, 0.0)).to_msg("map"))
        self.plan.publish(Path(header=Header(frame_id="odom"), poses=[at(0.0, 0.0), at(1.0, 0.0)]))
        corners = [Point32(x=x, y=y) for x, y in ((0.1, 0.1), (-0.1, 0.1), (0.0, -0.1))]
        self.outline.publish(PolygonStamped(header=Header(frame_id="base_scan"), polygon=Polygon(points=corners)))


async def shown(graph: Graph, s: Stage, robot: Robot) -> None:
    for _ in range(2):  # the first scan opens the other topics
        await graph.settle()
        await s.look()
        robot.show()
        await graph.settle()
        await s.look()
    await s.until("in map")


@slow
async def test_layers(graph: Graph) -> None:
    """Map, path, footprint and another robot are where they belong in the map's frame."""
    robot = Robot()
    await graph.start(robot)
    async with stage(Content("map"), graph=graph, size=(60, 30)) as s:
        await shown(graph, s, robot)
        await s.until(lambda: bool(len(s.view._drawing.walls)), "the map is there")  # type: ignore[attr-defined]
        drawing = s.view._drawing  # type: ignore[attr-defined]
        assert drawing.walls.shape == (20, 2)
        assert drawing.walls[0] == pytest.approx((-0.95, -0.95))
        assert drawing.path == [(1.0, 0.0), (2.0, 0.0)]
        assert drawing.footprint[0] == pytest.approx((1.1, 0.1))
        assert drawing.others == {"two": (2.0, 1.0, 0.0)}
        await s.until("two")  # drawn with the next frame


@slow
async def test_a_goal_that_no_node_takes(graph: Graph) -> None:
    """The message says which node would."""
    robot = Robot()
    await graph.start(robot)
    async with stage(Content("map"), graph=graph, size=(90, 30)) as s:
        await shown(graph, s, robot)
        await s.press("g")
        await s.press("up")
        await s.press("enter")
        await graph.settle()
        await s.until("no node subscribes to /goal_pose; graphflow run goal_driver -p frame:=map")


class Frames:
    """Transforms of more robots than are drawn, all at the origin."""

    frames = tuple(f"r{i}/base_link" for i in range(layers.OTHERS_BOUND + 3))

    def get(self, parent: str, frame: str) -> Transform:
        return Transform.of(parent, frame)


def test_bounds() -> None:
    """Cells, points and robots; the cells that are left out lie between those that are drawn."""
    drawing = RobotDrawing()
    shown: Any = layers.Layers(None, drawing, Frames(), "")  # type: ignore[arg-type]
    shown._planned(Path(poses=[at(1.0, 0.0)] * (layers.POINTS_BOUND + 3)))
    shown._outlined(PolygonStamped(polygon=Polygon(points=[Point32()] * (layers.POINTS_BOUND + 3))))
    shown._mapped(GridMap(np.full((layers.WALLS_BOUND // 100 + 1, 200), 100, np.int8), 0.1).to_msg("map"))
    assert (len(drawing.path), len(drawing.footprint)) == (layers.POINTS_BOUND, layers.POINTS_BOUND)
    assert layers.WALLS_BOUND // 2 < len(drawing.walls) <= layers.WALLS_BOUND
    assert len(shown._others()) == layers.OTHERS_BOUND


@slow
async def test_a_goal_is_set(graph: Graph) -> None:
    """By `g`, arrow keys and Enter, or a click; it is sent as rviz sends it, and drawn. Escape gives up."""
    robot = Robot()
    await graph.start(robot)
    goals = graph.tap(PoseStamped, "/goal_pose")
    estimates = graph.tap(PoseWithCovarianceStamped, "/initialpose")
    driven = graph.tap(Twist, "/cmd_vel")
    async with stage(Content("map"), graph=graph, size=(60, 30)) as s:
        await shown(graph, s, robot)
        await s.press("g")
        await s.until("goal: arrows, Enter, or a click")
        for _ in range(5):
            await s.press("up")
        await s.press("enter")
        await graph.settle()
        await s.until(lambda: bool(goals), "the goal is sent")
        goal = goals.latest
        assert goal.header.frame_id == "map"
        assert (goal.pose.position.x, goal.pose.position.y) == pytest.approx((1.0, 1.0))
        assert 2 * math.atan2(goal.pose.orientation.z, goal.pose.orientation.w) == pytest.approx(math.pi / 2)
        assert s.view._drawing.goal == pytest.approx((1.0, 1.0))  # type: ignore[attr-defined]
        await s.press("g")
        await s.press("escape")
        await s.press("enter")
        await s.press("e")
        await s.press("right")
        await s.press("enter")
        await graph.settle()
        await s.until(lambda: bool(estimates), "the estimate is sent")
        assert estimates.latest.pose.pose.position.x == pytest.approx(1.2)
        assert len(goals) == 1
        assert not driven  # the arrows moved the cursor

"""The mapper as a node: what it publishes, what it waits for, and when it begins again."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow import Node, Publisher, Time
from graphflow.maps import GridMap
from graphflow.msgs.nav_msgs.msg import OccupancyGrid
from graphflow.msgs.nav_msgs.srv import GetMap
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Header
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.qos import LATCHED, SENSOR_DATA
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from nodes.mapper import Mapper


class Robot(Node):
    """Stands in the middle of a round room."""

    tf = Transforms(listen=False)
    scan = Publisher(LaserScan, "scan", SENSOR_DATA)

    def look(self, second: float, x: float = 0.0, *, placed: bool = True, ranges: list[float] | None = None) -> None:
        stamp = Time(round(second * 1e9))
        if placed:
            self.tf.send(Transform.of("odom", "base_footprint", (x, 0.0, 0.0), stamp=stamp))
            self.tf.send_static(Transform.of("base_footprint", "base_scan", (-0.03, 0.0, 0.2)))
        seen = np.full(360, 1.5, np.float32) if ranges is None else np.array(ranges, np.float32)
        header = Header(stamp=stamp, frame_id="base_scan")
        step = math.tau / len(seen)
        self.scan.publish(LaserScan(header=header, angle_increment=step, range_min=0.1, range_max=3.5, ranges=seen))


async def test_map_and_transform(graph: Graph) -> None:
    """A scan becomes a map, which late subscribers get, too, and a transform at the scan's time."""
    robot, mapper = Robot(), Mapper()
    await graph.start(robot, mapper)
    robot.look(1.0)
    await graph.settle()
    await graph.clock.advance(1.1)
    maps = graph.tap(OccupancyGrid, "/map", LATCHED)
    await graph.settle()
    grid = GridMap.from_msg(maps.latest)
    assert maps.latest.header.frame_id == "map"
    assert grid.at(0.5, 0.5) < 50 < grid.at(1.47, 0.0)
    assert mapper.tf.get("map", "odom").stamp == Time(10**9)
    found = await graph.call(GetMap, "/dynamic_map", GetMap.Request())
    assert found.map.info.width == maps.latest.info.width
    await graph.clock.advance(5.0)
    assert len(maps) == 1  # nothing has changed


async def test_without_transforms(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The scan is left out, and the warning says what is missing."""
    robot, mapper = Robot(), Mapper()
    await graph.start(robot, mapper)
    robot.look(1.0, placed=False)
    await graph.clock.advance(1.0)
    assert "a scan is left out: odom -> base_footprint: there is no frame 'odom'" in caplog.text
    assert mapper.map.drawn == 0


async def test_time_that_jumps_back_and_a_reset(graph: Graph) -> None:
    """Both begin a new map."""
    robot, mapper = Robot(), Mapper()
    await graph.start(robot, mapper)
    robot.look(10.0)
    await graph.settle()
    assert mapper.map.drawn == 1
    robot.look(1.0)
    await graph.settle()
    assert mapper.latest == Time(10**9)
    await graph.call(Empty, "/mapper/reset", Empty.Request())
    assert mapper.map.drawn == 0


def test_beams() -> None:
    """A single beam without an echo is a dropout; several in a row look into free space; nonsense is left out."""
    mapper = Mapper()
    ranges = [1.0, math.inf, 1.0, math.inf, math.inf, math.inf, math.nan, 0.01, -1.0, 99.0]
    scan = LaserScan(angle_increment=math.tau / 10, range_min=0.1, range_max=3.0, ranges=np.array(ranges, np.float32))
    hit, free = mapper.points(scan)
    assert np.hypot(*hit.T) == pytest.approx([1.0, 1.0])
    assert np.hypot(*free.T) == pytest.approx([3.0])

"""Scans around their scanner."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow import Node, Publisher
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Robot(Node):
    scan = Publisher(LaserScan, "scan", 10)
    other = Publisher(LaserScan, "rear/scan", 10)
    word = Publisher(String, "word", 10)

    def look(self, wall: float) -> None:
        ranges = np.full(360, math.inf, np.float32)
        ranges[80:100] = wall  # on the left
        self.scan.publish(LaserScan(angle_increment=math.tau / 360, range_min=0.1, range_max=9.0, ranges=ranges))


@slow
async def test_a_scan(graph: Graph) -> None:
    """Points are where they were seen; the nearest is told; keys zoom and choose another scanner."""
    robot = Robot()
    await graph.start(robot)
    async with stage(Content("scan", "/scan"), graph=graph, size=(60, 24)) as s:
        await graph.settle()
        await s.until("/scan: no scan has come yet")
        robot.look(2.0)
        await graph.settle()
        await s.until("20 of 360 beams hit something; nearest 2.00 m at ")
        await s.until("ring 0.5 m")
        rows = [line for line in s.text.splitlines() if any("⠀" < c <= "⣿" for c in line)]
        assert "▲" in s.text
        middle = next(line for line in rows if "▲" in line)
        assert any("⠀" < c <= "⣿" for c in middle[: middle.index("▲")])
        await s.press("minus")
        await s.press("minus")
        assert s.view._polar.shown > 2.5  # type: ignore[attr-defined]
        await s.press("0")
        assert s.view._polar.radius == 0.0  # type: ignore[attr-defined]
        await s.press("n")
        await s.until("/rear/scan: no scan has come yet")


async def test_a_topic_without_scans(graph: Graph) -> None:
    """Its type is told."""
    await graph.start(Robot())
    async with stage(Content("scan", "/word"), graph=graph, size=(80, 20)) as s:
        await graph.settle()
        await s.until("/word has no scans: it is of type std_msgs/msg/String")

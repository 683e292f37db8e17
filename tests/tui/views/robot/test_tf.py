"""The tree of frames in the console."""

from __future__ import annotations

import pytest

from graphflow import Node, Time
from graphflow.testing import Graph
from graphflow.tf import FrameInfo, Transform, Transforms
from graphflow.tui.panes import Content
from graphflow.tui.views.robot.tf import is_stopped, remark
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Robot(Node):
    tf = Transforms(listen=False)

    def send(self, second: float, parent: str = "map") -> None:
        self.tf.send(Transform.of(parent, "odom", stamp=Time(round(second * 1e9))))


@slow
async def test_frames_are_drawn(graph: Graph) -> None:
    """Below each other, with their publishers; a second tree is told."""
    robot = Robot()
    await graph.start(robot)
    async with stage(Content("tf"), graph=graph, size=(70, 20)) as s:
        await graph.settle()
        await s.until("no transforms yet: nothing is published on /tf or /tf_static")
        robot.tf.send_static(Transform.of("odom", "base_link", (1.0, 0.0, 0.0)))
        robot.send(1.0)
        robot.send(1.5)
        await graph.settle()
        await s.until("└── odom   2.0 Hz, by /robot")
        await s.until("    └── base_link   static, by /robot")
        assert s.view.note == "3 frames"
        robot.tf.send_static(Transform.of("world", "moon"))
        await graph.settle()
        await s.until("5 frames, 2 trees, not connected")
        await s.press("C")
        await s.until("└── base_link")  # static frames come again


INFO = FrameInfo(
    "odom", "map", "/slam", is_static=False, rate=10.0, newest=Time(0), delay=0.0, longest_delay=0.0, silent=0.1
)


@pytest.mark.parametrize(
    ("changes", "stopped", "text"),
    [
        ({}, False, "10.0 Hz, by /slam"),
        ({"silent": 2.0}, True, "stopped 2.0 s ago, by /slam"),
        ({"rate": 0.5, "silent": 5.0}, False, "0.5 Hz, by /slam"),
        ({"rate": 0.5, "silent": 6.5}, True, "stopped 6.5 s ago, by /slam"),
        ({"publisher": ""}, True, "stopped 0.1 s ago, its publisher has ended"),
        ({"is_static": True, "silent": 99.0}, False, "static, by /slam"),
        ({"rate": 0.0, "silent": 99.0}, False, "by /slam"),
    ],
)
def test_breaks(changes: dict[str, object], stopped: bool, text: str) -> None:
    """A frame has stopped after three periods and a second, or when its publisher has ended; a static one never has."""
    from dataclasses import replace

    info = replace(INFO, **changes)  # type: ignore[arg-type]
    assert is_stopped(info) is stopped
    assert remark(info) == text

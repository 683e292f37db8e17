"""The topics of a simulated camera."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from graphflow import Node
from graphflow.errors import NoCamera
from graphflow.introspect.messages.images import pixels, uncompressed
from graphflow.msgs.sensor_msgs.msg import CameraInfo, CompressedImage, Image
from graphflow.simulator import SimulatedRobot
from graphflow.testing import Graph
from graphflow.tf import Transforms
from nodes.robot_simulator import RobotSimulator
from tests.cases import slow


class Listener(Node):
    tf = Transforms()


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Images that are drawn in the place of MuJoCo's, which not every machine can draw."""
    calls: list[str] = []

    def image(self: SimulatedRobot) -> Any:
        calls.append("image")
        return np.full((240, 320, 3), 99, np.uint8)

    def depth(self: SimulatedRobot) -> Any:
        calls.append("depth")
        return np.full((240, 320), 1.5, np.float32)

    monkeypatch.setattr(SimulatedRobot, "image", image)
    monkeypatch.setattr(SimulatedRobot, "depth", depth)
    return calls


@slow
async def test_images(graph: Graph, drawn: list[str]) -> None:
    """Each kind is sent ten times a second to those who subscribe, in the frame of the lens."""
    await graph.start(RobotSimulator(world="empty", model="waffle"))
    await graph.clock.advance(0.5)
    assert not drawn
    images, depths = graph.tap(Image, "/camera/image_raw"), graph.tap(Image, "/camera/depth/image_raw")
    small, infos = (
        graph.tap(CompressedImage, "/camera/image_raw/compressed"),
        graph.tap(CameraInfo, "/camera/camera_info"),
    )
    await graph.clock.advance(1.0)
    assert [len(tap) for tap in (images, depths, small, infos)] == pytest.approx([10] * 4, abs=1)
    assert pixels(images.latest).shape == uncompressed(small.latest).shape == (240, 320, 3)
    assert np.frombuffer(bytes(depths.latest.data), "<f4")[0] == 1.5
    assert images.latest.header.frame_id == infos.latest.header.frame_id == "camera_optical_frame"
    assert infos.latest.k[2] == 160.0
    assert infos.latest.k[0] == infos.latest.p[5] == pytest.approx(265, abs=1)


async def test_frames(graph: Graph) -> None:
    """The lens looks ahead: its z axis is the robot's x axis."""
    listener = Listener(use_sim_time=True)
    await graph.start(RobotSimulator(world="empty", model="waffle"), listener)
    await graph.clock.advance(0.2)
    ahead = listener.tf.get("base_link", "camera_optical_frame").vectors([0.0, 0.0, 1.0])
    assert ahead == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)


async def test_a_machine_that_cannot_draw(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It is told once, and all else goes on."""

    def fail(self: SimulatedRobot) -> None:
        raise NoCamera("this machine cannot draw")

    monkeypatch.setattr(SimulatedRobot, "image", fail)
    node = RobotSimulator(world="empty", model="waffle")
    await graph.start(node)
    graph.tap(Image, "/camera/image_raw")
    await graph.clock.advance(1.0)
    assert caplog.text.count("no images: this machine cannot draw") == 1
    assert node.simulation.time == pytest.approx(1.0, abs=0.05)

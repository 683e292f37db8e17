"""Images in cells of two pixels."""

from __future__ import annotations

import numpy as np
import pytest

from graphflow import Node, Publisher
from graphflow.msgs.sensor_msgs.msg import CompressedImage, Image
from graphflow.msgs.std_msgs.msg import Header
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Camera(Node):
    image = Publisher(Image, "camera/image_raw", 10)
    compressed = Publisher(CompressedImage, "camera/image_raw/compressed", 10)

    def shoot(self, encoding: str = "rgb8") -> None:
        pixels = np.zeros((20, 40, 3), np.uint8)
        pixels[:, 20:, 0] = 255
        self.image.publish(
            Image(header=Header(frame_id="lens"), encoding=encoding, width=40, height=20, step=120, data=pixels.ravel())
        )


async def test_an_image(graph: Graph) -> None:
    """It fills the pane as far as its shape allows; size, encoding, rate and frame are told."""
    camera = Camera()
    await graph.start(camera)
    async with stage(Content("image"), graph=graph, size=(80, 24)) as s:
        await graph.settle()
        await s.until("/camera/image_raw: no image has come yet")
        camera.shoot()
        await graph.settle()
        await s.until("40 x 20 rgb8, ")
        await s.until("Hz, lens")
        row = max(s.text.splitlines(), key=lambda line: line.count("▀"))
        assert row.count("▀") == 2 * len([line for line in s.text.splitlines() if "▀" in line]) * 2
        await s.press("space")
        assert s.view.note == "paused"
        await s.press("space")
        camera.shoot("strange")
        await graph.settle()
        await s.until("not shown: the encoding 'strange' is unknown")
        await s.press("n")
        await s.until("/camera/image_raw/compressed: no image has come yet")
        camera.compressed.publish(CompressedImage(format="jpeg", data=np.zeros(5, np.uint8)))
        await graph.settle()
        await s.until("not shown: its data is no JPEG or PNG image")

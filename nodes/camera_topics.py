"""The topics of a simulated robot's camera: images, compressed images, depths and the camera's data."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image as Picture

from graphflow import GraphflowError, Node, Time
from graphflow.msgs.sensor_msgs.msg import CameraInfo, CompressedImage, Image
from graphflow.msgs.std_msgs.msg import Header
from graphflow.qos import SENSOR_DATA
from graphflow.tf import Transform

if TYPE_CHECKING:  # it imports mujoco, which may not be there
    from graphflow.simulator import SimulatedRobot

OPTICAL = (-math.pi / 2, 0.0, -math.pi / 2)
"""Roll, pitch and yaw of an image's frame in the camera's: x to the right, y down, z ahead. Source: REP 103."""


class CameraTopics:
    """The camera of one robot; images are drawn only for those who subscribe.

    Args:
        before: What precedes the robot's topics and frames, such as `second/`.
    """

    def __init__(self, node: Node, robot: SimulatedRobot, before: str) -> None:
        camera = robot.robot.camera
        assert camera is not None
        self._node, self._robot, self._camera, self._before = node, robot, camera, before
        self.image = node.create_publisher(Image, f"{before}camera/image_raw", SENSOR_DATA)
        self.compressed = node.create_publisher(CompressedImage, f"{before}camera/image_raw/compressed", SENSOR_DATA)
        self.info = node.create_publisher(CameraInfo, f"{before}camera/camera_info", SENSOR_DATA)
        depth = f"{before}camera/depth/image_raw"
        self.depth = node.create_publisher(Image, depth, SENSOR_DATA) if camera.depth else None
        self._can_draw = True

    def frames(self, base: str, height: float) -> list[Transform]:
        """Return the fixed places of the camera and of its images.

        Args:
            height: That of the base's frame above the ground.
        """
        x, y, z = self._camera.at
        frame = self._before + self._camera.frame
        tilted = Transform.of(base, frame, (x, y, z - height), rpy=(0.0, self._camera.pitch, 0.0))
        return [tilted, Transform.of(frame, self._optical, rpy=OPTICAL)]

    @property
    def _optical(self) -> str:
        return f"{self._before}{self._camera.frame.removesuffix('_link')}_optical_frame"

    def publish(self, stamp: Time) -> None:
        """Publish what is subscribed to."""
        header = Header(stamp=stamp, frame_id=self._optical)
        if self.info.get_subscription_count():
            self.info.publish(self._data(header))
        if not self._can_draw:
            return
        try:
            self._draw(header)
        except GraphflowError as error:
            self._can_draw = False
            self._node.log.error("no images: %s", error)

    def _draw(self, header: Header) -> None:
        wants_compressed = self.compressed.get_subscription_count()
        width, height = self._camera.width, self._camera.height
        if self.image.get_subscription_count() or wants_compressed:
            image = self._robot.image()
            message = Image(header=header, encoding="rgb8", width=width, height=height, step=3 * width)
            message.data = image.ravel()
            self.image.publish(message)
            if wants_compressed:
                file = io.BytesIO()
                Picture.fromarray(image).save(file, "JPEG", quality=80)
                data = np.frombuffer(file.getvalue(), np.uint8)
                self.compressed.publish(CompressedImage(header=header, format="rgb8; jpeg compressed bgr8", data=data))
        if self.depth is not None and self.depth.get_subscription_count():
            depths = self._robot.depth().astype("<f4")
            message = Image(header=header, encoding="32FC1", width=width, height=height, step=4 * width)
            message.data = np.frombuffer(depths.tobytes(), np.uint8)
            self.depth.publish(message)

    def _data(self, header: Header) -> CameraInfo:
        """Return the camera's data: an ideal lens. Source: sensor_msgs/msg/CameraInfo."""
        focal, width, height = self._camera.focal, self._camera.width, self._camera.height
        u, v = width / 2, height / 2
        return CameraInfo(
            header=header,
            width=width,
            height=height,
            distortion_model="plumb_bob",
            d=[0.0] * 5,
            k=[focal, 0.0, u, 0.0, focal, v, 0.0, 0.0, 1.0],
            r=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            p=[focal, 0.0, u, 0.0, 0.0, focal, v, 0.0, 0.0, 0.0, 1.0, 0.0],
        )

    def close(self) -> None:
        """Withdraw the topics."""
        for publisher in (self.image, self.compressed, self.info, self.depth):
            if publisher is not None:
                publisher.close()

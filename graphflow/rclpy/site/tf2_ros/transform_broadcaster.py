"""Broadcasting of transforms that change."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from rclpy.impl.mistakes.refused_transforms import check
from rclpy.impl.mistakes.unstamped_transforms import Unstamped
from rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from rclpy.node import Node


class TransformBroadcaster:
    """Publishes transforms on `/tf`."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", 100 if qos is None else qos)
        self._unstamped = Unstamped(node)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802 - tf2's name
        """Publish one transform, or several."""
        transforms = as_list(transform)
        for one in transforms:
            check(one)
            self._unstamped.check(one)
        self.pub_tf.publish(TFMessage(transforms=transforms))


def as_list(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    """Return one transform, or several, as a list."""
    return list(transform) if hasattr(transform, "__iter__") else [transform]

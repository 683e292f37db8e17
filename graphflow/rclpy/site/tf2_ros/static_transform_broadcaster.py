"""Broadcasting of transforms that do not change."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from rclpy.impl.mistakes.refused_transforms import check
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_ros.transform_broadcaster import as_list

if TYPE_CHECKING:
    from rclpy.node import Node


class StaticTransformBroadcaster:
    """Publishes transforms on `/tf_static`, also for late subscribers."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        if qos is None:
            kept = DurabilityPolicy.TRANSIENT_LOCAL
            qos = QoSProfile(depth=1, durability=kept, history=HistoryPolicy.KEEP_LAST)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos)
        self._sent: dict[str, TransformStamped] = {}

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802 - tf2's name
        """Publish one transform, or several, with all those published before: only the last message is kept."""
        transforms = as_list(transform)
        for one in transforms:
            check(one)
        self._sent |= {one.child_frame_id: one for one in transforms}
        self.pub_tf.publish(TFMessage(transforms=list(self._sent.values())))

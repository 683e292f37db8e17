"""The listener that fills a buffer with transforms."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from tf2_msgs.msg import TFMessage
from tf2_py import BufferCore

from graphflow.tf.frames import BACK, seconds
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, ShutdownException, SingleThreadedExecutor
from rclpy.impl.nodes import internals_of
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_ros.buffer import Buffer

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.subscription import Subscription


DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"
DEPTH = 100


class TransformListener:
    """Adds transforms from `/tf` and `/tf_static` to a buffer while its node is spun.

    Args:
        spin_thread: Whether to spin the node in a thread of its own.
        static_only: Whether to ignore `/tf`.
    """

    def __init__(
        self,
        buffer: BufferCore,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        static_only: bool = False,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        self.buffer, self.node = buffer, node
        self._latest_ns = 0
        if isinstance(buffer, Buffer):
            internals_of(buffer).is_filled = True
        self.group = ReentrantCallbackGroup()
        if static_qos is None:
            kept = DurabilityPolicy.TRANSIENT_LOCAL
            static_qos = QoSProfile(depth=DEPTH, durability=kept, history=HistoryPolicy.KEEP_LAST)
        self.tf_sub: Subscription | None = None
        if not static_only:
            self.tf_sub = node.create_subscription(
                TFMessage, tf_topic, self.callback, DEPTH if qos is None else qos, callback_group=self.group
            )
        self.tf_static_sub: Subscription | None = node.create_subscription(
            TFMessage, tf_static_topic, self.static_callback, static_qos, callback_group=self.group
        )
        self.executor: SingleThreadedExecutor | None = None
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(node)
            self.dedicated_listener_thread = threading.Thread(target=self._spin, args=(self.executor,), daemon=True)
            self.dedicated_listener_thread.start()

    @staticmethod
    def _spin(executor: SingleThreadedExecutor) -> None:
        try:
            executor.spin()
        except (ExternalShutdownException, ShutdownException):
            return  # its context has ended, or `unregister` was called

    def callback(self, data: TFMessage) -> None:
        """Add the transforms of a `/tf` message."""
        self._clear_after_jump()
        for transform in data.transforms:
            self.buffer.set_transform(transform)

    def _clear_after_jump(self) -> None:
        """Clear the buffer if the node's time has jumped back, as when a simulation or a bag begins again."""
        now, before = self.node.get_clock().now().nanoseconds, self._latest_ns
        self._latest_ns = now
        if now < before - BACK:
            back = seconds(before - now)
            self.node.get_logger().info(f"the time has jumped back by {back} s; only static transforms are kept")
            self.buffer.clear()

    def static_callback(self, data: TFMessage) -> None:
        """Add the transforms of a `/tf_static` message."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform)

    def unregister(self) -> None:
        """Stop listening."""
        if self.executor is not None:
            self.executor.shutdown()
            self.executor = None
        for subscription in (self.tf_sub, self.tf_static_sub):
            if subscription is not None:
                self.node.destroy_subscription(subscription)
        self.tf_sub = self.tf_static_sub = None

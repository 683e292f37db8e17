#!/usr/bin/env python3
"""Print the transform between two frames periodically. Source: tf2_ros tf2_echo, its arguments and output."""

from __future__ import annotations

import argparse
import sys

from geometry_msgs.msg import TransformStamped
from tf2_ros import Buffer, TransformException, TransformListener

import rclpy
from graphflow.tf.text import described
from graphflow.tf.transform import Transform, pose_of
from graphflow.times import Time as NativeTime
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from rclpy.utilities import remove_ros_args


class Echo(Node):
    """Prints a transform once per period, or the reason why there is none.

    Args:
        target: The frame in which coordinates are given.
        source: The frame whose pose is given.
        once: Whether to exit after the first.
    """

    def __init__(self, target: str, source: str, period: float, *, once: bool) -> None:
        super().__init__("tf2_echo")
        self._target, self._source, self._once = target, source, once
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._is_known = False
        self.create_timer(period, self._print)

    def _print(self) -> None:
        try:
            found = self._buffer.lookup_transform(self._target, self._source, Time())
        except TransformException as error:
            if not self._is_known:
                waiting = f"Waiting for transform {self._target} -> {self._source}: {error}"
                self.get_logger().info(waiting, throttle_duration_sec=0.9)
            else:
                _show(f"Failure at {self.get_clock().now().nanoseconds / 1e9}\n{error}\n")
            return
        self._is_known = True
        _show(f"{described(_native(found))}\n")
        if self._once:
            raise SystemExit


def _native(found: TransformStamped) -> Transform:
    stamp = Time.from_msg(found.header.stamp).nanoseconds
    return Transform(found.header.frame_id, found.child_frame_id, pose_of(found.transform), NativeTime(stamp))


def _show(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()


def main() -> None:
    """Run the program."""
    rclpy.init()
    parser = argparse.ArgumentParser("tf2_echo", description="Print the transform between two frames.")
    parser.add_argument("source_frame", help="the frame in which coordinates are given")
    parser.add_argument("target_frame", help="the frame whose pose is given")
    parser.add_argument("rate", nargs="?", type=float, default=1.0, help="times a second (default 1)")
    parser.add_argument("-1", "--once", action="store_true", help="show it once")
    found = parser.parse_args(remove_ros_args(sys.argv)[1:])
    if not found.rate > 0:
        parser.error(f"rate: expected more than 0, got {found.rate}")
    try:
        rclpy.spin(Echo(found.source_frame, found.target_frame, 1.0 / found.rate, once=found.once))
    except (KeyboardInterrupt, ExternalShutdownException):
        return


if __name__ == "__main__":
    main()

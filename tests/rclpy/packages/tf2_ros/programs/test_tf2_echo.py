"""What tf2_echo shows."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import pytest
from tf2_py.core import message
from tf2_ros import TransformBroadcaster

from graphflow.tf.poses import Pose
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

HALF = math.sqrt(0.5)
SHOWN = """At time 7.000000005
- Translation: [1.000, 2.000, 0.000]
- Rotation: in Quaternion (xyzw) [0.000, 0.000, 0.707, 0.707]
- Rotation: in RPY (radian) [0.000, -0.000, 1.571]
- Rotation: in RPY (degree) [0.000, -0.000, 90.000]
- Matrix:
  0.000 -1.000  0.000  1.000
  1.000  0.000  0.000  2.000
  0.000  0.000  1.000  0.000
  0.000  0.000  0.000  1.000
"""


def test_a_transform_is_shown_as_tf2_echo_shows_it(
    program: Callable[[str], Any], node: Node, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    """Until there is one, why there is none; once it is there, itself."""
    echo = program("tf2_ros/tf2_echo")["Echo"]("map", "base", 0.01, once=True)
    executor = SingleThreadedExecutor()
    executor.add_node(echo)
    until = time.monotonic() + 10
    while not caplog.messages and time.monotonic() < until:
        executor.spin_once(timeout_sec=0.05)
    assert caplog.messages[0].startswith("Waiting for transform map -> base: ")
    says, pose = TransformBroadcaster(node), Pose((1.0, 2.0, 0.0), (0.0, 0.0, HALF, HALF))
    with pytest.raises(SystemExit):
        while time.monotonic() < until:
            says.sendTransform(message(pose, "map", "base", 7 * 10**9 + 5))
            executor.spin_once(timeout_sec=0.05)
    assert capsys.readouterr().out == SHOWN

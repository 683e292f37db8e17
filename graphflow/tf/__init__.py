"""Transforms between coordinate frames over time, on ROS's topics /tf and /tf_static.

Read `declaration` (what a node class declares) and `buffer` (what a node then has) first. `frames` keeps the poses and
finds chains, `poses` and `planar` have the arithmetic, `transform` the result of a lookup, `messages` what it converts,
`faults` what is refused, and `reports` what is warned of. Only `declaration` and `buffer` know nodes; rclpy's tf2
packages are built on the other modules. May import the runtime and everything below it.
"""

from graphflow.tf.buffer import TransformBuffer
from graphflow.tf.declaration import Transforms
from graphflow.tf.info import FrameInfo
from graphflow.tf.planar import Pose2D
from graphflow.tf.poses import Pose
from graphflow.tf.transform import Transform

__all__ = ["FrameInfo", "Pose", "Pose2D", "Transform", "TransformBuffer", "Transforms"]

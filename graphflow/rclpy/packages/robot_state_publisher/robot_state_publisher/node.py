"""The node `robot_state_publisher`. Source: its parameters, topics and rules as in ROS 2's package of that name."""

from __future__ import annotations

import sys
from pathlib import Path

from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_py.core import message
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from robot_state_publisher.urdf import MOVES, Joint, Robot, URDFError, parse


class RobotStatePublisher(Node):
    """Publishes the poses of a robot's links: moving links on each `joint_states` message, fixed ones once.

    Args:
        description: The robot in URDF, used if the parameter `robot_description` is empty.
    """

    def __init__(self, description: str = "") -> None:
        super().__init__("robot_state_publisher")
        self.declare_parameter("robot_description", description, ParameterDescriptor(description="The robot, in URDF."))
        most = FloatingPointRange(from_value=0.0, to_value=1000.0)
        about = "Highest rate at which a joint is published, in Hz; 0 for every state."
        self.declare_parameter(
            "publish_frequency", 20.0, ParameterDescriptor(description=about, floating_point_range=[most])
        )
        self.declare_parameter(
            "ignore_timestamp", False, ParameterDescriptor(description="Publish every joint state, whatever its time.")
        )
        self.declare_parameter("frame_prefix", "", ParameterDescriptor(description="Prefix of each frame's name."))
        if not self._text("robot_description"):
            raise URDFError("the parameter robot_description must not be empty")
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._description = self.create_publisher(String, "robot_description", kept)
        self._moving, self._fixed = TransformBroadcaster(self), StaticTransformBroadcaster(self)
        self._robot = parse(self._text("robot_description"))
        self._published: dict[str, int] = {}
        """The stamp of each joint's last published state, in nanoseconds."""
        self._heard = 0
        self._begin()
        self.create_subscription(JointState, "joint_states", self.on_joint_state, qos_profile_sensor_data)
        self.add_on_set_parameters_callback(self._is_well)
        self.add_post_set_parameters_callback(self._changed)
        self.get_logger().info("Robot initialized")

    def _text(self, name: str) -> str:
        return str(self.get_parameter(name).value)

    def _begin(self) -> None:
        """Publish the description and the poses of the fixed links."""
        self._description.publish(String(data=self._text("robot_description")))
        now = self.get_clock().now().nanoseconds
        fixed = [self._transform(joint, 0.0, now) for joint in self._robot.joints.values() if joint.type not in MOVES]
        if fixed:
            self._fixed.sendTransform(fixed)

    def _is_well(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == "robot_description":
                try:
                    parse(str(parameter.value))
                except URDFError as error:
                    return SetParametersResult(successful=False, reason=f"robot_description: {error}")
        return SetParametersResult(successful=True)

    def _changed(self, parameters: list[Parameter]) -> None:
        names = {parameter.name for parameter in parameters}
        if "robot_description" in names:
            self._robot = parse(self._text("robot_description"))
        if names & {"robot_description", "frame_prefix"}:
            self._begin()

    def on_joint_state(self, state: JointState) -> None:
        """Publish the poses of the moving links, unless that was done less than a period ago."""
        if len(state.position) != len(state.name):
            named = ", ".join(state.name)
            if not state.position:
                self.get_logger().warning(f"a JointState of {named} is ignored: it has no positions")
            else:
                self.get_logger().error(f"a JointState of {named} is ignored: it needs one position per name")
            return
        now, stamp = self.get_clock().now().nanoseconds, Time.from_msg(state.header.stamp).nanoseconds
        if now < self._heard:
            self.get_logger().warning("Moved backwards in time, re-publishing joint transforms!")
            self._published.clear()
        self._heard = now
        own = [name for name in state.name if name in self._robot.joints]
        least = min((self._published.get(name, 0) for name in own), default=now)
        frequency = self.get_parameter("publish_frequency").value
        period = 1e9 / frequency if frequency else 0.0
        if stamp < least + period and not self.get_parameter("ignore_timestamp").value:
            return
        known = dict(zip(state.name, state.position, strict=True))
        self._published.update(dict.fromkeys(own, stamp))
        moved = moved_joints(self._robot, known)
        if moved:
            self._moving.sendTransform([self._transform(joint, at, stamp) for joint, at in moved])

    def _transform(self, joint: Joint, position: float, stamp: int) -> TransformStamped:
        prefix = self._text("frame_prefix")
        return message(joint.pose(position), prefix + joint.parent, prefix + joint.child, stamp)


def moved_joints(robot: Robot, known: dict[str, float]) -> list[tuple[Joint, float]]:
    """Yield the moving joints with their positions: those reported, and those that mimic them."""
    found = []
    for joint in robot.joints.values():
        position = known.get(joint.name)
        if position is None and joint.mimic is not None and joint.mimic.joint in known:
            position = known[joint.mimic.joint] * joint.mimic.factor + joint.mimic.offset
        if position is not None and joint.type in MOVES:
            found.append((joint, position))
    return found


def main() -> None:
    """Run the node with the parameter `robot_description`, or with a file name as its argument."""
    rclpy.init()
    _, *files = remove_ros_args(sys.argv)
    try:
        node = RobotStatePublisher(Path(files[0]).read_text(encoding="utf-8") if files else "")
        rclpy.spin(node)
    except OSError as error:
        sys.exit(f"error: robot_state_publisher: {error.filename}: {error.strerror}")
    except URDFError as error:
        sys.exit(f"error: robot_state_publisher: {error}")
    except (KeyboardInterrupt, ExternalShutdownException):
        return

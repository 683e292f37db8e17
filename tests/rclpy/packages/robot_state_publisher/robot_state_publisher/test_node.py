"""The node robot_state_publisher."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_ros import Buffer, TransformListener

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time

ROBOT = """<robot name="r">
 <link name="base"/><link name="arm"/><link name="tip"/><link name="finger"/>
 <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
 <joint name="fix" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/></joint>
 <joint name="grip" type="prismatic"><parent link="tip"/><child link="finger"/>
  <mimic joint="turn" multiplier="2" offset="0.5"/></joint>
</robot>"""


@pytest.fixture
def robot(importable: None, node: Node, spin: Any) -> Iterator[Any]:
    """The node, which is spun with `node`."""
    from robot_state_publisher.node import RobotStatePublisher

    publisher = RobotStatePublisher(ROBOT)
    spin.executor.add_node(publisher)
    yield publisher
    publisher.destroy_node()


def state(stamp: int, **positions: float) -> JointState:
    message = JointState(name=list(positions), position=list(positions.values()))
    message.header.stamp.sec = stamp
    return message


def test_links_are_where_the_joints_say(robot: Any, node: Node, spin: Any) -> None:
    """Those that mimic others, too; what is fixed is there without them."""
    buffer = Buffer()
    TransformListener(buffer, node)
    joints = node.create_publisher(JointState, "joint_states", 10)
    spin(lambda: buffer.can_transform("arm", "tip", Time()) and joints.get_subscription_count())
    assert not buffer.can_transform("base", "finger", Time())
    joints.publish(state(5, turn=math.pi / 2, wheel=3.0))
    spin(lambda: buffer.can_transform("base", "finger", Time()))
    found = buffer.lookup_transform("base", "finger", Time())
    moved = found.transform.translation
    assert (moved.x, moved.y) == pytest.approx((0.0, 1.0 + 2 * math.pi / 2 + 0.5))
    assert found.header.stamp.sec == 5


def test_states_are_published_at_most_so_often(robot: Any) -> None:
    """By their own times; all of them if that is wished. Those that make no sense are left out."""
    sent: list[Any] = []
    robot._moving.sendTransform = sent.append
    robot.set_parameters([Parameter("publish_frequency", value=0.5)])
    for stamp in (10, 11, 12, 13, 14):
        robot.on_joint_state(state(stamp, turn=1.0, wheel=2.0))  # one that the robot does not have
    assert len(sent) == 3  # at 10, 12 and 14
    robot.set_parameters([Parameter("ignore_timestamp", value=True)])
    robot.on_joint_state(state(14, turn=1.0))
    assert len(sent) == 4
    robot.on_joint_state(JointState(name=["turn"]))
    robot.on_joint_state(JointState(name=["turn"], position=[1.0, 2.0]))
    assert len(sent) == 4


def test_the_description_is_published_and_can_be_changed(robot: Any, node: Node, spin: Any) -> None:
    """By its parameter; one that is none is refused."""
    heard: list[str] = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, "robot_description", lambda message: heard.append(message.data), kept)
    spin(lambda: heard == [ROBOT])
    [result] = robot.set_parameters([Parameter("robot_description", value="<robot/>")])
    assert (result.successful, result.reason) == (False, "robot_description: it has no link")
    one = '<robot><link name="base"/></robot>'
    assert robot.set_parameters([Parameter("robot_description", value=one)])[0].successful
    spin(lambda: heard == [ROBOT, one])
    assert not robot.set_parameters([Parameter("publish_frequency", value=-1.0)])[0].successful


def test_frames_may_have_a_prefix(robot: Any, node: Node, spin: Any) -> None:
    """Also later."""
    buffer = Buffer()
    TransformListener(buffer, node)
    robot.set_parameters([Parameter("frame_prefix", value="two/")])
    spin(lambda: buffer.can_transform("two/arm", "two/tip", Time()))


def test_without_a_description_there_is_no_node(importable: None, node: Node) -> None:
    """It says what is missing."""
    from robot_state_publisher.node import RobotStatePublisher
    from robot_state_publisher.urdf import URDFError

    with pytest.raises(URDFError, match="robot_description must not be empty"):
        RobotStatePublisher()

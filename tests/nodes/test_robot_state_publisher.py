"""Frames from a description and joint states, as ROS's robot_state_publisher sends them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from graphflow import Node, ParameterError, Time
from graphflow.msgs.sensor_msgs.msg import JointState
from graphflow.msgs.std_msgs.msg import Header, String
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.qos import LATCHED
from graphflow.testing import Graph
from graphflow.tf import Transforms
from nodes.robot_state_publisher import RobotStatePublisher

ROBOT = """<robot name="r">
 <link name="base"/><link name="arm"/><link name="tip"/><link name="finger"/>
 <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
 <joint name="fix" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/></joint>
 <joint name="grip" type="prismatic"><parent link="tip"/><child link="finger"/><limit lower="0" upper="9"/>
  <mimic joint="turn" multiplier="2" offset="0.5"/></joint>
</robot>"""


class Listener(Node):
    tf = Transforms()


def state(stamp: float, **positions: float) -> JointState:
    header = Header(stamp=Time(round(stamp * 1e9)))
    return JointState(header=header, name=list(positions), position=list(positions.values()))


async def test_links_are_where_the_joints_say(graph: Graph) -> None:
    """Those that mimic others, too; what is fixed is there without joint states."""
    listener, publisher = Listener(), RobotStatePublisher(robot_description=ROBOT)
    await graph.start(listener, publisher)
    await graph.settle()
    assert listener.tf.get("arm", "tip").translation == (1.0, 0.0, 0.0)
    joints = graph.publisher(JointState, "/joint_states")
    joints.publish(state(5, turn=math.pi / 2, wheel=3.0))  # one that the robot does not have
    await graph.settle()
    found = listener.tf.get("base", "finger")
    assert found.translation[:2] == pytest.approx((0.0, 1.0 + 2 * math.pi / 2 + 0.5))
    assert found.stamp == Time(5 * 10**9)


async def test_states_are_published_at_most_so_often(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """By their own times, or all of them if that is wished; malformed ones are left out."""
    publisher = RobotStatePublisher(robot_description=ROBOT, publish_frequency=0.5)
    await graph.start(publisher)
    sent = graph.tap(TFMessage, "/tf")
    joints = graph.publisher(JointState, "/joint_states")
    for second in (10, 11, 12, 13, 14):
        joints.publish(state(second, turn=1.0))
        await graph.settle()
    assert len(sent) == 3  # at 10, 12 and 14
    publisher.ignore_timestamp = True
    joints.publish(state(14, turn=1.0))
    await graph.settle()
    assert len(sent) == 4
    joints.publish(JointState(name=["turn"]))
    joints.publish(JointState(name=["turn"], position=[1.0, 2.0]))
    await graph.settle()
    assert len(sent) == 4
    assert "a JointState of turn is ignored: it has no positions" in caplog.text


async def test_the_description_is_published_and_can_be_changed(graph: Graph) -> None:
    """By its parameter; one that is none is refused. Frames may have a prefix."""
    publisher, listener = RobotStatePublisher(robot_description=ROBOT, frame_prefix="two/"), Listener()
    await graph.start(publisher, listener)
    heard = graph.tap(String, "/robot_description", LATCHED)
    await graph.settle()
    assert [message.data for message in heard] == [ROBOT]
    assert listener.tf.get("two/arm", "two/tip").translation == (1.0, 0.0, 0.0)
    with pytest.raises(ParameterError, match="the robot has no link"):
        publisher.robot_description = "<robot/>"
    one = '<robot><link name="base"/></robot>'
    publisher.robot_description = one
    await graph.settle()
    assert heard.latest.data == one
    publisher.frame_prefix = "three/"
    await graph.settle()
    assert len(heard) == 3


async def test_from_a_file(graph: Graph, tmp_path: Path) -> None:
    """By its path; without a description there is no node."""
    (tmp_path / "r.urdf").write_text(ROBOT)
    publisher = RobotStatePublisher(file=str(tmp_path / "r.urdf"))
    await graph.start(publisher)
    assert publisher.robot_description == ROBOT
    with pytest.raises(ParameterError, match="robot_description must not be empty; or name a file: -p file:=PATH"):
        await graph.start(RobotStatePublisher("other"))


async def test_time_that_jumps_back(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The joints are then published again."""
    publisher = RobotStatePublisher(robot_description=ROBOT)
    await graph.start(publisher)
    sent = graph.tap(TFMessage, "/tf")
    joints = graph.publisher(JointState, "/joint_states")
    joints.publish(state(100, turn=1.0))
    await graph.settle()
    publisher.heard += 10**18
    joints.publish(state(1, turn=1.0))
    await graph.settle()
    assert len(sent) == 2
    assert "the time has jumped back" in caplog.text


async def test_joints_of_another_name(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The first one is told, with the joints that there are; joints beside the robot's own are nothing."""
    await graph.start(RobotStatePublisher(robot_description=ROBOT))
    joints = graph.publisher(JointState, "/joint_states")
    for message in (state(1.0, turn=0.1, wheel=0.0), state(2.0, turn_joint=0.1), state(3.0, turn_joint=0.2)):
        joints.publish(message)
        await graph.settle()
    text = "joint_states has none of the robot's joints: it has no joint 'turn_joint'; there is fix, grip, turn"
    assert [told for told in caplog.messages if "joint_states" in told] == [text]


async def test_joints_that_are_not_sent(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The frames that wait are told, and then states without a stamp and positions beyond the limits."""
    await graph.start(RobotStatePublisher(robot_description=ROBOT))
    await graph.clock.advance(6.0)
    assert (
        "no joint_states yet, so nothing is sent for arm, finger: start for example joint_state_publisher"
        in caplog.text
    )
    joints = graph.publisher(JointState, "/joint_states")
    joints.publish(JointState(name=["turn"], position=[0.1]))
    joints.publish(state(1.0, grip=90.0))
    await graph.settle()
    assert "joint_states has no stamp, and is left out: set header.stamp" in caplog.text
    assert "grip is at 90, beyond 0 to 9 metres" in caplog.text

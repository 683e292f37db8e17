"""Positions of joints without a robot."""

from __future__ import annotations

import pytest

from graphflow.msgs.sensor_msgs.msg import JointState
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import LATCHED
from graphflow.testing import Graph
from nodes.joint_state_publisher import JointStatePublisher

ROBOT = """<robot name="r">
 <link name="base"/><link name="arm"/><link name="hand"/><link name="eye"/>
 <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><limit lower="-1" upper="1"/></joint>
 <joint name="grip" type="prismatic"><parent link="arm"/><child link="hand"/><limit lower="0.1" upper="0.3"/></joint>
 <joint name="look" type="continuous"><parent link="arm"/><child link="eye"/>
  <mimic joint="turn" multiplier="-1"/></joint>
</robot>"""


async def test_positions(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Each joint has its start, and takes what is set within its limits; joints that mimic others follow."""
    node = JointStatePublisher(zeros=["turn=0.5", "nose=1"], source_list=["sources"])
    await graph.start(node)
    states = graph.tap(JointState, "/joint_states")
    await graph.clock.advance(0.5)
    assert not states
    graph.publisher(String, "/robot_description", LATCHED).publish(String(data=ROBOT))
    await graph.clock.advance(0.2)
    assert dict(zip(states.latest.name, states.latest.position, strict=True)) == {
        "turn": 0.5,
        "grip": 0.2,
        "look": -0.5,
    }
    assert "zeros names joints that the robot does not have: nose" in caplog.text
    graph.publisher(JointState, "/joint_state_publisher/set").publish(
        JointState(name=["turn", "look", "nose"], position=[7.0, 1.0, 1.0])
    )
    graph.publisher(JointState, "/sources").publish(JointState(name=["grip"], position=[0.25]))
    await graph.clock.advance(0.2)
    assert list(states.latest.position) == [1.0, 0.25, -1.0]
    assert "a position of look is left out" in caplog.text


async def test_a_description_that_is_none(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is told, and nothing is published."""
    await graph.start(JointStatePublisher())
    states = graph.tap(JointState, "/joint_states")
    graph.publisher(String, "/robot_description", LATCHED).publish(String(data="<sdf/>"))
    await graph.clock.advance(0.5)
    assert "the root element is <sdf>, not <robot>" in caplog.text
    assert not states

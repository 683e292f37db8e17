"""Sliders of joints: what they show, and what they publish."""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher
from graphflow.msgs.sensor_msgs.msg import JointState
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import LATCHED
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from nodes.joint_state_publisher import JointStatePublisher
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

ROBOT = """<robot name="arm">
 <link name="base"/><link name="upper"/><link name="hand"/><link name="wheel"/>
 <joint name="elbow" type="revolute"><parent link="base"/><child link="upper"/><limit lower="-1" upper="1"/></joint>
 <joint name="grip" type="prismatic"><parent link="upper"/><child link="hand"/><limit lower="0" upper="0.2"/></joint>
 <joint name="roll" type="continuous"><parent link="base"/><child link="wheel"/></joint>
</robot>"""


class Described(Node):
    description = Publisher(String, "robot_description", LATCHED)

    async def on_start(self) -> None:
        self.description.publish(String(data=ROBOT))


class Wheel(Node):
    states = Publisher(JointState, "joint_states", 10)


@slow
async def test_sliders_publish(graph: Graph) -> None:
    """Without a publisher of positions, the view is one; keys choose a joint and move it within its limits."""
    await graph.start(Described())
    states = graph.tap(JointState, "/joint_states")
    async with stage(Content("joints"), graph=graph, size=(80, 20)) as s:
        await graph.settle()
        await s.until("▸ elbow")
        assert "unknown" in s.text
        await s.press("right")
        await graph.settle()
        await s.until("0.05 rad    3°")
        await s.press("down")
        await s.press("left")
        await s.until("▸ grip")
        await graph.settle()
        found = dict(zip(states.latest.name, states.latest.position, strict=True))
        assert found == pytest.approx({"elbow": 0.05, "grip": 0.0, "roll": 0.0})
        await s.press("0")
        await s.until("0.00 rad    0°")


@slow
async def test_positions_of_a_publisher(graph: Graph) -> None:
    """A joint_state_publisher takes what is set."""
    publisher = JointStatePublisher()
    await graph.start(Described(), publisher)
    await graph.clock.advance(0.3)
    async with stage(Content("joints"), graph=graph, size=(80, 20)) as s:
        await graph.clock.advance(0.3)
        await s.until("▸ elbow")
        await s.press("right")
        await graph.clock.advance(0.3)
        assert publisher.positions["elbow"] == pytest.approx(0.05)


@slow
async def test_a_robot_that_tells_its_own(graph: Graph) -> None:
    """Its positions are shown, and nothing is set against it."""
    wheel = Wheel()
    await graph.start(Described(), wheel)
    async with stage(Content("joints"), graph=graph, size=(100, 20)) as s:
        await graph.settle()
        await s.until("▸ elbow")
        wheel.states.publish(JointState(name=["roll", "other"], position=[6.5, 1.0]))
        await graph.settle()
        await s.until("0.22 rad   12°")
        await s.press("right")
        await s.until("/wheel publishes the positions; only a joint_state_publisher takes others")


async def test_a_description_that_is_none(graph: Graph) -> None:
    """Its mistake is shown."""
    node = Described()
    await graph.start(node)
    node.description.publish(String(data="<sdf/>"))
    async with stage(Content("joints"), graph=graph, size=(80, 20)) as s:
        await graph.settle()
        await s.until("the root element is <sdf>, not <robot>")

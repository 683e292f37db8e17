"""The positions of a robot's joints where nothing else gives them: for looking at a description without a robot.

It takes the description from the topic `robot_description`, and positions from topics in `source_list`, from the
parameter `zeros`, or from messages on `~/set`, such as those of the sliders of the console's view `joints`.
"""

from __future__ import annotations

import math

import graphflow
from graphflow import GraphFileError, Node, Param, Publisher, subscription
from graphflow.description import Robot, parse
from graphflow.msgs.sensor_msgs.msg import JointState
from graphflow.msgs.std_msgs.msg import Header, String
from graphflow.qos import LATCHED


class JointStatePublisher(Node):
    """Publish the position of every joint that moves by itself."""

    node_name = "joint_state_publisher"
    dynamic_names = True

    rate = Param(10, unit="Hz", ge=1, le=1000, read_only=True, doc="Of the messages.")
    source_list = Param([""], read_only=True, doc="Topics of joint states whose positions are taken over.")
    zeros = Param([""], read_only=True, doc="Positions to start with, such as ['arm=0.5', 'grip=0.02'].")
    joints = Publisher(JointState, "joint_states", 10)
    robot: Robot | None = None

    async def on_start(self) -> None:
        self.positions: dict[str, float] = {}
        for topic in filter(None, self.source_list):
            self.create_subscription(JointState, topic, self.take, 10)
        self.create_timer(1.0 / self.rate, self.publish)

    @subscription(String, "robot_description", LATCHED)
    async def described(self, text: String) -> None:
        try:
            self.robot = parse(text.data)
        except GraphFileError as error:
            self.log.error("%s", error)
            return
        start = dict(entry.split("=", 1) for entry in self.zeros if "=" in entry)
        unknown = sorted(start.keys() - self.robot.joints.keys())
        if unknown:
            self.log.warning("zeros names joints that the robot does not have: %s", ", ".join(unknown))
        for joint in self.robot.joints.values():
            if joint.moves and joint.mimic is None:
                self.positions.setdefault(joint.name, float(start.get(joint.name, joint.home)))

    @subscription(JointState, "~/set", 10)
    async def set(self, state: JointState) -> None:
        self.take(state)

    def take(self, state: JointState) -> None:
        """Take over the positions of joints that the robot has, within their limits."""
        for name, position in zip(state.name, state.position, strict=False):
            joint = None if self.robot is None else self.robot.joints.get(name)
            if joint is None or name not in self.positions or not math.isfinite(position):
                self.log.warning("a position of %s is left out", name, throttle=5.0)
                continue
            low, high = joint.limits or (-math.inf, math.inf)
            self.positions[name] = min(high, max(low, float(position)))

    def publish(self) -> None:
        """Publish all positions, those of joints that mimic others included."""
        if self.robot is None:
            return
        moved = self.robot.moved(self.positions)
        names, positions = [joint.name for joint, _ in moved], [position for _, position in moved]
        header = Header(stamp=self.clock.now())
        self.joints.publish(JointState(header=header, name=names, position=positions))


if __name__ == "__main__":
    graphflow.run(JointStatePublisher)

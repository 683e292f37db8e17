"""The frames of a robot's links, from its description and the positions of its joints.

    graphflow run robot_state_publisher robot_state_publisher my_robot.urdf.xacro
    graphflow run nodes/robot_state_publisher.py -p file:=my_robot.urdf -p frame_prefix:=left/

Parameters, topics and rules are those of ROS 2's package of that name.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable

import graphflow
from graphflow import GraphFileError, Node, Param, ParameterError, Publisher, Time, subscription, task
from graphflow.description import Joint, parse, read_robot
from graphflow.msgs.sensor_msgs.msg import JointState
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import LATCHED, SENSOR_DATA
from graphflow.tf import Transform, Transforms

PATIENCE = 5.0
"""Seconds for the first message on `joint_states`."""
SLACK = 0.1
"""Metres or radians by which a joint may be beyond its limits."""


class RobotStatePublisher(Node):
    """Publish the poses of moving links with each message on `joint_states`, and those of fixed ones once."""

    node_name = "robot_state_publisher"

    robot_description = Param("", doc="The robot in URDF.")
    file = Param("", read_only=True, doc="A URDF or xacro file in place of robot_description.")
    publish_frequency = Param(20.0, unit="Hz", ge=0.0, le=1000.0, doc="At most, of a joint; 0 for every state.")
    ignore_timestamp = Param(False, doc="Whether to publish every state, whatever its time.")
    frame_prefix = Param("", doc="What precedes the name of each frame, such as left/.")
    tf = Transforms(listen=False)
    description = Publisher(String, "robot_description", LATCHED)

    async def on_start(self) -> None:
        file = self.file or next((word for word in sys.argv[1:] if word.endswith((".urdf", ".xacro"))), "")
        if file and not self.robot_description:
            self.robot, self.robot_description = read_robot(file)
        elif not self.robot_description:
            raise ParameterError("the parameter robot_description must not be empty; or name a file: -p file:=PATH")
        else:
            self.robot = parse(self.robot_description)
        self.published: dict[str, int] = {}
        self.heard = 0
        self.has_warned = False
        for remark in self.robot.remarks:
            self.log.warning("%s", remark)
        self.begin()
        self.log.info("robot %s: %d links, %d joints", self.robot.name, len(self.robot.links), len(self.robot.joints))

    def begin(self) -> None:
        """Publish the description, and the poses of fixed links."""
        self.description.publish(String(data=self.robot_description))
        fixed = [(joint, 0.0) for joint in self.robot.joints.values() if not joint.moves]
        if fixed:
            self.tf.send_static(*self.transforms(fixed, self.clock.now()))

    def transforms(self, joints: Iterable[tuple[Joint, float]], stamp: Time) -> list[Transform]:
        """Return the transforms of joints at positions."""
        before = self.frame_prefix
        return [Transform(before + j.parent, before + j.child, j.pose(position), stamp) for j, position in joints]

    @task
    async def look_for_joints(self) -> None:
        """Tell after a while which frames are missing, since nobody publishes `joint_states`."""
        await self.clock.sleep(PATIENCE)
        moving = [joint.child for joint in self.robot.joints.values() if joint.moves]
        if moving and not self.published:
            text = "no joint_states yet, so nothing is sent for %s: start for example joint_state_publisher"
            self.log.warning(text, ", ".join(moving[:3]))

    @robot_description.check
    def is_a_description(self, text: str) -> None:
        try:
            if text:
                parse(text)
        except GraphFileError as error:
            raise ValueError(str(error)) from None

    @robot_description.on_change
    async def changed(self, old: str, new: str) -> None:
        if old and new:
            self.robot = parse(new)
            self.begin()

    @frame_prefix.on_change
    async def renamed(self, old: str, new: str) -> None:
        self.begin()

    @subscription(JointState, "joint_states", SENSOR_DATA)
    async def take(self, state: JointState) -> None:
        """Publish the poses of the moving links, unless that was done less than a period ago."""
        positions = dict(zip(state.name, map(float, state.position), strict=False))
        if len(state.position) != len(state.name):
            what = "it has no positions" if not len(state.position) else "it needs one position per name"
            self.log.warning("a JointState of %s is ignored: %s", ", ".join(state.name), what, throttle=5.0)
            return
        now, stamp = self.clock.now().nanoseconds, Time.from_msg(state.header.stamp)
        if now < self.heard:
            self.log.warning("the time has jumped back; the joints are published again")
            self.published.clear()
        self.heard = now
        own = [name for name in positions if name in self.robot.joints]
        if not own and positions and not self.has_warned:
            self.has_warned = True
            text = "joint_states has none of the robot's joints: it has no joint %s"
            self.log.warning(text, self.robot.unknown(next(iter(positions))))
        if not stamp.nanoseconds and not self.ignore_timestamp:
            self.log.warning("joint_states has no stamp, and is left out: set header.stamp", throttle=5.0)
            return
        for joint in (self.robot.joints[name] for name in own):
            low, high = joint.limits or (-math.inf, math.inf)
            if not low - SLACK <= positions[joint.name] <= high + SLACK:
                limits = f"{low:g} to {high:g} {'metres' if joint.kind == 'prismatic' else 'radians'}"
                self.log.warning("%s is at %g, beyond %s", joint.name, positions[joint.name], limits, throttle=5.0)
        least = min((self.published.get(name, 0) for name in own), default=now)
        period = 1e9 / self.publish_frequency if self.publish_frequency else 0.0
        if stamp.nanoseconds < least + period and not self.ignore_timestamp:
            return
        self.published.update(dict.fromkeys(own, stamp.nanoseconds))
        moved = self.robot.moved(positions)
        if moved:
            self.tf.send(*self.transforms(moved, stamp))


if __name__ == "__main__":
    graphflow.run(RobotStatePublisher)

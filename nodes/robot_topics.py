"""The topics of one simulated robot, as a TurtleBot3 has them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from graphflow import Node, Time, TopicPublisher, TopicSubscription
from graphflow.msgs.geometry_msgs.msg import Point, Quaternion, Twist, TwistStamped, Vector3
from graphflow.msgs.geometry_msgs.msg import Pose as PoseMessage
from graphflow.msgs.nav_msgs.msg import Odometry
from graphflow.msgs.sensor_msgs.msg import BatteryState, Imu, JointState, LaserScan
from graphflow.msgs.std_msgs.msg import Bool, Header, String
from graphflow.qos import LATCHED, SENSOR_DATA
from graphflow.tf import Transform, TransformBuffer

from .camera_topics import CameraTopics

if TYPE_CHECKING:  # it imports mujoco, which may not be there
    from graphflow.simulator import SimulatedRobot

JOINTS = ["wheel_left_joint", "wheel_right_joint"]
TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
STATE_HZ = 1.0
"""Messages a second of the battery and the bumper; the bumper's come with each change, too."""
COVARIANCE = [0.001, 0.001, 1e6, 1e6, 1e6, 0.03]
"""Variances of x, y, z, roll, pitch and yaw; what the wheels cannot know is large."""


class Due:
    """A rate by simulated time."""

    def __init__(self, hz: float) -> None:
        self._period, self._next = 1.0 / hz, 0.0

    def is_now(self, time: float) -> bool:
        """Whether a period has passed since it was due last."""
        if time + 1e-9 < self._next:
            return False
        self._next += self._period
        if self._next <= time:  # the time has jumped
            self._next = time + self._period
        return True

    def restart(self) -> None:
        """Begin again at time 0."""
        self._next = 0.0


class RobotTopics:
    """The topics and commands of a robot: below its name, or at the node's names if it has none."""

    def __init__(self, node: Node, tf: TransformBuffer, robot: SimulatedRobot, *, stamped: bool) -> None:
        self._node, self._tf, self.robot = node, tf, robot
        self._before = f"{robot.placed.name}/" if robot.placed.name else ""
        made, model = self._before, robot.robot
        self.odom = node.create_publisher(Odometry, f"{made}odom", 10)
        self.joints = node.create_publisher(JointState, f"{made}joint_states", 10)
        self.bumper = node.create_publisher(Bool, f"{made}bumper", 10)
        self.scan = node.create_publisher(LaserScan, f"{made}scan", SENSOR_DATA) if model.lidar else None
        self.imu = node.create_publisher(Imu, f"{made}imu", SENSOR_DATA) if model.imu else None
        self.battery = node.create_publisher(BatteryState, f"{made}battery_state", 10) if model.battery else None
        self.commands: list[TopicSubscription[Any]] = []
        self._takes: set[str] = set()
        self._take(TWIST_STAMPED if stamped else TWIST)
        self.dues = {
            "odom": Due(model.odom_rate),
            "scan": Due(model.lidar.rate if model.lidar else 1.0),
            "imu": Due(model.imu.rate if model.imu else 1.0),
            "camera": Due(model.camera.rate if model.camera else 1.0),
            "state": Due(STATE_HZ),
        }
        self._was_touching = False
        self._told: set[str] = set()
        self.camera = CameraTopics(node, robot, made) if model.camera else None
        self.description = node.create_publisher(String, f"{made}robot_description", LATCHED)
        self.description.publish(String(data=robot.description(made)))

    def _take(self, type_name: str) -> None:
        """Take commands of a type."""
        self._takes.add(type_name)
        topic = f"{self._before}cmd_vel"
        if type_name == TWIST:
            self.commands.append(self._node.create_subscription(Twist, topic, self.command, 10))
        else:
            self.commands.append(self._node.create_subscription(TwistStamped, topic, self.command_stamped, 10))

    def _take_others(self) -> None:
        """Take commands of the other type, too, once somebody sends them: programs for Jazzy stamp them."""
        found = self._node.context.cache.topics().get(self.commands[0].name, [])
        for type_name in {TWIST, TWIST_STAMPED}.intersection(found) - self._takes:
            self._take(type_name)

    def _warn_of_rivals(self) -> None:
        """Warn of several nodes that steer the robot."""
        nodes = [name for name in self._senders() if "/_" not in name]  # not commands, which people type
        if len(nodes) > 1:
            topic = self.commands[0].name
            self._once(f"{' and '.join(nodes)} all publish {topic}, and the robot obeys the latest: stop all but one")

    def _senders(self) -> list[str]:
        """Return the nodes that publish commands for it."""
        return sorted({sender.node_name for commands in self.commands for sender in commands.matched.values()})

    @property
    def title(self) -> str:
        """Its model, and its name if it has one: `burger`, `burger /second`."""
        name = self.robot.placed.name
        return f"{self.robot.robot.name} /{name}" if name else self.robot.robot.name

    def restart(self) -> None:
        """Begin again at time 0."""
        for due in self.dues.values():
            due.restart()

    def close(self) -> None:
        """Withdraw the topics."""
        for commands in self.commands:
            commands.close()
        if self.camera is not None:
            self.camera.close()
        publishers: list[TopicPublisher[Any] | None] = [self.odom, self.joints, self.bumper, self.scan, self.imu]
        for publisher in (*publishers, self.battery, self.description):
            if publisher is not None:
                publisher.close()

    def frame(self, name: str) -> str:
        """Return the full name of one of its frames."""
        return self._before + name

    def command(self, twist: Twist) -> None:
        """Take a velocity."""
        self._explain(twist)
        try:
            self.robot.command(twist.linear.x, twist.angular.z)
        except ValueError as error:
            topic, senders = f"{self._before}cmd_vel", " or ".join(self._senders()) or "a node that has gone"
            text = "%s: %s, and is left out; %s sends it: look for a division by 0, and for ranges that are inf or nan"
            self._node.log.warning(text, topic, error, senders, throttle=2.0)

    def _explain(self, twist: Twist) -> None:
        """Say, once each, which part of a command has no effect."""
        model, topic = self.robot.robot, f"{self._before}cmd_vel"
        ignored = {"linear.y": twist.linear.y, "linear.z": twist.linear.z}
        ignored |= {"angular.x": twist.angular.x, "angular.y": twist.angular.y}
        for field, value in ignored.items():
            if value:
                self._once(f"{topic}: {field} is ignored: a {model.name} drives by linear.x and turns by angular.z")
        most, turn = model.max_linear, model.max_angular
        if math.isfinite(twist.linear.x) and abs(twist.linear.x) > 1.5 * most:
            self._once(f"{topic} asks for more than a {model.name} can: it drives at most {most:g} m/s")
        if math.isfinite(twist.angular.z) and abs(twist.angular.z) > 1.5 * turn:
            self._once(f"{topic} asks for more than a {model.name} can: it turns at most by {turn:g} rad/s")

    def _once(self, text: str) -> None:
        if text not in self._told:
            self._told.add(text)
            self._node.log.warning("%s", text)

    def command_stamped(self, message: TwistStamped) -> None:
        """Take a velocity with a header."""
        self.command(message.twist)

    def send_fixed_frames(self) -> None:
        """Send the places of its sensors, which never change."""
        model = self.robot.robot
        base, height = self.frame(model.base_frame), model.base_height
        fixed = [Transform.of(self.frame(model.footprint_frame), base, (0.0, 0.0, height))]
        for sensor in (model.lidar, model.imu):
            if sensor is not None:
                x, y, z = sensor.at
                fixed.append(Transform.of(base, self.frame(sensor.frame), (x, y, z - height)))
        if self.camera is not None:
            fixed += self.camera.frames(base, height)
        self._tf.send_static(*fixed)

    def publish(self, time: float) -> None:
        """Publish what is due at a time in seconds."""
        if self.robot.has_timed_out:
            timeout = self.robot.robot.command_timeout
            self._once(f"no {self._before}cmd_vel for {timeout:g} s: it stops; publish again and again, from a timer")
        stamp, dues = Time(round(time * 1e9)), self.dues
        if self.imu is not None and dues["imu"].is_now(time):
            self._publish_imu(stamp)
        if self.scan is not None and dues["scan"].is_now(time):
            self._publish_scan(stamp)
        if dues["odom"].is_now(time):
            self._publish_odom(stamp)
        if self.camera is not None and dues["camera"].is_now(time):
            self.camera.publish(stamp)
        is_due = dues["state"].is_now(time)
        if is_due or self.robot.is_touching is not self._was_touching:
            self._was_touching = self.robot.is_touching
            self.bumper.publish(Bool(data=self._was_touching))
        if is_due:
            self._publish_battery(stamp)
            self._take_others()
            self._warn_of_rivals()

    def _publish_odom(self, stamp: Time) -> None:
        odometry, model = self.robot.odometry, self.robot.robot
        turn = Quaternion(z=math.sin(odometry.yaw / 2), w=math.cos(odometry.yaw / 2))
        frame, child = self.frame("odom"), self.frame(model.footprint_frame)
        message = Odometry(header=Header(stamp=stamp, frame_id=frame), child_frame_id=child)
        message.pose.pose = PoseMessage(position=Point(x=odometry.x, y=odometry.y), orientation=turn)
        message.pose.covariance = message.twist.covariance = np.diag(COVARIANCE).ravel()
        message.twist.twist = Twist(linear=Vector3(x=odometry.linear), angular=Vector3(z=odometry.angular))
        self.odom.publish(message)
        rotation = (0.0, 0.0, turn.z, turn.w)
        moving = [Transform.of(frame, child, (odometry.x, odometry.y, 0.0), rotation=rotation, stamp=stamp)]
        angles, wheels = self.robot.wheel_angles, model.wheels
        base = self.frame(model.base_frame)
        half = wheels.separation / 2
        for name, angle, y in (("left", angles[0], half), ("right", angles[1], -half)):
            # The wheel's frame has its axle along z, as in the TurtleBot3's description.
            place, rpy = (0.0, y, wheels.radius - model.base_height), (-math.pi / 2, angle, 0.0)
            moving.append(Transform.of(base, self.frame(f"wheel_{name}_link"), place, rpy=rpy, stamp=stamp))
        self._tf.send(*moving)
        self.joints.publish(JointState(header=Header(stamp=stamp), name=JOINTS, position=list(angles)))

    def _publish_scan(self, stamp: Time) -> None:
        lidar = self.robot.robot.lidar
        assert self.scan is not None
        assert lidar is not None
        if not self.scan.get_subscription_count():
            return  # nobody sees it, and the rays cost more than all else
        self.scan.publish(
            LaserScan(
                header=Header(stamp=stamp, frame_id=self.frame(lidar.frame)),
                angle_min=lidar.angle_min,
                angle_max=lidar.angle_max,
                angle_increment=(lidar.angle_max - lidar.angle_min) / lidar.beams,
                scan_time=1.0 / lidar.rate,
                range_min=lidar.range_min,
                range_max=lidar.range_max,
                ranges=self.robot.scan(),
            )
        )

    def _publish_imu(self, stamp: Time) -> None:
        sensor = self.robot.robot.imu
        assert self.imu is not None
        assert sensor is not None
        if not self.imu.get_subscription_count():
            return
        read = self.robot.imu()
        x, y, z, w = read.orientation
        message = Imu(header=Header(stamp=stamp, frame_id=self.frame(sensor.frame)))
        message.orientation = Quaternion(x=x, y=y, z=z, w=w)
        message.angular_velocity = Vector3(**dict(zip("xyz", map(float, read.gyro), strict=True)))
        message.linear_acceleration = Vector3(**dict(zip("xyz", map(float, read.accelerometer), strict=True)))
        self.imu.publish(message)

    def _publish_battery(self, stamp: Time) -> None:
        charge = self.robot.charge
        if self.battery is not None and charge is not None:
            state = BatteryState(header=Header(stamp=stamp), present=True)
            state.voltage, state.current, state.percentage = charge.voltage, -charge.current, charge.share
            state.capacity = state.design_capacity = charge.battery.capacity
            state.charge = charge.share * charge.battery.capacity
            self.battery.publish(state)

"""A robot from above: its map, its scan, its trail and its way; keys drive it, and send it to places."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from textual.app import ComposeResult
from textual.widgets import Static

from graphflow.errors import TransformError
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.views.robot.layers import Layers
from graphflow.tui.views.robot.topics import next_of, topics_of
from graphflow.tui.widgets.map_canvas import MapCanvas, RobotDrawing
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.msgs.sensor_msgs.msg import LaserScan
    from graphflow.tf import Transform, TransformBuffer

SCAN = "sensor_msgs/msg/LaserScan"
FIXED = ("map", "odom", "world")
"""Frames that count as fixed, the best first."""
LINEAR, ANGULAR = 0.15, 0.8
"""Velocities of one press of an arrow key, in m/s and rad/s; robots stop by themselves soon after."""
KEPT = 10.0
"""Seconds for which transforms are kept."""
BACK = 1.0
"""Seconds by which a scan's time jumps back when a simulation begins again."""
ZOOM = 1.25
GOAL, ESTIMATE = "goal_pose", "initialpose"
"""The topics of rviz's tools "2D Goal Pose" and "2D Pose Estimate"."""


class RobotMap(View):
    """A robot in a fixed frame: its map or the obstacles seen so far, its scan, its trail, its path and its goal.

    The arrow keys drive, or move the cursor while a place is chosen: `g` and Enter, or a click, send the robot there.
    """

    NAME = "map"
    DOC = "a robot from above: map, scan, trail, path; arrow keys drive, g sets a goal"
    EVERY = 0.2
    LEAST_HEIGHT = 14
    ACTIONS = (
        Action("forward", "drive", keys=("up",), hint=True, label="↑↓←→ drive"),
        Action("backward", "drive backwards", keys=("down",)),
        Action("left", "turn left", keys=("left",)),
        Action("right", "turn right", keys=("right",)),
        Action("stop", "stop", keys=("space",), hint=True),
        Action("closer", "zoom in", keys=("plus", "equals_sign"), hint=True, label="+- zoom"),
        Action("farther", "zoom out", keys=("minus",)),
        Action("follow", "follow the robot, or stay", keys=("f",), hint=True, label="f follow"),
        Action("goal", "set a goal", keys=("g",), hint=True),
        Action("estimate", "say where the robot is", keys=("e",)),
        Action("accept", "take the place of the cursor", keys=("enter",)),
        Action("give_up", "choose no place", keys=("escape",)),
        Action("next_robot", "next robot", keys=("n",), hint=True),
        Action("clear", "clear", keys=("C",), hint=True),
    )

    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._topic = self.about
        self._monitor: TopicMonitor | None = None
        self._tf: TransformBuffer | None = None
        self._drawing = RobotDrawing()
        self._canvas = MapCanvas(self._drawing)
        self._latest = 0.0
        self._frame = ""
        self._trouble = ""
        self._choosing = ""
        """The topic for which a place is being chosen; "" if none is."""
        self._layers: Layers | None = None
        self._empty = Static("waiting for a robot: no node publishes a laser scan yet", classes="hint")

    def compose(self) -> ComposeResult:
        yield self._canvas
        yield self._empty

    @property
    def title(self) -> str:
        return f"map {self._topic}" if self._topic else "map"

    @property
    def note(self) -> str:
        if self._choosing:
            return "goal: arrows, Enter, or a click" if self._choosing == GOAL else "the robot's place: arrows, Enter"
        if self._trouble or self._drawing.pose is None:
            return self._trouble
        x, y, yaw = self._drawing.pose
        return f"x {x:.2f}  y {y:.2f}  {round(math.degrees(yaw)):4d}°  in {self._frame}"

    def look(self, now: float) -> None:
        topics = self._scans()
        if self._topic not in topics and topics and not self.about:
            self._watch(topics[0])
        elif self._monitor is None and self._topic in topics:
            self._watch(self._topic)
        if self._monitor is not None:
            self._monitor.look()
        if self._layers is not None and self._frame:
            self._layers.look(self._frame)
        is_there = self._monitor is not None and self._monitor.count > 0
        self._canvas.display, self._empty.display = is_there, not is_there
        if is_there:
            self._canvas.redraw()

    def _scans(self) -> list[str]:
        return topics_of(self.hub.live, SCAN)

    def _watch(self, topic: str) -> None:
        live = self.hub.live
        assert live is not None
        self.closed()
        self._topic, self._monitor = topic, TopicMonitor(live, topic)
        self._monitor.on_message = self._scanned
        self._begin()

    def _begin(self) -> None:
        """Listen to transforms anew."""
        from graphflow.runtime.node_core import core_of
        from graphflow.tf import TransformBuffer
        from graphflow.times import to_ns

        live = self.hub.live
        assert live is not None
        assert live.node is not None
        if self._tf is not None:
            self._tf.close()
        self._tf = TransformBuffer(live.node, core_of(live.node), to_ns(KEPT), listen=True)
        self._drawing.clear()
        if self._layers is not None:
            self._layers.close()
        self._layers = Layers(live, self._drawing, self._tf, self._topic.rpartition("/")[0])
        self._latest = 0.0

    def _scanned(self, scan: LaserScan, _: float) -> None:
        from graphflow.tf import Transform
        from graphflow.tf.messages import scan_points

        time = scan.header.stamp.sec + scan.header.stamp.nanosec / 1e9
        if time < self._latest - BACK:
            self._begin()
        self._latest = time
        try:
            found = self._lookup(scan)
        except TransformError as error:
            # Without transforms, the scanner itself is the middle of everything.
            self._trouble, self._frame = str(error), scan.header.frame_id
            found = Transform.of(self._frame, self._frame)
        else:
            self._trouble = ""
        x, y, _ = found.translation
        self._drawing.moved(x, y, found.yaw)
        self._drawing.scanned([(float(px), float(py)) for px, py, _ in found.points(scan_points(scan))])

    def _lookup(self, scan: LaserScan) -> Transform:
        """Return the scanner's pose in the fixed frame, at the scan's time, or as it is known."""
        assert self._tf is not None
        frame = scan.header.frame_id
        self._frame = next((name for name in FIXED if self._reaches(name, frame)), "odom")
        try:
            return self._tf.get(self._frame, frame, scan.header.stamp)
        except TransformError:
            return self._tf.get(self._frame, frame)

    def _reaches(self, fixed: str, frame: str) -> bool:
        """Whether a frame is in the tree of a fixed one; frames of one robot of several are below its name."""
        assert self._tf is not None
        before = frame.rpartition("/")[0]
        try:
            self._tf.chain(fixed if not before else f"{before}/{fixed}", frame)
        except TransformError:
            return False
        return True

    def closed(self) -> None:
        if self._monitor is not None:
            self._monitor.close()
            self._monitor = None
        if self._layers is not None:
            self._layers.close()
            self._layers = None
        if self._tf is not None:
            self._tf.close()
            self._tf = None

    # choosing a place

    def _choose(self, topic: str) -> None:
        if self._drawing.pose is None:
            self.say("there is no robot yet", bad=True)
            return
        self._choosing, self._drawing.cursor = topic, self._drawing.cursor or self._drawing.pose[:2]
        self._canvas.redraw()

    def _step(self, dx: int, dy: int) -> None:
        """Move the cursor by cells of the screen."""
        x, y = self._drawing.cursor or (0.0, 0.0)
        step = self._drawing.radius / 15
        self._drawing.cursor = x + dx * step, y + dy * step
        self._canvas.redraw()

    def on_map_canvas_chosen(self, event: MapCanvas.Chosen) -> None:
        """Take a place that was clicked, as a goal unless something else is being chosen."""
        if self._choosing:
            self._drawing.cursor = event.x, event.y
            self.do_accept()

    def do_goal(self) -> None:
        self._choose(GOAL)

    def do_estimate(self) -> None:
        self._choose(ESTIMATE)

    def do_give_up(self) -> None:
        self._choosing, self._drawing.cursor = "", None
        self._canvas.redraw()

    def do_accept(self) -> None:
        """Send the place of the cursor; the heading is that of the way there."""
        live, cursor, pose = self.hub.live, self._drawing.cursor, self._drawing.pose
        if live is None or live.node is None or not self._choosing or cursor is None or pose is None:
            return
        from graphflow.msgs.geometry_msgs.msg import Point, Pose, PoseStamped, PoseWithCovarianceStamped, Quaternion
        from graphflow.msgs.std_msgs.msg import Header

        is_goal = self._choosing == GOAL
        yaw = math.atan2(cursor[1] - pose[1], cursor[0] - pose[0]) if is_goal else pose[2]
        topic = f"{self._topic.rpartition('/')[0]}/{self._choosing}"
        header = Header(frame_id=self._frame, stamp=live.node.clock.now())
        turn = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
        place = Pose(position=Point(x=cursor[0], y=cursor[1]), orientation=turn)
        if is_goal:
            live.publisher(PoseStamped, topic).publish(PoseStamped(header=header, pose=place))
            self._drawing.goal = cursor
        else:
            estimate = PoseWithCovarianceStamped(header=header)
            estimate.pose.pose = place
            live.publisher(PoseWithCovarianceStamped, topic).publish(estimate)
        self.do_give_up()
        kind = "PoseStamped" if is_goal else "PoseWithCovarianceStamped"
        values = f"{{position: {{x: {cursor[0]:.2f}, y: {cursor[1]:.2f}}}}}"
        values = f"{{header: {{frame_id: {self._frame}}}, pose: {values if is_goal else f'{{pose: {values}}}'}}}"
        self.did(f"graphflow topic pub --once {topic} geometry_msgs/msg/{kind} '{values}'")
        if not live.cache.endpoints(Kind.SUBSCRIPTION, topic):
            way = f"; graphflow run goal_driver -p frame:={self._frame}" if is_goal else ""
            self.say(f"no node subscribes to {topic}{way}", bad=True)

    # driving

    def _drive(self, linear: float, angular: float) -> None:
        live = self.hub.live
        if live is None or live.node is None or not self._topic:
            return
        from graphflow.msgs import registry
        from graphflow.msgs.geometry_msgs.msg import Twist, Vector3

        topic = f"{self._topic.rpartition('/')[0]}/cmd_vel"
        types = live.cache.topics().get(topic, [])
        twist = Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))
        type_name = "geometry_msgs/msg/TwistStamped" if "geometry_msgs/msg/TwistStamped" in types else Twist.SCHEMA.name
        type_: Any = registry.interface_class(type_name)
        live.publisher(type_, topic).publish(twist if type_ is Twist else type_(twist=twist))
        values = f"{{linear: {{x: {linear}}}, angular: {{z: {angular}}}}}"
        self.did(f"graphflow topic pub --once {topic} {type_name} '{values}'")

    def _arrow(self, velocity: tuple[float, float], step: tuple[int, int]) -> None:
        """Drive, or move the cursor while a place is chosen."""
        if self._choosing:
            self._step(*step)
        else:
            self._drive(*velocity)

    def do_forward(self) -> None:
        self._arrow((LINEAR, 0.0), (0, 1))

    def do_backward(self) -> None:
        self._arrow((-LINEAR, 0.0), (0, -1))

    def do_left(self) -> None:
        self._arrow((0.0, ANGULAR), (-1, 0))

    def do_right(self) -> None:
        self._arrow((0.0, -ANGULAR), (1, 0))

    def do_stop(self) -> None:
        self._drive(0.0, 0.0)

    def do_closer(self) -> None:
        self._drawing.zoom(1 / ZOOM)

    def do_farther(self) -> None:
        self._drawing.zoom(ZOOM)

    def do_follow(self) -> None:
        self._drawing.follows = not self._drawing.follows
        self.say("follows the robot" if self._drawing.follows else "stays where it is")

    def do_next_robot(self) -> None:
        topics = self._scans()
        if topics:
            self._watch(next_of(topics, self._topic))

    def do_clear(self) -> None:
        self._drawing.clear()


VIEW = RobotMap

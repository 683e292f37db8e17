"""The turtle simulator of ROS 2's tutorials: a node whose topics and services come and go.

A node that knows its topics and services in advance declares them on its class. This one cannot: each turtle has its
own topics and services, which are created when it hatches, with the `create_*` methods that declarations use, too, and
closed when it is killed. The turtles' behaviour is in `turtle_world.py`, which does not depend on nodes.

There is no window. With `-p view:=true` a page in your browser shows the turtles live; its address is logged. Or
request a picture at any time, an SVG file in the response's `message`:

    graphflow snapshot

Source: turtlesim 1.8.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from typing import Any

import graphflow
from graphflow import Abort, InvalidName, Node, Param, service, timer
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.msgs.turtlesim.action import RotateAbsolute
from graphflow.msgs.turtlesim.msg import Color, Pose
from graphflow.msgs.turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

from .turtle_canvas import Colour, Pen
from .turtle_picture import svg
from .turtle_view import TurtleView
from .turtle_world import SIZE, TICK, NameTaken, Turtle, World, in_degrees, normalize

TURNING_SPEED = 1.0
"""Turning speed of `rotate_absolute`, in rad/s."""
PATIENCE = 2.0
"""Seconds for the loop to draw a picture for the view."""
CLOSE_ENOUGH = 0.02
"""Radians from the goal at which `rotate_absolute` ends."""


class TurtleSim(Node):
    """Turtles that follow `<turtle>/cmd_vel` and draw lines."""

    node_name = "turtlesim"
    dynamic_names = (
        "*/turtle1/cmd_vel",
        "*/turtle1/pose",
        "*/?*/cmd_vel",
        "*/?*/pose",
        "*/?*/color_sensor",
        "*/?*/set_pen",
        "*/?*/teleport_absolute",
        "*/?*/teleport_relative",
        "*/?*/rotate_absolute",
    )

    background_r = Param(69, ge=0, le=255, doc="Red part of the background colour.")
    background_g = Param(86, ge=0, le=255, doc="Green part of the background colour.")
    background_b = Param(255, ge=0, le=255, doc="Blue part of the background colour.")
    holonomic = Param(False, doc="Whether turtles also move sideways, as linear.y says.")
    view = Param(False, read_only=True, doc="Whether a page shows the turtles in a browser on this machine.")
    view_port = Param(0, ge=0, le=65535, read_only=True, doc="The page's port; 0 takes a free one.")

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.world = World()
        self.reins: dict[str, Reins] = {}
        self.explained: set[str] = set()
        self.hatch_first()

    async def on_start(self) -> None:
        self.log.info("Starting turtlesim with node name %s", self.full_name)
        for turtle in self.world.turtles.values():
            self.announce(turtle)
        if self.view:
            await self.enter(self.shown())

    @asynccontextmanager
    async def shown(self) -> AsyncGenerator[None, None]:
        """Serve the page that shows the turtles."""
        loop = asyncio.get_running_loop()

        async def picture() -> str:
            return svg(self.world, self.background)

        def drive(linear: float, angular: float) -> None:
            loop.call_soon_threadsafe(self.drive_first, linear, angular)

        try:
            page = TurtleView(
                self.view_port, lambda: asyncio.run_coroutine_threadsafe(picture(), loop).result(PATIENCE), drive
            )
        except OSError as error:
            raise graphflow.GraphflowError(f"port {self.view_port} of the view: {error.strerror}") from None
        self.log.info("Watch the turtles, and steer with the arrow keys: %s", page.url)
        try:
            yield
        finally:
            await asyncio.to_thread(page.close)

    def drive_first(self, linear: float, angular: float) -> None:
        """Steer turtle1, or the oldest turtle."""
        for reins in list(self.reins.values())[:1]:
            reins.command(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))

    @property
    def background(self) -> Colour:
        return self.background_r, self.background_g, self.background_b

    @timer(TICK)
    async def update(self) -> None:
        now_ns = self.clock.monotonic_ns()
        for reins in self.reins.values():
            reins.rotate()
            beyond = self.world.step(reins.turtle, now_ns)
            if beyond is not None:
                self.log.warning("Oh no! I hit the wall! (Clamping from [x=%f, y=%f])", *beyond)
            reins.publish()

    @service(Spawn, "spawn")
    async def spawn_turtle(self, request: Spawn.Request) -> Spawn.Response:
        name = request.name or self.world.free_name()
        self.explain_radians("theta", request.theta)
        try:
            turtle = self.hatch(name, request.x, request.y, request.theta)
        except NameTaken:
            self.log.error("A turtle named [%s] already exists", name)
        except InvalidName as error:
            self.log.error("A turtle cannot be named [%s]: %s", name, error)
        else:
            self.announce(turtle)
            return Spawn.Response(name=name)
        return Spawn.Response()

    @service(Kill, "kill")
    async def kill_turtle(self, request: Kill.Request) -> None:
        if request.name in self.reins:
            self.remove(request.name)
        else:
            self.log.error("Tried to kill turtle [%s], which does not exist", request.name)

    @service(Empty, "clear")
    async def clear_drawing(self, _: Empty.Request) -> None:
        self.log.info("Clearing turtlesim.")
        self.world.clear()

    @service(Empty, "reset")
    async def begin_again(self, _: Empty.Request) -> None:
        self.log.info("Resetting turtlesim.")
        for name in list(self.reins):
            self.remove(name)
        self.world = World()
        self.announce(self.hatch_first())

    @service(Trigger, "~/snapshot")
    async def snapshot(self, _: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True, message=svg(self.world, self.background))

    def hatch(self, name: str, x: float, y: float, theta: float) -> Turtle:
        """Add a turtle with its topics and services.

        Raises:
            NameTaken: There is already one of that name.
            InvalidName: The name is not legal in a topic.
            ValueError: A coordinate is not legal.
        """
        turtle = self.world.spawn(name, x, y, theta)
        try:
            self.reins[name] = Reins(self, turtle)
        except InvalidName:
            self.world.kill(name)
            raise
        return turtle

    def hatch_first(self) -> Turtle:
        """Put turtle1 in the middle."""
        return self.hatch(self.world.free_name(), SIZE / 2, SIZE / 2, 0.0)

    def announce(self, turtle: Turtle) -> None:
        self.log.info("Spawning turtle [%s] at x=[%f], y=[%f], theta=[%f]", turtle.name, *turtle.position, turtle.theta)

    def explain_radians(self, field: str, angle: float, before: float = 0.0) -> None:
        """Warn, once, of an angle that seems to be in degrees, which is obeyed all the same."""
        if field not in self.explained and in_degrees(angle, before):
            self.explained.add(field)
            self.log.warning("%s is in radians; %g degrees are %.4g", field, angle, math.radians(angle))

    def remove(self, name: str) -> None:
        """Remove a turtle with its topics and services."""
        self.reins.pop(name).close()
        self.world.kill(name)


class Rotation:
    """A goal of `rotate_absolute` in progress: its start, and the future of its end."""

    def __init__(self, goal: RotateAbsolute.Handle, start: float) -> None:
        self.goal, self.start = goal, start
        self.ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()


class Reins:
    """The topics, services and action of one turtle, with relative names: namespace and remaps apply."""

    rotation: Rotation | None = None

    def __init__(self, node: TurtleSim, turtle: Turtle) -> None:
        self.node, self.turtle = node, turtle
        self.told_theta = turtle.theta
        """The last heading that a client gave."""
        name = turtle.name
        self.endpoints = (
            # The longest name first: if it is legal, so are the others.
            node.create_service(TeleportAbsolute, f"{name}/teleport_absolute", self.teleport_absolute),
            node.create_service(TeleportRelative, f"{name}/teleport_relative", self.teleport_relative),
            node.create_service(SetPen, f"{name}/set_pen", self.set_pen),
            node.create_action_server(
                RotateAbsolute, f"{name}/rotate_absolute", self.rotate_absolute, policy="preempt"
            ),
            node.create_subscription(Twist, f"{name}/cmd_vel", self.command, 7),
            pose := node.create_publisher(Pose, f"{name}/pose", 7),
            color := node.create_publisher(Color, f"{name}/color_sensor", 7),
        )
        self.pose, self.color = pose, color

    def close(self) -> None:
        """Close the topics, services and action."""
        for endpoint in self.endpoints:
            endpoint.close()

    def publish(self) -> None:
        """Publish the turtle's pose and the colour under it."""
        t = self.turtle
        self.pose.publish(Pose(x=t.x, y=t.y, theta=t.theta, linear_velocity=t.speed, angular_velocity=t.turning))
        r, g, b = self.node.world.canvas.colour_at(t.position) or self.node.background
        self.color.publish(Color(r=r, g=g, b=b))

    async def rotate_absolute(self, goal: RotateAbsolute.Handle) -> RotateAbsolute.Result:
        self.heading_given(goal.request.theta)
        rotation = self.rotation = Rotation(goal, self.turtle.theta)
        try:
            await rotation.ended
        except asyncio.CancelledError:
            if goal.is_preempted:
                log = "Rotation goal received before a previous goal finished. Aborting previous goal"
                self.node.log.warning(log)
            else:
                self.node.log.info("Rotation goal canceled")
            self.stand_still()
            raise
        finally:
            self.rotation = None
        self.stand_still()
        self.node.log.info("Rotation goal completed successfully")
        return goal.partial

    def heading_given(self, theta: float) -> None:
        """Note a heading that a client gives."""
        self.node.explain_radians("theta", theta, self.told_theta)
        self.told_theta = theta

    def stand_still(self) -> None:
        """End the current command, if any."""
        self.turtle.command(0.0, 0.0, 0.0, self.node.clock.monotonic_ns())

    def rotate(self) -> None:
        """Turn towards the goal, if there is one, and check whether it is reached."""
        if self.rotation is None or self.rotation.ended.done():
            return
        goal, turtle = self.rotation.goal, self.turtle
        remaining = normalize(goal.request.theta - turtle.theta)
        # The angle back to the start, as in turtlesim: negative after a turn to the left.
        goal.partial = RotateAbsolute.Result(delta=normalize(self.rotation.start - turtle.theta))
        goal.feedback(RotateAbsolute.Feedback(remaining=remaining))
        if abs(remaining) < CLOSE_ENOUGH:
            self.rotation.ended.set_result(None)
        else:
            turning = -TURNING_SPEED if remaining < 0 else TURNING_SPEED
            turtle.command(0.0, 0.0, turning, self.node.clock.monotonic_ns())

    def command(self, twist: Twist) -> None:
        self.explain_ignored(twist)
        if self.rotation is not None and not self.rotation.ended.done():
            self.node.log.warning("Velocity command received during rotation goal. Aborting goal")
            self.rotation.ended.set_exception(Abort())
        sideways = twist.linear.y if self.node.holonomic else 0.0
        self.turtle.command(twist.linear.x, sideways, twist.angular.z, self.node.clock.monotonic_ns())

    def explain_ignored(self, twist: Twist) -> None:
        """Warn, once each, of parts of a command that have no effect."""
        parts = {"linear.z": twist.linear.z, "angular.x": twist.angular.x, "angular.y": twist.angular.y}
        parts |= {} if self.node.holonomic else {"linear.y": twist.linear.y}
        for field, value in parts.items():
            if value and field not in self.node.explained:
                self.node.explained.add(field)
                self.node.log.warning("%s is ignored: a turtle drives by linear.x and turns by angular.z", field)

    def set_pen(self, request: SetPen.Request) -> None:
        colour = (request.r, request.g, request.b)
        self.turtle.pen = None if request.off else Pen(colour, request.width or 1)

    def teleport_absolute(self, request: TeleportAbsolute.Request) -> None:
        self.heading_given(request.theta)
        self.node.world.teleport(self.turtle, request.x, request.y, request.theta)

    def teleport_relative(self, request: TeleportRelative.Request) -> None:
        self.node.explain_radians("angular", request.angular)
        self.node.world.jump(self.turtle, request.linear, request.angular)


if __name__ == "__main__":
    graphflow.run(TurtleSim)

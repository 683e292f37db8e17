"""Turtlesim's window in the terminal, with its keys."""

from __future__ import annotations

import math
import time
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from textual.app import ComposeResult
from textual.widgets import Static

from graphflow.errors import GraphflowError
from graphflow.names import is_hidden
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.canvas import WORLD, Drawing, TurtleCanvas, read_picture

if TYPE_CHECKING:
    from graphflow.introspect.graph_view import View as Graph

# Modules of messages are imported once there is a graph: this view is in the first window to be drawn.

POSES = ("turtlesim/msg/Pose", "turtlesim_msgs/msg/Pose")
SPAWN = ("turtlesim/srv/Spawn", "turtlesim_msgs/srv/Spawn")
TURTLES = 50
"""Maximum turtles followed."""
PICTURE_EVERY = 3.0
"""Seconds between two pictures, which also show the effects of clear, set_pen and teleports."""
PICTURE_SHARE = 0.01
"""Maximum share of time spent on pictures."""
JUMP = 1.0
"""Metres between two poses beyond which the turtle was teleported."""
LINEAR, ANGULAR = 2.0, 2.0
"""Velocities of one press of an arrow key, in m/s and rad/s, as in teleop."""
TURNS = {"g": 0, "t": 45, "r": 90, "e": 135, "d": 180, "c": -135, "v": -90, "b": -45}
"""Teleop's keys and their headings in degrees, as the keys are arranged around the f."""
TURN_LABEL = f"{''.join(TURNS)} turn"


class Pose(Protocol):
    """A pose from turtlesim, whose package depends on the ROS distribution."""

    x: float
    y: float
    theta: float


class Turtles(View):
    """The turtles of a turtlesim, live."""

    NAME = "turtle"
    DOC = "turtlesim live: trails, and arrow keys that drive"
    EVERY = 0.05
    LEAST_HEIGHT = 14
    ACTIONS = (
        Action("forward", "drive", keys=("up",), hint=True, label="↑↓←→ drive"),
        Action("backward", "drive backwards", keys=("down",)),
        Action("left", "turn left", keys=("left",)),
        Action("right", "turn right", keys=("right",)),
        *(
            Action(f"turn:{degrees}", f"turn to {degrees}°", keys=(key,), hint=not degrees, label=TURN_LABEL)
            for key, degrees in TURNS.items()
        ),
        Action("stop_turning", "stop turning", keys=("f",)),
        Action("add", "add a turtle", keys=("a",), verb="graphflow service call /spawn", hint=True),
        Action("next_turtle", "next turtle", keys=("n",), hint=True),
        Action("clear", "clear", keys=("C",), verb="graphflow service call /clear", hint=True),
    )

    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._monitors: dict[str, TopicMonitor] = {}
        self._drawing = Drawing()
        self._canvas = TurtleCanvas(self._drawing)
        self._driven = self.about
        self._wanted = ""
        """A requested turtle, to be driven once it exists."""
        self._picture_at = 0.0
        self._seen = -1
        self._empty = Static("waiting for a turtle: no node publishes a turtlesim pose yet", classes="hint")

    def compose(self) -> ComposeResult:
        yield self._canvas
        yield self._empty

    @property
    def title(self) -> str:
        return f"turtle {self._driven}" if len(self._monitors) > 1 and self._driven else "turtle"

    @property
    def note(self) -> str:
        pose = self._drawing.turtles.get(self._driven)
        if pose is None:
            return ""
        return f"x {pose.x:.1f}  y {pose.y:.1f}  {round(math.degrees(pose.theta)):4d}°"

    def look(self, now: float) -> None:
        live = self.hub.live
        self._canvas.display, self._empty.display = bool(self._monitors), not self._monitors
        if live is None or live.context is None:
            return
        if live.changes != self._seen:
            self._seen = live.changes
            self._find()
        self._drawing.now = now
        for monitor in self._monitors.values():
            monitor.look()
        if self._monitors and now > self._picture_at:
            self._picture_at = now + PICTURE_EVERY
            self.work(self._take_picture, group="picture")
        self._canvas.redraw()

    def _find(self) -> None:
        from graphflow.msgs.geometry_msgs.msg import Twist
        from graphflow.wire.liveliness import Kind

        assert self.hub.live is not None
        topics = self.hub.live.cache.topics()
        wanted = {
            t.removesuffix("/pose").removeprefix("/"): t for t, types in topics.items() if set(types) & set(POSES)
        }
        published = {e.name for e in self.hub.live.cache.endpoints(Kind.PUBLISHER)}
        wanted = dict(list({n: t for n, t in wanted.items() if t in published}.items())[:TURTLES])
        for name in [n for n in self._monitors if n not in wanted]:
            self._monitors.pop(name).close()
            self._drawing.turtles.pop(name, None)
        for name, topic in wanted.items():
            if name not in self._monitors:
                monitor = self._monitors[name] = TopicMonitor(self.hub.live, topic)
                monitor.on_message = partial(self._received, name)
                # Early, so that the simulator has discovered the publisher by the first key.
                self.hub.live.publisher(Twist, f"/{name}/cmd_vel")
        if self._wanted in self._monitors:
            self._driven, self._wanted = self._wanted, ""
        if self._driven not in self._monitors and self._monitors:
            self._driven = self.about if self.about in self._monitors else next(iter(self._monitors))

    def _received(self, name: str, pose: Pose, _: float) -> None:
        self._drawing.moved(name, pose.x, pose.y, pose.theta, JUMP)

    async def _take_picture(self) -> None:
        """Fetch a picture: strokes from before the view was opened, and changes that poses do not show."""
        from graphflow.msgs.std_srvs.srv import Trigger

        assert self.hub.live is not None
        services = self.hub.live.cache.services()
        name = next((n for n, types in services.items() if n.endswith("/snapshot") and Trigger.NAME in types), None)
        if name is None:
            return
        began = time.monotonic()

        def call(graph: Graph) -> str:
            return str(graph.call(name, Trigger.NAME, Trigger.Request(), 2.0).message)

        try:
            picture = read_picture(await self.hub.live.ask(call))
        except GraphflowError:
            return  # without pictures, turtles are still drawn by their poses
        took = time.monotonic() - began
        self._picture_at = time.monotonic() + max(PICTURE_EVERY, took / PICTURE_SHARE)
        self._drawing.take(picture, began)

    def closed(self) -> None:
        for monitor in self._monitors.values():
            monitor.close()
        self._monitors.clear()

    # driving

    def _drive(self, linear: float, angular: float) -> None:
        if not self._driven or self.hub.live is None or self.hub.live.node is None:
            return
        from graphflow.msgs.geometry_msgs.msg import Twist, Vector3

        topic = f"/{self._driven}/cmd_vel"
        publisher = self.hub.live.publisher(Twist, topic)
        publisher.publish(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))
        values = f"{{linear: {{x: {linear}}}, angular: {{z: {angular}}}}}"
        self.did(f"graphflow topic pub --once {topic} geometry_msgs/msg/Twist '{values}'")
        others = self._drivers(topic)
        if others:
            self.say(f"{others[0]} drives {self._driven} too; a adds a turtle of your own")

    def _drivers(self, topic: str) -> list[str]:
        """Return the nodes that drive a turtle, except consoles, which are hidden nodes."""
        from graphflow.wire.liveliness import Kind

        assert self.hub.live is not None
        found = {e.node_name for e in self.hub.live.cache.endpoints(Kind.PUBLISHER) if e.name == topic}
        return sorted(name for name in found if not is_hidden(name))

    def do_forward(self) -> None:
        self._drive(LINEAR, 0.0)

    def do_backward(self) -> None:
        self._drive(-LINEAR, 0.0)

    def do_left(self) -> None:
        self._drive(0.0, ANGULAR)

    def do_right(self) -> None:
        self._drive(0.0, -ANGULAR)

    def do_turn(self, degrees: str) -> None:
        self.work(lambda: self._turn_to(math.radians(float(degrees))), group="turn")

    async def _turn_to(self, theta: float) -> None:
        from graphflow.msgs import registry

        live = self.hub.live
        if live is None or live.node is None:
            return
        name = f"/{self._driven}/rotate_absolute"
        types = live.cache.actions().get(name)
        if not types:
            self.say(f"no node offers {name}", bad=True)
            return
        type_: Any = registry.interface_class(types[0])
        self.did(f"graphflow action send_goal {name} {types[0]} '{{theta: {theta:.4f}}}'")
        client = live.action_client(type_, name)
        async with client.send(type_.Goal(theta=theta)) as goal:
            await goal.result()

    def do_stop_turning(self) -> None:
        self.work(self._do_nothing, group="turn")

    async def _do_nothing(self) -> None:
        """Do nothing; replaces a turn under way, which cancels it."""

    def do_next_turtle(self) -> None:
        names = list(self._monitors)
        if names:
            at = names.index(self._driven) + 1 if self._driven in names else 0
            self._driven = names[at % len(names)]

    def do_add(self) -> None:
        self.work(self._add, group="add")

    async def _add(self) -> None:
        from graphflow.msgs import registry

        live = self.hub.live
        if live is None or live.context is None:
            return
        found = [(n, t) for n, types in live.cache.services().items() for t in types if t in SPAWN]
        if not found:
            self.say("no node offers /spawn", bad=True)
            return
        name, type_name = found[0]
        type_: Any = registry.interface_class(type_name)
        middle = WORLD / 2
        self.did(f"graphflow service call {name} {type_name} '{{x: {middle}, y: {middle}}}'")
        answer = await live.ask(lambda g: g.call(name, type_name, type_.Request(x=middle, y=middle), 2.0))
        self._wanted = answer.name
        live.changes += 1

    def do_clear(self) -> None:
        from graphflow.msgs.std_srvs.srv import Empty

        async def clear() -> None:
            if self.hub.live is not None:
                await self.hub.live.ask(lambda graph: graph.call("/clear", Empty.NAME, Empty.Request(), 2.0))
                self._picture_at = 0.0

        self.did("graphflow service call /clear std_srvs/srv/Empty")
        self.work(clear)


VIEW = Turtles

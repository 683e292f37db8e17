"""The joints of a robot as sliders, which publish positions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rich.text import Text
from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.widget import Widget
from textual.widgets import Static

from graphflow.errors import GraphFileError
from graphflow.names import is_hidden
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.views.robot.topics import topics_of
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.description import Joint, Robot
    from graphflow.msgs.sensor_msgs.msg import JointState
    from graphflow.msgs.std_msgs.msg import String

DESCRIPTION, TEXT, STATES = "/robot_description", "std_msgs/msg/String", "sensor_msgs/msg/JointState"
SETTER = "/set"
"""The end of the topic on which `joint_state_publisher` takes positions."""
TURN = math.pi
"""Half the range of a slider whose joint has no limits, in radians or metres."""
STEPS = 40
"""Presses from one end of a slider to the other."""


class Joints(View):
    """A slider per joint: arrow keys choose one and move it."""

    NAME = "joints"
    DOC = "the joints of a robot as sliders, which publish positions"
    EVERY = 0.2
    LEAST_WIDTH = 44
    ACTIONS = (
        Action("up", "joint above", keys=("up",)),
        Action("down", "joint below", keys=("down",), hint=True, label="↑↓ choose"),
        Action("less", "move back", keys=("left",), hint=True, label="←→ move"),
        Action("more", "move on", keys=("right",)),
        Action("home", "all to their start", keys=("0",), hint=True),
    )
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._robot: Robot | None = None
        self._trouble = ""
        self._text = Static("")
        self._row = 0
        self._positions: dict[str, float] = {}
        """Positions by joint: those heard, and those set here."""
        self._is_set = False
        self._description: TopicMonitor | None = None
        self._states: TopicMonitor | None = None
        self._seen = 0

    DEFAULT_CSS = """
    Joints Static { padding: 0 1; }
    """

    def compose(self) -> ComposeResult:
        with VerticalScroll():
            yield self._text

    @property
    def focus_target(self) -> Widget:
        return self

    @property
    def note(self) -> str:
        return self._robot.name if self._robot is not None else ""

    @property
    def _joints(self) -> list[Joint]:
        return [] if self._robot is None else [j for j in self._robot.joints.values() if j.moves and j.mimic is None]

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or live.node is None:
            return
        if self._description is None:
            self._description = TopicMonitor(live, self.about or DESCRIPTION)
        self._description.look()
        if self._description.type_name not in ("", TEXT):
            self._trouble = f"{self._description.topic} is no description: it is of type {self._description.type_name}"
        elif self._description.message is not None and self._description.count != self._seen:
            self._seen = self._description.count
            self._take(self._description.message)
        if self._robot is None:
            told = self._trouble or self._description.trouble or "waiting for a robot's description"
            self._text.update(Text(told, self.colours.bad if self._trouble else self.colours.dim))
            return
        self._hear()
        if self._is_set and not self._setter():
            self._publish("/joint_states")  # without a publisher of joint states, this view is one
        self._draw()

    def _take(self, message: String) -> None:
        from graphflow.description import parse

        try:
            self._robot, self._trouble = parse(message.data), ""
        except GraphFileError as error:
            self._trouble = str(error)
            return
        self._row = min(self._row, max(0, len(self._joints) - 1))

    def _hear(self) -> None:
        """Take positions from the joint states, unless they are set here."""
        live = self.hub.live
        assert live is not None
        if self._states is None:
            topic = next(iter(topic for topic in topics_of(live, STATES) if not topic.endswith(SETTER)), "")
            if not topic:
                return
            self._states = TopicMonitor(live, topic)
            self._states.on_message = self._heard
        self._states.look()

    def _heard(self, state: JointState, _: float) -> None:
        if not self._is_set or self._setter():
            known = {joint.name for joint in self._joints}
            self._positions |= {n: float(p) for n, p in zip(state.name, state.position, strict=False) if n in known}

    def _setter(self) -> str:
        """Return the topic on which a node takes positions; "" if none does."""
        live = self.hub.live
        if live is None:
            return ""
        return next((topic for topic in topics_of(live, STATES) if topic.endswith(SETTER)), "")

    def _draw(self) -> None:
        colours, text = self.colours, Text()
        width = max(10, self.size.width - 40)
        for index, joint in enumerate(self._joints):
            low, high = limits(joint)
            position = self._positions.get(joint.name)
            if position is not None and joint.limits is None and joint.kind == "continuous":
                position = math.remainder(position, math.tau)
            share = 0.5 if position is None else (min(high, max(low, position)) - low) / (high - low)
            at = round(share * (width - 1))
            chosen = index == self._row
            text.append("▸ " if chosen else "  ", colours.accent)
            text.append(f"{joint.name[:18]:<18} ", colours.strong if chosen else colours.text)
            text.append("─" * at, colours.dim)
            text.append("●" if position is not None else "○", colours.accent if chosen else colours.text)
            text.append("─" * (width - 1 - at), colours.dim)
            shown = "unknown" if position is None else described(joint, position)
            text.append(f" {shown}\n", colours.text)
        if not self._joints:
            text.append("no joint of this robot moves", colours.dim)
        self._text.update(text)

    def _move(self, way: int) -> None:
        if not self._joints or not self._may_set():
            return
        joint = self._joints[self._row]
        low, high = limits(joint)
        position = self._positions.get(joint.name, joint.home) + way * (high - low) / STEPS
        self._positions[joint.name] = min(high, max(low, position))
        self._send()

    def _may_set(self) -> bool:
        """Whether positions may be set here; if not, say why."""
        live = self.hub.live
        if self._setter() or self._is_set or live is None or self._states is None:
            return True
        publishers = {e.node_name for e in live.cache.endpoints(Kind.PUBLISHER, self._states.topic)}
        others = sorted(name for name in publishers if not is_hidden(name))
        if others:
            self.say(f"{others[0]} publishes the positions; only a joint_state_publisher takes others", bad=True)
        return not others

    def _send(self) -> None:
        self._is_set = True
        self._publish(self._setter() or "/joint_states")
        self._draw()

    def _publish(self, topic: str) -> None:
        from graphflow.msgs.sensor_msgs.msg import JointState
        from graphflow.msgs.std_msgs.msg import Header

        live = self.hub.live
        if live is None or live.node is None or self._robot is None:
            return
        positions = {joint.name: self._positions.get(joint.name, joint.home) for joint in self._joints}
        if not topic.endswith(SETTER):
            positions = {joint.name: position for joint, position in self._robot.moved(positions)}
        header = Header(stamp=live.node.clock.now())
        state = JointState(header=header, name=list(positions), position=list(positions.values()))
        live.publisher(JointState, topic).publish(state)

    def do_up(self) -> None:
        self._row = max(0, self._row - 1)
        self._draw()

    def do_down(self) -> None:
        self._row = min(max(0, len(self._joints) - 1), self._row + 1)
        self._draw()

    def do_less(self) -> None:
        self._move(-1)

    def do_more(self) -> None:
        self._move(1)

    def do_home(self) -> None:
        if not self._may_set():
            return
        self._positions |= {joint.name: joint.home for joint in self._joints}
        self._send()

    def closed(self) -> None:
        for monitor in (self._description, self._states):
            if monitor is not None:
                monitor.close()
        self._description = self._states = None


def limits(joint: Joint) -> tuple[float, float]:
    """Return the ends of a joint's slider, in radians or metres."""
    low, high = joint.limits or (-TURN, TURN)
    return (low, high) if high > low else (low - TURN, low + TURN)


def described(joint: Joint, position: float) -> str:
    """Format a position: in radians and degrees, or in metres."""
    if joint.kind == "prismatic":
        return f"{position:.3f} m"
    return f"{position:.2f} rad {round(math.degrees(position)):4d}°"


VIEW = Joints

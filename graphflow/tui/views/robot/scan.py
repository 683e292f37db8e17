"""A laser scan around its scanner, which looks up."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.app import ComposeResult
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Static

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.views.robot.topics import next_of, topics_of
from graphflow.tui.widgets.canvas import RGB, Dots
from graphflow.tui.widgets.colours import colours_of

if TYPE_CHECKING:
    from graphflow.msgs.sensor_msgs.msg import LaserScan

SCAN = "sensor_msgs/msg/LaserScan"
RING, HIT, NEAREST = (0x3A, 0x46, 0x54), (0xFF, 0x6B, 0x5E), (0xFF, 0xD1, 0x66)
"""Colours of the rings, of the points, and of the nearest point."""
ZOOM = 1.25
STEPS = (0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 25.0, 50.0)
"""Distances between rings in metres."""


class Polar(Widget):
    """Points around the middle, with rings at round distances."""

    def __init__(self) -> None:
        super().__init__()
        self.radius = 0.0
        """Metres from the middle to the nearer edge; 0 to show everything."""
        self.points: NDArray[np.float64] = np.zeros((0, 2))
        self.nearest = -1
        self._dots = Dots(0, 0)

    @property
    def shown(self) -> float:
        """Metres from the middle to the nearer edge, as drawn."""
        if self.radius:
            return self.radius
        return max(0.5, float(np.hypot(*self.points.T).max(initial=0.5)) * 1.05)

    @property
    def step(self) -> float:
        """Metres between two rings."""
        return next((step for step in STEPS if self.shown / step <= 5), STEPS[-1])

    def redraw(self) -> None:
        """Draw everything."""
        dots, shown = Dots(*self.size), self.shown
        width, height = 2 * self.size.width, 4 * self.size.height
        scale = min(width, height) / 2 / shown
        for ring in np.arange(self.step, shown * 1.01, self.step):
            for angle in np.linspace(0.0, math.tau, max(24, int(ring * scale * 3)), endpoint=False):
                dots.dot(
                    round(width / 2 + ring * scale * math.cos(angle)),
                    round(height / 2 + ring * scale * math.sin(angle)),
                    RING,
                )
        # The scanner's x axis points up, its y axis to the left.
        for index, (x, y) in enumerate(self.points):
            colour = NEAREST if index == self.nearest else HIT
            dots.dot(round(width / 2 - y * scale), round(height / 2 - x * scale), colour)
        self._dots = dots
        self.refresh()

    def render_line(self, y: int) -> Strip:
        base = self.rich_style
        if y >= self._dots.height:
            return Strip.blank(self.size.width, base)
        segments = [Segment(text, base + self._visible(c) if c is not None else base) for text, c in self._dots.row(y)]
        if y == self.size.height // 2:
            return self._with_scanner(segments, base)
        return Strip(segments)

    def _with_scanner(self, segments: list[Segment], base: Style) -> Strip:
        strip, middle = Strip(segments), self.size.width // 2
        mark = Segment("▲", base + colours_of(self).nodes[1] + Style(bold=True))
        return Strip([*strip.crop(0, middle), mark, *strip.crop(middle + 1)])

    def _visible(self, colour: RGB) -> Style:
        if not colours_of(self).is_dark:
            colour = (int(colour[0] * 0.6), int(colour[1] * 0.6), int(colour[2] * 0.6))
        return Style(color=Color.from_rgb(*colour))


class Scan(View):
    """The newest scan of a topic."""

    NAME = "scan"
    DOC = "a laser scan around its scanner: rings, points, the nearest one"
    EVERY = 0.2
    LEAST_HEIGHT = 14
    ACTIONS = (
        Action("closer", "zoom in", keys=("plus", "equals_sign"), hint=True, label="+- zoom"),
        Action("farther", "zoom out", keys=("minus",)),
        Action("everything", "show everything", keys=("0",), hint=True),
        Action("next_topic", "next scan", keys=("n",), hint=True),
        Action("echo", "echo", keys=("e",), verb="graphflow topic echo {topic}"),
    )
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._topic = self.about
        self._monitor: TopicMonitor | None = None
        self._polar = Polar()
        self._legend = Static("waiting for a scan: no node publishes a laser scan yet")
        self._seen = 0

    def compose(self) -> ComposeResult:
        yield self._polar
        yield self._legend

    DEFAULT_CSS = """
    Scan Polar { height: 1fr; }
    Scan Static { height: 1; padding: 0 1; }
    """

    @property
    def focus_target(self) -> Widget:
        return self

    @property
    def title(self) -> str:
        return f"scan {self._topic}".rstrip()

    @property
    def note(self) -> str:
        return f"ring {self._polar.step:g} m" if self._seen else ""

    def chosen(self) -> dict[str, str]:
        return {"topic": self._topic}

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or live.node is None:
            return
        if not self._topic:
            self._topic = next(iter(topics_of(live, SCAN)), "")
        if not self._topic:
            return
        if self._monitor is None:
            self._monitor = TopicMonitor(live, self._topic)
        self._monitor.look()
        if self._monitor.trouble:
            self._legend.update(self._monitor.trouble)
        elif self._monitor.type_name != SCAN:
            self._legend.update(f"{self._topic} has no scans: it is of type {self._monitor.type_name}")
        elif self._monitor.message is None:
            self._legend.update(f"{self._topic}: no scan has come yet")
        elif self._monitor.count != self._seen:
            self._seen = self._monitor.count
            self._show(self._monitor.message)

    def _show(self, scan: LaserScan) -> None:
        from graphflow.tf.messages import scan_points

        points = scan_points(scan)[:, :2]
        distances = np.hypot(*points.T)
        self._polar.points = points
        self._polar.nearest = int(distances.argmin()) if len(points) else -1
        beams = f"{len(points)} of {len(scan.ranges)} beams hit something"
        if len(points):
            x, y = points[self._polar.nearest]
            degrees = round(math.degrees(math.atan2(y, x)))
            beams += f"; nearest {distances.min():.2f} m at {degrees}°"
        self._legend.update(beams)
        self._polar.redraw()

    def _zoom(self, factor: float) -> None:
        self._polar.radius = min(200.0, max(0.2, self._polar.shown * factor))
        self._polar.redraw()

    def do_closer(self) -> None:
        self._zoom(1 / ZOOM)

    def do_farther(self) -> None:
        self._zoom(ZOOM)

    def do_everything(self) -> None:
        self._polar.radius = 0.0
        self._polar.redraw()

    def do_next_topic(self) -> None:
        live = self.hub.live
        if live is not None:
            self.closed()
            self._topic, self._seen = next_of(topics_of(live, SCAN), self._topic), 0

    def do_echo(self) -> None:
        if self._topic:
            self.open("echo", self._topic)

    def closed(self) -> None:
        if self._monitor is not None:
            self._monitor.close()
            self._monitor = None


VIEW = Scan

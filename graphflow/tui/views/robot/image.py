"""The images of a topic: in the pixels of a terminal that draws graphics, elsewhere in cells of two pixels."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.app import ComposeResult
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Static

from graphflow.introspect.messages.images import NotShown, Pixels, pixels, shrunk, uncompressed
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.views.robot.topics import next_of, topics_of
from graphflow.tui.widgets.graphics import Graphics, are_drawn

IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
RECENT = 2.0
"""Seconds over which the rate is counted."""


class Picture(Widget):
    """An image as large as fits; each cell is an upper and a lower pixel."""

    def __init__(self) -> None:
        super().__init__()
        self._image: Pixels | None = None
        self._cells: Pixels | None = None
        self._for: tuple[int, int] = (0, 0)

    def show(self, image: Pixels) -> None:
        """Show another image."""
        self._image, self._cells = image, None
        self.refresh()

    def _scaled(self) -> Pixels | None:
        width, height = self.size
        if self._image is None or not width or not height:
            return None
        if self._cells is None or self._for != (width, height):
            rows, columns = self._image.shape[:2]
            scale = min(width / columns, 2 * height / rows)
            across, down = max(1, int(columns * scale)), max(2, int(rows * scale) // 2 * 2)
            self._cells, self._for = shrunk(self._image, across, down), (width, height)
        return self._cells

    def render_line(self, y: int) -> Strip:
        base, cells = self.rich_style, self._scaled()
        if cells is None or 2 * y + 1 >= len(cells):
            return Strip.blank(self.size.width, base)
        upper, lower = cells[2 * y], cells[2 * y + 1]
        left = (self.size.width - len(upper)) // 2
        segments = [Segment(" " * left, base)]
        # Cells of one colour pair are one segment.
        pair = np.concatenate([upper, lower], axis=1)
        starts = np.flatnonzero(np.any(pair[1:] != pair[:-1], axis=1)) + 1
        for run in np.split(np.arange(len(pair)), starts):
            r, g, b, u, v, w = (int(value) for value in pair[run[0]])
            style = Style(color=Color.from_rgb(r, g, b), bgcolor=Color.from_rgb(u, v, w))
            segments.append(Segment("▀" * len(run), style))
        return Strip(segments).adjust_cell_length(self.size.width, base)


class ImageView(View):
    """The newest image of a topic."""

    NAME = "image"
    DOC = "the images of a camera"
    EVERY = 0.1
    LEAST_HEIGHT = 14
    ACTIONS = (
        Action("next_topic", "next camera", keys=("n",), hint=True),
        Action("pause", "pause", keys=("space",), hint=True),
        Action("hz", "rate", keys=("h",), verb="graphflow topic hz {topic}"),
    )
    DEFAULT_CSS = """
    ImageView Picture { height: 1fr; }
    ImageView Static { height: 1; padding: 0 1; }
    """
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._topic = self.about
        self._monitor: TopicMonitor | None = None
        self._picture = Graphics() if are_drawn() else Picture()
        self._legend = Static("waiting for a camera: no node publishes images yet")
        self._seen = 0
        self._paused = False

    def compose(self) -> ComposeResult:
        yield self._picture
        yield self._legend

    @property
    def focus_target(self) -> Widget:
        return self

    @property
    def title(self) -> str:
        return f"image {self._topic}".rstrip()

    @property
    def note(self) -> str:
        return "paused" if self._paused else ""

    def chosen(self) -> dict[str, str]:
        return {"topic": self._topic}

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or live.node is None:
            return
        if not self._topic:
            self._topic = min(topics_of(live, IMAGE, COMPRESSED), key=_last, default="")
        if not self._topic:
            return
        if self._monitor is None:
            self._monitor = TopicMonitor(live, self._topic)
        self._monitor.look()
        if self._monitor.trouble:
            self._legend.update(self._monitor.trouble)
        elif self._monitor.type_name not in (IMAGE, COMPRESSED):
            self._legend.update(f"{self._topic} has no images: it is of type {self._monitor.type_name}")
        elif self._monitor.message is None:
            self._legend.update(f"{self._topic}: no image has come yet")
        elif self._monitor.count != self._seen and not self._paused:
            self._seen = self._monitor.count
            self._show(self._monitor.message, self._monitor)

    def _show(self, message: Any, monitor: TopicMonitor) -> None:
        try:
            if monitor.type_name == IMAGE:
                image, kind = pixels(message), message.encoding
            else:
                image, kind = uncompressed(message), message.format or "compressed"
        except NotShown as error:
            self._legend.update(f"not shown: {error}")
            return
        self._picture.show(image)
        count = sum(at > time.monotonic() - RECENT for at in monitor.arrivals)
        height, width = image.shape[:2]
        self._legend.update(f"{width} x {height} {kind}, {count / RECENT:.0f} Hz, {message.header.frame_id}")

    def do_next_topic(self) -> None:
        self.closed()
        self._topic, self._seen = next_of(topics_of(self.hub.live, IMAGE, COMPRESSED), self._topic), 0

    def do_hz(self) -> None:
        if self._topic:
            self.open("hz", self._topic)

    def do_pause(self) -> None:
        self._paused = not self._paused

    def closed(self) -> None:
        if self._monitor is not None:
            self._monitor.close()
            self._monitor = None


def _last(topic: str) -> tuple[bool, str]:
    """Order topics: depths come last."""
    return "depth" in topic, topic


VIEW = ImageView

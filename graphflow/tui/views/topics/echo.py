"""The messages of one topic: the latest, or as a stream."""

from __future__ import annotations

from typing import Any

from textual.app import ComposeResult
from textual.widget import Widget

from graphflow.introspect.messages.echo import block, plain, truncated
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.line_view import LineView

ELEMENTS = 32
"""Maximum elements and characters shown of arrays and strings."""
LINES = 2000


class Echo(View):
    """The messages of a topic."""

    NAME = "echo"
    DOC = "the messages of a topic"
    LEAST_WIDTH = 36
    EVERY = 0.2
    ACTIONS = (
        Action("stream", "one after the other, or the latest", keys=("s",), hint=True),
        Action("pause", "pause", keys=("space",), hint=True),
        Action("hz", "rate", keys=("h",), hint=True),
        Action("plot", "plot", keys=("p",), hint=True),
        Action("copy", "copy the message", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._lines = LineView[str](20_000)
        self._monitor: TopicMonitor | None = None
        self._shown = 0
        self._left_out = 0
        self._streams = False
        self._paused = False

    def compose(self) -> ComposeResult:
        yield self._lines

    @property
    def focus_target(self) -> Widget:
        return self._lines

    @property
    def note(self) -> str:
        monitor = self._monitor
        if monitor is None or not monitor.count:
            return ""
        lost = self._left_out + monitor.dropped
        words = [f"{monitor.count} messages", *([f"{lost} not shown"] if lost and self._streams else [])]
        return ", ".join([*words, *(["paused"] if self._paused else [])])

    def chosen(self) -> dict[str, str]:
        return {"topic": self.about}

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or self._paused:
            return
        if self._monitor is None:
            self._monitor = TopicMonitor(live, self.about)
        monitor = self._monitor
        if not monitor.is_open:
            monitor.look()
            if monitor.trouble and not monitor.count:
                self._lines.replace([plain_text(monitor.trouble)])
        if monitor.count == self._shown or monitor.message is None:
            return
        self._left_out += monitor.count - self._shown - 1
        self._shown = monitor.count
        rows = _lines_of(monitor.message)
        if self._streams:
            self._lines.extend([*rows, "---"])
        else:
            top, follows = self._lines.scroll_offset.y, self._lines.follows
            self._lines.follows = False
            self._lines.replace(rows)
            self._lines.follows = follows
            self._lines.scroll_to(y=min(top, max(0, len(rows) - 1)), animate=False, immediate=True)

    def do_stream(self) -> None:
        self._streams = not self._streams
        self._left_out = 0
        self._lines.replace([])
        self._lines.follows = True
        self._shown = 0 if self._monitor is None else max(0, self._monitor.count - 1)

    def do_pause(self) -> None:
        self._paused = not self._paused

    def do_hz(self) -> None:
        self.open("hz", self.about)

    def do_plot(self) -> None:
        self.open("plot", self.about)

    def do_copy(self) -> None:
        if self._monitor is not None and self._monitor.message is not None:
            self.console.copy(block(plain(self._monitor.message)), "the message as YAML")

    def closed(self) -> None:
        if self._monitor is not None:
            self._monitor.close()
            self._monitor = None


def _lines_of(message: Any) -> list[str]:
    lines = block(truncated(plain(message), ELEMENTS)).split("\n")
    more = len(lines) - LINES
    return [*lines[:LINES], f"... {more} lines more"] if more > 0 else lines


VIEW = Echo

"""Numeric fields of a topic as curves over the last seconds."""

from __future__ import annotations

import math
import time
from collections import deque
from typing import Any

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Static

from graphflow.msgs.base import Message
from graphflow.tui.actions import Action
from graphflow.tui.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.tap import Tap
from graphflow.tui.view import View

SECONDS = 30.0
CURVES = 6
SAMPLES_PER_SECOND = 50.0
"""Samples kept; what comes faster is thinned out."""


class Plot(View):
    """Curves of a topic's numbers: `/turtle1/pose.x,theta`, or all of them."""

    NAME = "plot"
    DOC = "numbers of a topic as curves: /turtle1/pose.x,theta"
    EVERY = 0.25
    ACTIONS = (
        Action("longer", "more seconds", keys=("minus",), hint=True),
        Action("shorter", "fewer seconds", keys=("plus", "equals_sign"), hint=True),
        Action("pause", "pause", keys=("space",), hint=True),
        Action("echo", "echo", keys=("e",), verb="graphflow topic echo {topic}"),
    )
    DEFAULT_CSS = """
    Plot PlotWidget { height: 1fr; background: $background; }
    Plot Static { height: 1; padding: 0 1; }
    """
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        from textual_plot import PlotWidget

        super().__init__(hub, content)
        self._topic, _, fields = self.about.partition(".")
        self._fields = [field for field in fields.split(",") if field][:CURVES]
        self._seconds = float(self.options.get("seconds") or SECONDS)
        self._tap: Tap | None = None
        self._samples: deque[tuple[float, list[float]]] = deque()
        self._last = 0.0
        self._paused = False
        self._plot = PlotWidget(allow_pan_and_zoom=False)
        self._legend = Static("")

    def compose(self) -> ComposeResult:
        yield self._legend
        yield self._plot

    @property
    def heart(self) -> Widget:
        return self

    def chosen(self) -> dict[str, str]:
        return {"topic": self._topic}

    @property
    def note(self) -> str:
        return f"{self._seconds:g} s{', paused' if self._paused else ''}"

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None:
            return
        if self._tap is None:
            self._tap = Tap(live, self._topic)
            self._tap.heard = self._heard
        self._tap.look()
        if self._tap.trouble:
            self._legend.update(Text(self._tap.trouble, style=self.ink.warn))
        elif not self._paused:
            self._draw(time.monotonic())

    def _heard(self, message: Message, now: float) -> None:
        if now - self._last < 1.0 / SAMPLES_PER_SECOND:
            return
        self._last = now
        if not self._fields:
            self._fields = [path for path, _ in numbers(message)][:CURVES]
        values = dict(numbers(message))
        self._samples.append((now, [values.get(field, math.nan) for field in self._fields]))
        while self._samples and self._samples[0][0] < now - 4 * self._seconds:
            self._samples.popleft()

    def _draw(self, now: float) -> None:
        from textual_plot import HiResMode

        ink = self.ink
        shown = [(at - now, values) for at, values in self._samples if at > now - self._seconds]
        self._plot.clear()
        legend = Text()
        for i, field in enumerate(self._fields):
            points = [(x, values[i]) for x, values in shown if math.isfinite(values[i])]
            colour = ink.nodes[i % len(ink.nodes)].color
            latest = f" {points[-1][1]:.3g}" if points else " no such number"
            legend.append(f"━ {field}{latest}  ", style=ink.nodes[i % len(ink.nodes)])
            if len(points) > 1 and colour is not None:
                xs, ys = zip(*points, strict=True)
                self._plot.plot(xs, ys, line_style=colour.name, hires_mode=HiResMode.BRAILLE)
        self._plot.set_xlimits(-self._seconds, 0.0)
        values = [v for _, row in shown for v in row if math.isfinite(v)]
        if values:
            low, high = min(values), max(values)
            margin = (high - low) * 0.05 or max(abs(high) * 0.1, 1e-3)
            self._plot.set_ylimits(low - margin, high + margin)
        self._legend.update(legend if self._fields else Text("no message yet", style=ink.dim))

    def do_longer(self) -> None:
        self._span(2.0)

    def do_shorter(self) -> None:
        self._span(0.5)

    def _span(self, factor: float) -> None:
        self._seconds = min(600.0, max(2.0, self._seconds * factor))
        self.options["seconds"] = self._seconds

    def do_pause(self) -> None:
        self._paused = not self._paused

    def do_echo(self) -> None:
        self.open("echo", self._topic)

    def closed(self) -> None:
        if self._tap is not None:
            self._tap.close()


def numbers(message: Any, path: str = "") -> list[tuple[str, float]]:
    """The numeric fields of a message by their paths: `linear.x`. Arrays are left out."""
    found: list[tuple[str, float]] = []
    for field in message.SCHEMA.fields:
        value = getattr(message, field.name)
        where = f"{path}.{field.name}" if path else field.name
        if isinstance(value, Message):
            found += numbers(value, where)
        elif isinstance(value, (int, float)):
            found.append((where, float(value)))
    return found


VIEW = Plot

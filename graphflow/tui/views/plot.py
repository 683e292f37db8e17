"""Numeric fields of a topic as curves over the last seconds."""

from __future__ import annotations

import time

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Static

from graphflow.errors import UsageFault
from graphflow.introspect.curves import CURVES, Curve, chart
from graphflow.introspect.fields import numbers
from graphflow.msgs.base import Message
from graphflow.tui.actions import Action
from graphflow.tui.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.tap import Tap
from graphflow.tui.view import View

SECONDS = 30.0
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
    Plot #curves { height: 1fr; }
    Plot #legend { height: 1; padding: 0 1; }
    """
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._topic, _, fields = self.about.partition(".")
        self._fields = [field for field in fields.split(",") if field][:CURVES]
        self._seconds = float(self.options.get("seconds") or SECONDS)
        self._tap: Tap | None = None
        self._curves: list[Curve] = []
        self._trouble = ""
        self._last = 0.0
        self._paused = False
        self._plot = Static("", id="curves")
        self._legend = Static("", id="legend")

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
        if trouble := self._tap.trouble or self._trouble:
            self._legend.update(Text(trouble, style=self.ink.warn))
        elif not self._paused:
            self._draw(time.monotonic())

    def _heard(self, message: Message, now: float) -> None:
        if self._trouble or now - self._last < 1.0 / SAMPLES_PER_SECOND:
            return
        self._last = now
        if not self._curves:
            self._begin(message.SCHEMA.name)
        for curve in self._curves:
            curve.forget(now - 4 * self._seconds)
            curve.add(now, message)

    def _begin(self, type_name: str) -> None:
        fields = self._fields or numbers(type_name)[:CURVES]
        try:
            self._curves = [Curve(field, type_name) for field in fields]
        except UsageFault as error:
            self._trouble = str(error)
        if not fields:
            self._trouble = f"{type_name} has no numbers"

    def _draw(self, now: float) -> None:
        ink = self.ink
        styles = [ink.nodes[i % len(ink.nodes)] for i in range(len(self._curves))]
        legend = Text()
        for curve, style in zip(self._curves, styles, strict=True):
            legend.append(f"━ {curve.legend}  ", style=style)
        self._legend.update(legend if self._curves else Text("no message yet", style=ink.dim))
        colours = [style.color.name for style in styles if style.color is not None]
        size, span = (self._plot.size.width, self._plot.size.height), (now - self._seconds, now)
        self._plot.update(Text.from_ansi(chart(self._curves, size, span=span, colours=colours, legend=False)))

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


VIEW = Plot

"""Numeric fields of a topic as curves over the last seconds."""

from __future__ import annotations

import time

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Static

from graphflow.errors import UsageFault
from graphflow.introspect.drawing.curves import CURVES, Curve, chart
from graphflow.introspect.messages.fields import numbers
from graphflow.msgs.base import Message
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.dialogs import Item, Pick

SECONDS = 30.0
AXES = ("unit", "each", "one")
"""The sharing of charts: curves of one unit, none, or all."""
SAMPLES_PER_SECOND = 50.0
"""Samples kept per second; faster topics are thinned out."""


class Plot(View):
    """Curves of a topic's numeric fields: `/turtle1/pose.x,theta`, or all of them."""

    NAME = "plot"
    DOC = "numbers of a topic as curves: /turtle1/pose.x,theta"
    LEAST_WIDTH = 40
    EVERY = 0.25
    ACTIONS = (
        Action("fields", "choose fields", keys=("f",), hint=True),
        Action("axes", "axes: by unit, one each, or one", keys=("a",), hint=True),
        Action("longer", "more seconds", keys=("minus",), hint=True),
        Action("shorter", "fewer seconds", keys=("plus", "equals_sign"), hint=True),
        Action("pause", "pause", keys=("space",), hint=True),
        Action("echo", "echo", keys=("e",), verb="graphflow topic echo {topic}"),
    )
    DEFAULT_CSS = """
    Plot #curves { height: 1fr; }
    Plot #legend { height: auto; max-height: 3; padding: 0 1; }
    """
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._topic, _, fields = self.about.partition(".")
        self._fields = [field for field in fields.split(",") if field][:CURVES]
        self._seconds = float(self.options.get("seconds") or SECONDS)
        self._monitor: TopicMonitor | None = None
        self._curves: list[Curve] = []
        self._type_name = ""
        self._trouble = ""
        self._last = 0.0
        self._paused = False
        self._plot = Static("", id="curves")
        self._legend = Static("", id="legend")

    def compose(self) -> ComposeResult:
        yield self._legend
        yield self._plot

    @property
    def focus_target(self) -> Widget:
        return self

    def chosen(self) -> dict[str, str]:
        return {"topic": self._topic}

    @property
    def note(self) -> str:
        axes = {"unit": "", "each": ", an axis each", "one": ", one axis"}[self._axes]
        return f"{self._seconds:g} s{axes}{', paused' if self._paused else ''}"

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None:
            return
        if self._monitor is None:
            self._monitor = TopicMonitor(live, self._topic)
            self._monitor.on_message = self._received
        self._monitor.look()
        if trouble := self._monitor.trouble or self._trouble:
            self._legend.update(Text(trouble, style=self.colours.warn))
        elif not self._paused:
            self._draw(time.monotonic())

    def _received(self, message: Message, now: float) -> None:
        if self._trouble or now - self._last < 1.0 / SAMPLES_PER_SECOND:
            return
        self._last = now
        if not self._curves:
            self._begin(message.SCHEMA.name)
        for curve in self._curves:
            curve.forget(now - 4 * self._seconds)
            curve.add(now, message)

    def _begin(self, type_name: str) -> None:
        self._type_name = type_name
        fields = self._fields or numbers(type_name)[:CURVES]
        try:
            self._curves = [Curve(field, type_name) for field in fields]
        except UsageFault as error:
            self._trouble = str(error)
        if not fields:
            self._trouble = f"{type_name} has no numeric fields"

    def _draw(self, now: float) -> None:
        colours = self.colours
        styles = [colours.nodes[i % len(colours.nodes)] for i in range(len(self._curves))]
        legend = Text()
        for curve, style in zip(self._curves, styles, strict=True):
            legend.append(f"━ {curve.legend}  ", style=style)
        self._legend.update(legend if self._curves else Text("no message yet", style=colours.dim))
        names = [style.color.name for style in styles if style.color is not None]
        span, width, height = (now - self._seconds, now), self._plot.size.width, self._plot.size.height
        groups = self._groups()
        charts = [
            chart(
                [self._curves[i] for i in group],
                (width, height // len(groups)),
                span=span,
                colours=[names[i] for i in group],
                legend=False,
            )
            for group in groups
        ]
        self._plot.update(Text.from_ansi("\n".join(filter(None, charts))))

    @property
    def _axes(self) -> str:
        """The sharing of charts. Layouts saved by earlier versions have True for `each`."""
        if self.app.no_color:  # colour alone tells curves of one chart apart
            return "each"
        axes = self.options.get("axes")
        return "each" if axes is True else axes if axes in AXES else AXES[0]

    def _groups(self) -> list[list[int]]:
        """Return the curves of each chart, by index."""
        groups: dict[object, list[int]] = {}
        for i, curve in enumerate(self._curves):
            groups.setdefault({"unit": curve.unit, "each": i, "one": 0}[self._axes], []).append(i)
        return [*groups.values()]

    @property
    def content(self) -> Content:
        fields = f".{','.join(self._fields)}" if self._fields else ""
        return Content(self.NAME, f"{self._topic}{fields}", self.options)

    @property
    def title(self) -> str:
        return f"plot {self.content.about}"

    def do_fields(self) -> None:
        """Let the user show or hide fields, one after the other, until escape."""
        if not self._type_name:
            self.say(self._monitor.trouble if self._monitor is not None and self._monitor.trouble else "no message yet")
            return
        shown = [curve.label for curve in self._curves]
        items = [Item(field, "shown" if field in shown else "", field) for field in numbers(self._type_name)]

        def picked(field: str | None) -> None:
            if field is None:
                return
            chosen = [name for name in shown if name != field] if field in shown else [*shown, field]
            kept = {curve.label: curve for curve in self._curves}
            self._fields = chosen[:CURVES]
            self._curves = [kept.get(name) or Curve(name, self._type_name) for name in self._fields]
            self.do_fields()

        self.app.push_screen(Pick(f"Fields of {self._topic}: enter shows one, or leaves it out", items), picked)

    def do_axes(self) -> None:
        """Switch between charts by unit, by field, and one for all, where a large curve flattens the others."""
        if self.app.no_color:
            self.say("without colours, each curve has an axis of its own")
            return
        self.options["axes"] = AXES[(AXES.index(self._axes) + 1) % len(AXES)]

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
        if self._monitor is not None:
            self._monitor.close()


VIEW = Plot

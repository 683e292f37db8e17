"""The graph as boxes and arrows: nodes, topics with their rates, and mismatches in red."""

from __future__ import annotations

from collections.abc import Iterator

from rich.style import Style
from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.geometry import Region, Size
from textual.widget import Widget

from graphflow.introspect.drawing.layered import Box, Cell, Drawing, draw
from graphflow.introspect.drawing.picture import Picture, mermaid, picture
from graphflow.tui.commands.actions import Action, shown
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.colours import Colours
from graphflow.tui.widgets.line_view import LineView

BOXES = 120
"""Maximum boxes; larger graphs are first collapsed by namespace."""
SIDEWAYS = 20
"""Columns scrolled by one press of an arrow key."""


class Boxes(LineView[Text]):
    """The drawing, which scrolls both ways."""

    wide = 0

    def action_scroll_left(self) -> None:
        self.sideways(-1)

    def action_scroll_right(self) -> None:
        self.sideways(1)

    def sideways(self, step: int) -> None:
        """Scroll to the right by a number of steps."""
        self.scroll_relative(x=step * SIDEWAYS, animate=False, immediate=True)

    @property
    def _widest(self) -> int:
        return max(self.wide, super()._widest)

    def get_content_width(self, container: Size, viewport: Size) -> int:
        return max(self.wide, container.width)


class Graph(View):
    """The graph as a drawing."""

    NAME = "graph"
    DOC = "nodes and topics as boxes and arrows"
    LEAST_WIDTH = 60
    EVERY = 1.0
    ACTIONS = (
        Action("next_box", "next box", keys=("n",), hint=True),
        Action("previous_box", "box before", keys=("N",)),
        Action("open_box", "open it", keys=("enter",), hint=True),
        Action("collapse", "collapse its namespace, or all back", keys=("space",), hint=True),
        Action("sideways:-1", "to the left", keys=("left", "h"), hint=True, label="←→ sideways"),
        Action("sideways:1", "to the right", keys=("right", "l")),
        Action("everything", "unconnected topics too", keys=("a",), hint=True),
        Action("mermaid", "copy as Mermaid", keys=("M",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._boxes = Boxes(5000)
        self._boxes.follows = False
        self._collapsed: frozenset[str] = frozenset()
        self._everything = False
        self._chosen = ""
        self._picture = Picture((), (), ())
        self._drawing = Drawing([])
        self._drawn: object = None

    def compose(self) -> ComposeResult:
        yield self._boxes

    @property
    def focus_target(self) -> Widget:
        return self._boxes

    @property
    def note(self) -> str:
        bad = sum(arrow.is_bad for arrow in self._picture.arrows)
        more = ", ←→ more" if self._boxes.wide > self._boxes.size.width > 0 else ""
        return f"{len(self._picture.nodes)} nodes{f', {bad} misfits' if bad else ''}{more}"

    def chosen(self) -> dict[str, str]:
        if self._chosen in self._picture.topics:
            return {"topic": self._chosen}
        return {"node": self._chosen} if self._chosen in self.hub.nodes() else {}

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or live.context is None:
            return
        live.want("numbers")
        current = picture(live.cache, self.about, self._collapsed, everything=self._everything)
        if len(current.nodes) + len(current.topics) > BOXES and not self._collapsed:
            spaces = frozenset(n.rpartition("/")[0] for n in current.nodes if n.count("/") > 1)
            if spaces:
                self._collapsed = spaces
                current = picture(live.cache, self.about, self._collapsed, everything=self._everything)
        bad = {arrow.source for arrow in current.arrows if arrow.is_bad}
        labels = {t: f"{'✖ ' if t in bad else ''}{_label(t, live.numbers.published(t))}" for t in current.topics}
        wanted = (current, tuple(labels.values()), self._chosen, self.colours)
        if wanted == self._drawn:
            return
        self._drawn, self._picture = wanted, current
        self._draw(current, labels)

    def _draw(self, current: Picture, labels: dict[str, str]) -> None:
        boxes, colours = self._boxes, self.colours
        top, left = boxes.scroll_offset.y, boxes.scroll_offset.x
        if not current.nodes:
            boxes.replace([Text("no nodes yet", style=colours.dim)])
            return
        if len(current.nodes) + len(current.topics) > BOXES:
            many = f"{len(current.nodes)} nodes are too many to draw"
            text = f"{many}; give a namespace: {shown(self.console.prefix)} : graph /NAME"
            boxes.replace([Text(text, style=colours.warn)])
            return
        parts = {n: Box((n,)) for n in current.nodes} | {
            t: Box(tuple(labels[t].split("\n")), False) for t in current.topics
        }
        self._drawing = draw(parts, ((arrow.source, arrow.target) for arrow in current.arrows))
        boxes.wide = max((sum(len(cell.text) for cell in row) for row in self._drawing.rows), default=0)
        boxes.replace(_rows(self._drawing, current, self._chosen, colours))
        boxes.scroll_to(x=left, y=top, animate=False, immediate=True)

    def _names(self) -> list[str]:
        return [*self._picture.nodes, *self._picture.topics]

    def _step(self, step: int) -> None:
        names = self._names()
        if names:
            at = names.index(self._chosen) + step if self._chosen in names else 0
            self._chosen = names[at % len(names)]
            self.look(0.0)
            place = self._drawing.boxes.get(self._chosen)
            if place is not None:
                self._boxes.scroll_to_region(Region(*place), animate=False, immediate=True)

    def do_next_box(self) -> None:
        self._step(1)

    def do_previous_box(self) -> None:
        self._step(-1)

    def do_sideways(self, step: str) -> None:
        self._boxes.sideways(int(step))

    def do_open_box(self) -> None:
        if self._chosen in self._picture.topics:
            self.did(f"graphflow topic echo {self._chosen}")
            self.open("echo", self._chosen)
        elif self._chosen.endswith("/…"):
            self._collapsed -= {self._chosen.removesuffix("/…")}
            self.look(0.0)
        elif self._chosen:
            self.did(f"graphflow node info {self._chosen}")
            self.open("prompt", f"node info {self._chosen}", run=True)
        else:
            self.say("choose a box first: n, or a click")

    def do_collapse(self) -> None:
        space = self._chosen.rpartition("/")[0]
        if self._chosen in self._picture.nodes and space:
            self._collapsed ^= {space}
        else:
            self._collapsed = frozenset()
        self.look(0.0)

    def do_everything(self) -> None:
        self._everything = not self._everything
        self.look(0.0)

    def do_mermaid(self) -> None:
        self.console.copy(mermaid(self._picture), "the graph as Mermaid")

    def on_click(self, event: events.Click) -> None:
        row = event.screen_y - self._boxes.region.y + self._boxes.scroll_offset.y
        column = event.screen_x - self._boxes.region.x + self._boxes.scroll_offset.x
        for name, place in self._drawing.boxes.items():
            if place.contains(column, row):
                self._chosen = name
                self.look(0.0)


def _label(topic: str, rate: float | None) -> str:
    return topic if not rate else f"{topic}\n{rate:.1f} Hz"


def _rows(drawing: Drawing, current: Picture, chosen: str, colours: Colours) -> Iterator[Text]:
    """Return the drawing as one text per row."""
    topics = set(current.topics)
    bad = {arrow.source for arrow in current.arrows if arrow.is_bad}

    def style(cell: Cell) -> Style:
        if cell.box:
            base = (
                colours.bad
                if cell.box in bad & topics
                else colours.dim
                if cell.box in topics
                else colours.node(cell.box)
            )
            return base + colours.cursor + Style(bold=True) if cell.box == chosen else base
        if cell.arrow == chosen:
            return colours.accent
        return colours.bad if cell.arrow in bad else colours.dim

    for row in drawing.rows:
        text = Text(no_wrap=True)
        for cell in row:
            text.append(cell.text, style(cell))
        text.rstrip()
        yield text


VIEW = Graph

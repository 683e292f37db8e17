"""The tree of frames, with rates, ages and publishers; frames that no longer come are red."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.text import Text
from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.widget import Widget
from textual.widgets import Static

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.view import View

if TYPE_CHECKING:
    from graphflow.tf import FrameInfo, TransformBuffer

KEPT = 10.0
"""Seconds for which transforms are kept."""
LATE = 3.0
"""Periods without a transform after which a frame counts as stopped."""
LEAST = 1.0
"""Seconds below which no frame counts as stopped."""
SHOWN = 500
"""Frames that are drawn, at most."""


class FrameTree(View):
    """All frames, each below the one that it is placed in."""

    NAME = "tf"
    DOC = "the tree of frames: rates, ages, publishers; breaks in red"
    EVERY = 0.5
    LEAST_WIDTH = 40
    ACTIONS = (Action("clear", "forget all", keys=("C",), hint=True),)
    DEFAULT_CSS = """
    FrameTree Static { padding: 0 1; text-wrap: nowrap; text-overflow: ellipsis; }
    """
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._tf: TransformBuffer | None = None
        self._text = Static("")
        self._note = ""

    def compose(self) -> ComposeResult:
        with VerticalScroll():
            yield self._text

    @property
    def focus_target(self) -> Widget:
        return self

    @property
    def note(self) -> str:
        return self._note

    def look(self, now: float) -> None:
        if self._tf is None:
            self._begin()
        infos = self._tf.infos() if self._tf is not None else []
        if not infos:
            self._note = ""
            self._text.update(Text("no transforms yet: nothing is published on /tf or /tf_static", self.colours.dim))
            return
        self._text.update(self._drawn(infos[:SHOWN]))

    def _begin(self) -> None:
        from graphflow.runtime.node_core import core_of
        from graphflow.tf import TransformBuffer
        from graphflow.times import to_ns

        live = self.hub.live
        if live is not None and live.node is not None:
            self._tf = TransformBuffer(live.node, core_of(live.node), to_ns(KEPT), listen=True)

    def _drawn(self, infos: list[FrameInfo]) -> Text:
        from graphflow.tf.text import tree

        colours, stopped = self.colours, {info.frame for info in infos if is_stopped(info)}
        lines = tree({info.frame: info.parent for info in infos}, {info.frame: remark(info) for info in infos})
        roots = {info.parent for info in infos} - {info.frame for info in infos}
        parts = [f"{len(infos) + len(roots)} frames"]
        parts += [f"{len(stopped)} stopped"] if stopped else []
        parts += [f"{len(roots)} trees, not connected"] if len(roots) > 1 else []
        self._note = ", ".join(parts)
        text = Text()
        for line in lines:
            name, _, rest = line.partition("   (")
            frame = name.lstrip("│├└─ ")
            is_bad = frame in stopped or (len(roots) > 1 and frame in roots)
            shown = colours.match if self.about and frame == self.about else colours.bad if is_bad else colours.text
            text.append(name, shown)
            if rest:
                text.append(f"   {rest.removesuffix(')')}", colours.bad if is_bad else colours.dim)
            text.append("\n")
        return text

    def do_clear(self) -> None:
        self.closed()

    def closed(self) -> None:
        if self._tf is not None:
            self._tf.close()
            self._tf = None


def is_stopped(info: FrameInfo) -> bool:
    """Whether a frame no longer comes: its publisher has ended, or is silent for several periods."""
    if info.is_static:
        return False
    return not info.publisher or (info.silent > max(LEAST, LATE / info.rate) if info.rate else False)


def remark(info: FrameInfo) -> str:
    """Describe a frame's transforms: `30.0 Hz, by /odometry`, or that they have stopped."""
    by = f"by {info.publisher}" if info.publisher else "its publisher has ended"
    if info.is_static:
        return f"static, {by}"
    if is_stopped(info):
        return f"stopped {info.silent:.1f} s ago, {by}"
    return f"{info.rate:.1f} Hz, {by}" if info.rate else by


VIEW = FrameTree

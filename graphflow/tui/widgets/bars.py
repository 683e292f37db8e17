"""The bars at the bottom: the available keys, the windows, and the keys after the prefix."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Container, Iterable, Sequence
from typing import NamedTuple

from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.strip import Strip
from textual.widget import Widget

from graphflow.tui.commands.actions import console_actions, shown
from graphflow.tui.feeds.supervision import NodeRow
from graphflow.tui.view import ConsoleBase

MESSAGE_SECONDS = 6.0
"""Seconds for which a message replaces the hints."""
SEEN_AFTER = 1.5
"""Seconds after which a key dismisses a message."""


class StateMark(NamedTuple):
    """The glyph and style of a node's state; the state itself is always written beside it."""

    glyph: str
    colours: str


MARKS = {
    "ready": StateMark("●", "good"),
    "starting": StateMark("◐", "warn"),
    "restarting": StateMark("◐", "warn"),
    "unresponsive": StateMark("◍", "bad"),
    "resetting": StateMark("◐", "warn"),
    "waiting": StateMark("◷", "warn"),
    "stopping": StateMark("◑", "warn"),
    "pending": StateMark("◌", "dim"),
    "ended": StateMark("○", "dim"),
    "failed": StateMark("✖", "bad"),
    "given_up": StateMark("⊘", "bad"),
    "lost": StateMark("◇", "bad"),
    "foreign": StateMark("◆", "accent"),
    "active": StateMark("●", "good"),
    "inactive": StateMark("◒", "warn"),
    "unconfigured": StateMark("◌", "warn"),
    "finalized": StateMark("○", "dim"),
    "deadlock": StateMark("∞", "bad"),
}


def displayed_state(row: NodeRow, stuck: Container[str]) -> str:
    """Return the state of a node for display: that of its process, of its lifecycle, or `deadlock`.

    Args:
        row: Its row of `ps`.
        stuck: The nodes that are in a deadlock.
    """
    if row["node"] in stuck and row["state"] in ("ready", "unresponsive"):
        return "deadlock"
    return row["lifecycle"] or row["state"]


class Bar(Widget):
    """A bar of styled text."""

    @property
    def console_app(self) -> ConsoleBase:
        app = self.app
        assert isinstance(app, ConsoleBase)
        return app

    def pieces(self, y: int, width: int) -> list[tuple[str, Style]]:
        """Return the styled pieces of a line."""
        raise NotImplementedError

    def render_line(self, y: int) -> Strip:
        base = self.rich_style
        strip = Strip([Segment(text, base + style) for text, style in self.pieces(y, self.size.width)])
        return strip.crop_extend(0, self.size.width, base)


class Hints(Bar):
    """The keys available now, or for a while the latest message."""

    def __init__(self) -> None:
        super().__init__()
        self._message: tuple[str, str, float] | None = None

    def say(self, text: str, colours: str) -> None:
        """Show a message for a while. An error stays until it has been seen."""
        if colours == "text" and self._message is not None and self._message[1] == "bad":
            return
        self._message = (text, colours, time.monotonic() + MESSAGE_SECONDS)
        self.refresh()

    def look(self, now: float, *, pressed: bool = False) -> None:
        """Dismiss a message after its time, or at the first key once it has been seen."""
        if self._message is not None and now > self._message[2] - (MESSAGE_SECONDS - SEEN_AFTER if pressed else 0.0):
            self._message = None
            self.refresh()

    def pieces(self, y: int, width: int) -> list[tuple[str, Style]]:
        colours = self.console_app.colours
        if self._message is not None:
            text, name = self._message[0].replace("\n", " "), self._message[1]
            if len(text) > width - 1:
                more = f" … {shown(self.console_app.prefix)} ~ shows all"
                text = text[: max(0, width - 1 - len(more))] + more
            return [(" ", colours.text), (text, getattr(colours, name))]
        found: list[tuple[str, Style]] = [(" ", colours.text)]
        for _, key, title in self._shown(width):
            found += [(key, colours.accent), (f" {title}  ", colours.text)]
        return found

    def _shown(self, width: int) -> list[tuple[str, str, str]]:
        """Return name, key and title of the focused view's actions, as far as they fit."""
        view = self.console_app.focused_view
        room = width - 1
        found: list[tuple[str, str, str]] = []
        if view is None:
            return found
        for action in view.ACTIONS:
            if view.offers(action) and action.keys:
                label = action.label or f"{shown(action.keys[0])} {action.title}"
                key, _, title = label.partition(" ")
                room -= len(key) + len(title) + 3
                if room < 0:
                    break
                found.append((action.name, key, title))
        return found

    def on_click(self, event: events.Click) -> None:
        """Carry out the action under the mouse, or dismiss the message."""
        if self._message is not None:
            self._message = None
            self.refresh()
            return
        at = 1
        for name, key, title in self._shown(self.size.width):
            at += len(key) + len(title) + 3
            if event.x < at:
                view = self.console_app.focused_view
                if view is not None:
                    view.action_act(name)
                return


class Status(Bar):
    """The graph, its windows, the states of its nodes, and the two most important keys."""

    def pieces(self, y: int, width: int) -> list[tuple[str, Style]]:
        colours, states = self.console_app.colours, self._states()
        found = [(self._head, colours.strong), *(piece for _, piece in self._windows(width))]
        right = [*states, *self._keys()]
        if _width(found) + _width(right) > width:
            right = states
        return [*found, (" " * max(0, width - _width(found) - _width(right)), colours.text), *right]

    @property
    def _head(self) -> str:
        return f" [{self.console_app.hub.graph}] "

    def _windows(self, width: int) -> list[tuple[int, tuple[str, Style]]]:
        """Return the windows that fit beside the states, always including the current one, each with its number."""
        app, colours = self.console_app, self.console_app.colours
        windows = app.windows
        found = []
        for number, window in windows.windows.items():
            current = number == windows.current
            mark = "*" if current else "-" if number == windows.last else ""
            mark += "Z" if window.zoomed else ""
            mark += app.flags.get(number, "")
            style = colours.cursor + colours.strong if current else colours.dim
            found.append((number, (f" {number}:{window.name}{mark} ", style)))
        at = [number for number, _ in found].index(windows.current)
        room = width - len(self._head) - _width(self._states())
        first, last = _fitting([len(text) for _, (text, _) in found], at, room)
        more = [
            (found[i][0], (mark, colours.accent)) for i, mark in ((first - 1, "<"), (last, ">")) if 0 <= i < len(found)
        ]
        before, after = more[: first > 0], more[first > 0 :]
        return [*before, *found[first:last], *after]

    def _states(self) -> list[tuple[str, Style]]:
        app, colours = self.console_app, self.console_app.colours
        supervision = app.hub.supervision
        found: list[tuple[str, Style]] = []
        if supervision is None:
            return [("no supervisor here ", colours.warn)]
        if supervision.exit_code is not None:
            return [
                (
                    f"ended, exit code {supervision.exit_code} ",
                    colours.bad if supervision.exit_code else colours.warn,
                )
            ]
        if supervision.is_lost:
            return [("✖ supervisor gone ", colours.bad)]
        live, logs = app.hub.live, app.hub.logs
        stuck = live.stuck_nodes if live is not None else ()
        counts = Counter(displayed_state(row, stuck) for row in supervision.nodes.values())
        for state, mark in MARKS.items():
            if counts[state]:
                found.append((f"{mark.glyph}{counts[state]} ", getattr(colours, mark.colours)))
        errors = sum(app.hub.unseen(node)[0] for node in logs.errors)
        if errors:
            found.append((f"E{errors} {shown(app.prefix)} e ", colours.bad))
        if logs.races:
            many = "S" if len(logs.races) > 1 else ""
            found.append((f"⇄{len(logs.races)} RACE{many} {shown(app.prefix)} g ", colours.warn))
        if live is not None and live.misfits:
            found.append((f"≠{len(live.misfits)} ", colours.bad))
        if app.deadlocks:
            many = "S" if app.deadlocks > 1 else ""
            found.append((f"✖ {app.deadlocks} DEADLOCK{many} {shown(app.prefix)} g ", colours.bad))
        return found

    def _keys(self) -> list[tuple[str, Style]]:
        colours, prefix = self.console_app.colours, shown(self.console_app.prefix)
        return [
            (f" {prefix} ?", colours.accent),
            (" help ", colours.text),
            (f" {prefix} d", colours.accent),
            (" leave ", colours.text),
        ]

    def on_click(self, event: events.Click) -> None:
        at = len(self._head)
        for number, (text, _) in self._windows(self.size.width):
            at += len(text)
            if event.x < at:
                self.console_app.commands.go_to_window(number)
                return
        from_right = self.size.width - event.x
        leave = len(self._keys()[2][0] + self._keys()[3][0])
        if from_right <= leave:
            self.console_app.commands.do_detach()
        elif from_right <= leave + len(self._keys()[0][0] + self._keys()[1][0]):
            self.console_app.commands.do_help()
        elif self.console_app.deadlocks or self.console_app.hub.logs.races:
            self.console_app.commands.do_groups()


def _width(pieces: Iterable[tuple[str, Style]]) -> int:
    return sum(len(text) for text, _ in pieces)


def _fitting(widths: Sequence[int], at: int, room: int) -> tuple[int, int]:
    """Return the range of neighbours that fit, as first and last (exclusive), with a mark where some are left out."""
    first, last = 0, len(widths)
    while last - first > 1 and sum(widths[first:last]) + (first > 0) + (last < len(widths)) > room:
        if at - first > last - 1 - at:
            first += 1
        else:
            last -= 1
    return first, last


class WhichKey(Bar):
    """The keys after the prefix, shown if the next key does not follow soon."""

    def on_mount(self) -> None:
        self.display = False

    def open(self) -> None:
        """Show the bar, with as many lines as needed."""
        self.styles.height = min(self._rows(), max(4, self.app.size.height - 4))
        self.display = True

    def _entries(self) -> list[tuple[str, str]]:
        found: dict[str, list[str]] = {}
        for action in console_actions():
            if action.short:
                found.setdefault(action.short, []).extend(map(shown, action.chord))
        return [(_joined(keys), short) for short, keys in found.items()]

    def _columns(self) -> int:
        return max(1, self.app.size.width // 16)

    def _rows(self) -> int:
        return math.ceil(len(self._entries()) / self._columns())

    def pieces(self, y: int, width: int) -> list[tuple[str, Style]]:
        colours, entries, rows = self.console_app.colours, self._entries(), self._rows()
        room = width // self._columns()
        found: list[tuple[str, Style]] = []
        for key, short in entries[y::rows]:
            found += [(f" {key}", colours.accent), (f" {short}".ljust(room - len(key) - 1), colours.text)]
        return found


def _joined(keys: list[str]) -> str:
    """Join the keys of one entry: digits as a range, others one after the other."""
    return "0-9" if len(keys) == 10 else "".join(keys)

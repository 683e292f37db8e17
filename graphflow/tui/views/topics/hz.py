"""The rate of a topic, its jitter and its losses."""

from __future__ import annotations

import itertools
import statistics
import time
from collections import deque

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Sparkline, Static

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.view import View

WINDOW = 5.0
"""Seconds over which the rate is averaged."""
HISTORY = 120
"""Half seconds of the rate's history."""


class Hz(View):
    """The rate of a topic."""

    NAME = "hz"
    DOC = "how fast a topic is, how evenly, what got lost"
    EVERY = 0.5
    ACTIONS = (
        Action("echo", "echo", keys=("e", "enter"), verb="graphflow topic echo {topic}", hint=True),
        Action("plot", "plot", keys=("p",), hint=True),
    )
    DEFAULT_CSS = """
    Hz Sparkline { height: 1fr; max-height: 6; margin: 1 1 0 1; }
    Hz Sparkline > .sparkline--max-color { color: $primary; }
    Hz Sparkline > .sparkline--min-color { color: $primary; }
    Hz Static { height: auto; padding: 0 1; }
    """
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._monitor: TopicMonitor | None = None
        self._history: deque[float] = deque([0.0] * HISTORY, maxlen=HISTORY)
        self._counted = 0
        self._at = 0.0
        self._line = Sparkline(list(self._history), summary_function=max)
        self._words = Static("")

    def compose(self) -> ComposeResult:
        yield self._line
        yield self._words

    @property
    def focus_target(self) -> Widget:
        return self

    def chosen(self) -> dict[str, str]:
        return {"topic": self.about}

    @property
    def note(self) -> str:
        rates = list(itertools.islice(reversed(self._history), 4))
        return f"{sum(rates) / len(rates):.1f} Hz"

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None:
            return
        if self._monitor is None:
            self._monitor = TopicMonitor(live, self.about)
        monitor = self._monitor
        monitor.look()
        if monitor.trouble:
            self._words.update(Text(monitor.trouble, style=self.colours.warn))
            return
        if self._at:
            self._history.append((monitor.count - self._counted) / (now - self._at))
            self._line.data = list(self._history)
        self._counted, self._at = monitor.count, now
        self._words.update(self._numbers(monitor))

    def _numbers(self, monitor: TopicMonitor) -> Text:
        colours = self.colours
        since = time.monotonic() - WINDOW
        arrivals = [at for at in monitor.arrivals if at > since]
        gaps = [b - a for a, b in itertools.pairwise(arrivals)]
        text = Text()
        if gaps:
            mean = statistics.fmean(gaps)
            text.append(f"average rate {1 / mean if mean else 0.0:.2f} Hz\n", style=colours.strong)
            text.append(f"min {_ms(min(gaps))}   max {_ms(max(gaps))}   jitter {_ms(statistics.pstdev(gaps))}   ")
            text.append(f"over {len(arrivals)} messages\n", style=colours.dim)
        elif monitor.count:
            text.append(f"nothing for {WINDOW:g} s, {monitor.count} messages before\n", style=colours.warn)
        else:
            text.append("no message yet\n", style=colours.dim)
        text.append(f"{monitor.lost} lost on the way", style=colours.bad if monitor.lost else colours.dim)
        text.append(
            f"   {monitor.dropped} came too fast to be shown",
            style=colours.warn if monitor.dropped else colours.dim,
        )
        return text

    def do_echo(self) -> None:
        self.open("echo", self.about)

    def do_plot(self) -> None:
        self.open("plot", self.about)

    def closed(self) -> None:
        if self._monitor is not None:
            self._monitor.close()


def _ms(seconds: float) -> str:
    return f"{seconds * 1000:.1f} ms"


VIEW = Hz

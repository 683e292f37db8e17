"""The end of a node: its exit status, traceback and last output, and how to start it again."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget

from graphflow.times import ago
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import Logs, Record
from graphflow.tui.feeds.supervision import NodeRow
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.views.source import edit, find_file
from graphflow.tui.widgets.bars import MARKS
from graphflow.tui.widgets.line_view import LineView
from graphflow.workspace.project import INSTALLED_DEMOS, PACKAGE

LAST_LINES = 20
_LIBRARY = re.compile(r"/lib\d*/python3|/(site|dist)-packages/")
"""Matches the path of files that are not the user's own."""
_FRAME = re.compile(r'File "([^"]+)", line (\d+)')


class Crash(View):
    """The evidence of a crash."""

    NAME = "crash"
    DOC = "how a node ended, its traceback and last words"
    LEAST_WIDTH = 48
    EVERY = 1.0
    ACTIONS = (
        Action("restart", "restart", keys=("r",), verb="graphflow restart {node}", hint=True),
        Action("edit", "open the line in $EDITOR", keys=("e",), hint=True),
        Action("source", "show the line", keys=("enter",), hint=True),
        Action("log", "whole log", keys=("l",), verb="graphflow logs {node}", hint=True),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._lines = LineView[Text](2000, wraps=True, copies=True)
        self._lines.follows = False
        self._seen: object = None
        self._own: Logs | None = None
        """The node's log, read from its file."""

    def compose(self) -> ComposeResult:
        yield self._lines

    @property
    def focus_target(self) -> Widget:
        return self._lines

    def chosen(self) -> dict[str, str]:
        return {"node": self.about}

    def look(self, now: float) -> None:
        supervision = self.hub.supervision
        row = supervision.nodes.get(self.about) if supervision is not None else None
        self._own = self._own or self.hub.own_logs(self.about)
        if self._own is not None:
            self._own.read()
        seen = (row and (row["state"], row["detail"], row["restarts"]), self._logs.total, int(now))
        if seen != self._seen:
            self._seen = seen
            self._lines.replace(list(self._rows(row)))

    def _rows(self, row: NodeRow | None) -> Iterator[Text]:
        colours = self.colours
        if row is None:
            yield Text(f"{self.about} is not a node of this graph", style=colours.warn)
            return
        state = row["state"]
        mark = MARKS[state]
        since = ago(time.time() - row["since"])
        yield Text.assemble(
            (f"{mark.glyph} {self.about} {state}", getattr(colours, mark.colours)),
            (f", {since} ago", colours.dim),
        )
        if row["detail"]:
            yield Text(f"  {row['detail']}", style=colours.bad)
        process = f"process {row['pid']}" if row["pid"] else "no process"
        yield Text(f"  {process}, restarts: {row['restarts'] or 'none'}", style=colours.dim)
        yield Text(f"  {row['log']}", style=colours.dim)
        records = self._records()
        trace = traceback_of(records)
        if trace:
            yield Text("")
            yield Text("the traceback, your own lines marked", style=colours.strong)
            for record in trace:
                own = _is_own(record.text)
                yield Text(f"{'▌' if own else ' '} {record.text}", style=colours.bad if own else colours.dim)
        yield Text("")
        yield Text(f"its last {LAST_LINES} lines", style=colours.strong)
        for record in records[-LAST_LINES:]:
            yield Text(f"  {record.text}", style=colours.level(record.level))

    @property
    def _logs(self) -> Logs:
        return self._own or self.hub.logs

    def _records(self) -> list[Record]:
        return [record for record in self._logs.since(0) if record.node == self.about]

    def _place(self) -> tuple[str, int] | None:
        """Return the innermost frame of the traceback in the user's code, otherwise the innermost."""
        trace = traceback_of(self._records())
        frames = [(m[1], int(m[2])) for record in trace if (m := _FRAME.search(record.text))]
        own = [frame for frame in frames if _is_own(f'File "{frame[0]}"')]
        return (own or frames)[-1] if frames else None

    def do_restart(self) -> None:
        self.console.commands.restart(self.about)

    def do_edit(self) -> None:
        place = self._place()
        file = find_file(place[0], []) if place is not None else None
        if place is None or file is None:
            self.say("the log names no line of source")
            return
        edit(self, file, place[1])

    def do_source(self) -> None:
        place = self._place()
        if place is None:
            self.say("the log names no line of source")
        else:
            self.open("source", f"{place[0]}:{place[1]}")

    def do_log(self) -> None:
        self.open("log", self.about)


def traceback_of(records: list[Record]) -> list[Record]:
    """Return the lines of the last traceback among a node's records."""
    start = next((i for i in range(len(records) - 1, -1, -1) if records[i].text.startswith("Traceback (most")), None)
    if start is None:
        return []
    found = [records[start]]
    for record in records[start + 1 :]:
        found.append(record)
        if record.text and not record.text.startswith((" ", "\t")):
            break
    return found


def _is_own(text: str) -> bool:
    found = _FRAME.search(text + ", line 0")
    if found is None:
        return False
    path = found[1]
    is_graphflow = path.startswith(f"{PACKAGE}/") and not path.startswith(f"{INSTALLED_DEMOS}/")
    return not (is_graphflow or path.startswith("<") or _LIBRARY.search(path))


VIEW = Crash

"""The logs: of all nodes in the order of time, of one node, or of those below a namespace."""

from __future__ import annotations

import re
import time
from collections.abc import Iterable

from rich.style import Style
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Input

from graphflow.tui.actions import Action
from graphflow.tui.hub import Hub
from graphflow.tui.lines import KEPT, Lines
from graphflow.tui.logs import LEVELS, Record
from graphflow.tui.panes import Content
from graphflow.tui.view import View

_PLACE = re.compile(r'(?:File "([^"]+)", line (\d+))|((?:[\w./-]+/)?[\w-]+\.(?:py|yaml)):(\d+)')
_NAME_WIDTH = 18


class LogLines(Lines):
    """The records, each on one line."""

    def __init__(self, log: Log) -> None:
        super().__init__(KEPT, wraps=bool(log.options.get("wrap")))
        self._log = log

    def draw(self, row: Record) -> Iterable[tuple[str, Style]]:
        ink, log = self.ink, self._log
        if row.is_more:
            yield " " * log.indent, ink.dim
        else:
            if log.size.width > 60:
                yield f"{time.strftime('%H:%M:%S', time.localtime(row.stamp))} ", ink.dim
            if log.shows_names:
                name = row.node if len(row.node) <= log.name_width else "…" + row.node[1 - log.name_width :]
                yield f"{name.ljust(log.name_width)} ", ink.node(row.node)
            if row.level >= 2:
                yield f"{LEVELS[row.level]} ", ink.level(row.level)
        text, style = row.text, ink.level(row.level)
        found = log.pattern.search(text) if log.pattern is not None else None
        if found is None or found.end() == found.start():
            yield text, style
        else:
            yield text[: found.start()], style
            yield found.group(), ink.match
            yield text[found.end() :], style


class Log(View):
    """What nodes have written."""

    NAME = "log"
    DOC = "what nodes have written: all, one node, or a namespace"
    EVERY = 0.1
    ACTIONS = (
        Action("filter", "filter", keys=("slash",), verb="graphflow logs {node}", hint=True),
        Action("follow", "follow", keys=("f",), hint=True),
        Action("level:0", "debug and up", keys=("1",)),
        Action("level:1", "info and up", keys=("2",)),
        Action("level:2", "warnings and up", keys=("3",), hint=True),
        Action("level:3", "errors and up", keys=("4",)),
        Action("level:4", "fatal", keys=("5",)),
        Action("source", "go to the line of source", keys=("enter",), hint=True),
        Action("next_match", "next match", keys=("n",)),
        Action("previous_match", "previous match", keys=("N",)),
        Action("wrap", "wrap long lines", keys=("w",)),
        Action("mute", "mute the node, or not", keys=("m",)),
        Action("only", "only this node", keys=("o",)),
        Action("copy", "copy the line", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        level = str(self.options.get("level", "")).upper()
        self.level = LEVELS.index(level) if level in LEVELS else 0
        self.pattern: re.Pattern[str] | None = None
        self.name_width = 4
        self._lines = LogLines(self)
        self._filter = Input(str(self.options.get("filter", "")), placeholder="regular expression", classes="find")
        self._read = 0
        """Number of the first record that has not been looked at."""
        self._bad = ""
        self._muted: frozenset[str] = frozenset()

    def compose(self) -> ComposeResult:
        yield self._lines
        yield self._filter

    def on_mount(self) -> None:
        self._compile(self._filter.value)
        self._lines.follows = bool(self.options.get("follow", True))

    @property
    def title(self) -> str:
        return f"log {self.about or 'of all nodes'}"

    @property
    def note(self) -> str:
        words = []
        if self._bad:
            words.append(self._bad)
        elif self.pattern is not None:
            words.append(f"/{self.pattern.pattern}/")
        if self.level:
            words.append(f"{LEVELS[self.level].lower()}+")
        if self.hub.muted and not self.about:
            words.append(f"{len(self.hub.muted)} muted")
        words.append("follow ▼" if self._lines.follows else f"{len(self._lines.rows)} lines, f follows")
        return " ".join(words)

    @property
    def shows_names(self) -> bool:
        return not self.about or self.about.endswith("/") or self.about not in self.hub.logs.counts

    @property
    def indent(self) -> int:
        return (9 if self.size.width > 60 else 0) + (self.name_width + 1 if self.shows_names else 0)

    def look(self, now: float) -> None:
        logs = self.hub.logs
        if self._muted != frozenset(self.hub.muted) and not self.about:
            self._again()
        widest = max((len(name) for name in logs.counts), default=4)
        width = min(widest, _NAME_WIDTH if self.size.width < 100 else 30)
        if width != self.name_width:
            self.name_width = width
            self._lines.refresh()
        if logs.total == self._read:
            return
        fresh = [record for record in logs.since(self._read) if self._fits(record)]
        self._read = logs.total
        if fresh:
            self._lines.extend(fresh)

    def _fits(self, record: Record) -> bool:
        if record.level < self.level:
            return False
        if self.about:
            if record.node != self.about and not record.node.startswith(self.about.rstrip("/") + "/"):
                return False
        elif record.node in self._muted:
            return False
        return self.pattern is None or self.pattern.search(record.text) is not None

    def _again(self) -> None:
        """Look at all records once more: what is shown has changed."""
        self._muted = frozenset(self.hub.muted)
        self._lines.replace([r for r in self.hub.logs.since(0) if self._fits(r)])
        self._read = self.hub.logs.total

    def _compile(self, text: str) -> None:
        try:
            self.pattern, self._bad = re.compile(text, re.IGNORECASE) if text else None, ""
        except re.error as error:
            self._bad = f"not a regular expression: {error}"
            return
        self.options["filter"] = text
        if not text:
            self.options.pop("filter")
        self._again()

    def on_input_changed(self, event: Input.Changed) -> None:
        event.stop()
        if len(event.value) <= 200:
            self._compile(event.value)

    def on_input_submitted(self) -> None:
        self._lines.focus()

    def key_escape(self) -> None:
        """Take the filter away."""
        self._filter.value = ""
        self._filter.remove_class("shown")
        self._lines.focus()

    @property
    def heart(self) -> Widget:
        return self._lines

    def chosen(self) -> dict[str, str]:
        record = self._chosen()
        node = record.node if record is not None else self.about
        return {"node": node} if node else {}

    def _chosen(self) -> Record | None:
        record: Record | None = self._lines.chosen
        return record

    # actions

    def do_filter(self) -> None:
        self._filter.add_class("shown")
        self._filter.focus()

    def do_follow(self) -> None:
        if self._lines.follows:
            self._lines.hold()
        else:
            self._lines.action_bottom()

    def do_level(self, level: str) -> None:
        self.level = int(level)
        self.options["level"] = LEVELS[self.level].lower()
        self._again()

    def do_source(self) -> None:
        record = self._chosen()
        if record is None:
            self.say("choose a line first: ↑ or a click")
            return
        self.work(lambda: self._open_source(record), group="source")

    async def _open_source(self, record: Record) -> None:
        found = place_in(record.text)
        if found is None and self.hub.live is not None:
            found = await self.hub.live.source_of(record.stamp, record.text)
        if found is None:
            self.say("nobody has told where this line was written: it is older than this console, or a print")
        else:
            self.open("source", found)

    def do_next_match(self) -> None:
        self._go_to_match(1)

    def do_previous_match(self) -> None:
        self._go_to_match(-1)

    def _go_to_match(self, step: int) -> None:
        """Without a filter that hides the rest: warnings and errors, the marks in a long log."""
        lines = self._lines
        at = lines.cursor if lines.cursor is not None else len(lines.rows) - (step > 0)
        for i in range(at + step, len(lines.rows) if step > 0 else -1, step):
            record = lines.row_that_begins(i)
            if isinstance(record, Record) and (self.pattern is not None or record.level >= 2):
                lines.hold()
                lines.cursor = i
                lines.show_row(i)
                return
        self.say("no more " + ("matches" if self.pattern is not None else "warnings or errors"))

    def do_wrap(self) -> None:
        self.options["wrap"] = not self._lines.wraps
        self._lines.wrap(not self._lines.wraps)

    def do_mute(self) -> None:
        self.console.deeds.do_mute_node()

    def do_only(self) -> None:
        record = self._chosen()
        if record is not None:
            self.open("log", record.node)

    def do_copy(self) -> None:
        record = self._chosen()
        if record is None:
            self.say("choose a line first: ↑ or a click")
        else:
            self.console.copy_to_clipboard(record.text)
            self.say("copied the line")


def place_in(text: str) -> str | None:
    """The file and line that a line of a log names: `nodes/arrival.py:41`; None for none."""
    found = _PLACE.search(text)
    if found is None:
        return None
    return f"{found[1]}:{found[2]}" if found[1] else f"{found[3]}:{found[4]}"


VIEW = Log

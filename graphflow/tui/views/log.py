"""Log records: of all nodes merged by time, of one node, or of a namespace."""

from __future__ import annotations

import re
import time
from collections.abc import Iterable, Iterator

from rich.style import Style
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Input

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import LEVELS, WARNING, Logs, Record
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.line_view import KEPT, LineView

_PLACE = re.compile(r'(?:File "([^"]+)", line (\d+))|((?:[\w./-]+/)?[\w-]+\.(?:py|yaml)):(\d+)')
_NAME_WIDTH = 18
MORE_ROOM, MORE_INDENT = 60, 2
"""Minimum columns beside the names for a report's further lines; with fewer, they begin at column MORE_INDENT."""


class LogLines(LineView[Record]):
    """Records, one line each."""

    HAS_SEARCH = False

    def __init__(self, log: Log) -> None:
        super().__init__(KEPT, wraps=bool(log.options.get("wrap", True)))
        self._log = log

    def hanging(self, row: Record) -> int | None:
        indent, text = self._indented(row)
        return indent + len(text) - len(text.lstrip(" "))

    def _indented(self, row: Record) -> tuple[int, str]:
        """Return the column at which a record begins, and its text; in little room, further lines move to the left."""
        if not row.is_more or self._log.size.width - self._log.indent >= MORE_ROOM:
            return self._log.indent, row.text
        text = row.text.lstrip(" ")
        return MORE_INDENT, " " * ((len(row.text) - len(text)) // 2) + text

    def draw(self, row: Record) -> Iterable[tuple[str, Style]]:
        colours, log = self.colours, self._log
        indent, text = self._indented(row)
        if row.is_more:
            yield " " * indent, colours.dim
        else:
            if log.size.width > 60:
                yield f"{time.strftime('%H:%M:%S', time.localtime(row.stamp))} ", colours.dim
            if log.shows_names:
                name = row.node if len(row.node) <= log.name_width else "…" + row.node[1 - log.name_width :]
                yield f"{name.ljust(log.name_width)} ", colours.node(row.node)
            if row.level >= 2:
                yield f"{LEVELS[row.level]} ", colours.level(row.level)
        style = colours.level(row.level)
        found = log.pattern.search(text) if log.pattern is not None else None
        if found is None or found.end() == found.start():
            yield text, style
        else:
            yield text[: found.start()], style
            yield found.group(), colours.match
            yield text[found.end() :], style
        if row.times > 1:
            yield f"  x{row.times}", colours.accent


class Log(View):
    """Log records."""

    NAME = "log"
    DOC = "the logs of all nodes, of one, or of a namespace"
    LEAST_WIDTH = 40
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
        self._own: Logs | None = None
        """The records of one node or namespace, read from its own files, so that no other node displaces them."""
        self._read = 0
        """The index of the first unread record."""
        self._goes_to = str(self.options.pop("at", ""))
        """The record to go to first, by file and offset."""
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
        if self._source.lost and self.level < WARNING:
            words.append(f"{self._source.lost:,} older ones gone{'' if self.about else ', o shows one node'}")
        lines = len(self._lines.rows)
        words.append("follow ▼" if self._lines.follows else f"{lines} line{'' if lines == 1 else 's'}, f follows")
        return " ".join(words)

    @property
    def _source(self) -> Logs:
        return self._own or self.hub.logs

    @property
    def shows_names(self) -> bool:
        return not self.about or self.about.endswith("/") or self.about not in self.hub.logs.counts

    @property
    def indent(self) -> int:
        return (9 if self.size.width > 60 else 0) + (self.name_width + 1 if self.shows_names else 0)

    def look(self, now: float) -> None:
        if self.about and self._own is None and (own := self.hub.own_logs(self.about)) is not None:
            self._own, self._read = own, 0
            self._lines.replace([])
        if self._own is not None:
            self._own.read()
        logs = self._source
        if self.about in self.hub.nodes():
            self.hub.seen[self.about] = (self.hub.logs.errors[self.about], self.hub.logs.warnings[self.about])
        if self._muted != frozenset(self.hub.muted) and not self.about:
            self._again()
        widest = max((len(name) for name in logs.counts), default=4)
        width = min(widest, _NAME_WIDTH if self.size.width < 100 else 30)
        if width != self.name_width:
            self.name_width = width
            self._lines.wrap(self._lines.wraps)
        if logs.total == self._read:
            return
        fresh = [record for record in logs.since(self._read) if self._fits(record)]
        self._read = logs.total
        self._add(fresh)
        if self._goes_to:
            self._go_to_record()

    def reopened(self, content: Content) -> None:
        self._goes_to = str(content.options.get("at", ""))
        self._go_to_record()

    def _add(self, fresh: list[Record]) -> None:
        """Append records; consecutive repetitions only once."""
        lines = self._lines
        folded = list(_folded(fresh))
        last = lines.last_row
        if folded and isinstance(last, Record) and folded[0].repeats(last):
            times = last.times + folded.pop(0).times
            lines.replace_last(last._replace(times=times))
        if folded:
            lines.extend(folded)

    def _go_to_record(self) -> None:
        """Move the cursor to the requested record, once it has been read."""
        lines = self._lines
        for i in range(len(lines.rows)):
            record = lines.row_that_begins(i)
            if isinstance(record, Record) and f"{record.file}:{record.offset}" == self._goes_to:
                self._goes_to = ""
                lines.hold()
                lines.cursor = i
                lines.scroll_to(y=max(0, i - 2), animate=False, immediate=True)
                return

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
        """Read all records again after a change of filter."""
        self._muted = frozenset(self.hub.muted)
        source = self._source
        kept = source.serious if self.level >= WARNING else source.since(0)
        self._lines.replace(_folded([record for record in kept if self._fits(record)]))
        self._read = source.total

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
        """Clear the filter."""
        self._filter.value = ""
        self._filter.remove_class("shown")
        self._lines.focus()

    @property
    def focus_target(self) -> Widget:
        return self._lines

    def chosen(self) -> dict[str, str]:
        record = self._chosen()
        node = record.node if record is not None else self.about
        return {"node": node} if node else {}

    def _chosen(self) -> Record | None:
        return self._lines.chosen

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
            self.say("the source of this line is unknown: it is older than this console, or printed")
        else:
            self.open("source", found)

    def do_next_match(self) -> None:
        self._go_to_match(1)

    def do_previous_match(self) -> None:
        self._go_to_match(-1)

    def _go_to_match(self, step: int) -> None:
        """Go to the next match of the filter or, without a filter, to the next warning or error."""
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
        self.console.commands.do_mute_node()

    def do_only(self) -> None:
        record = self._chosen()
        if record is not None:
            self.open("log", record.node)

    def do_copy(self) -> None:
        record = self._chosen()
        if record is None:
            self.say("choose a line first: ↑ or a click")
        else:
            self.console.copy(record.text, "the line")


def _folded(records: Iterable[Record]) -> Iterator[Record]:
    """Merge consecutive equal records, counting them in the first."""
    last: Record | None = None
    for record in records:
        if last is not None and record.repeats(last):
            last = last._replace(times=last.times + record.times)
            continue
        if last is not None:
            yield last
        last = record
    if last is not None:
        yield last


def place_in(text: str) -> str | None:
    """Return the file and line that a log line contains, such as `nodes/arrival.py:41`; None if there is none."""
    found = _PLACE.search(text)
    if found is None:
        return None
    return f"{found[1]}:{found[2]}" if found[1] else f"{found[3]}:{found[4]}"


VIEW = Log

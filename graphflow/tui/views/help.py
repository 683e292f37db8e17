"""All keys of the console and of its views, from the table of actions, with a search."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Input

from graphflow.console.views import known_views
from graphflow.tui.commands.actions import CONSOLE, Action, keys_of, shown
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.registry import view_class
from graphflow.tui.view import View
from graphflow.tui.widgets.line_view import LineView

KEYS_WIDTH = 22
"""Columns of the keys."""
_SCROLL = {"up": -1, "down": 1, "pageup": -10, "pagedown": 10}


class KeyLines(LineView[Text]):
    """Keys in a column, and their descriptions, wrapped if needed."""

    def hanging(self, row: Text) -> int | None:
        return KEYS_WIDTH + 3 if row.plain.startswith("  ") else None


class Help(View):
    """All keys, beginning with those of the view that opened the help: the option `first`."""

    NAME = "help"
    DOC = "all keys of the console and of every view"

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._first = str(self.options.pop("first", ""))
        self._find = Input(placeholder="type to find a key or what it does; ↑↓ scroll")
        self._lines = KeyLines(wraps=True)

    def compose(self) -> ComposeResult:
        yield self._find
        yield self._lines

    def on_mount(self) -> None:
        self._lines.follows = False
        self._show("")

    def restyle(self) -> None:
        self._show(self._find.value)

    def _show(self, wanted: str) -> None:
        rows = list(self._rows(wanted.lower().strip()))
        self._lines.replace(rows or [Text(f"no match for {wanted!r}", style=self.colours.warn)])
        self._lines.scroll_home(animate=False, immediate=True)

    def on_input_changed(self, event: Input.Changed) -> None:
        event.stop()
        self._show(event.value)

    def on_key(self, event: events.Key) -> None:
        if event.key in _SCROLL and self._find.has_focus:
            event.stop()
            self._lines.scroll_relative(y=_SCROLL[event.key], animate=False, immediate=True)

    def _rows(self, wanted: str) -> Iterator[Text]:
        colours, prefix = self.colours, self.console.prefix
        if not wanted:
            yield Text.assemble(
                ("The prefix is ", colours.text),
                (shown(prefix), colours.accent),
                (": press it, let go, then the key.", colours.text),
            )
        names = [*(name for name in known_views() if name == self._first)]
        for name in names:
            yield from self._view(name, wanted)
        for section, actions in CONSOLE.items():
            yield from self._section(Text(section, style=colours.strong), actions, wanted)
        for name in known_views():
            if name not in names:
                yield from self._view(name, wanted)

    def _view(self, name: str, wanted: str) -> Iterator[Text]:
        view, colours = view_class(name), self.colours
        head = Text.assemble((f"View {name}", colours.strong), (f"   {view.DOC}", colours.dim))
        yield from self._section(head, view.ACTIONS, wanted, show_empty=not wanted)

    def _section(
        self, head: Text, actions: Iterable[Action], wanted: str, *, show_empty: bool = False
    ) -> Iterator[Text]:
        """Return a heading and the actions that match the search; empty if none does."""
        rows = [self._row(keys_of(a, self.console.prefix), a.title, a.verb) for a in actions]
        rows = [row for row in rows if wanted in row.plain.lower() or wanted in head.plain.lower()]
        if rows or show_empty:
            yield from (Text(""), head, *rows)

    def _row(self, keys: str, title: str, shell: str) -> Text:
        colours = self.colours
        text = Text.assemble((f"  {keys:{KEYS_WIDTH}}", colours.accent), (f" {title}", colours.text))
        if shell:
            text.append(f"   $ {shell}", style=colours.dim)
        return text

    @property
    def focus_target(self) -> Widget:
        return self._find


VIEW = Help

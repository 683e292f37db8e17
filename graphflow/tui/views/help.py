"""All keys: the console's and those of every view, from the one table they are made of."""

from __future__ import annotations

from collections.abc import Iterator

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget

from graphflow.graph.console import known_views
from graphflow.tui.actions import CONSOLE, keys_of, shown
from graphflow.tui.lines import Lines
from graphflow.tui.registry import view_class
from graphflow.tui.view import View


class Help(View):
    """All keys."""

    NAME = "help"
    DOC = "all keys of the console and of every view"

    def compose(self) -> ComposeResult:
        self._lines = Lines()
        yield self._lines

    def on_mount(self) -> None:
        self._lines.follows = False
        self._lines.replace(list(self._rows()))

    def _rows(self) -> Iterator[Text]:
        ink, prefix = self.ink, self.console.prefix
        yield Text.assemble(
            ("The prefix is ", ink.text), (shown(prefix), ink.accent), (": press it, let go, then the key.", ink.text)
        )
        for section, actions in CONSOLE.items():
            yield Text("")
            yield Text(section, style=ink.strong)
            for action in actions:
                yield self._row(keys_of(action, prefix), action.title, action.verb)
        for name in known_views():
            view = view_class(name)
            yield Text("")
            yield Text.assemble((f"View {name}", ink.strong), (f"   {view.DOC}", ink.dim))
            for action in view.ACTIONS:
                yield self._row(keys_of(action, prefix), action.title, action.verb)

    def _row(self, keys: str, title: str, shell: str) -> Text:
        ink = self.ink
        text = Text.assemble((f"  {keys:22}", ink.accent), (f" {title}", ink.text))
        if shell:
            text.append(f"   $ {shell}", style=ink.dim)
        return text

    @property
    def heart(self) -> Widget:
        return self._lines


VIEW = Help

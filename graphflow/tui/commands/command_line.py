"""The command line of the console: a verb of graphflow, or a command of the console's own."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Input, Label, Static

from graphflow.console.views import VIEWS
from graphflow.tui.commands.completion import Completer, completed, nothing_to_complete
from graphflow.tui.feeds.hub import Hub

ADVICE = "tab completes, ↑ recalls, enter runs it in a pane, esc back"


class CommandLine(ModalScreen[str | None]):
    """One line, completed by tab. The result is the text."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", show=False),
        Binding("tab", "complete", show=False, priority=True),
        Binding("up", "recall(-1)", show=False),
        Binding("down", "recall(1)", show=False),
    ]

    def __init__(self, hub: Hub) -> None:
        super().__init__()
        self._history = hub.history
        self._completer = Completer(hub, VIEWS)
        self._at = len(hub.history.lines)

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog wide"):
            yield Label("Any verb of graphflow; or a view, layout NAME, save-layout, quit", classes="question")
            yield Input(placeholder="topic echo /turtle1/pose")
            yield Static(ADVICE, classes="detail")

    def action_recall(self, step: int) -> None:
        past = self._history.lines
        self._at = max(0, min(len(past), self._at + step))
        self.query_one(Input).value = past[self._at] if self._at < len(past) else ""

    def action_complete(self) -> None:
        self.run_worker(self._complete(), exclusive=True)

    async def _complete(self) -> None:
        text, choices = await completed(self.query_one(Input), self._completer)
        shown = "  ".join(choices[:40]) if len(choices) > 1 else ADVICE
        self.query_one(".detail", Static).update(shown if choices else nothing_to_complete(text))

    def on_input_submitted(self, event: Input.Submitted) -> None:
        self._history.add(event.value)
        self.dismiss(event.value)

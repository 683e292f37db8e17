"""The substitute for a view that cannot be shown."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.widgets import Static

from graphflow.tui.view import View


def broken(why: str) -> type[View]:
    """Return a view class that shows the reason."""

    class Broken(View):
        NAME = "broken"
        DOC = why

        def compose(self) -> ComposeResult:
            yield Static(why, classes="hint", markup=False)

    return Broken

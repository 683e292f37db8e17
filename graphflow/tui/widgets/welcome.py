"""The line for newcomers: how to move, to leave and to stop. Once dismissed, it does not return."""

from __future__ import annotations

import logging
from pathlib import Path

from rich.style import Style

from graphflow.folders import state_root
from graphflow.tui.commands.actions import shown
from graphflow.tui.widgets.bars import Bar

logger = logging.getLogger("graphflow.console")


def _mark() -> Path:
    return state_root() / ".welcomed"


def is_first_visit() -> bool:
    """Return whether this user has not yet dismissed the line."""
    return not _mark().exists()


class Welcome(Bar):
    """The essentials, most important first; the end is cut off if there is no room."""

    def pieces(self, y: int, width: int) -> list[tuple[str, Style]]:
        colours, prefix = self.console_app.colours, shown(self.console_app.prefix)
        found = [(" New here? ", colours.strong)]
        for key, what in (
            ("tab", "next pane"),
            (f"{prefix} d", "leave, all runs on"),
            ("^c", "stop..."),
            ("^p", "menu"),
            ("esc", "hide"),
        ):
            found += [(key, colours.accent), (f" {what}  ", colours.text)]
        return found

    def on_click(self) -> None:
        self.put_away()

    def put_away(self) -> None:
        """Hide the line for good."""
        self.display = False
        try:
            _mark().parent.mkdir(parents=True, exist_ok=True)
            _mark().touch()
        except OSError as error:
            logger.warning("the line for newcomers will come again: %s", error)

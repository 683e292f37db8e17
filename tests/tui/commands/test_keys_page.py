"""The page of keys says what the keys do."""

from __future__ import annotations

import re

from graphflow.tui.commands.actions import console_actions
from graphflow.tui.commands.keys_page import page
from tests.conftest import PROJECT


def test_the_page_is_that_of_the_table() -> None:
    """Made by: python -m graphflow.tui.commands.keys_page > docs/keys.md."""
    assert (PROJECT / "docs" / "keys.md").read_text(encoding="utf-8") == page()


def test_every_action_of_the_console_is_there() -> None:
    """With its keys, and a table that is well formed."""
    text = page()
    assert all(f"| {action.title} |" in text for action in console_actions())
    assert all(line.count(" | ") == 2 for line in text.splitlines() if re.match(r"\| `", line))

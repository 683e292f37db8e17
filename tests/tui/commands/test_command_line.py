"""The command line: views and commands of the console's own, otherwise any verb, in a pane."""

from __future__ import annotations

import pytest

from graphflow.tui.commands.command_line import CommandLine
from graphflow.tui.panes import Content
from tests.cases import sample, slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
@pytest.mark.parametrize(
    ("text", "opens"),
    sample(
        [
            ("echo /pose", "echo /pose"),
            ("topics", "topics"),
            ("graphflow topic list", "prompt topic list"),
            ("gf ps", "prompt ps"),
            ("groups move /a b c", "prompt groups move /a b c"),
            ("groups", "groups"),
            ("param set /a x '1 2'", "prompt param set /a x '1 2'"),
        ]
    ),
)
async def test_what_is_typed(text: str, opens: str) -> None:
    """A view or a verb is opened."""
    async with stage(Content("nodes")) as s:
        await s.prefix("colon")
        s.console.screen.query_one("Input").value = text  # type: ignore[attr-defined]
        await s.press("enter")
        assert str(s.view.content) == opens


@slow
async def test_words_of_the_consoles_own() -> None:
    """Layouts are applied; an empty line does nothing."""
    async with stage(Content("nodes")) as s:
        await s.prefix("percent_sign")
        await s.press("escape")
        await s.prefix("colon")
        await s.type("layout even-vertical")
        await s.press("enter")
        assert s.console.window.layout == "even-vertical"
        await s.prefix("colon")
        await s.press("enter")
        assert len(s.console.window.numbers) == 2


async def test_recall_and_completion() -> None:
    """↑ recalls commands of any prompt; tab completes."""
    async with stage(Content("nodes")) as s:
        s.console.hub.history.add("ros2 ps --json")
        await s.press("colon")
        assert isinstance(s.console.screen, CommandLine)
        await s.press("up")
        assert s.console.screen.query_one("Input").value == "ps --json"  # type: ignore[attr-defined]
        await s.press("ctrl+u")
        await s.type("topic e")
        await s.press("tab")
        await s.until(lambda: s.console.screen.query_one("Input").value == "topic echo ")  # type: ignore[attr-defined]

"""Many lines: bounded, followed, wrapped; scrolled without jumping."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
from rich.text import Text
from textual.widget import Widget

from graphflow.tui.panes import Content
from graphflow.tui.widgets.line_view import MAX_PARTS, LineView, breaks
from tests.cases import slow
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@asynccontextmanager
async def lines(**options: Any) -> AsyncIterator[tuple[Stage, LineView[Any]]]:
    async with stage(Content("nodes"), size=(40, 12)) as s:
        made: LineView[Any] = LineView(**options)
        view: Widget = s.view
        await view.remove_children()
        await view.mount(made)
        s.console.screen.set_focus(made)
        await s.pilot.pause()
        yield s, made


@slow
async def test_only_so_many_are_kept_and_what_is_read_stays_put() -> None:
    """While the user has scrolled up, dropping the oldest lines does not move the visible ones."""
    async with lines(bound=50) as (s, made):
        made.extend([f"line {i}" for i in range(50)])
        assert "line 49" in s.text
        await s.press("pageup", "pageup", "up")
        top, chosen = s.text.split("\n")[1], made.chosen
        assert chosen is not None
        made.extend([f"line {i}" for i in range(50, 55)])
        await s.pilot.pause()
        assert len(made.rows) == 50
        assert s.text.split("\n")[1] == top
        assert made.chosen == chosen
        await s.press("end")
        await s.until("line 54")


@slow
async def test_long_rows_wrap() -> None:
    """Rows are split at the width; selecting a part selects the row."""
    async with lines(wraps=True) as (s, made):
        made.extend(["a" * 50, Text("short")])
        assert "a" * 10 in s.text
        await s.press("up", "up")
        assert made.chosen == "a" * 50
        assert len(made.rows) == 3
        made.wrap(False)
        assert len(made.rows) == 2


async def test_a_last_row_that_is_replaced() -> None:
    """All parts of the row are replaced."""
    async with lines(wraps=True) as (_, made):
        made.extend(["short", "a" * 50])
        made.replace_last("new")
        assert [*made.rows] == ["short", "new"]


@pytest.mark.parametrize(
    ("text", "width", "lines"),
    [
        ("one two three", 9, ["one two", "three"]),
        ("   │   one two three", 16, ["   │   one two", "   │   three"]),
        ("a" * 15, 10, ["a" * 10, "a" * 5]),
        ("日本" * 3, 7, ["日本日", "本日本"]),
        ("", 10, [""]),
    ],
)
def test_breaking_between_words(text: str, width: int, lines: list[str]) -> None:
    """Indent and border are repeated on each line; a word that is too long is cut."""
    scale = 2 if text.startswith("日") else 1
    found = [text[:indent] + text[start // scale : end // scale] for start, end, indent in breaks(text, width)]
    assert found == lines


def test_a_row_that_is_much_too_long() -> None:
    """The number of lines is limited."""
    assert len([*breaks("a" * 100_000, 10)]) == MAX_PARTS


@slow
async def test_moving() -> None:
    """The cursor moves by lines, by pages, and to both ends."""
    async with lines() as (s, made):
        made.extend([f"line {i}" for i in range(100)])
        await s.press("home")
        await s.until("line 0")
        assert not made.follows
        await s.press("j")
        assert made.chosen is not None
        await s.press("pagedown", "k")
        for back, on in (("k", "G"), ("pageup", "pagedown")):
            await s.press(back)
            assert not made.follows
            await s.press(on)
            assert made.follows
            assert made.chosen is None


@slow
async def test_searching() -> None:
    """The search begins at the end and goes backwards; n and N continue; lower case matches any case."""
    async with stage(Content("help")) as s:
        lines = s.view.query_one(LineView)
        lines.replace([f"{'Gear' if i % 10 == 0 else 'line'} {i}" for i in range(100)])
        lines.focus()
        await s.press("slash")
        await s.until("Search for")
        await s.type("gear")
        await s.press("enter")
        assert lines.chosen == "Gear 90"
        await s.press("N")
        assert lines.chosen == "Gear 80"
        await s.press("n")
        assert lines.chosen == "Gear 90"
        assert not lines.search("nothing", 1)
        assert not lines.search("GEAR", -1)


async def test_copying_a_line() -> None:
    """`y` copies the line unless the view binds it otherwise."""
    async with stage(Content("prompt")) as s:
        lines = s.view.query_one(LineView)
        lines.replace(["one", "two"])
        await s.prefix("[")
        await s.press("up", "y")
        assert s.console.clipboard_text in ("one", "two")

"""Dialogs."""

from __future__ import annotations

import pytest
from textual.widgets import Input, OptionList

from graphflow.tui.widgets.dialogs import SHOWN, Ask, AskLine, Choice, Item, Pick
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
@pytest.mark.parametrize(
    ("keys", "answer"), [(["d"], "d"), (["s"], "s"), (["escape"], None), (["up", "enter"], "s"), (["enter"], None)]
)
async def test_a_question(keys: list[str], answer: str | None) -> None:
    """A question is answered by a key, by a button, or not at all; an accidental enter cancels."""
    async with stage() as s:
        answers: list[str | None] = []
        s.console.push_screen(
            Ask("Stay or go?", [Choice("d", "stay"), Choice("s", "go [now]")], "detail"), answers.append
        )
        await s.until("[s] go [now]")
        await s.press(*keys)
        assert answers == [answer]


@slow
async def test_a_line() -> None:
    """Enter accepts the line, escape cancels."""
    async with stage() as s:
        answers: list[str | None] = []
        s.console.push_screen(AskLine("Name", "old"), answers.append)
        await s.until(lambda: isinstance(s.console.focused, Input))
        await s.type("new")
        await s.press("enter")
        assert answers == ["new"]


@slow
async def test_picking_by_parts_of_a_name() -> None:
    """The best match comes first; arrows select; brackets in names are no markup; long lists are bounded."""
    async with stage() as s:
        answers: list[int | None] = []
        items = [Item(f"/arm{i}/[pose]", "x/msg/Y", i) for i in range(500)]
        s.console.push_screen(Pick("Which", items), answers.append)
        await s.until("/arm0/[pose]")
        assert s.console.screen.query_one(OptionList).option_count == SHOWN
        await s.type("arm417")
        assert s.console.screen.query_one(OptionList).option_count == 1
        await s.press("enter")
        assert answers == [417]


@slow
async def test_what_fits_best_comes_first() -> None:
    """An exact match comes first, then words, beginnings and parts."""
    texts = ["detail", "catalogue", "log /arm", "log", "logger", "x"]
    async with stage() as s:
        picked: list[str | None] = []
        s.console.push_screen(
            Pick("Which", [Item(t, "params, log" if t == "detail" else "", t) for t in texts]), picked.append
        )
        await s.until("catalogue")
        await s.type("log")
        screen = s.console.screen
        assert isinstance(screen, Pick)
        assert [item.text for item in screen._found] == ["log", "log /arm", "logger", "catalogue", "detail"]
        await s.press("enter")
        assert picked == ["log"]


@slow
async def test_nothing_to_pick() -> None:
    """The dialog says so, and enter does nothing."""
    async with stage() as s:
        s.console.push_screen(Pick("Which", [], "no graph runs"))
        await s.until("no graph runs")
        await s.press("enter")
        assert isinstance(s.console.screen, Pick)
        await s.press("escape")
        assert len(s.console.screen_stack) == 1


@slow
async def test_names_and_details_stay_apart() -> None:
    """On a narrow screen, too, each keeps to its line."""
    items = [Item(f"call /turtle1/{'a' * n}teleport", "turtlesim/srv/TeleportAbsolute", n) for n in (3, 30)]
    async with stage(size=(80, 24)) as s:
        s.console.push_screen(Pick("Which?", items))
        await s.until("turtle1/aaateleport")
        rows = [line.strip("│ ") for line in s.text.split("\n") if "call" in line]
        assert len(rows) == 2
        assert [len(row.split("  ")) >= 2 for row in rows] == [True, True]
        assert rows[1].startswith("call /turtle1/aaa")
        assert "…" in rows[1]


async def test_a_name_is_shown_before_its_detail() -> None:
    """Names take up to half of the line if they need it."""
    async with stage(size=(80, 24)) as s:
        s.console.push_screen(Pick("Which?", [Item("call /turtle1/teleport_absolute", "d" * 60, 0)]))
        await s.until("call /turtle1/teleport_absolute")
        assert "d…" in s.text

"""Tables: rows come, go and change under a cursor that stays."""

from __future__ import annotations

import pytest
from textual.widgets import DataTable

from graphflow.tui import table
from graphflow.tui.panes import Content
from graphflow.tui.table import FIND, Cells, TableView
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Numbers(TableView):
    """Rows that a test sets."""

    NAME = "numbers"
    COLUMNS = ("name", "value")
    ACTIONS = (FIND,)
    now: dict[str, Cells] = {}  # noqa: RUF012

    def rows(self) -> dict[str, Cells]:
        return self.now


async def test_the_cursor_stays_on_its_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever comes before it, changes in it, or goes after it."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    Numbers.now = {name: (name, "1") for name in "bdf"}
    async with stage(Content("numbers")) as s:
        view = s.view
        assert isinstance(view, Numbers)
        await s.look()
        await s.press("down")
        assert view.key == "d"
        Numbers.now = {name: (name, "2") for name in "abcde"}
        await s.look()
        assert view.key == "d"
        assert view.query_one(DataTable).row_count == 5
        Numbers.now = {name: (name, "3") for name in "abcde"}
        await s.look()
        assert "3" in s.text
        Numbers.now = {}
        await s.look()
        assert view.key == ""
        assert "nothing there yet" in s.text


async def test_where_nothing_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """It says what was sought, and how all rows come back."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    Numbers.now = {"a": ("a", "1")}
    async with stage(Content("numbers")) as s:
        await s.look()
        assert "nothing there yet" not in s.text
        await s.press("slash", "z")
        assert "no row has 'z'; esc shows all" in s.text
        await s.press("enter", "escape")
        assert "esc shows all" not in s.text


async def test_long_tables_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not shown is counted."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    monkeypatch.setattr(table, "ROWS", 10)
    Numbers.now = {f"r{i}": (f"r{i}", "") for i in range(25)}
    async with stage(Content("numbers")) as s:
        await s.look()
        assert "10, 15 more not shown" in s.text

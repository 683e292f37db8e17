"""Tables: rows come, go and change under a cursor that stays."""

from __future__ import annotations

from typing import ClassVar

import pytest
from textual.widgets import DataTable

from graphflow.tui.panes import Content
from graphflow.tui.widgets import table
from graphflow.tui.widgets.table import FIND, ORDER, Cells, TableView
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Numbers(TableView):
    """Rows set by the test."""

    NAME = "numbers"
    COLUMNS: ClassVar[tuple[str, ...]] = ("name", "value")
    ACTIONS = (FIND, ORDER)
    now: dict[str, Cells] = {}  # noqa: RUF012

    def rows(self) -> dict[str, Cells]:
        return self.now


async def test_the_cursor_stays_on_its_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """The cursor stays on its row while rows before it come and go."""
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
        await s.until("3")
        Numbers.now = {}
        await s.look()
        assert view.key == ""
        assert "nothing there yet" in s.text


@pytest.mark.parametrize("key", ["a", "b"])
async def test_rows_that_are_drawn_before_they_are_measured(monkeypatch: pytest.MonkeyPatch, key: str) -> None:
    """They are drawn again, old and new ones, with columns as wide as they need."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    Numbers.now = {"a": ("a", "1")}
    async with stage(Content("numbers")) as s:
        await s.look()
        Numbers.now = {key: ("what is much longer", "1")}
        s.view.look(0.0)
        assert "what is much longer" not in s.text
        await s.look()
        assert "what is much longer" in s.text


@slow
async def test_where_nothing_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The message names the search, and the key that clears it."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    Numbers.now = {"a": ("a", "1")}
    async with stage(Content("numbers")) as s:
        await s.look()
        assert "nothing there yet" not in s.text
        await s.press("slash", "z")
        await s.until("no row contains 'z'; esc shows all")
        await s.press("enter", "escape")
        assert "esc shows all" not in s.text


async def test_long_tables_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows that are not shown are counted."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    monkeypatch.setattr(table, "ROWS", 10)
    Numbers.now = {f"r{i}": (f"r{i}", "") for i in range(25)}
    async with stage(Content("numbers")) as s:
        await s.look()
        await s.until("10 of 25")
        assert s.view.query_one(DataTable).row_count == 10


@slow
async def test_an_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows are sorted by quantities with their units; choosing again reverses; rows without a value come last."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    Numbers.now = {name: (name, value) for name, value in zip("abcd", ("10ms", "", "1.5s", "900ms"), strict=True)}
    async with stage(Content("numbers")) as s:
        view = s.view
        assert isinstance(view, Numbers)
        for keys, order, head in ((("down", "enter"), "adcb", "value ▲"), (("down", "enter"), "cdab", "value ▼")):
            await s.press("o")
            await s.until("Order by")
            await s.press(*keys)
            await s.look()
            assert [*view._shown] == list(order)
            assert head in s.text
        assert view.content.options["order"] == "-value"


@slow
async def test_a_find_stays_in_the_title(monkeypatch: pytest.MonkeyPatch) -> None:
    """The title gives the number of matches; the search is restored with the windows."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Numbers)
    Numbers.now = {f"r{i}": (f"r{i}", "") for i in range(25)}
    async with stage(Content("numbers", options={"find": "r2"})) as s:
        await s.look()
        await s.until("[/r2] 6 of 25")
        await s.press("escape")
        await s.look()
        assert "of 25" not in s.text


class Wide(Numbers):
    """A table whose last column takes the remaining width."""

    COLUMNS: ClassVar[tuple[str, ...]] = ("name", "value", "text")
    SHED = ("name", "text", "value")
    KEEPS = 1
    STRETCHES = True


@slow
@pytest.mark.parametrize(
    ("width", "shown"), [(80, "a one long"), (40, "a one long"), (28, "a long"), (20, "a one"), (12, "a")]
)
async def test_the_width_that_is_there(monkeypatch: pytest.MonkeyPatch, width: int, shown: str) -> None:
    """The last column takes the rest of the line; columns without room are hidden by importance."""
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: Wide)
    Wide.now = {"a": ("a", "one", "long " * 30)}
    async with stage(Content("numbers"), size=(width, 12)) as s:
        await s.look()
        row = s.text.split("\n")[2]
        assert " ".join(row.split()).startswith(shown)
        assert ("…" in row) is ("long" in shown)
        if "…" in row:
            assert width - len(row) < 5

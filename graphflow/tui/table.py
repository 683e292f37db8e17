"""A view that is a table: rows that come, go and change, found by typing, chosen by a cursor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from rich.cells import cell_len
from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import DataTable, Input, Static

from graphflow.tui.actions import Action
from graphflow.tui.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.view import View

Cells = tuple[Text | str, ...]
FIND = Action("find_row", "find", keys=("slash",), hint=True)
ROWS = 2000
"""Rows shown; a find narrows what there is."""


class TableView(View):
    """A view of rows, each known by a key.

    Subclasses say COLUMNS and `rows`.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = ()
    KEEPS: ClassVar[int | None] = None
    """Columns that stay where there is no room; the others go, from the last. None: the table scrolls sideways."""
    EMPTY: ClassVar[str] = "nothing there yet"
    """What stands in place of the rows where there are none."""

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self.table: DataTable[Text | str] = DataTable(cursor_type="row", zebra_stripes=False, cell_padding=1)
        self._empty = Static("", classes="hint", markup=False)
        self._find = Input(placeholder="find; enter keeps, esc clears", classes="find")
        self._shown: dict[str, Cells] = {}
        self._hidden = 0
        self._columns: tuple[str, ...] = ()
        self._filled = False
        """Whether rows have come since they were drawn last."""

    def compose(self) -> ComposeResult:
        yield self.table
        yield self._empty
        yield self._find

    def rows(self) -> Mapping[str, Cells]:
        """The rows as they should be, in order."""
        raise NotImplementedError

    def look(self, now: float) -> None:
        wanted = self._find.value.lower()
        rows = {k: v for k, v in self.rows().items() if not wanted or wanted in k.lower() or wanted in _words(v)}
        self._hidden = max(0, len(rows) - ROWS)
        self.show_rows(dict(list(rows.items())[:ROWS]))

    def why_empty(self) -> str:
        """Why there are no rows."""
        if self._find.value:
            return f"no row has {self._find.value!r}; esc shows all"
        return self.EMPTY

    @property
    def note(self) -> str:
        more = f", {self._hidden} more not shown" if self._hidden else ""
        found = f"/{self._find.value} " if self._find.value else ""
        return f"{found}{len(self._shown)}{more}"

    def show_rows(self, rows: dict[str, Cells]) -> None:
        """Change what differs; the cursor stays on its row."""
        self.set_class(not rows, "-empty")
        if not rows:
            self._empty.update(self.why_empty())
        if self._filled:
            self._filled = False
            self.call_after_refresh(self._draw_again)
        columns = self._fitting(rows)
        if columns != self._columns:
            self._columns = columns
            self.table.clear(columns=True)
            for column in columns:
                self.table.add_column(column, key=column)
            self._fill(rows)
        elif list(rows) != [k for k in self._shown if k in rows] or any(k not in rows for k in self._shown):
            self._fill(rows)
        else:
            for key, cells in rows.items():
                for column, cell, before in zip(columns, cells, self._shown[key], strict=False):
                    if cell != before:
                        self.table.update_cell(key, column, cell, update_width=True)
        self._shown = rows

    def _fitting(self, rows: dict[str, Cells]) -> tuple[str, ...]:
        """The columns for which there is room."""
        room = self.table.size.width
        if self.KEEPS is None or not room:
            return self.COLUMNS
        found = 0
        for i, column in enumerate(self.COLUMNS):
            room -= 2 + max(cell_len(text) for text in (column, *(str(cells[i]) for cells in rows.values())))
            if room < 0 and i >= self.KEEPS:
                break
            found += 1
        return self.COLUMNS[:found]

    def _draw_again(self) -> None:
        """Have the rows drawn anew: the table keeps what it has drawn between their coming and its measuring them."""
        for key, cells in list(self._shown.items())[:1]:
            self.table.update_cell(key, self.COLUMNS[0], cells[0])

    def _fill(self, rows: dict[str, Cells]) -> None:
        kept = self.key
        self._filled = True
        top = self.table.scroll_offset.y
        self.table.clear()
        for key, cells in rows.items():
            self.table.add_row(*cells[: len(self._columns)], key=key)
        if kept in rows:
            self.table.move_cursor(row=list(rows).index(kept), animate=False, scroll=False)
        self.table.scroll_to(y=top, animate=False)

    @property
    def key(self) -> str:
        """The key of the row that is chosen; empty for none."""
        keys = list(self._shown)
        row = self.table.cursor_row
        return keys[row] if 0 <= row < len(keys) else ""

    def choose(self, key: str) -> None:
        """Put the cursor on a row."""
        if key in self._shown:
            self.table.move_cursor(row=list(self._shown).index(key), animate=False)

    @property
    def heart(self) -> Widget:
        return self.table

    def do_find_row(self) -> None:
        self._find.add_class("shown")
        self._find.focus()

    def on_input_changed(self, event: Input.Changed) -> None:
        if event.input is self._find:
            self.look(0.0)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        if event.input is self._find:
            self.table.focus()

    def key_escape(self) -> None:
        """Take the find away."""
        self._find.value = ""
        self._find.remove_class("shown")
        self.table.focus()


def _words(cells: Cells) -> str:
    return " ".join(str(cell) for cell in cells).lower()

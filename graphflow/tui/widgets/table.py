"""A view that is a table, with incremental search, sorting and a cursor that stays on its row."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import ClassVar

from rich.cells import cell_len
from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import DataTable, Input, Static

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.dialogs import Item, Pick

Cells = tuple[Text | str, ...]
FIND = Action("find_row", "find", keys=("slash",), hint=True)
ORDER = Action("order", "order", keys=("o",), hint=True)
ROWS = 2000
"""Maximum rows shown; a search narrows them."""
STRETCH_LEAST = 16
"""Minimum cells of a last column that takes the rest of the line."""
_QUANTITY = re.compile(r"(-?[\d.,]+) ?(ms|[a-zA-Z%]*)")
_UNITS = {"ms": 1e-3, "s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0, "k": 1e3, "M": 1e6, "G": 1e9}


class _Lines(DataTable[Text | str]):
    """A table that draws its lines again when it has measured them: Textual keeps those that it drew before."""

    def on_idle(self) -> None:
        if self._require_update_dimensions:  # Textual's own handler, which is called next, measures
            self.call_next(self._draw_again)

    def _draw_again(self) -> None:
        self._clear_caches()
        self.refresh()


class TableView(View):
    """A view of rows identified by keys. Subclasses set COLUMNS and implement `rows`."""

    COLUMNS: ClassVar[tuple[str, ...]] = ()
    KEEPS: ClassVar[int | None] = None
    """Number of columns that always stay; the last of SHED are hidden first. None: hide none, scroll instead."""
    SHED: ClassVar[tuple[str, ...]] = ()
    """The columns by importance; empty for their order in the table."""
    STRETCHES: ClassVar[bool] = False
    """Whether the last column takes the remaining width."""
    EMPTY: ClassVar[str] = "nothing there yet"
    """The text in place of an empty table."""

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self.table = _Lines(cursor_type="row", zebra_stripes=False, cell_padding=1)
        self._empty = Static("", classes="hint", markup=False)
        self._find = Input(
            str(self.options.get("find", "")), placeholder="find; enter keeps, esc clears", classes="find"
        )
        self._shown: dict[str, Cells] = {}
        self._total = self._found = 0
        """Number of all rows, and of those that match the search."""
        self._columns: tuple[str, ...] = ()

    def compose(self) -> ComposeResult:
        yield self.table
        yield self._empty
        yield self._find

    def rows(self) -> Mapping[str, Cells]:
        """Return the rows in their order."""
        raise NotImplementedError

    def look(self, now: float) -> None:
        wanted = self._find.value.lower()
        rows = dict(self.rows())
        self._total = len(rows)
        if wanted:
            rows = {k: v for k, v in rows.items() if wanted in k.lower() or wanted in _words(v)}
        self._found = min(ROWS, len(rows))
        self.show_rows(dict(list(self.ordered(rows).items())[:ROWS]))

    def why_empty(self) -> str:
        """Return the reason why there are no rows."""
        if self._find.value:
            return f"no row contains {self._find.value!r}; esc shows all"
        return self.EMPTY

    @property
    def note(self) -> str:
        if self._found == self._total:
            return str(self._total)
        find = f"[/{self._find.value}] " if self._find.value else ""
        return f"{find}{self._found} of {self._total}"

    # sorting

    @property
    def _order(self) -> tuple[str, bool]:
        """Return the column to sort by, empty for none, and whether to reverse it."""
        column = str(self.options.get("order", ""))
        return column.removeprefix("-"), column.startswith("-")

    def ordered(self, rows: dict[str, Cells]) -> dict[str, Cells]:
        """Sort the rows by the chosen column; rows without a value come last."""
        column, backwards = self._order
        if column not in self.COLUMNS:
            return rows
        at = self.COLUMNS.index(column)
        filled = [key for key in rows if str(rows[key][at]).strip()]
        filled.sort(key=lambda key: _magnitude(str(rows[key][at])), reverse=backwards)
        return {key: rows[key] for key in (*filled, *(key for key in rows if key not in set(filled)))}

    def do_order(self) -> None:
        """Let the user choose a column; choosing the current one reverses the order."""
        now, backwards = self._order

        def picked(column: str | None) -> None:
            if column is None:
                return
            self.options["order"] = f"-{column}" if column == now and not backwards else column
            self._columns = ()  # their heads show the order
            self.look(0.0)

        items = [Item(column, self._order_note(column), column) for column in self.COLUMNS if column]
        self.app.push_screen(Pick("Order by", [*items, Item("as it comes", "", "")]), picked)

    def _order_note(self, column: str) -> str:
        now, backwards = self._order
        return (
            "" if column != now else "now, backwards; again for forwards" if backwards else "now; again for backwards"
        )

    def _head(self, column: str) -> str:
        name, backwards = self._order
        return f"{column} {'▼' if backwards else '▲'}" if column == name and column else column

    # rows and columns

    def show_rows(self, rows: dict[str, Cells]) -> None:
        """Update the rows that differ; the cursor stays on its row."""
        self.set_class(not rows, "-empty")
        if not rows:
            self._empty.update(self.why_empty())
        columns, rest = self._fitting(rows)
        at = [self.COLUMNS.index(column) for column in columns]
        if rest:
            rows = {key: (*cells[:-1], _cropped(cells[-1], rest)) for key, cells in rows.items()}
        if columns != self._columns or list(rows) != list(self._shown):
            self._fill(rows, columns, at)
        else:
            for key, cells in rows.items():
                before = self._shown[key]
                for column, i in zip(columns, at, strict=True):
                    if cells[i] != before[i]:
                        self.table.update_cell(key, column, cells[i], update_width=True)
        self._shown = rows

    def restyle(self) -> None:
        self._shown = {}
        self.look(0.0)

    def _fitting(self, rows: dict[str, Cells]) -> tuple[tuple[str, ...], int]:
        """Return the columns that fit, and the width left for a last one that stretches."""
        room = self.table.size.width
        if self.KEEPS is None or not room:
            return self.COLUMNS, 0
        stretching = self.COLUMNS[-1] if self.STRETCHES else ""
        found: list[str] = []
        for column in self.SHED or self.COLUMNS:
            i = self.COLUMNS.index(column)
            if column == stretching and not any(str(cells[i]) for cells in rows.values()):
                continue
            widest = max(map(cell_len, (self._head(column), *(str(cells[i]) for cells in rows.values()))))
            needed = 2 + (min(STRETCH_LEAST, widest) if column == stretching else widest)
            if needed > room and len(found) >= self.KEEPS:
                continue
            room -= needed
            found.append(column)
        rest = max(0, room) + STRETCH_LEAST - 1 if stretching in found else 0
        return tuple(column for column in self.COLUMNS if column in found), rest

    def _fill(self, rows: dict[str, Cells], columns: tuple[str, ...], at: list[int]) -> None:
        kept, top = self._row_key, self.table.scroll_offset.y
        self.table.clear(columns=columns != self._columns)
        if columns != self._columns:
            self._columns = columns
            for column in columns:
                self.table.add_column(self._head(column), key=column)
        for key, cells in rows.items():
            self.table.add_row(*(cells[i] for i in at), key=key)
        if kept in rows:
            self.table.move_cursor(row=list(rows).index(kept), animate=False, scroll=False)
        self.table.scroll_to(y=top, animate=False)

    @property
    def key(self) -> str:
        """The key of the selected row; empty if there is none."""
        return self._row_key

    @property
    def _row_key(self) -> str:
        keys = list(self._shown)
        row = self.table.cursor_row
        return keys[row] if 0 <= row < len(keys) else ""

    def choose(self, key: str) -> None:
        """Move the cursor to a row."""
        if key in self._shown:
            self.table.move_cursor(row=list(self._shown).index(key), animate=False)

    @property
    def focus_target(self) -> Widget:
        return self.table

    def do_find_row(self) -> None:
        self._find.add_class("shown")
        self._find.focus()

    def on_input_changed(self, event: Input.Changed) -> None:
        if event.input is self._find:
            self.options["find"] = event.value
            self.look(0.0)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        if event.input is self._find:
            self._find.remove_class("shown")
            self.table.focus()

    def key_escape(self) -> None:
        """Clear the search."""
        self._find.value = ""
        self._find.remove_class("shown")
        self.table.focus()


def _words(cells: Cells) -> str:
    return " ".join(str(cell) for cell in cells).lower()


def _cropped(cell: Text | str, width: int) -> Text | str:
    """Return a cell as one line, cropped to the width."""
    if cell_len(str(cell)) <= width:
        return cell
    text = cell.copy() if isinstance(cell, Text) else Text(cell)
    text.truncate(width, overflow="ellipsis")
    return text


def _magnitude(text: str) -> tuple[float, str]:
    """Return the sort key of a cell: a quantity with its unit, otherwise the text."""
    found = _QUANTITY.match(text)
    if found is None:
        return float("inf"), text.lower()
    try:
        return float(found[1].replace(",", "")) * _UNITS.get(found[2], 1.0), text.lower()
    except ValueError:
        return float("inf"), text.lower()

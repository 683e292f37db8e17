"""A view of many lines of text, of which only the visible ones are drawn."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any, ClassVar, Generic, NamedTuple, TypeVar

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual import events
from textual.binding import Binding, BindingType
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from graphflow.tui.widgets.colours import Colours, ThemedApp, colours_of

R = TypeVar("R")
"""A row: text, or whatever `draw` of a subclass can draw."""

KEPT = 20_000
MAX_PARTS = 50
"""Maximum lines of one wrapped row."""
_INDENT = re.compile(r"[ │]*")
"""The beginning that is repeated on each line of a wrapped row, so that the border of a box continues."""
_MAX_INDENT = 24
"""Maximum columns of an indent."""


class Part(NamedTuple, Generic[R]):
    """A piece of a row that is too long for one line."""

    row: R
    start: int
    """The column of the row at which the piece begins."""
    end: int
    indent: int
    """Columns before the piece, copied from the row's beginning or, if `is_blank`, left blank."""
    is_blank: bool = False


def breaks(text: str, width: int, hanging: int | None = None) -> Iterator[tuple[int, int, int]]:
    """Return the start, end and indent of each piece of a row, in columns, preferably broken between words.

    Args:
        hanging: The indent of further lines; None for that of the row.
    """
    found = _INDENT.match(text)
    indent = hanging if hanging is not None else found.end() if found else 0
    if indent > (min(_MAX_INDENT, width // 2) if hanging is None else width // 2):
        indent = 0
    if cell_len(text) != len(text):  # columns are not characters: cut where the line is full
        rest = range(width, min(cell_len(text), width * MAX_PARTS), width - indent)
        yield 0, width, 0
        yield from ((at, at + width - indent, indent) for at in rest)
        return
    start, room = 0, width
    for _ in range(MAX_PARTS):
        if len(text) - start <= room:
            yield start, len(text), indent if start else 0
            return
        space = text.rfind(" ", start + 1, start + room + 1)
        end = space if space > start + room // 2 else start + room
        yield start, end, indent if start else 0
        start, room = end + (text[end] == " "), width - indent


class LineView(ScrollView, Generic[R], can_focus=True):
    """Lines that grow at the end, where the view follows them until the user scrolls up.

    Args:
        bound: Maximum lines; the oldest are dropped.
        wraps: Whether long rows are wrapped rather than cut off.
        copies: Whether `y` copies the selected line; some views bind it to something else.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", show=False),
        Binding("down,j", "move(1)", show=False),
        Binding("pageup", "page(-1)", show=False),
        Binding("pagedown", "page(1)", show=False),
        Binding("home,g", "top", show=False),
        Binding("end,G", "bottom", show=False),
        Binding("slash", "search", show=False),
        Binding("n", "next_match(1)", show=False),
        Binding("N", "next_match(-1)", show=False),
        Binding("y", "copy_line", show=False),
    ]

    HAS_SEARCH: ClassVar[bool] = True
    """Whether `/` searches the lines; views with a filter of their own need no search."""

    class SearchRequested(Message):
        """The user requests a search."""

        def __init__(self, lines: LineView[Any]) -> None:
            super().__init__()
            self.lines = lines

    def __init__(self, bound: int = KEPT, *, wraps: bool = False, copies: bool = False) -> None:
        super().__init__()
        self.copies = copies
        self.search_text = ""
        self.wraps = wraps
        self._wrapped_at = 0
        self.rows: deque[R | Part[R]] = deque(maxlen=bound)
        self.follows = True
        self.cursor: int | None = None
        """The index of the selected row; None if there is none."""

    @property
    def colours(self) -> Colours:
        return colours_of(self)

    def draw(self, row: R) -> Iterable[tuple[str, Style]]:
        """Return a row as pieces of text; overridden by views whose rows are not plain text."""
        return self.draw_text(row if isinstance(row, Text) else str(row))

    def draw_text(self, text: Text | str) -> Iterable[tuple[str, Style]]:
        """Return a text as pieces of one style each."""
        if isinstance(text, Text):
            whole = text.style if isinstance(text.style, Style) else self.colours.text
            for segment in text.render(self.app.console):  # the style of the whole line is left to the caller
                yield segment.text, segment.style or whole
        else:
            yield text, self.colours.text

    def hanging(self, row: R) -> int | None:
        """Return the indent of a row's further lines; None for that of the row."""
        return None

    def replace_last(self, row: R) -> None:
        """Replace the last row."""
        # A wrapped row has several lines; its first one is the last to go.
        while self.rows:
            if self.row_that_begins(len(self.rows) - 1) is not None:
                self.rows.pop()
                break
            self.rows.pop()
        self.extend([row])

    def extend(self, rows: Iterable[R]) -> None:
        """Append rows."""
        before = len(self.rows)
        fresh = list(self._parts(rows))
        self.rows.extend(fresh)
        self._moved(lost=before + len(fresh) - len(self.rows))

    def replace(self, rows: Iterable[R]) -> None:
        """Replace all rows."""
        # Before the rows are cleared: `rows` may be made from them.
        fresh = list(self._parts(rows))
        self.rows.clear()
        self.rows.extend(fresh)
        self.cursor = None
        self._moved(lost=0)

    @property
    def chosen(self) -> R | None:
        """The selected row; None if there is none."""
        if self.cursor is None or not 0 <= self.cursor < len(self.rows):
            return None
        return _whole(self.rows[self.cursor])

    @property
    def last_row(self) -> R | None:
        """The last row; None if there is none."""
        return _whole(self.rows[-1]) if self.rows else None

    @property
    def whole_rows(self) -> Iterator[R]:
        """The rows as they were added, without the splits of wrapping."""
        return (_whole(row) for row in self.rows if not isinstance(row, Part) or row.start == 0)

    def row_that_begins(self, index: int) -> R | None:
        """Return the row whose first line this is; None for a further line of a row."""
        line = self.rows[index]
        if isinstance(line, Part):
            return None if line.start else line.row
        return line

    def _parts(self, rows: Iterable[R]) -> Iterator[R | Part[R]]:
        """Convert rows to lines, splitting the long ones if they wrap."""
        width = self._wrapped_at = self.scrollable_content_region.width
        if not self.wraps or not width:
            yield from rows
            return
        for row in rows:
            text = "".join(text for text, _ in self.draw(row))
            if cell_len(text) <= width:
                yield row
            else:
                hanging = self.hanging(row)
                yield from (Part(row, *piece, hanging is not None) for piece in breaks(text, width, hanging))

    def wrap(self, wraps: bool) -> None:
        """Turn wrapping on or off."""
        self.wraps = wraps
        self.replace(list(self.whole_rows))

    def recolour(self, recolour: Callable[[Text], None]) -> None:
        """Apply a change of theme to rows of text; other rows read the current theme when drawn."""
        for row in self.whole_rows:
            if isinstance(row, Text):
                recolour(row)
        self.refresh()

    def _moved(self, lost: int) -> None:
        self.virtual_size = Size(self._widest, len(self.rows))
        if self.follows:
            self.scroll_end(animate=False, immediate=True, x_axis=False)
        elif lost:
            self.scroll_to(y=max(0, self.scroll_offset.y - lost), animate=False, immediate=True)
            self.cursor = None if self.cursor is None else max(0, self.cursor - lost)
        self.refresh()

    @property
    def _widest(self) -> int:
        return self.scrollable_content_region.width

    def render_line(self, y: int) -> Strip:
        width = self.scrollable_content_region.width
        left, top = self.scroll_offset
        index = top + y
        base = self.rich_style
        if not 0 <= index < len(self.rows):
            return Strip.blank(width, base)
        colours = self.colours
        style = base + colours.cursor if index == self.cursor else base
        row = self.rows[index]
        strip = Strip([Segment(text, style + piece) for text, piece in self.draw(_whole(row))])
        if isinstance(row, Part):
            head = Strip.blank(row.indent, style) if row.is_blank else strip.crop(0, row.indent)
            strip = Strip.join([head, strip.crop(row.start, row.end)])
        return strip.crop_extend(left, left + width, style)

    def on_resize(self, event: events.Resize) -> None:
        if self.wraps and self._wrapped_at != self.scrollable_content_region.width:
            self.wrap(True)
        self._moved(lost=0)

    # searching

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action == "copy_line":
            return self.copies
        if action == "next_match":
            return bool(self.search_text)
        return self.HAS_SEARCH or action != "search"

    def action_copy_line(self) -> None:
        row, app = self.chosen, self.app
        if row is not None and isinstance(app, ThemedApp):
            app.copy("".join(piece for piece, _ in self.draw(row)).strip(), "the line")

    def action_search(self) -> None:
        self.post_message(self.SearchRequested(self))

    def action_next_match(self, step: int) -> None:
        self.search(self.search_text, step)

    def search(self, text: str, step: int) -> bool:
        """Go to the next line with a text, or the previous one; return whether there is one.

        A text in lower case matches any case.
        """
        self.search_text = text
        count = len(self.rows)
        at = self.cursor if self.cursor is not None else (count if step < 0 else self.scroll_offset.y - 1)
        for i in range(at + step, count if step > 0 else -1, step) if text else ():
            row = self.row_that_begins(i)
            if row is None:
                continue
            words = "".join(piece for piece, _ in self.draw(row))
            if text in (words.lower() if text.islower() else words):
                self.hold()
                self.cursor = i
                self.show_row(i)
                return True
        return False

    # moving

    def hold(self) -> None:
        """Stop following, so that the lines in view stay in place."""
        self.follows = False

    def action_move(self, step: int) -> None:
        height = self.scrollable_content_region.height
        if self.cursor is None:
            self.cursor = min(len(self.rows) - 1, self.scroll_offset.y + height - 1)
        else:
            self.cursor = max(0, min(len(self.rows) - 1, self.cursor + step))
        self.hold()
        self.show_row(self.cursor)

    def show_row(self, index: int) -> None:
        """Scroll as little as possible to bring a row into view."""
        height, top = self.scrollable_content_region.height, self.scroll_offset.y
        if index < top:
            self.scroll_to(y=index, animate=False, immediate=True)
        elif index >= top + height:
            self.scroll_to(y=index - height + 1, animate=False, immediate=True)
        self.refresh()

    def action_page(self, step: int) -> None:
        height = self.scrollable_content_region.height
        if step < 0:
            self.hold()
        self.scroll_to(y=self.scroll_offset.y + step * max(1, height - 1), animate=False, immediate=True)
        self._follow_at_the_end()

    def action_top(self) -> None:
        self.hold()
        self.scroll_home(animate=False, immediate=True)

    def action_bottom(self) -> None:
        self.follows, self.cursor = True, None
        self.scroll_end(animate=False, immediate=True, x_axis=False)
        self.refresh()

    def on_mouse_scroll_up(self) -> None:
        self.hold()

    def on_mouse_scroll_down(self) -> None:
        self.call_after_refresh(self._follow_at_the_end)

    def _follow_at_the_end(self) -> None:
        if self.is_vertical_scroll_end:
            self.follows, self.cursor = True, None
            self.refresh()

    def on_click(self, event: events.Click) -> None:
        index = self.scroll_offset.y + event.y
        if 0 <= index < len(self.rows):
            self.hold()
            self.cursor = index
            self.refresh()

    def get_content_width(self, container: Size, viewport: Size) -> int:
        return container.width


def _whole(row: R | Part[R]) -> R:
    return row.row if isinstance(row, Part) else row

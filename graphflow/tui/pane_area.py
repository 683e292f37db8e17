"""The part of the screen that panes share: placing them, drawing the lines between them, moving them by mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.app import ComposeResult
from textual.geometry import NULL_OFFSET, Region, Size, Spacing
from textual.layout import ArrangeResult, Layout, WidgetPlacement
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget

from graphflow.introspect.drawing.layered import Rect
from graphflow.tui.layout import Layout as Windows
from graphflow.tui.panes import Content, Divider, Window, drag
from graphflow.tui.view import View
from graphflow.tui.widgets.colours import colours_of

if TYPE_CHECKING:
    from collections.abc import Callable

_NO_MARGIN = Spacing()
NOTE_LEAST = 8
"""Columns below which a note beside a title is left out."""
TRIES, TRY_AGAIN_AFTER = 20, 0.02
"""Attempts to focus a pane that is not mounted yet, and the seconds between them."""


class Title(Widget):
    """The first line of a pane: its number, its title, and its note."""

    class Grabbed(Message):
        """The title was pressed, possibly to drag it."""

        def __init__(self, frame: Frame, x: int, y: int) -> None:
            super().__init__()
            self.frame, self.x, self.y = frame, x, y

    def __init__(self, frame: Frame) -> None:
        super().__init__()
        self._frame = frame
        self._shown: tuple[object, ...] = ()
        """The content that was drawn last."""

    def render_line(self, y: int) -> Strip:
        frame, width = self._frame, self.size.width
        colours = colours_of(self)
        focused = frame.is_focused
        base = self.rich_style + (colours.cursor if focused else Style())
        name, note = frame.view.title, frame.view.note
        self._shown = (name, note, focused)
        mark = "▌" if focused else " "
        name = _cut(name, width - 1)
        head = f"{mark}{name}"
        note = _cut(note, width - len(head) - 3, NOTE_LEAST)
        gap = max(1, width - len(head) - len(note) - 1)
        fill = " " * gap if focused or gap < 3 else f" {'─' * (gap - 2)} "
        pieces = [
            Segment(mark, base + colours.accent),
            Segment(name, base + (colours.strong if focused else colours.dim)),
            Segment(fill, base + colours.dim),
            Segment(note, base + colours.accent),
        ]
        return Strip(pieces).crop_extend(0, width, base)

    def refresh_if_changed(self) -> None:
        """Redraw if the content has changed."""
        frame = self._frame
        if (frame.view.title, frame.view.note, frame.is_focused) != self._shown:
            self.refresh()

    def on_mouse_down(self, event: events.MouseDown) -> None:
        self.post_message(self.Grabbed(self._frame, int(event.screen_x), int(event.screen_y)))


def _cut(text: str, width: int, least: int = 1) -> str:
    """Shorten a text to the width, marked with an ellipsis; empty if fewer columns than `least` are left of it."""
    if len(text) <= width:
        return text
    return f"{text[: width - 1]}…" if width >= least else ""


class Frame(Widget):
    """A pane on the screen: its title and its view."""

    class Focused(Message):
        """The focus has entered the pane."""

        def __init__(self, number: int) -> None:
            super().__init__()
            self.number = number

    def __init__(self, number: int, view: View) -> None:
        super().__init__()
        self.number = number
        self.view = view
        self.is_focused = False
        self.title_line = Title(self)

    def compose(self) -> ComposeResult:
        yield self.title_line
        yield self.view

    def on_descendant_focus(self) -> None:
        self.post_message(self.Focused(self.number))

    def on_click(self) -> None:
        if not self.has_focus_within:
            self.view.focus_inside()


class _Places(Layout):
    """The layout that puts frames at the places of the current window."""

    name = "panes"

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def arrange(self, parent: Widget, children: list[Widget], size: Size, greedy: bool = True) -> ArrangeResult:
        places = self._workspace.windows.window.places(size.width, size.height)
        found = []
        for child in children:
            if isinstance(child, Frame) and child.number in places:
                region = Region(*places[child.number])
                found.append(WidgetPlacement(region, NULL_OFFSET, _NO_MARGIN, child))
        return found


class Workspace(Widget):
    """The panes of all windows; those of the current window are displayed.

    Args:
        make_view: Makes the view of a pane.
    """

    class FocusArrived(Message):
        """The pane that should have the focus has it, or cannot take it."""

    def __init__(self, windows: Windows, make_view: Callable[[Content], View]) -> None:
        super().__init__()
        self.windows = windows
        self.frames: dict[int, Frame] = {}
        self._make_view = make_view
        self._dragged: Divider | None = None
        self.focus_is_due = True
        """Whether a change of focus is under way: meanwhile, reports of the old focus are ignored and keys wait."""
        self._places = _Places(self)

    @property
    def layout(self) -> Layout:
        return self._places

    @property
    def window(self) -> Window:
        return self.windows.window

    @property
    def focused(self) -> Frame | None:
        """The frame of the focused pane."""
        return self.frames.get(self.window.focused)

    @property
    def visible_frames(self) -> list[Frame]:
        return [f for f in self.frames.values() if f.display]

    def on_mount(self) -> None:
        self.sync()

    def sync(self, *, focus: bool = True) -> None:
        """Update the screen to the windows: panes that were opened, closed, moved or changed."""
        wanted = {p.number: p for w in self.windows.windows.values() for p in w.panes()}
        for number in [n for n in self.frames if n not in wanted]:
            self.frames.pop(number).remove()
        # Before the first layout there is no size, and nothing to leave out.
        places = self.window.places(*self.size) if self.size else dict.fromkeys(self.window.numbers)
        for number, pane in wanted.items():
            # Views of other windows are made when their window is first shown.
            if number not in self.frames and number in places:
                self.frames[number] = frame = Frame(number, self._make_view(pane.content))
                self.mount(frame)
        for number, frame in self.frames.items():
            frame.display = number in places
            frame.is_focused = number == self.window.focused
            frame.title_line.refresh_if_changed()
        self._place_again()
        if focus:
            self.bring_focus()

    def _place_again(self) -> None:
        """Lay the panes out again. Textual calls `layout` again only when a child requests it."""
        self.refresh()
        for frame in self.frames.values():
            frame.refresh(layout=True)

    def bring_focus(self) -> None:
        """Move the focus to the pane that should have it."""
        self.focus_is_due = True
        self._focus()
        self.call_after_refresh(self._bring_focus, TRIES)  # a new pane cannot take it earlier

    def regain_focus(self) -> bool:
        """Restore the focus of the focused pane; return whether the pane can take it."""
        frame = self.focused
        if frame is None or not frame.view.focus_target.focusable:
            return False
        self.bring_focus()
        return True

    def _focus(self) -> None:
        frame = self.focused
        if frame is not None and frame.display and frame.is_mounted and not frame.has_focus_within:
            frame.view.focus_inside()

    def _bring_focus(self, tries: int) -> None:
        self._focus()
        frame = self.focused
        if tries and frame is not None and frame.display and not frame.has_focus_within:
            self.set_timer(TRY_AGAIN_AFTER, lambda: self._bring_focus(tries - 1))
            return
        self.focus_is_due = False
        self.post_message(self.FocusArrived())

    def replace_view(self, number: int, content: Content) -> None:
        """Replace the view in a pane."""
        frame = self.frames.pop(number, None)
        if frame is not None:
            frame.remove()
        pane = next(p for w in self.windows.windows.values() for p in w.panes() if p.number == number)
        pane.content = content
        self.sync()

    def store_contents(self) -> None:
        """Store the views' current content in the windows, so that it is saved with them."""
        for window in self.windows.windows.values():
            for pane in window.panes():
                if pane.number in self.frames:
                    pane.content = self.frames[pane.number].view.content

    def room(self, number: int) -> Rect:
        """Return the place of a pane, or the one it would have if displayed."""
        places = self.window.places(*self.size)
        return places.get(number, Rect(0, 0, *self.size))

    def on_resize(self) -> None:
        self.sync(focus=False)

    def on_frame_focused(self, event: Frame.Focused) -> None:
        frame = self.frames.get(event.number)
        if frame is None or not frame.has_focus_within or self.focus_is_due:  # a late report: the focus has moved on
            return
        if event.number in self.window.numbers and event.number != self.window.focused:
            self.window.focus(event.number)
            self.sync(focus=False)

    # the lines between panes, and dragging them

    def render_line(self, y: int) -> Strip:
        width = self.size.width
        colours = colours_of(self)
        base = self.rich_style
        bars = {
            d.place.x
            for d in self.window.dividers(*self.size)
            if d.split.axis == "columns" and d.place.y <= y < d.place.bottom
        }
        pieces, at = [], 0
        for x in sorted(bars):
            pieces += [Segment(" " * (x - at), base), Segment("│", base + colours.dim)]
            at = x + 1
        return Strip([*pieces, Segment(" " * (width - at), base)]).crop_extend(0, width, base)

    def _divider_at(self, x: int, y: int) -> Divider | None:
        return next((d for d in self.window.dividers(*self.size) if d.place.contains(x, y)), None)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        self._grab(int(event.x), int(event.y))

    def on_title_grabbed(self, event: Title.Grabbed) -> None:
        self._grab(event.x - self.region.x, event.y - self.region.y)

    def _grab(self, x: int, y: int) -> None:
        self._dragged = self._divider_at(x, y)
        if self._dragged is not None:
            self.capture_mouse()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._dragged is None:
            return
        divider = self._dragged
        to = int(event.x) if divider.split.axis == "columns" else int(event.y)
        if drag(divider, to):
            self._place_again()
            # A divider has the place at which it was; the next move begins at its new one.
            self._dragged = next(
                (
                    d
                    for d in self.window.dividers(*self.size)
                    if d.split is divider.split and d.before == divider.before
                ),
                None,
            )

    def on_mouse_up(self) -> None:
        if self._dragged is not None:
            self._dragged = None
            self.release_mouse()
            focused = self.focused
            if focused is not None:
                focused.view.focus_inside()

"""The console's actions on panes and windows."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from textual.widgets import Input

from graphflow.tui.commands.actions import shown
from graphflow.tui.context import ConsoleApp
from graphflow.tui.layout import to_section
from graphflow.tui.panes import MAX_WINDOWS, Axis, Content, Direction
from graphflow.tui.registry import view_class
from graphflow.tui.widgets.dialogs import AskLine, Item, Pick
from graphflow.tui.widgets.line_view import LineView

STEP = {"left": 4, "right": 4, "up": 2, "down": 2}
"""Cells by which a key moves a border."""


class PaneCommands:
    """Carries out the console's actions on panes and windows."""

    def __init__(self, console: ConsoleApp) -> None:
        self._app = console

    # panes

    def do_split(self, axis: Axis) -> None:
        self._split(axis)

    def _split(self, axis: Axis, content: Content | None = None) -> bool:
        app = self._app
        windows = app.windows
        number = app.window.focused
        new = windows.make_pane(content or Content("prompt"))
        if not app.window.split(number, new, axis, app.workspace.room(number)):
            if content is None:
                app.say("no room for another pane here; zoom out, close one, or open a window", bad=True)
            return False
        app.changed()
        return True

    def open_beside(self, content: Content) -> None:
        """Open a view beside the focused pane, or in a new window if there is no room."""
        app = self._app
        visible = {frame.number: frame.view for frame in app.workspace.visible_frames}
        for number, view in visible.items():
            if view.shows(content):
                app.window.focus(number)
                app.changed()
                return
        same = [p for p in app.window.panes() if str(p.content) == str(content) and content.view != "prompt"]
        if same:
            app.window.focus(same[0].number)
            app.changed()
            if same[0].number in app.workspace.frames:
                app.workspace.frames[same[0].number].view.reopened(content)
            return
        room = app.workspace.room(app.window.focused)
        least, lowest = view_class(content.view).LEAST_WIDTH, view_class(content.view).LEAST_HEIGHT
        ways: list[tuple[Axis, bool]] = [
            ("columns", room.width >= 2 * least + 1 and room.width > 2.5 * room.height),
            ("rows", room.width >= least and room.height >= 2 * lowest),
            ("columns", room.width >= 2 * least + 1),
        ]
        if any(fits and self._split(axis, content) for axis, fits in ways):
            return
        self.open_window(content)
        app.say(f"opened in a window of its own; {shown(app.prefix)} l goes back")

    def open_window(self, content: Content, name: str = "") -> None:
        """Open a view in a new window, or go to the window that has it."""
        app = self._app
        for number, window in app.windows.windows.items():
            if [str(p.content) for p in window.panes()] == [str(content)]:
                self.go_to_window(number)
                return
        if len(app.windows.windows) >= MAX_WINDOWS:
            app.say(f"there are {MAX_WINDOWS} windows; close one first", bad=True)
            return
        app.windows.select(app.windows.open(name or content.view, app.windows.make_pane(content)))
        app.changed()

    def do_focus(self, direction: Direction) -> None:
        window = self._app.window
        found = window.neighbour(window.focused, direction, *self._app.workspace.size)
        if found is not None:
            window.focus(found)
            self._app.changed()

    def do_step_pane(self, step: str) -> None:
        window = self._app.window
        window.focus(window.next_pane(window.focused, int(step)))
        self._app.changed()

    def do_last_pane(self) -> None:
        self._app.window.focus(self._app.window.last_focused)
        self._app.changed()

    def do_zoom(self) -> None:
        window = self._app.window
        window.zoomed = not window.zoomed and len(window.numbers) > 1
        self._app.changed()

    def do_close_pane(self) -> None:
        app = self._app
        if not app.window.close(app.window.focused):
            self.do_close_window()
            return
        app.changed()

    def do_swap(self, step: str) -> None:
        self._app.window.swap(self._app.window.focused, int(step))
        self._app.changed()

    def do_break_pane(self) -> None:
        app = self._app
        app.workspace.store_contents()
        window = app.window
        pane = window.pane(window.focused)
        if not window.close(pane.number):
            app.say("the pane already has a window of its own")
            return
        pane.share = 1.0
        app.windows.select(app.windows.open(pane.content.view, pane))
        app.changed()

    def do_grow(self, direction: Direction) -> None:
        window = self._app.window
        if window.resize(window.focused, direction, STEP[direction], *self._app.workspace.size):
            self._app.changed()

    def do_next_layout(self) -> None:
        self._app.say(f"layout {self._app.window.next_layout()}")
        self._app.changed()

    def do_arrange(self, layout: str) -> None:
        """Arrange the panes of the window in a named layout."""
        self._app.window.arrange(layout)
        self._app.changed()

    def do_scroll_mode(self) -> None:
        view = self._app.focused_view
        lines = None if view is None else next(iter(view.query(LineView)), None)
        if lines is None:
            self._app.say("nothing to scroll in this pane")
            return
        lines.focus()
        lines.action_page(-1)
        self._app.say("scrolled back: ↑↓ pgup pgdn move, / searches, n N go on, y copies a line, end follows again")

    def search_in(self, lines: LineView[Any]) -> None:
        """Prompt for a text, and search for it in a view of lines."""

        def typed(text: str | None) -> None:
            if text and not (lines.search(text, -1) or lines.search(text, 1)):
                self._app.say(f"no line contains {text!r}")

        self._app.push_screen(AskLine("Search for; n and N go on from there", lines.search_text), typed)

    def do_paste(self) -> None:
        focused = self._app.focused
        if isinstance(focused, Input) and self._app.clipboard_text:
            focused.insert_text_at_cursor(self._app.clipboard_text.replace("\n", " "))
        elif not self._app.clipboard_text:
            self._app.say("nothing has been copied yet")

    def do_change_view(self) -> None:
        self._pick_view("Show in this pane", self._replace_view)

    def _replace_view(self, content: Content) -> None:
        window = self._app.window
        if window.name == window.pane(window.focused).content.view:  # named by default, not by the user
            window.name = content.view
        self._app.workspace.replace_view(window.focused, content)

    # windows

    def do_new_window(self) -> None:
        self._pick_view("New window with", self.open_window)

    def _pick_view(self, question: str, use: Callable[[Content], None]) -> None:
        from graphflow.tui.widgets.pickable import contents

        def picked(content: Content | None) -> None:
            if content is not None:
                use(content)
                self._app.changed()

        self._app.push_screen(Pick(question, contents(self._app.hub)), picked)

    def do_step_window(self, step: str) -> None:
        self._app.windows.step(int(step))
        self._app.changed()

    def do_select_window(self, number: str) -> None:
        self.go_to_window(int(number))

    def do_last_window(self) -> None:
        self.go_to_window(self._app.windows.last)

    def go_to_window(self, number: int) -> None:
        """Make a window current."""
        if not self._app.windows.select(number):
            self._app.say(f"there is no window {number}; {shown(self._app.prefix)} c opens one")
            return
        self._app.flags.pop(number, None)
        self._app.changed()

    def do_rename_window(self) -> None:
        def renamed(name: str | None) -> None:
            if name and name.isprintable():
                self._app.window.name = name.strip()[:40]
                self._app.changed()

        self._app.push_screen(AskLine("Name of the window", self._app.window.name), renamed)

    def do_close_window(self) -> None:
        app = self._app
        if not app.windows.close(app.windows.current):
            app.say(f"the last window stays; {shown(app.prefix)} d leaves the console")
            return
        app.changed()

    def do_windows(self) -> None:
        items = [
            Item(f"{number}:{window.name}", str(pane.content), (number, pane.number))
            for number, window in self._app.windows.windows.items()
            for pane in window.panes()
        ]

        def picked(place: tuple[int, int] | None) -> None:
            if place is not None:
                self._app.windows.select(place[0])
                self._app.window.focus(place[1])
                self._app.changed()

        self._app.push_screen(Pick("Windows and panes", items), picked)

    def do_save_layout(self) -> None:
        app = self._app
        if app.hub.supervision is None:
            app.say("there is no graph file to write to: these nodes were started elsewhere", bad=True)
            return
        from graphflow.graph.edit import with_console
        from graphflow.tui.widgets.file_changes import write_file

        app.workspace.store_contents()
        file = Path(app.hub.supervision.run.file)
        write_file(app, file, lambda text: with_console(text, to_section(app.windows)), "the windows of this console")

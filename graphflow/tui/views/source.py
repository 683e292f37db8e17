"""A source file at a line: a wait, or the origin of a log record."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from pathlib import Path

from rich.syntax import Syntax
from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget

from graphflow.reading import found_bytes
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.line_view import LineView

LONGEST = 1 << 20
"""Maximum bytes shown of a file."""
FILES_BOUND = 5000
"""Maximum files searched for one known only by name."""


class Source(View):
    """A file at a line."""

    NAME = "source"
    DOC = "the file and line of a wait or a log line"
    LEAST_WIDTH = 56
    ACTIONS = (
        Action("edit", "open in $EDITOR", keys=("e",), hint=True),
        Action("back", "back to the line", keys=("b",), hint=True),
        Action("close", "close", keys=("escape",), hint=True),
        Action("copy", "copy file:line", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        name, _, line = self.about.rpartition(":")
        self._line = int(line) if line.isdecimal() else 1
        self._file = find_file(name if line.isdecimal() else self.about, self._roots())
        self._lines = LineView[Text](50_000)
        self._lines.follows = False

    def _roots(self) -> list[Path]:
        plan = self.hub.plan
        return [Path.cwd(), *([Path(plan.root)] if plan is not None else [])]

    def compose(self) -> ComposeResult:
        yield self._lines

    @property
    def focus_target(self) -> Widget:
        return self._lines

    def on_mount(self) -> None:
        if self._file is None:
            self._lines.replace([Text(f"there is no file {self.about} here", style=self.colours.warn)])
            return
        try:
            data = found_bytes(self._file)[:LONGEST]
        except OSError as error:
            self._lines.replace([Text(f"{self._file}: {error.strerror}", style=self.colours.warn)])
            return
        code = "\n".join(plain_text(line) for line in data.decode(errors="replace").split("\n"))
        theme = "monokai" if self.colours.is_dark else "default"
        lexer = Syntax.guess_lexer(str(self._file), code)
        rows = Syntax("", lexer, theme=theme, background_color="default").highlight(code).split("\n")
        width = len(str(len(rows)))
        lines = []
        for number, row in enumerate(rows, 1):
            mark = "▶" if number == self._line else " "
            row.stylize_before(self.colours.text)
            lines.append(Text.assemble((f"{mark}{number:>{width}} ", self.colours.dim), row))
        self._lines.extend(lines)
        self.call_after_refresh(self.do_back)

    def on_resize(self) -> None:
        """Keep the line centred until the user moves: a new pane gets its size only later."""
        if self._lines.cursor == self._at:
            self.call_after_refresh(self.do_back)

    @property
    def _at(self) -> int:
        """The row of the line."""
        return min(self._line - 1, max(0, len(self._lines.rows) - 1))

    def do_back(self) -> None:
        self._lines.cursor = self._at
        height = self._lines.scrollable_content_region.height
        self._lines.scroll_to(y=max(0, self._line - 1 - height // 2), animate=False, immediate=True)
        self._lines.refresh()

    def do_edit(self) -> None:
        if self._file is None:
            return
        at = (self._lines.cursor or 0) + 1
        edit(self, self._file, at)

    def do_close(self) -> None:
        self.console.commands.do_close_pane()

    def do_copy(self) -> None:
        place = f"{self._file or self.about}:{(self._lines.cursor or 0) + 1}"
        self.console.copy(place)


def edit(view: View, file: Path, line: int) -> None:
    """Open a file in the user's editor, which takes over the terminal."""
    editor = os.environ.get("VISUAL") or os.environ.get("EDITOR")
    if not editor:
        view.say("set EDITOR, for example export EDITOR=nano", bad=True)
        return
    try:
        words = shlex.split(editor)
    except ValueError as error:
        view.say(f"EDITOR is {editor!r}: {error}", bad=True)
        return
    if not words or shutil.which(words[0]) is None:
        view.say(f"EDITOR is {editor!r}, and there is no such program: install it, or export EDITOR=nano", bad=True)
        return
    trouble = ""
    with view.app.suspend():  # Textual does not leave `suspend` cleanly when something is raised in it
        try:
            subprocess.run([*words, f"+{line}", str(file)], check=False)
        except OSError as error:
            trouble = f"{editor}: {error.strerror}"
    if trouble:
        view.say(trouble, bad=True)


def find_file(name: str, roots: list[Path]) -> Path | None:
    """Find a file by its path, or by its name below one of the folders."""
    path = Path(name)
    for root in roots:
        if (root / path).is_file():
            return root / path
    if path.name != name:
        return None
    for root in roots:
        for looked, found in enumerate(root.rglob("*.py")):
            if found.name == name and ".venv" not in found.parts:
                return found
            if looked > FILES_BOUND:
                break
    return None


VIEW = Source

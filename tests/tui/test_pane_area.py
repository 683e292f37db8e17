"""Panes on the screen: the mouse focuses them and drags borders; titles describe their content."""

from __future__ import annotations

import pytest

from graphflow.tui.pane_area import Frame, Title, Workspace, _cut
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_a_click_focuses_a_pane() -> None:
    """A click on the title or anywhere in a pane focuses it."""
    async with stage(Content("nodes")) as s:
        await s.prefix("percent_sign")
        a, b = s.console.window.numbers
        assert s.console.window.focused == b
        await s.pilot.click(s.console.workspace.frames[a].title_line)
        await s.until(lambda: s.console.window.focused == a)
        await s.pilot.click(s.console.workspace.frames[b].view)
        await s.until(lambda: s.console.window.focused == b)


@slow
@pytest.mark.parametrize(("key", "axis"), [("percent_sign", "columns"), ("quotation_mark", "rows")])
async def test_borders_are_dragged(key: str, axis: str) -> None:
    """The line between columns can be dragged, and the title of the lower of two rows."""
    async with stage(Content("nodes"), size=(100, 30)) as s:
        await s.prefix(key)
        await s.pilot.pause()
        a, b = s.console.window.numbers
        frames = s.console.workspace.frames
        before = frames[a].size
        if axis == "columns":
            x, y = frames[a].region.right, 5
            await s.pilot.mouse_down(Workspace, offset=(x, y))
            await s.pilot.hover(Workspace, offset=(x + 10, y))
            await s.pilot.mouse_up(Workspace, offset=(x + 10, y))
            await s.until(lambda: frames[a].size.width == before.width + 10)
        else:
            y = frames[b].region.y
            await s.pilot.mouse_down(frames[b].title_line)
            await s.pilot.hover(Workspace, offset=(5, y - 4))
            await s.pilot.mouse_up(Workspace, offset=(5, y - 4))
            await s.until(lambda: frames[a].size.height == before.height - 4)


@slow
async def test_views_keep_their_state_while_another_window_is_shown() -> None:
    """A view is not recreated when its window is left and shown again."""
    async with stage(Content("nodes"), Content("log")) as s:
        await s.prefix("1")
        view = s.view
        await s.prefix("0")
        await s.prefix("1")
        assert s.view is view
        assert len(s.console.query(Frame)) == 2


@slow
async def test_the_title_says_what_is_special() -> None:
    """The note is on the right of the title if there is room; the focused title is marked."""
    async with stage(Content("log"), size=(60, 20)) as s:
        assert s.text.startswith("▌log of all nodes")
        assert "follow ▼" in s.text.split("\n")[0]
        await s.prefix("quotation_mark")
        assert s.text.startswith(" log of all nodes ──")
        assert len(s.console.query(Title)) == 2


async def test_a_note_that_comes_and_goes_between_two_looks() -> None:
    """A note that appears and vanishes between two updates is not left in the title."""
    async with stage(Content("log")) as s:
        title = s.console.workspace.frames[s.console.window.focused].title_line
        title.refresh_if_changed()
        s.view._bad = "a passing note"  # type: ignore[attr-defined]
        assert "a passing note" in title.render_line(0).text
        s.view._bad = ""  # type: ignore[attr-defined]
        title.refresh_if_changed()
        await s.until(lambda: "a passing note" not in s.text)
        assert "a passing note" not in title.render_line(0).text
        assert title._shown[1] == s.view.note


@pytest.mark.parametrize(("width", "shown"), [(6, "a name"), (5, "a na…"), (1, "…"), (0, ""), (-3, "")])
def test_titles_that_are_too_long(width: int, shown: str) -> None:
    """Long titles end with an ellipsis."""
    assert _cut("a name", width) == shown


@pytest.mark.parametrize(("width", "shown"), [(6, "a note"), (5, "a no…"), (4, "a n…"), (3, "")])
def test_notes_without_room(width: int, shown: str) -> None:
    """Notes are left out rather than cut to a few letters."""
    assert _cut("a note", width, least=4) == shown

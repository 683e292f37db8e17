"""Every key for panes and windows does what its description says, even while an input is focused."""

from __future__ import annotations

import pytest

from graphflow.tui.panes import Content, Split, Window
from graphflow.tui.widgets.dialogs import AskLine, Pick
from tests.cases import slow, some
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
@pytest.mark.parametrize("focused", some(["list", "line"], "line"))
async def test_panes(focused: str) -> None:
    """Panes are split, focused, resized, zoomed, swapped, broken out and closed, whatever has the focus."""
    first = Content("nodes") if focused == "list" else Content("prompt")
    async with stage(first) as s:

        def window() -> Window:
            return s.console.window  # a different one after each step

        a = window().focused
        await s.prefix("percent_sign")
        b = window().focused
        assert window().numbers == [a, b]
        assert b != a
        await s.prefix("quotation_mark")
        c = window().focused
        assert window().numbers == [a, b, c]
        for key, there in (("up", b), ("left", a), ("right", b), ("down", c), ("o", a), ("semicolon", c)):
            await s.prefix(key)
            assert window().focused == there, key
        before = window().places(100, 28)
        await s.prefix("ctrl+up")
        assert window().places(100, 28)[c].height == before[c].height + 2
        await s.prefix("ctrl+left")
        assert window().places(100, 28)[c].width == before[c].width + 4
        await s.prefix("ctrl+right")
        await s.prefix("ctrl+down")
        assert window().places(100, 28) == before
        await s.prefix("z")
        assert window().zoomed
        assert window().places(100, 28) == {c: (0, 0, 100, 28)}
        await s.prefix("z")
        assert not window().zoomed
        await s.prefix("left_curly_bracket")
        assert window().numbers == [a, c, b]
        await s.prefix("right_curly_bracket")
        assert window().numbers == [a, b, c]
        for i, name in enumerate(("even-horizontal", "even-vertical", "main-horizontal", "main-vertical", "tiled")):
            await s.prefix(f"alt+{i + 1}")
            assert window().layout == name
        await s.prefix("space")
        assert window().layout == "even-horizontal"
        await s.prefix("exclamation_mark")
        assert [w.numbers for w in s.console.windows.windows.values()] == [[a, b], [c]]
        assert s.console.windows.current == 1
        await s.prefix("x")
        assert [w.numbers for w in s.console.windows.windows.values()] == [[a, b]]
        await s.prefix("x")
        await s.prefix("x")
        assert len(window().numbers) == 1
        assert "the last window stays" in s.text
        assert s.asked == [], "closing panes stops no node"


@pytest.mark.parametrize("focused", some(["topics", "prompt"]))
async def test_windows(focused: str) -> None:
    """Windows are opened, selected, renamed and closed."""
    async with stage(Content("nodes"), Content(focused), Content("log")) as s:
        windows = s.console.windows
        for key, there in (("n", 1), ("l", 0), ("p", 2), ("1", 1), ("2", 2), ("0", 0), ("l", 2), ("1", 1)):
            await s.prefix(key)
            assert windows.current == there, key
        await s.prefix("9")
        await s.until("there is no window 9")
        await s.prefix("comma")
        assert isinstance(s.console.screen, AskLine)
        await s.press("ctrl+u")
        await s.type("drive")
        await s.press("enter")
        assert windows.window.name == "drive"
        assert "1:drive*" in s.text
        await s.prefix("ampersand")
        assert list(windows.windows) == [0, 2]
        await s.prefix("c")
        assert isinstance(s.console.screen, Pick)
        await s.type("top")
        await s.press("enter")
        assert list(windows.windows) == [0, 1, 2]
        assert windows.window.name in ("top", "topics")
        await s.prefix("w")
        assert isinstance(s.console.screen, Pick)
        await s.type("log")
        await s.press("enter")
        assert windows.current == 2


@slow
@pytest.mark.parametrize(
    ("size", "view", "where"),
    [
        ((120, 30), "params", "columns"),
        ((100, 30), "params", "rows"),
        ((100, 14), "params", "a window"),
        ((100, 14), "echo", "columns"),
        ((50, 40), "params", "a window"),
        ((58, 40), "params", "rows"),
    ],
)
async def test_what_is_opened_has_the_room_that_it_needs(size: tuple[int, int], view: str, where: str) -> None:
    """A view opens beside, below, or in a new window."""
    async with stage(Content("top"), size=size) as s:
        s.console.open_beside(Content(view, "/talker"))
        await s.pilot.pause()
        root = s.console.windows.windows[0].root
        assert (root.axis if isinstance(root, Split) else "a window") == where
        assert (len(s.console.windows.windows) == 2) is (where == "a window")

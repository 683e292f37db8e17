"""Images in the pixels of a terminal."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from textual.app import App, ComposeResult

from graphflow.tui.widgets import graphics
from graphflow.tui.widgets.graphics import Graphics, are_drawn, ask_terminal

pytestmark = pytest.mark.usefixtures("graphflow_runner")
widget = pytest.importorskip("textual_image.widget")


def test_a_terminal_that_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is not asked, and draws nothing."""
    monkeypatch.setattr(graphics, "_widgets", [])
    monkeypatch.setattr(sys, "__stdout__", None)
    ask_terminal()
    assert not are_drawn()


@pytest.mark.parametrize(("best", "drawn"), [("SixelImage", True), ("TGPImage", True), ("HalfcellImage", False)])
def test_what_a_terminal_can(monkeypatch: pytest.MonkeyPatch, best: str, drawn: bool) -> None:
    """Graphics are used only if the terminal has answered that it draws them."""
    from textual_image import renderable

    monkeypatch.setattr(graphics, "_widgets", [])
    monkeypatch.setattr(sys, "__stdout__", SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr(renderable, "Image", getattr(renderable, best))
    ask_terminal()
    assert are_drawn() is drawn


def test_without_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then cells are used."""
    monkeypatch.setattr(graphics, "_widgets", [])
    monkeypatch.setattr(sys, "__stdout__", SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr(graphics, "find_spec", lambda _: None)
    ask_terminal()
    assert not are_drawn()


class Shows(App[None]):
    def compose(self) -> ComposeResult:
        yield Graphics()


@pytest.mark.filterwarnings("ignore:Image.Image.getdata:DeprecationWarning")
@pytest.mark.parametrize(("shape", "is_wide"), [((20, 200, 3), True), ((200, 20, 3), False)])
async def test_shapes(monkeypatch: pytest.MonkeyPatch, shape: tuple[int, int, int], is_wide: bool) -> None:
    """An image fills the width or the height, and large ones are made smaller."""
    monkeypatch.setattr(graphics, "_widgets", [widget.HalfcellImage])
    app = Shows()
    async with app.run_test(size=(40, 20)) as pilot:
        shown = app.query_one(Graphics)
        shown.show(np.zeros(shape, np.uint8))
        await pilot.pause()
        drawing = shown.query_one(widget.HalfcellImage)
        assert (drawing.styles.width.is_auto, drawing.styles.height.is_auto) == (not is_wide, is_wide)
        assert 0 < drawing.size.width <= 40
        assert 0 < drawing.size.height <= 20
        shown.show(np.zeros((4000, 4000, 3), np.uint8))
        assert drawing.image.size == (480, 480)

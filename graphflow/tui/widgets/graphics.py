"""Images in pixels, in terminals that draw graphics: by sixel, or by kitty's protocol (extra `images`)."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING

from textual.app import ComposeResult
from textual.containers import Center

from graphflow.introspect.messages.images import Pixels, picture, shrunk

if TYPE_CHECKING:
    from textual_image.widget import AutoImage, SixelImage

CELL = (12, 24)
"""Pixels of a cell that an image may have, at most: more only take time."""
_widgets: list[type[AutoImage | SixelImage]] = []
"""The widget that draws what the terminal can; empty if it cannot, or was not asked."""


def ask_terminal() -> None:
    """Find out whether the terminal draws graphics. Before the console starts: it reads all that the terminal sends."""
    has_terminal = sys.__stdout__ is not None and sys.__stdout__.isatty()
    if _widgets or not has_terminal or find_spec("textual_image") is None:
        return
    from textual_image.renderable import Image as Best
    from textual_image.renderable import SixelImage, TGPImage
    from textual_image.widget import Image

    if Best in (SixelImage, TGPImage):
        _widgets.append(Image)


def are_drawn() -> bool:
    """Whether the terminal draws graphics."""
    return bool(_widgets)


class Graphics(Center):
    """An image as large as fits, in the terminal's pixels."""

    DEFAULT_CSS = """
    Graphics { height: 1fr; align: center top; }
    Graphics > * { width: auto; height: auto; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._drawing = _widgets[0]()

    def compose(self) -> ComposeResult:
        yield self._drawing

    def show(self, image: Pixels) -> None:
        """Show another image."""
        width, height = self.size
        rows, columns = image.shape[:2]
        if not width or not height:
            return
        # A cell is about twice as high as wide; the widget keeps the shape of the image.
        is_wide = columns * 2 * height > rows * width
        self._drawing.styles.width = "100%" if is_wide else "auto"
        self._drawing.styles.height = "auto" if is_wide else "100%"
        scale = min(width * CELL[0] / columns, height * CELL[1] / rows)
        small = shrunk(image, max(1, int(columns * scale)), max(1, int(rows * scale))) if scale < 1 else image
        self._drawing.image = picture(small)

"""Contrast: WCAG AA in both themes, and the ansi themes use the terminal's own colours."""

from __future__ import annotations

from typing import Any

import pytest
from rich.style import Style
from rich.text import Text
from textual.theme import Theme

from graphflow.tui.panes import Content
from graphflow.tui.widgets.colours import DARK, LIGHT
from graphflow.tui.widgets.line_view import LineView
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

AA = 4.5
"""The contrast required for text of normal size. Source: WCAG 2.1, 1.4.3."""


def luminance(rgb: tuple[int, int, int]) -> float:
    parts = [c / 255 for c in rgb]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: tuple[int, int, int], b: tuple[int, int, int]) -> float:
    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def rgb(text: str) -> tuple[int, int, int]:
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


@slow
@pytest.mark.parametrize("theme", [DARK, LIGHT], ids=["dark", "light"])
async def test_all_that_is_written_can_be_read(theme: Theme) -> None:
    """Contrast suffices on the background, on titles, and on selected rows."""
    name = theme.name
    async with stage(Content("help")) as s:
        s.console.theme = name
        await s.pilot.pause()
        colours = s.console.colours
        styles: dict[str, Style] = {
            n: getattr(colours, n) for n in ("text", "dim", "strong", "accent", "good", "warn", "bad")
        }
        styles |= {f"node {i}": style for i, style in enumerate(colours.nodes)} | {"match": colours.match}
        for ground in (theme.background, theme.surface, theme.panel):
            assert ground is not None
            for what, style in styles.items():
                assert style.color is not None
                triplet = style.color.get_truecolor()
                found = contrast((triplet.red, triplet.green, triplet.blue), rgb(ground))
                assert found >= (AA if ground != theme.panel else 4.0), (name, what, ground, round(found, 2))


async def test_ansi_themes_use_the_terminals_colours() -> None:
    """The themes contain no colours of their own."""
    async with stage(Content("help")) as s:
        s.console.theme = "ansi-dark"
        await s.pilot.pause()
        colours = s.console.colours
        assert colours.text.color is None
        assert all(
            style.color is None or style.color.is_default or style.color.number is not None for style in colours.nodes
        )


@slow
async def test_a_node_has_one_colour() -> None:
    """A node has the same colour in all views."""
    async with stage(Content("help")) as s:
        assert s.console.colours.node("/a") == s.console.colours.node("/a")


@slow
async def test_lines_drawn_before_a_change_of_theme_follow_it() -> None:
    """Lines change with the theme, and back."""
    async with stage(Content("prompt")) as s:
        lines: LineView[Any] = s.view.query_one(LineView)
        colours = s.console.colours
        lines.extend([Text.assemble(("good ", colours.good), ("/talker", colours.nodes[7]), style=colours.dim)])
        for name in (LIGHT.name, DARK.name):
            s.console.theme = name
            await s.until(lambda is_dark=name == DARK.name: s.console.colours.is_dark is is_dark)
            colours = s.console.colours
            text = lines.last_row
            assert text is not None
            assert [text.style, text.spans[0].style] == [colours.dim, colours.good]
            assert text.spans[1].style == colours.nodes[7]
        assert next(lines.whole_rows).style == colours.dim

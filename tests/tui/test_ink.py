"""Colours can be read: WCAG AA in both themes, and the ansi themes use the terminal's own."""

from __future__ import annotations

import pytest
from rich.style import Style
from rich.text import Text
from textual.theme import Theme

from graphflow.tui.ink import DARK, LIGHT
from graphflow.tui.lines import Lines
from graphflow.tui.panes import Content
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

AA = 4.5
"""The contrast that text of normal size needs. Source: WCAG 2.1, 1.4.3."""


def luminance(rgb: tuple[int, int, int]) -> float:
    parts = [c / 255 for c in rgb]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: tuple[int, int, int], b: tuple[int, int, int]) -> float:
    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def rgb(text: str) -> tuple[int, int, int]:
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


@pytest.mark.parametrize("theme", [DARK, LIGHT], ids=["dark", "light"])
async def test_all_that_is_written_can_be_read(theme: Theme) -> None:
    """On the ground, on titles, and on what is chosen."""
    name = theme.name
    async with stage(Content("help")) as s:
        s.console.theme = name
        await s.pilot.pause()
        ink = s.console.ink
        styles: dict[str, Style] = {
            n: getattr(ink, n) for n in ("text", "dim", "strong", "accent", "good", "warn", "bad")
        }
        styles |= {f"node {i}": style for i, style in enumerate(ink.nodes)} | {"match": ink.match}
        for ground in (theme.background, theme.surface, theme.panel):
            assert ground is not None
            for what, style in styles.items():
                assert style.color is not None
                triplet = style.color.get_truecolor()
                found = contrast((triplet.red, triplet.green, triplet.blue), rgb(ground))
                assert found >= (AA if ground != theme.panel else 4.0), (name, what, ground, round(found, 2))


async def test_ansi_themes_use_the_terminals_colours() -> None:
    """No colour of ours in them."""
    async with stage(Content("help")) as s:
        s.console.theme = "ansi-dark"
        await s.pilot.pause()
        ink = s.console.ink
        assert ink.text.color is None
        assert all(
            style.color is None or style.color.is_default or style.color.number is not None for style in ink.nodes
        )


async def test_a_node_has_one_colour() -> None:
    """Wherever it is named."""
    async with stage(Content("help")) as s:
        assert s.console.ink.node("/a") == s.console.ink.node("/a")


async def test_lines_drawn_before_a_change_of_theme_follow_it() -> None:
    """There and back."""
    async with stage(Content("prompt")) as s:
        lines = s.view.query_one(Lines)
        ink = s.console.ink
        lines.extend([Text.assemble(("good ", ink.good), ("/talker", ink.nodes[7]), style=ink.dim)])
        for name in (LIGHT.name, DARK.name):
            s.console.theme = name
            await s.until(lambda is_dark=name == DARK.name: s.console.ink.is_dark is is_dark)
            ink = s.console.ink
            text = lines.last_row
            assert [text.style, text.spans[0].style] == [ink.dim, ink.good]
            assert text.spans[1].style == ink.nodes[7]
        assert lines.rows[0].style == ink.dim

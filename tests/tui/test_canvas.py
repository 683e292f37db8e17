"""Dots, pictures and moves."""

from __future__ import annotations

import pytest

from graphflow.tui.canvas import DEFAULT_PEN, RECENT, Dots, Drawing, read_picture
from nodes.turtle_canvas import Pen
from nodes.turtle_picture import svg
from nodes.turtle_world import World

RED = (255, 0, 0)


def test_dots_are_braille() -> None:
    """Two columns and four rows to the cell, in Unicode's order; outside is nothing."""
    dots = Dots(2, 1)
    for x, y in ((0, 0), (1, 3), (2, 1), (-1, 0), (99, 0), (0, 99)):
        dots.dot(x, y, RED)
    assert dots.row(0) == [("⢁⠂", RED)]


def test_lines() -> None:
    """From one dot to another, without a gap."""
    dots = Dots(4, 2)
    dots.line(0, 0, 7, 7, RED)
    assert "".join(text for text, _ in dots.row(0)).strip() == "⠑⢄"
    assert "".join(text for text, _ in dots.row(1)).strip() == "⠑⢄"


def test_turtlesims_own_picture_is_read() -> None:
    """Where its turtle went, in metres, and the colour of its pen."""
    world = World()
    world.canvas.draw("t", Pen((1, 2, 3), 3), (2.0, 3.0), (4.0, 5.0))
    [line] = read_picture(svg(world, (0, 0, 0)))
    assert line.colour == (1, 2, 3)
    assert [(round(x, 2), round(y, 2)) for x, y in line.points] == [(2.0, 3.0), (4.0, 5.0)]


@pytest.mark.parametrize(
    "text", ["", "<svg/>", '<polyline points="a,b" stroke="#000000" stroke-width="3"/>', "x" * 10_000_000]
)
def test_no_picture(text: str) -> None:
    """Whatever a service of that name may answer."""
    assert read_picture(text) == []


def test_moves_draw_and_jumps_do_not() -> None:
    """A turtle that was carried has left no line; what is not a number is no place."""
    drawing = Drawing()
    for x, y in ((1.0, 1.0), (1.5, 1.0), (1.5, 1.0), (9.0, 9.0), (float("nan"), 0.0)):
        drawing.moved("t", x, y, 0.0, jump=1.0)
    assert [(m.x0, m.x1) for m in drawing.recent] == [(1.0, 1.5)]
    assert (drawing.turtles["t"].x, drawing.turtles["t"].y) == (9.0, 9.0)


def test_a_picture_replaces_the_moves_before_it_and_tells_the_pens() -> None:
    """Those since it was asked for are drawn upon it."""
    drawing = Drawing()
    for i in range(4):
        drawing.now = float(i)
        drawing.moved("t", i / 10, 0.0, 0.0, jump=1.0)
    assert drawing.turtles["t"].colour == DEFAULT_PEN
    drawing.take(read_picture('<polyline points="0.5,499.5 14.0,499.5" stroke="#ff0000" stroke-width="3"/>'), asked=2.5)
    assert [m.at for m in drawing.recent] == [3.0]
    assert drawing.turtles["t"].colour == RED
    assert drawing.recent.maxlen == RECENT

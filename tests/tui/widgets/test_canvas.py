"""Dots, pictures and moves."""

from __future__ import annotations

import pytest
from textual.geometry import Region

from graphflow.tui.panes import Content
from graphflow.tui.widgets import canvas as module
from graphflow.tui.widgets.canvas import DEFAULT_PEN, RECENT, Dots, Drawing, TurtleCanvas, read_picture
from nodes.turtle_canvas import Pen
from nodes.turtle_picture import svg
from nodes.turtle_world import World
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

RED = (255, 0, 0)


def test_dots_are_braille() -> None:
    """A cell has two columns and four rows in Unicode's order; dots outside are ignored."""
    dots = Dots(2, 1)
    for x, y in ((0, 0), (1, 3), (2, 1), (-1, 0), (99, 0), (0, 99)):
        dots.dot(x, y, RED)
    assert dots.row(0) == [("⢁⠂", RED)]


def test_lines() -> None:
    """A line has no gaps."""
    dots = Dots(4, 2)
    dots.line(0, 0, 7, 7, RED)
    assert "".join(text for text, _ in dots.row(0)).strip() == "⠑⢄"
    assert "".join(text for text, _ in dots.row(1)).strip() == "⠑⢄"


def test_turtlesims_own_picture_is_read() -> None:
    """The path of the turtle is read in metres, with the colour of its pen."""
    world = World()
    world.canvas.draw("t", Pen((1, 2, 3), 3), (2.0, 3.0), (4.0, 5.0))
    [line] = read_picture(svg(world, (0, 0, 0)))
    assert line.colour == (1, 2, 3)
    assert [(round(x, 2), round(y, 2)) for x, y in line.points] == [(2.0, 3.0), (4.0, 5.0)]


@pytest.mark.parametrize(
    "text", ["", "<svg/>", '<polyline points="a,b" stroke="#000000" stroke-width="3"/>', "x" * 10_000_000]
)
def test_no_picture(text: str) -> None:
    """Other responses contain no strokes."""
    assert read_picture(text) == []


def test_moves_draw_and_jumps_do_not() -> None:
    """A teleported turtle leaves no line; positions that are not finite are ignored."""
    drawing = Drawing()
    for x, y in ((1.0, 1.0), (1.5, 1.0), (1.5, 1.0), (9.0, 9.0), (float("nan"), 0.0)):
        drawing.moved("t", x, y, 0.0, jump=1.0)
    assert [(m.x0, m.x1) for m in drawing.recent] == [(1.0, 1.5)]
    assert (drawing.turtles["t"].x, drawing.turtles["t"].y) == (9.0, 9.0)


def test_a_picture_replaces_the_moves_before_it_and_tells_the_pens() -> None:
    """Moves since the request of the picture are drawn over it."""
    drawing = Drawing()
    for i in range(4):
        drawing.now = float(i)
        drawing.moved("t", i / 10, 0.0, 0.0, jump=1.0)
    assert drawing.turtles["t"].colour == DEFAULT_PEN
    drawing.take(read_picture('<polyline points="0.5,499.5 14.0,499.5" stroke="#ff0000" stroke-width="3"/>'), asked=2.5)
    assert [m.at for m in drawing.recent] == [3.0]
    assert drawing.turtles["t"].colour == RED
    assert drawing.recent.maxlen == RECENT


async def test_only_what_has_changed_is_drawn_again() -> None:
    """Heads and names are redrawn at their old and new places, with new pieces of lines; nothing if nothing moves."""
    drawing = Drawing()
    drawing.moved("alice", 2.0, 2.0, 0.0, jump=1.0)
    drawing.moved("bob", 9.0, 9.0, 0.0, jump=1.0)
    async with stage(Content("nodes"), size=(80, 30)) as s:
        canvas = TurtleCanvas(drawing)
        await s.view.mount(canvas)
        await s.pilot.pause()
        canvas.redraw()
        asked: list[Region] = []
        canvas.refresh = lambda *regions, **_: asked.extend(regions)  # type: ignore[method-assign,assignment]
        before = canvas._placed["alice"]
        canvas.redraw()
        assert asked == []
        drawing.moved("alice", 2.9, 2.0, 0.0, jump=1.0)
        canvas.redraw()
        after = canvas._placed["alice"]
        for column, row, *_ in (before, after):
            for cell in ((column, row), (column + 1, row - 1), (column + len("alice"), row - 1)):
                assert any(region.contains(*cell) for region in asked)
        far = canvas._placed["bob"]
        assert not any(region.contains(*far[:2]) for region in asked)


async def test_names_of_turtles_that_are_near_each_other() -> None:
    """The second name is below its turtle, as is that of a turtle at the upper edge."""
    drawing = Drawing()
    for name, x, y in (("alice", 2.0, 2.0), ("bob", 2.6, 2.0), ("carol", 9.0, 11.0)):
        drawing.moved(name, x, y, 0.0, jump=1.0)
    async with stage(Content("nodes"), size=(80, 40)) as s:
        canvas = TurtleCanvas(drawing)
        canvas.styles.height = 30
        await s.view.mount(canvas)
        await s.pilot.pause()
        canvas.redraw()
        placed = canvas._placed
        assert placed["alice"].row == placed["bob"].row
        assert placed["alice"].name_row == placed["alice"].row - 1
        assert placed["bob"].name_row == placed["bob"].row + 1
        assert (placed["carol"].row, placed["carol"].name_row) == (0, 1)
        await s.until("alice")
        assert "bob" in s.text
        drawing.moved("bob", 7.0, 2.0, 0.0, jump=1.0)
        canvas.redraw()
        assert canvas._placed["bob"].name_row == canvas._placed["bob"].row - 1


def test_a_picture_that_is_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its first strokes are drawn."""
    stroke = '<polyline points="0.5,499.5 14.0,499.5" stroke="#ff0000" stroke-width="3"/>'
    monkeypatch.setattr(module, "PICTURE_BOUND", 2 * len(stroke))
    assert len(read_picture(stroke * 3)) == 2


def test_a_name_that_is_too_long() -> None:
    """It takes up so many cells."""
    assert len(module.Placed(0, 0, "▲", 1).named("x" * 1000)) == module.LONGEST


async def test_a_long_name_that_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only its cells are drawn again."""
    monkeypatch.setattr(module, "LONGEST", 3)
    drawing = Drawing()
    drawing.moved("x" * 40, 1.0, 2.0, 0.0, jump=1.0)
    async with stage(Content("nodes"), size=(80, 30)) as s:
        canvas = TurtleCanvas(drawing)
        await s.view.mount(canvas)
        await s.pilot.pause()
        canvas.redraw()
        asked: list[Region] = []
        canvas.refresh = lambda *regions, **_: asked.extend(regions)  # type: ignore[method-assign,assignment]
        drawing.moved("x" * 40, 1.5, 2.0, 0.0, jump=1.0)
        canvas.redraw()
        at = canvas._placed["x" * 40]
        assert any(region.contains(at.column + 3, at.name_row) for region in asked)
        assert not any(region.contains(at.column + 10, at.name_row) for region in asked)

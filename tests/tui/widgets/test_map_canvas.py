"""The drawing of a robot from above."""

from __future__ import annotations

import pytest

from graphflow.tui.widgets.map_canvas import FARTHEST, NEAREST, SEEN_BOUND, RobotDrawing


def test_obstacles_are_remembered_up_to_a_bound() -> None:
    """Nearby points share a cell; the oldest cells go first."""
    drawing = RobotDrawing()
    drawing.scanned([(0.01, 0.01), (0.02, 0.03), (1.0, 1.0)])
    assert len(drawing.seen) == 2
    drawing.scanned([(i * 0.05 + 0.01, 50.0) for i in range(SEEN_BOUND + 10)])
    assert len(drawing.seen) == SEEN_BOUND
    assert (0, 0) not in drawing.seen


def test_the_trail() -> None:
    """A robot that stands leaves no trail; the middle follows it, or stays."""
    drawing = RobotDrawing()
    for x in (0.0, 0.001, 0.1, 0.1):
        drawing.moved(x, 0.0, 0.0)
    assert list(drawing.trail) == [(0.0, 0.0), (0.1, 0.0)]
    assert drawing.middle == (0.1, 0.0)
    drawing.follows = False
    drawing.moved(2.0, 0.0, 0.0)
    assert drawing.middle == (0.1, 0.0)
    drawing.clear()
    assert not drawing.trail


@pytest.mark.parametrize(("factor", "end"), [(1.25, FARTHEST), (0.8, NEAREST)])
def test_zoom_has_ends(factor: float, end: float) -> None:
    """Neither a wall nor the world fills the screen with nothing."""
    drawing = RobotDrawing()
    for _ in range(100):
        drawing.zoom(factor)
    assert drawing.radius == end

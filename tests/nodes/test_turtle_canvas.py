"""The drawing surface of turtles."""

import math
import random
from itertools import pairwise

import pytest

from nodes.turtle_canvas import MAX_POINTS, STROKE_POINTS, TOLERANCE, Canvas, Pen, Position, Stroke
from tests.cases import slow, some

RED = Pen((255, 0, 0), 3)


def distance_to_line(point: Position, stroke: Stroke) -> float:
    """How far a point is from a stroke, by trying every piece of it."""
    return min(distance_to_piece(point, a, b) for a, b in pairwise(stroke.points))


def distance_to_piece(p: Position, a: Position, b: Position) -> float:
    """How far a point is from the straight line between two others."""
    length = math.dist(a, b)
    along = 0.0 if length == 0 else ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length**2
    t = min(max(along, 0.0), 1.0)
    return math.dist(p, (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))


def test_a_straight_way_is_two_points() -> None:
    """However many steps it took."""
    canvas = Canvas()
    for i in range(1000):
        canvas.draw("t", RED, (1.0, 1.0 + i * 0.005), (1.0, 1.0 + (i + 1) * 0.005))

    (stroke,) = canvas.strokes
    assert stroke.points == [(1.0, 1.0), (1.0, 6.0)]


@pytest.mark.parametrize("step", [*some([0.0005, -0.0005]), 0.01, 0.1, -0.01])
def test_no_point_of_a_curve_is_off_its_stroke(step: float) -> None:
    """The stroke stays within the tolerance of every position, with far fewer points."""
    way = [(5 + math.cos(i * step), 5 + math.sin(i * step)) for i in range(int(6 / abs(step)))]
    canvas = Canvas()
    for start, end in pairwise(way):
        canvas.draw("t", RED, start, end)

    (stroke,) = canvas.strokes
    assert max(distance_to_line(p, stroke) for p in way) <= TOLERANCE * 1.01
    assert len(stroke.points) <= 61


def test_no_point_of_a_random_walk_is_off_its_stroke() -> None:
    """Neither turning back nor standing still loses anything."""
    dice = random.Random(1)
    way, heading = [(5.0, 5.0)], 0.0
    for _ in range(150):
        heading += dice.choice([0.0, 0.0, 0.01, -0.3, math.pi])
        length = dice.choice([0.0, 0.001, 0.02])
        way.append((way[-1][0] + length * math.cos(heading), way[-1][1] + length * math.sin(heading)))
    canvas = Canvas()
    for start, end in pairwise(way):
        canvas.draw("t", RED, start, end)

    (stroke,) = canvas.strokes
    assert max(distance_to_line(p, stroke) for p in way) <= TOLERANCE * 1.01


def test_there_and_back_keeps_the_far_end() -> None:
    """A way that returns on itself is not shortened."""
    canvas = Canvas()
    for start, end in [((1.0, 1.0), (2.0, 1.0)), ((2.0, 1.0), (3.0, 1.0)), ((3.0, 1.0), (1.5, 1.0))]:
        canvas.draw("t", RED, start, end)

    (stroke,) = canvas.strokes
    assert stroke.points == [(1.0, 1.0), (3.0, 1.0), (1.5, 1.0)]


def test_another_pen_or_place_or_turtle_begins_a_stroke() -> None:
    """A stroke has one pen, one author and no gap."""
    canvas = Canvas()
    canvas.draw("a", RED, (1.0, 1.0), (2.0, 1.0))
    canvas.draw("a", Pen(), (2.0, 1.0), (3.0, 1.0))
    canvas.draw("a", Pen(), (4.0, 1.0), (5.0, 1.0))
    canvas.draw("b", Pen(), (5.0, 1.0), (6.0, 1.0))

    assert [s.points for s in canvas.strokes] == [
        [(1.0, 1.0), (2.0, 1.0)],
        [(2.0, 1.0), (3.0, 1.0)],
        [(4.0, 1.0), (5.0, 1.0)],
        [(5.0, 1.0), (6.0, 1.0)],
    ]


@slow
def test_points_are_bounded_and_the_newest_stay() -> None:
    """A zigzag for ever keeps its end, in strokes that hang together, and forgets its beginning."""
    canvas = Canvas()
    canvas.draw("still", RED, (0.0, 0.0), (0.1, 0.0))
    way = [(i % 100 / 10, 1.0 + i % 2) for i in range(3 * MAX_POINTS)]
    for start, end in pairwise(way):
        canvas.draw("t", RED, start, end)

    counts = [len(s.points) for s in canvas.strokes]
    assert MAX_POINTS - STROKE_POINTS <= sum(counts) <= MAX_POINTS
    assert max(counts) <= STROKE_POINTS
    assert canvas.strokes[-1].points[-1] == way[-1]
    ends = list(canvas.strokes)
    assert all(a.points[-1] == b.points[0] for a, b in pairwise(ends))


@slow
def test_a_turtle_whose_stroke_was_forgotten_draws_on() -> None:
    """Its next line starts a new stroke."""
    canvas = Canvas()
    canvas.draw("slow", RED, (0.0, 0.0), (0.1, 0.0))
    for i in range(MAX_POINTS):
        canvas.draw("fast", RED, (i % 100 / 10, 1.0 + i % 2), ((i + 1) % 100 / 10, 1.0 + (i + 1) % 2))
    canvas.draw("slow", RED, (0.1, 0.0), (0.2, 0.0))

    assert canvas.strokes[-1].points == [(0.1, 0.0), (0.2, 0.0)]


def test_colour_is_the_last_one_drawn_over_a_place() -> None:
    """As wide as the pen is, and no wider."""
    canvas = Canvas()
    canvas.draw("t", RED, (1.0, 2.0), (9.0, 2.0))
    canvas.draw("t", Pen((0, 0, 0), 10), (5.0, 1.0), (5.0, 3.0))

    assert canvas.colour_at((2.0, 2.0)) == (255, 0, 0)
    assert canvas.colour_at((5.0, 2.0)) == (0, 0, 0)
    assert canvas.colour_at((5.0 + 4 / 45, 2.5)) == (0, 0, 0)
    assert canvas.colour_at((5.0 + 7 / 45, 2.5)) is None
    assert canvas.colour_at((2.0, 2.1)) is None


def test_drawing_beyond_the_edge_colours_what_is_inside() -> None:
    """Neither the drawing nor the question need be inside."""
    canvas = Canvas()
    canvas.draw("t", RED, (5.0, 5.0), (500.0, 5.0))
    canvas.draw("t", RED, (-7.0, -7.0), (-8.0, -8.0))

    assert canvas.colour_at((11.0, 5.0)) == (255, 0, 0)
    assert canvas.colour_at((99.0, 5.0)) == (255, 0, 0)
    assert canvas.colour_at((0.0, 0.0)) is None


def test_a_dot_is_drawn() -> None:
    """A line of no length is as wide as the pen."""
    canvas = Canvas()
    canvas.draw("t", RED, (5.0, 5.0), (5.0, 5.0))

    assert canvas.colour_at((5.0, 5.0)) == (255, 0, 0)

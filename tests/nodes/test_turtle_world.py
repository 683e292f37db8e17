"""The world of turtlesim, without a node."""

import math

import pytest

from nodes.turtle_canvas import Pen
from nodes.turtle_world import SIZE, TICK, NameTaken, Turtle, World, in_degrees, normalize


def run(world: World, turtle: Turtle, ticks: int) -> None:
    """Let time pass for a turtle, without its command growing old."""
    for _ in range(ticks):
        world.step(turtle, turtle.commanded_ns)


def test_a_turtle_goes_in_a_circle_of_v_over_w() -> None:
    """2 m/s and 1.8 rad/s make 2.22 m across."""
    world = World()
    turtle = world.spawn("t", 5.0, 5.0, 0.0)
    turtle.command(2.0, 0.0, 1.8, 0)
    places = []
    for _ in range(250):
        world.step(turtle, 0)
        places.append(turtle.position)

    for axis in zip(*places, strict=True):
        assert max(axis) - min(axis) == pytest.approx(2.222, abs=0.002)


def test_turning_comes_before_moving() -> None:
    """The first step goes along the new heading."""
    turtle = Turtle("t", 0.0, 0.0)
    turtle.command(1.0, 0.0, math.pi / 2 / TICK, 0)
    turtle.move(TICK)

    assert turtle.position == pytest.approx((0.0, TICK))


def test_sideways_is_to_the_left() -> None:
    """A turtle that looks along y and moves left goes to smaller x."""
    turtle = Turtle("t", 5.0, 5.0, math.pi / 2)
    turtle.command(3.0, 4.0, 0.0, 0)
    turtle.move(0.1)

    assert turtle.position == pytest.approx((4.6, 5.3))
    assert turtle.speed == 5.0


def test_a_command_holds_for_a_second() -> None:
    """At a second it moves, a nanosecond later it stands."""
    world = World()
    turtle = world.spawn("t", 5.0, 5.0, 0.0)
    turtle.command(1.0, 0.0, 1.0, 0)

    world.step(turtle, 1_000_000_000)
    assert turtle.speed == 1.0
    world.step(turtle, 1_000_000_001)
    assert (turtle.speed, turtle.turning) == (0.0, 0.0)


def test_a_wall_stops_what_goes_into_it_only() -> None:
    """The turtle slides along it, and `step` returns the position beyond."""
    world = World()
    turtle = world.spawn("t", SIZE, 5.0, math.pi / 4)
    turtle.command(1.0, 0.0, 0.0, 0)

    beyond = world.step(turtle, 0)

    step = TICK / math.sqrt(2)
    assert beyond == pytest.approx((SIZE + step, 5.0 + step))
    assert turtle.position == pytest.approx((SIZE, 5.0 + step))


def test_free_names_skip_taken_ones_and_are_not_used_again() -> None:
    """turtle2 is taken by hand; turtle3 is not free again after it was killed."""
    world = World()
    world.spawn("turtle2", 1.0, 1.0, 0.0)
    assert [world.free_name() for _ in range(2)] == ["turtle1", "turtle3"]
    world.spawn("turtle3", 1.0, 1.0, 0.0)
    world.kill("turtle3")
    assert world.free_name() == "turtle4"


def test_a_name_is_taken_once() -> None:
    """The turtle that has it stays as it is."""
    world = World()
    first = world.spawn("t", 1.0, 1.0, 0.0)
    with pytest.raises(NameTaken):
        world.spawn("t", 2.0, 2.0, 0.0)
    assert world.turtles == {"t": first}


def test_every_move_draws_unless_the_pen_is_lifted() -> None:
    """Steps and teleports draw; turning on the spot does not."""
    world = World()
    turtle = world.spawn("t", 1.0, 1.0, 0.0)
    turtle.command(1.0, 0.0, 0.0, 0)
    run(world, turtle, 100)
    world.teleport(turtle, 2.6, 5.0, 0.0)
    turtle.pen = None
    world.teleport(turtle, 8.0, 8.0, 0.0)
    turtle.pen = Pen((0, 0, 0), 1)
    turtle.command(0.0, 0.0, 1.0, 0)
    run(world, turtle, 10)
    world.jump(turtle, 1.0, -turtle.theta)

    first, second = world.canvas.strokes
    assert [round(v, 9) for p in first.points for v in p] == [1.0, 1.0, 2.6, 1.0, 2.6, 5.0]
    assert [round(v, 9) for p in second.points for v in p] == [8.0, 8.0, 9.0, 8.0]


def test_a_jump_turns_first() -> None:
    """Quarter left, then two metres ahead, is two metres up."""
    world = World()
    turtle = world.spawn("t", 1.0, 1.0, 0.0)
    world.jump(turtle, 2.0, math.pi / 2)

    assert (turtle.x, turtle.y, turtle.theta) == pytest.approx((1.0, 3.0, math.pi / 2))


def test_what_is_no_number_is_refused() -> None:
    """A NaN would stay in the turtle for ever."""
    world = World()
    turtle = world.spawn("t", 1.0, 1.0, 0.0)
    for bad in (math.nan, math.inf, -1e300):
        with pytest.raises(ValueError, match="out of a turtle's range"):
            turtle.command(1.0, 0.0, bad, 0)
        with pytest.raises(ValueError, match="out of a turtle's range"):
            world.teleport(turtle, bad, 0.0, 0.0)
        with pytest.raises(ValueError, match="out of a turtle's range"):
            world.jump(turtle, bad, 0.0)
        with pytest.raises(ValueError, match="out of a turtle's range"):
            world.spawn("u", bad, 0.0, 0.0)
    assert world.turtles == {"t": Turtle("t", 1.0, 1.0, 0.0)}


@pytest.mark.parametrize(
    ("angle", "same"), [(0.0, 0.0), (4.0, 4.0 - math.tau), (-4.0, math.tau - 4.0), (math.pi, -math.pi), (100.0, -0.531)]
)
def test_angles_come_round(angle: float, same: float) -> None:
    """From -pi to pi, without pi itself."""
    assert normalize(angle) == pytest.approx(same, abs=1e-3)


@pytest.mark.parametrize(
    ("angle", "before", "told"),
    [
        (90.0, 0.0, True),
        (-45.0, 3.0, True),
        (10.0, 0.0, True),
        (5.0, 0.0, False),
        (10.0, 9.5, False),
        (6.3, 0.0, False),
        (18.85, 0.0, False),
        (math.nan, 0.0, False),
        (math.inf, 0.0, False),
    ],
)
def test_an_angle_that_seems_to_be_in_degrees(angle: float, before: float, told: bool) -> None:
    """Is a round number beyond 2 pi, and far from the one before."""
    assert in_degrees(angle, before) is told

"""Curves of numbers, and the pictures of them."""

from __future__ import annotations

import math

import pytest

from graphflow.errors import UsageFault
from graphflow.introspect.drawing.curves import COLOURS, Curve, chart
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import LaserScan

TWIST = "geometry_msgs/msg/Twist"


def line(label: str = "") -> Curve:
    """A curve that rises by 1 in a second."""
    curve = Curve("linear.x", TWIST, label)
    for second in range(10):
        curve.add(float(second), Twist(linear=Vector3(x=float(second))))
    return curve


def test_what_is_no_field_is_told_at_once() -> None:
    """Not when the first message comes."""
    with pytest.raises(UsageFault, match="not a number"):
        Curve("linear", TWIST)


def test_gaps() -> None:
    """Infinite, NaN and missing values are left out of the picture."""
    curve = Curve("ranges[1]", "sensor_msgs/msg/LaserScan")
    for i, ranges in enumerate(([0.0, 1.0], [0.0], [0.0, math.inf], [0.0, math.nan], [0.0, 5.0])):
        curve.add(float(i), LaserScan(ranges=ranges))
    assert curve.shown() == ([0.0, 4.0], [1.0, 5.0])
    assert curve.shown(0.5) == ([4.0], [5.0])
    assert curve.legend == "ranges[1] 5 m"


def test_what_is_old_is_forgotten() -> None:
    """Nothing grows for ever."""
    curve = line()
    curve.forget(7.0)
    assert list(curve.times) == [7.0, 8.0, 9.0]
    assert list(curve.values) == [7.0, 8.0, 9.0]


def test_a_picture() -> None:
    """A picture has the given size, rises from left to right, and names its curves."""
    rows = chart([line("speed")], (60, 12)).splitlines()
    assert max(map(len, rows)) <= 60
    assert len(rows) <= 12
    assert "speed 9" in rows[-1]
    drawn = [row for row in rows if "│" in row]
    top, bottom = drawn[1], drawn[-2]
    assert top.strip("│ ⠀").rstrip("0123456789. │") != ""
    assert top.index(top.strip("│ ")[0]) > bottom.index(bottom.strip("│ ")[0])
    assert "s" in rows[-2]


def test_the_last_seconds() -> None:
    """The end of the span is 0, and what was before its beginning is not drawn."""
    text = chart([line()], (60, 12), span=(5.0, 9.0), legend=False)
    assert "-3 s" in text or "-4 s" in text
    assert "linear.x" not in text


def test_colours() -> None:
    """One a curve; without any there is no escape sequence."""
    assert "\x1b" not in chart([line(), line()], (60, 12))
    assert "\x1b[38;2;86;180;233m" in chart([line(), line()], (60, 12), colours=COLOURS)


@pytest.mark.parametrize("size", [(0, 0), (3, 2), (20, 5), (300, 100)])
def test_any_size(size: tuple[int, int]) -> None:
    """A window may be smaller than the axes."""
    assert chart([line()], size)


def test_nothing_and_little() -> None:
    """No number is no picture; one, or the same again and again, is one."""
    empty, single, flat = Curve("linear.x", TWIST), Curve("linear.x", TWIST), Curve("linear.x", TWIST)
    single.add(0.0, Twist())
    for second in range(3):
        flat.add(float(second), Twist(linear=Vector3(x=5.0)))
    assert empty.legend == "linear.x -"
    assert chart([empty], (60, 12)) == ""
    assert chart([], (60, 12)) == ""
    assert chart([empty, single], (60, 12))
    assert "5" in chart([flat], (60, 12))

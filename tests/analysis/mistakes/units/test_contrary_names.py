"""Values that contradict their own names."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.contrary_names import contrary_names

SOURCE = """
import math
PERIOD_MS = 500
SHORT_MS = 0.5

class Robot(Node):
    wait_ms = Param(100)
    rate = Param(10.0)
    rate_hz = Param(10.0, unit="Hz")
    long_ms = Param(100, unit="ms")

    def __init__(self):
        period_ms = 100
        self.publish_rate = self.declare_parameter("rate", 20).value
        self.slow_rate = self.declare_parameter("slow", 0.5).value
        self.ms = self.declare_parameter("ms", 20).value
        self.computed_ms = 100 / 1000
        {}

    def turn(self, pose, given_ms):
        self.error = self.heading - pose.theta
"""
TAKES = "{0} takes seconds, and {1} is in milliseconds by its name; write {1} / 1000"
OF_RATE = "{0} takes seconds, and {1} is a frequency by its name; write {2}"
SWAPPED = "math.atan2({0}, {1}) counts from the y axis; atan2 takes y first: write math.atan2({1}, {0})"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("self.create_timer(period_ms, self.tick)", TAKES.format("create_timer", "period_ms")),
        ("self.create_timer(timer_period_sec=self.ms, callback=self.tick)", TAKES.format("create_timer", "self.ms")),
        ("time.sleep(PERIOD_MS)", TAKES.format("time.sleep", "PERIOD_MS")),
        ("self.clock.sleep(self.wait_ms)", TAKES.format("clock.sleep", "self.wait_ms")),
        ("@timer(PERIOD_MS)\n        def tick(self): pass", TAKES.format("timer", "PERIOD_MS")),
        ("@timer(rate)\n        def tick(self): pass", OF_RATE.format("timer", "rate", "@timer(hz=rate)")),
        (
            "self.create_timer(self.publish_rate, self.tick)",
            OF_RATE.format("create_timer", "self.publish_rate", "1 / self.publish_rate"),
        ),
        ("self.heading = math.atan2(dx, dy)", SWAPPED.format("dx", "dy")),
        ("a = math.atan2(goal_x - pose.x, goal_y - pose.y)", SWAPPED.format("goal_x - pose.x", "goal_y - pose.y")),
    ],
)
def test_contrary_names(line: str, told: str) -> None:
    """Each is told with its correction."""
    assert [text for _, text in contrary_names(ast.parse(SOURCE.format(line)))] == [told]


@pytest.mark.parametrize(
    "line",
    [
        "self.create_timer(period_ms / 1000, self.tick)",
        "self.create_timer(SHORT_MS, self.tick)",
        "self.create_timer(self.computed_ms, self.tick)",
        "self.create_timer(self.long_ms, self.tick)",
        "self.create_timer(self.programs, self.tick)",
        "self.create_timer(self.slow_rate, self.tick)",
        "self.create_timer(1 / self.publish_rate, self.tick)",
        "@timer(rate_hz)\n        def tick(self): pass",
        "self.sleep(period_ms)",
        "loop.create_task(period_ms)",
        "a = math.atan2(dy, dx)",
        "a = math.atan2(q.x, q.w)",
        "a = math.pi / 2 - math.atan2(dx, dy)",
        "bearing = math.atan2(dx, dy)",
        "a = math.atan2(axe, aye)",
    ],
)
def test_names_that_fit(line: str) -> None:
    """Values that are computed, small or in another unit are not told, nor are angles from north."""
    found = contrary_names(ast.parse(SOURCE.format(line)))
    assert found == ()


def test_angles_of_no_pose() -> None:
    """They may be counted from any axis."""
    source = SOURCE.replace("theta", "angle").format("a = math.atan2(dx, dy)")
    assert contrary_names(ast.parse(source)) == ()

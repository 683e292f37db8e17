"""Nanoseconds that are compared with seconds."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.nanoseconds import compared_nanoseconds

CONTROL = """
PERIOD = 0.5


class Control(Node):
    limit = 2.0

    def __init__(self):
        self.last = self.get_clock().now()
        self.t0 = 0
        self.pause = None

    def restart(self):
        self.t0 = self.clock.monotonic_ns()
        self.seconds = time.monotonic()

    def tick(self, start):
        now = self.get_clock().now()
        age = now - self.last
        elapsed = self.clock.monotonic_ns() - self.t0
        {}
"""


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (
            "if (now - self.last).nanoseconds > 0.5: go()",
            "(now - self.last).nanoseconds is in nanoseconds, and is compared with 0.5; for 0.5 s write 0.5e9",
        ),
        (
            "self.x += self.speed * elapsed",
            "elapsed is in nanoseconds; for seconds write (elapsed / 1e9)",
        ),
        ("if elapsed < 2.0: go()", "elapsed is in nanoseconds, and is compared with 2.0; for 2.0 s write 2.0e9"),
        ("if 3 <= elapsed: go()", "elapsed is in nanoseconds, and is compared with 3; for 3 s write 3e9"),
        (
            "while age.nanoseconds < 500: go()",
            "age.nanoseconds is in nanoseconds, and is compared with 500; for 500 ms write 500e6",
        ),
        (
            "if 0 < time.time_ns() - start < 2.5: go()",
            "time.time_ns() - start is in nanoseconds, and is compared with 2.5; for 2.5 s write 2.5e9",
        ),
        (
            "if elapsed > PERIOD: go()",
            "elapsed is in nanoseconds, and is compared with PERIOD, which is 0.5; for 0.5 s write PERIOD * 1e9",
        ),
        (
            "if abs(elapsed) > self.limit: go()",
            "abs(elapsed) is in nanoseconds, and is compared with self.limit, which is 2.0; for 2.0 s write "
            "self.limit * 1e9",
        ),
        (
            "if (Time.from_msg(m.stamp) - now).nanoseconds > 1.0: go()",
            "(Time.from_msg(m.stamp) - now).nanoseconds is in nanoseconds, and is compared with 1.0; for 1.0 s write "
            "1.0e9",
        ),
    ],
)
def test_nanoseconds_and_seconds(line: str, told: str) -> None:
    """Each comparison is told with the number that was meant."""
    assert [text for _, text in compared_nanoseconds(ast.parse(CONTROL.format(line)))] == [told]


@pytest.mark.parametrize(
    "line",
    [
        "if elapsed > 2e9: go()",
        "self.x += self.speed * elapsed * 1e-9",
        "self.x += self.speed * 2",
        "self.total += elapsed",
        "if elapsed / 1e9 > 2.0: go()",
        "if elapsed > 0 or elapsed == 0.5 or elapsed < 1: go()",
        "if elapsed > 2_000: go()",
        "if age.nanoseconds * 1e-9 > 0.5: go()",
        "if age.seconds > 0.5: go()",
        "if abs(elapsed) <= 5: go()",
        "assert elapsed < 500",
        "if (Time.from_msg(m.stamp) - Time.from_msg(n.stamp)).nanoseconds < 100: go()",
        "if time.monotonic() - self.seconds > 0.5: go()",
        "if start - self.pause > 0.5: go()",
        "if start.nanoseconds < 500: go()",
        "if (t1 - t2).nanoseconds < 500: go()",
        "elapsed = elapsed / 1e9\n        if elapsed > 2.0: go()",
        "elapsed /= 1e9\n        if elapsed > 2.0: go()",
        "if elapsed > start: go()",
        "if [elapsed for elapsed in start if elapsed > 0.5]: go()",
        "if elapsed > True: go()",
        "if time.perf_counter_ns() - time.perf_counter_ns() < 500: go()",
    ],
)
def test_comparisons_that_are_right(line: str) -> None:
    """Nanoseconds with nanoseconds, seconds with seconds, the tolerance of a difference, values of unknown origin."""
    assert compared_nanoseconds(ast.parse(CONTROL.format(line))) == ()


def test_tests() -> None:
    """They may say how near two times are."""
    assert compared_nanoseconds(ast.parse("def test_it():\n    if time_ns() - time_ns() < 500: go()\n")) == ()

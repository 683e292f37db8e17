"""Rates, delays and sizes, in ROS 2's formats."""

from __future__ import annotations

import math

import pytest

from graphflow.introspect.messages.rates import Arrivals, Delays, Weights, table


def at(hz: float, count: int, window: int = 10_000) -> Arrivals:
    arrivals = Arrivals(window)
    for n in range(count):
        arrivals.add(round(n * 1e9 / hz))
    return arrivals


@pytest.mark.parametrize("hz", [1.0, 62.5, 1000.0])
def test_a_rate(hz: float) -> None:
    """The rate is that of the gaps, of which there is one fewer than messages."""
    gaps = at(hz, 101).gaps()
    assert gaps is not None
    assert math.isclose(Arrivals.rate(gaps), hz, rel_tol=1e-6)
    assert gaps.window == 100


def test_the_words_of_a_rate() -> None:
    """The text is that of `ros2 topic hz`, and empty before the first gap."""
    arrivals = Arrivals(100)
    assert arrivals.text() == ""
    arrivals.add(0)
    assert arrivals.text() == ""
    for ms in (10, 30):
        arrivals.add(ms * 10**6)
    assert arrivals.text() == "average rate: 66.667\n\tmin: 0.010s max: 0.020s std dev: 0.00500s window: 2"


def test_a_window_forgets() -> None:
    """Only the last gaps count."""
    arrivals = at(10.0, 100, window=5)
    for n in range(5):
        arrivals.add(round(9.9e9 + (n + 1) * 1e7))
    gaps = arrivals.gaps()
    assert gaps is not None
    assert gaps.window == 5
    assert math.isclose(Arrivals.rate(gaps), 100.0)
    assert arrivals.count == 105


def test_messages_of_one_moment() -> None:
    """Have no rate, and are no error."""
    arrivals = Arrivals(10)
    arrivals.add(5)
    arrivals.add(5)
    assert arrivals.text().startswith("average rate: 0.000\n")


def test_several_topics() -> None:
    """Several topics are a table, without silent ones."""
    assert table({"/a": Arrivals(3)}) == ""
    lines = table({"/a": at(10.0, 11), "/long_name": at(100.0, 3), "/quiet": Arrivals(3)}).splitlines()
    assert lines[0].split() == ["topic", "rate", "min_delta", "max_delta", "std_dev", "window"]
    assert set(lines[1]) == {"="}
    assert lines[2].split() == ["/a", "10.00", "1.00e-01", "1.00e-01", "0.00e+00", "10"]
    assert lines[3].startswith("/long_name  100.00  ")
    assert len(lines) == 4


def test_delays() -> None:
    """By the stamps, which may be of the future."""
    delays = Delays(10)
    assert delays.text() == ""
    for ms in (-1, 3):
        delays.add(ms * 10**6)
    assert delays.text() == "average delay: 0.001\n\tmin: -0.001s max: 0.003s std dev: 0.00200s window: 2"


@pytest.mark.parametrize(
    ("size", "told"),
    [
        (24, "240.00 B/s from 10 messages\n\tMessage size mean: 24.00 B min: 24.00 B max: 24.00 B"),
        (500, "5.00 KB/s from 10 messages\n\tMessage size mean: 0.50 KB min: 0.50 KB max: 0.50 KB"),
        (10**6, "10.00 MB/s from 10 messages\n\tMessage size mean: 1.00 MB min: 1.00 MB max: 1.00 MB"),
    ],
)
def test_weights(size: int, told: str) -> None:
    """Payload bytes a second, in units of 1000, the same unit for all."""
    weights = Weights(100)
    assert weights.text(0) == ""
    for n in range(10):
        weights.add(n * 10**8, size)
    assert weights.text(10**9) == told


def test_no_weight_at_all() -> None:
    """No time has passed."""
    weights = Weights(3)
    assert weights.per_second(5) == 0.0
    weights.add(5, 100)
    assert weights.per_second(5) == 0.0


def test_numbers_for_programs() -> None:
    """The numbers are those of the text, in SI units; None before there are any."""
    arrivals, delays, weights = Arrivals(100), Delays(100), Weights(100)
    assert (arrivals.numbers(), delays.numbers(), weights.numbers(0)) == (None, None, None)
    for ms in (0, 250, 1000):
        arrivals.add(ms * 10**6)
        delays.add(ms * 10**6)
        weights.add(ms * 10**6, 100 + ms)
    assert arrivals.numbers() == {"rate": 2.0, "min": 0.25, "max": 0.75, "std_dev": 0.25, "window": 2}
    found = delays.numbers()
    assert found is not None
    assert {**found, "std_dev": 0} == {"delay": pytest.approx(1.25 / 3), "min": 0, "max": 1, "std_dev": 0, "window": 3}
    found = weights.numbers(2 * 10**9)
    assert found is not None
    assert (found["bytes_per_second"], found["min"], found["max"], found["window"]) == (775, 100, 1100, 3)

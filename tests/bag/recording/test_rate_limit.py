"""A limit on the rate at which a topic is recorded."""

from __future__ import annotations

import pytest

from graphflow.bag.recording.rate_limit import RateLimit

SECOND = 10**9


@pytest.mark.parametrize(("came", "rate"), [(30, 20), (30, 10), (100, 3), (30, 29), (1000, 0.5), (10, 10), (10, 50)])
def test_rates(came: int, rate: float) -> None:
    """Whatever the rate at which messages come, as many pass as may, the first among them."""
    gate = RateLimit(rate)
    passed = [n for n in range(came * 10) if gate.passes(n * SECOND // came)]
    assert passed[0] == 0
    assert abs(len(passed) - 10 * min(rate, came)) <= 1


def test_pauses() -> None:
    """Messages that a pause left unused are not made up for."""
    gate = RateLimit(1.0)
    passed = [t for t in (0, 1, 2, 60, 61, 62, 80) if gate.passes(t * SECOND // 10 if t < 60 else t * SECOND)]
    assert passed == [0, 60, 61, 62, 80]
    assert [gate.passes(80 * SECOND + n) for n in range(3)] == [False] * 3


def test_time_that_is_set_back() -> None:
    """Begins anew, as simulated time does."""
    gate = RateLimit(1.0)
    assert gate.passes(100 * SECOND)
    assert not gate.passes(100 * SECOND + 1)
    assert gate.passes(5 * SECOND)
    assert not gate.passes(5 * SECOND + 1)

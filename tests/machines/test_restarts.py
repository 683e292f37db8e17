"""Whether and when a process is started again."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow.machines.process import Exit
from graphflow.machines.restarts import CALM, JITTER, Again, Backoff, GiveUp, Policy, Restarts

WELL, FAILED, KILLED = Exit(code=0), Exit(code=1), Exit(signal=9)


@pytest.mark.parametrize(
    ("policy", "end", "is_again"),
    [
        ("never", FAILED, False),
        ("never", KILLED, False),
        ("on_failure", WELL, False),
        ("on_failure", FAILED, True),
        ("on_failure", KILLED, True),
        ("on_failure", Exit(), True),
        ("on_failure", Exit(code=70), True),
        ("always", WELL, True),
        ("always", KILLED, True),
    ],
)
def test_policies(policy: Policy, end: Exit, is_again: bool) -> None:
    """Failures are exit codes other than 0, signals, and ends of which nobody knows how they came."""
    found = Restarts(Backoff(policy)).decide(end, 1.0, 100.0, 0.5)
    assert found == (Again(0.1) if is_again else None)


@pytest.mark.parametrize("code", [64, 65, 69, 71, 78])
def test_a_wrong_configuration_stays_wrong(code: int) -> None:
    """Such a process is given up at once."""
    found = Restarts(Backoff("always")).decide(Exit(code=code), 1.0, 100.0, 0.5)
    assert isinstance(found, GiveUp)
    assert "a restart would not change exit code" in found.why


def test_each_time_twice_as_long() -> None:
    """Up to the longest delay; after it has been well for a while, from the beginning."""
    made = Restarts(Backoff("on_failure", max_restarts=100))
    delays = [made.decide(FAILED, 1.0, 100.0 + i, 0.5) for i in range(9)]
    assert delays == [Again(min(0.1 * 2**i, 10.0)) for i in range(9)]
    assert made.decide(FAILED, CALM, 200.0, 0.5) == Again(0.1)
    assert made.decide(FAILED, CALM - 1.0, 240.0, 0.5) == Again(0.2)


@given(st.floats(0.0, 1.0), st.integers(1, 2000))
def test_chance_keeps_processes_apart(chance: float, failures: int) -> None:
    """By a fifth at most, however often it has failed."""
    made = Restarts(Backoff("always", max_restarts=10_000))
    for _ in range(failures):
        found = made.decide(FAILED, 0.0, 100.0, chance)
    usual = min(0.1 * 2.0 ** min(failures - 1, 60), 10.0)
    assert isinstance(found, Again)
    assert usual * (1 - JITTER) - 1e-9 <= found.delay <= usual * (1 + JITTER) + 1e-9


def test_too_often_is_given_up() -> None:
    """So many times within so many seconds; not counting what is longer ago, or was before a start by hand."""
    made = Restarts(Backoff("on_failure", max_restarts=2, within=10.0))
    assert isinstance(made.decide(FAILED, 0.0, 100.0, 0.5), Again)
    assert isinstance(made.decide(FAILED, 0.0, 105.0, 0.5), Again)
    assert made.decide(FAILED, 0.0, 109.0, 0.5) == GiveUp("started again 2 times within 10 s")
    assert isinstance(made.decide(FAILED, 0.0, 111.0, 0.5), Again)
    made.forget()
    assert made.decide(FAILED, 0.0, 111.5, 0.5) == Again(0.1)

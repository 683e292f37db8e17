"""Turns that fill again with time."""

from __future__ import annotations

from graphflow.executor.allowance import Allowance


def test_turns() -> None:
    """As many at once as a second brings, then one each time that one has come back."""
    now = 10_000_000_000
    turns = Allowance(4, lambda: now)
    assert [turns.take() for _ in range(6)] == [True] * 4 + [False] * 2
    now += 250_000_000
    assert [turns.take(), turns.take()] == [True, False]
    now += 100_000_000_000
    assert [turns.take() for _ in range(6)] == [True] * 4 + [False] * 2
    assert turns.refused == 5

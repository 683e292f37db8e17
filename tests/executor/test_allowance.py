"""Turns that fill again with time."""

from __future__ import annotations

import pytest

from graphflow.executor import allowance
from graphflow.executor.allowance import Allowance


def test_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many at once as a second brings, then one each time that one has come back."""
    now = 10.0
    monkeypatch.setattr(allowance, "monotonic", lambda: now)
    turns = Allowance(4)
    assert [turns.take() for _ in range(6)] == [True] * 4 + [False] * 2
    now += 0.25
    assert [turns.take(), turns.take()] == [True, False]
    now += 100.0
    assert [turns.take() for _ in range(6)] == [True] * 4 + [False] * 2
    assert turns.refused == 5

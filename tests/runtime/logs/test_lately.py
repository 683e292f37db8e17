"""How often something has happened in the last moment."""

from __future__ import annotations

import pytest

from graphflow.runtime.logs.lately import MOST, WINDOW, Lately


def test_only_the_last_moment_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rate covers one window and at most the stored times."""
    now = 100.0
    monkeypatch.setattr("graphflow.runtime.logs.lately.time.monotonic", lambda: now)
    what = Lately()
    assert what.rate == 0.0
    for _ in range(10):
        what.note()
    now += WINDOW / 2
    what.note()
    assert what.rate == 11 / WINDOW
    now += WINDOW / 2
    assert what.rate == 1 / WINDOW
    for _ in range(2 * MOST):
        what.note()
    assert what.rate == MOST / WINDOW

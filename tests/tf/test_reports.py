"""Warnings about transforms."""

from __future__ import annotations

import logging

import pytest

from graphflow.tf import reports
from graphflow.tf.reports import Reports


def test_one_for_each_frame(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """A warning comes once for each frame, and others of the same kind come up to a bound."""
    monkeypatch.setattr(reports, "REPORTED_BOUND", 3)
    found = Reports(logging.getLogger("tf"))
    for _ in range(2):
        for frame in ("a", "b", "c", "d"):
            found.late("/sender", frame)
    assert [record.args[0] for record in caplog.records if isinstance(record.args, tuple)] == ["a", "b", "c"]

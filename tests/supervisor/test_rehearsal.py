"""The rehearsal in the preload process."""

from __future__ import annotations

import logging
import threading

import pytest

from graphflow.supervisor.rehearsal import rehearse


def test_it_leaves_nothing_behind(capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture) -> None:
    """It runs to its end, says nothing to anybody, and starts no thread: forking goes on being safe."""
    before = threading.active_count()
    with caplog.at_level(logging.INFO):
        assert rehearse()
    assert threading.active_count() == before
    assert capfd.readouterr() == ("", "")
    assert not caplog.records

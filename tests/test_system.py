"""Which of an operating system's ways are taken."""

from __future__ import annotations

import sys

import pytest

from graphflow.system import detached, host_name, is_portable


@pytest.mark.parametrize(
    ("platform", "value", "portable"),
    [
        ("linux", "", False),
        ("linux", "0", False),
        ("linux", "1", True),
        ("darwin", "", True),
        ("darwin", "0", True),
        ("win32", "", True),
    ],
)
def test_which_ways(platform: str, value: str, portable: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Linux takes its own unless it is told otherwise; the others have no choice."""
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setenv("GRAPHFLOW_PORTABLE", value)
    assert is_portable() is portable
    assert list(detached()) == (["creationflags"] if platform == "win32" else ["start_new_session"])


def test_a_host_name_fits_into_a_key(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever a machine is called, its name is one part of a key expression."""
    monkeypatch.setattr("platform.node", lambda: "Ann's robot #1/*")
    assert host_name() == "Ann_s_robot__1__"

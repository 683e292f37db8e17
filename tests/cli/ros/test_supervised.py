"""Faults that supervisors report, for `graphflow doctor`."""

from __future__ import annotations

import pytest

from graphflow.cli.ros import supervised
from graphflow.cli.ros.supervised import ended, faults, unseen
from tests.cli.rows import node_row


@pytest.mark.parametrize(
    ("state", "detail", "told"),
    [
        ("ready", "", []),
        ("ended", "", []),
        ("failed", "exit code 1", ["/a has failed: exit code 1: graphflow logs /a"]),
        ("given_up", "", ["/a has failed: its log says why: graphflow logs /a"]),
        ("unresponsive", "its event loop has said nothing for 4 s", ["/a is unresponsive: its event loop has said"]),
    ],
)
def test_states(state: str, detail: str, told: list[str]) -> None:
    """A node that runs or has ended normally is not a fault."""
    found = faults([node_row("/a", state, pid=None, detail=detail)])
    assert [text[: len(start)] for text, start in zip(found, told, strict=True)] == told


def test_a_stopped_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stopped process is reported as stopped, whether or not its supervisor has noticed."""
    monkeypatch.setattr(supervised, "is_stopped", lambda pid: pid == 7)
    rows = [node_row("/a"), node_row("/b", "unresponsive"), node_row("/c", pid=8)]
    assert faults(rows) == [f"{name} (process 7) is stopped: kill -CONT 7" for name in ("/a", "/b")]


def test_nodes_that_the_network_does_not_show() -> None:
    """Only what is ready, and has the name that the file gives it."""
    rows = [node_row("/a"), node_row("/b"), node_row("/c", "starting"), node_row("/program", is_named=False)]
    assert unseen(rows, ["/a"]) == ["not seen on the network, although ready for their supervisor: /b"]
    assert unseen(rows, ["/a", "/b"]) == []


def test_nodes_that_have_ended() -> None:
    """They are told with the way to start them again."""
    rows = [node_row("/a"), node_row("/b", "ended", pid=None)]
    assert ended(rows) == ["/b has ended; to start it again: graphflow start /b"]

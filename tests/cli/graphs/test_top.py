"""`graphflow top`."""

from __future__ import annotations

import json

import pytest

from tests.conftest import Machine

pytestmark = pytest.mark.real


def test_a_table(standing: Machine) -> None:
    """A row for each process, with what it costs and what flows."""
    head, *rows = standing.look("top", "-d", "0.3").splitlines()
    assert head.split() == ["PID", "CPU", "MEM", "THREADS", "LAG", "OUT/S", "IN/S", "DROPPED", "NODES"]
    assert any("/listener" in row and "/talker" in row for row in rows)
    assert not [row for row in rows if "_graphflow" in row]


def test_for_programs(standing: Machine) -> None:
    """The same as JSON."""
    found = json.loads(standing.look("top", "--json", "-M", "-d", "0.5"))
    [tutorial] = [row for row in found if "/talker" in row["nodes"]]
    assert tutorial["memory"] > 10_000_000
    assert tutorial["out"] > 5.0
    assert tutorial["in"] > 5.0
    assert [row["memory"] for row in found] == sorted((row["memory"] for row in found), reverse=True)


def test_nothing_runs(machine: Machine) -> None:
    """Exit code 3, as for all that look."""
    machine.look("top", "--once", code=3)

"""Steps: what a graph does once while it comes up."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Machine
from tests.supervisor.running import nothing_is_left, write

pytestmark = pytest.mark.real


@pytest.mark.parametrize(
    ("call", "expected"),
    [("/fails", "OSError: the disk is full"), ("/nowhere, type: std_srvs/srv/Trigger", "nobody offers the service")],
)
def test_a_failed_step_stops_the_graph(machine: Machine, project: Path, call: str, expected: str) -> None:
    """The step and the reason are told, everything is stopped again, the exit code is 1."""
    text = f"nodes:\n  /f: {{class: nodes.lab:Fails}}\nsteps:\n  ask: {{after: /f, call: {call}, timeout: 1.0}}\n"
    up = machine.start("up", write(project, text), cwd=project)

    assert up.wait() == 1

    assert "step ask FAILED" in up.text
    assert expected in up.text
    nothing_is_left(machine, [])

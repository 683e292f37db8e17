"""How earlier runs have ended."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from graphflow.supervisor import last_end
from graphflow.supervisor.last_end import how_ended, recent_death
from graphflow.supervisor.rundir import SUPERVISOR_LOG, GraphRun, RunDirectory

LATE = '2026-11-26 16:13:53,512 INFO {"event": "error", "message": "not ready within 20 s: /a"}\n'
STOPPED = '2026-11-26 16:13:54,000 INFO {"event": "stopping", "reason": "down, by pts/3"}\n'
LOST = '2026-11-26 16:13:54,012 INFO {"event": "error", "message": "process 7, which starts the nodes, was ended"}\n'
END = '2026-11-26 16:13:55,101 INFO {"event": "end", "exit_code": 1}\n'
GUARDIAN = "the supervisor, process 5, was ended by signal SIGKILL; its nodes have ended\n"


@pytest.mark.parametrize(
    ("log", "told"),
    [
        ("", ""),
        (END, ""),
        (LATE + STOPPED + END, "it was stopped (down, by pts/3)"),
        (STOPPED + LOST + END, "process 7, which starts the nodes, was ended"),
        (STOPPED + GUARDIAN, GUARDIAN.strip()),
        (STOPPED + LOST[:-20], "it was stopped (down, by pts/3)"),
    ],
)
def test_how_a_graph_has_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, log: str, told: str) -> None:
    """The last that its supervisor or its guardian has written of it; what a full disk has cut off is left out."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "run"))
    (tmp_path / "run").mkdir(0o700)
    (tmp_path / SUPERVISOR_LOG).write_text(log)
    assert how_ended(tmp_path) == told


def test_how_a_graph_without_a_guardian_has_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a guardian's report, the remaining run file shows how the graph ended."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "run"))
    (tmp_path / "run").mkdir(0o700)
    run = GraphRun("1", "lab", 7, 2**22 + 1, 1.0, 1.0, "", "", str(tmp_path), "", "")
    directory = RunDirectory(7, "lab")
    directory.claim()
    directory.write(run)
    assert how_ended(tmp_path) == f"the supervisor, process {run.pid}, was killed"
    directory.write(replace(run, guardian=2**22 + 2, guardian_started=1.0))
    assert how_ended(tmp_path) == f"the supervisor, process {run.pid}, was killed, and its guardian"
    assert how_ended(tmp_path / "other") == ""
    directory.release()


@pytest.mark.parametrize(("log", "told"), [(GUARDIAN, f"lab: {GUARDIAN.strip()}"), (STOPPED + END, ""), ("", "")])
def test_a_death_a_short_while_ago(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, log: str, told: str) -> None:
    """It is told where no graph runs; an orderly end, and one of long ago, are not."""
    for variable in ("XDG_RUNTIME_DIR", "XDG_STATE_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / variable))
        (tmp_path / variable).mkdir(0o700)
    logs = tmp_path / "XDG_STATE_HOME" / "graphflow" / "lab" / "2026-11-27"
    logs.mkdir(parents=True)
    (logs / SUPERVISOR_LOG).write_text(log)
    assert recent_death() == told
    past = logs.stat().st_mtime - last_end.RECENT - 1.0
    os.utime(logs, (past, past))
    assert recent_death() == ""

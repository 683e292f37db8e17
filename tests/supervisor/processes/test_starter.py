"""The interface that all starters share."""

from __future__ import annotations

import json
import shutil
import signal
import sys
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import PROGRAMS, Machine

pytestmark = pytest.mark.real

KINDS = ["spawning"] if sys.platform != "linux" else ["forking", "spawning"]


@slow
@pytest.mark.parametrize("kind", KINDS)
def test_both_kinds_tell_the_same(machine: Machine, project: Path, kind: str) -> None:
    """Interfaces come back; a failed worker reports its error and its end; its output and environment are its own."""
    shutil.copy(PROGRAMS / "supervisor" / "dawdles.py", project / "nodes")
    (project / "supervisor.log").touch()
    script = machine.start_python(str(PROGRAMS / "supervisor" / "starting.py"), kind, str(project))
    assert script.wait() == 0, script.text
    probed, *told, end = script.text.splitlines()
    assert probed.startswith(
        "['nodes.lab:Good', 'nodes.lab:Missing'] {'problem': \"module nodes.lab has no class 'Miss"
    )
    assert end == "end"
    lines = (project / "nodes" / "lab.py").read_text().splitlines()
    camera = f"{project / 'nodes' / 'lab.py'}:{1 + next(i for i, line in enumerate(lines) if 'no camera' in line)}"
    assert [json.loads(line) for line in told] == [
        {"event": "failed", "process": "wrong", "error": f"ValueError: no camera ({camera})"},
        {"event": "exited", "process": "wrong", "status": 78},
        {"event": "exited", "process": "leaves", "status": 0},
        {"event": "failed", "process": "fresh", "error": f"ValueError: no camera ({camera})"},
        {"event": "exited", "process": "fresh", "status": 78},
        {"event": "failed", "process": "impossible", "error": "cannot be started: illegal environment variable name"},
        {"event": "exited", "process": "impossible", "status": 1},
        {"event": "exited", "process": "killed", "status": -signal.SIGKILL},
    ]
    assert "ValueError: no camera" in (project / "wrong.log").read_text()
    assert (project / "killed.log").read_text() == "good morning\n"

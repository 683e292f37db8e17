"""Any process of a graph, killed at any moment: nothing is left two seconds later, and its death is told once.

`--cases full` tries a few kills, `--cases N` as many as wanted.
"""

from __future__ import annotations

import os
import random
import signal
import time
from pathlib import Path

import psutil
import pytest

from graphflow.supervisor.rundir import SUPERVISOR_LOG
from graphflow.system import is_portable
from tests.cases import count, slow
from tests.conftest import PROGRAMS, Machine, alive
from tests.supervisor.running import supervisor_of, write
from tests.until import until

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(is_portable(), reason="the portable way has other processes"),
]

TOLD = {
    "supervisor": "the supervisor, process {pid}, was ended by signal SIGKILL",
    "preload": "process {pid}, which starts the nodes, was ended by signal SIGKILL",
    "guardian": "the guardian, process {pid}, was ended",
    "node": '"pid": {pid}, "how": "signal SIGKILL',
}
NURSERY = "nodes:\n  /n: {class: nodes.nursery:Nursery}\n  /m: {class: nodes.nursery:Nursery}\n"
ORPHANS = 2.0
"""Seconds after which nothing may be left."""


def family_of(supervisor: int) -> dict[str, int]:
    """Return the processes of a graph by their part; a node only if there is one yet."""
    found = psutil.Process(supervisor)
    [preload] = found.children()
    parts = {"supervisor": supervisor, "guardian": found.ppid(), "preload": preload.pid}
    workers = [child.pid for child in preload.children()]
    return parts | ({"node": workers[0]} if workers else {})


@slow
@pytest.mark.parametrize("seed", range(count(few=1, full=8)))
def test_a_kill(machine: Machine, project: Path, seed: int) -> None:
    """Of a process chosen at random, at a random moment of a graph's first half second."""
    chance = random.Random(seed)
    (project / "nodes" / "nursery.py").write_text((PROGRAMS / "supervisor" / "nursery.py").read_text())
    up = machine.start("up", "-d", write(project, NURSERY), cwd=project)
    machine.until(lambda: bool(list(machine.run_directory.glob("graphflow/*/*/run.json"))), "it begins")
    run = supervisor_of(machine)
    time.sleep(chance.uniform(0.0, 0.5))  # the moment is what differs between the cases
    parts = family_of(run["pid"])
    guardian = psutil.Process(parts["guardian"])
    everybody = [guardian.pid, *(child.pid for child in guardian.children(recursive=True))]
    victim = chance.choice(sorted(parts))
    os.kill(parts[victim], signal.SIGKILL)

    log = Path(run["logs"]) / SUPERVISOR_LOG
    told = TOLD[victim].format(pid=parts[victim])
    if victim in ("guardian", "node"):  # a node that dies before all are ready ends the graph by itself
        machine.until(lambda: told in log.read_text(), "it is told", limit=10.0)
        up.process.wait(20.0)
        machine.look("down") if alive(run["pid"]) else None
    until(lambda: not any(map(alive, everybody)), lambda: f"{list(filter(alive, everybody))} have ended", ORPHANS)
    assert log.read_text().count(told) == 1
    up.process.wait(20.0)

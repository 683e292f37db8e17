"""The cost of a start, of short commands and of an idle graph, in counts: modules imported, forks, wake-ups.

Counts do not depend on how busy a machine is, so CI can hold them: `python -m benchmarks.counts` fails where more than
3 % more modules are imported than when `counts.json` was written, and names them; where a start forks more often; and
where an idle process wakes more often than `WAKES`. `--update` writes the file anew: do so in the commit that makes
something import less, or more for a reason.

The modules of the standard library differ from one version of Python to the next. For another version than that of the
file, graphflow's own are compared.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import psutil

from benchmarks.startup import own_machine

BASELINE = Path(__file__).with_suffix(".json")
GREW = 1.03
"""How many times as many modules as in the baseline are a failure."""
WAKES = 45.0
"""Wake-ups a second of an idle process that are a failure. About 25 are usual, 20 of them for Zenoh's shared memory."""
SETTLE, SECONDS = 2.0, 3.0
"""Seconds until a graph idles, and for which it is watched."""
LIMIT = 60.0
GRAPH = "talker_listener"
VERBS = ("--version", "ps", "topic list", "param get /talker rate", "topic echo --once /chatter", "doctor")
NEEDED_LATER = "graphflow.runtime.context"
"""The first module that a supervisor imports when it has had the nodes started."""
RECORDED = """
import os, sys
out = os.open(os.environ["GRAPHFLOW_COUNTS"], os.O_WRONLY | os.O_APPEND)
def heard(event, args):
    if event == "import":
        os.write(out, f"import {os.getpid()} {args[0]}\\n".encode())
    elif event == "subprocess.Popen":
        os.write(out, f"fork {os.getpid()} 0\\n".encode())
sys.addaudithook(heard)
os.register_at_fork(after_in_child=lambda: os.write(out, f"fork {os.getppid()} {os.getpid()}\\n".encode()))
from graphflow.cli.entry import main
main()
"""
"""Runs a command, and writes down what it and the processes that it forks import."""

Modules = dict[str, list[str]]
"""Modules that were imported, by what has imported them."""


class Recorded:
    """The counts of a command and its processes.

    Args:
        file: Where it is written down.
    """

    def __init__(self, file: Path, words: Iterable[str]) -> None:
        self._file = file
        file.touch()
        given = [sys.executable, "-c", RECORDED, *words]
        self._pid = _run(given, env=os.environ | {"GRAPHFLOW_COUNTS": str(file)})

    def _lines(self) -> list[list[str]]:
        return [line.split() for line in self._file.read_text().splitlines()]

    @property
    def forks(self) -> int:
        """How many processes it has begun, directly or not."""
        return sum(line[0] == "fork" for line in self._lines())

    def children(self, pid: int) -> list[int]:
        """The processes that one has forked."""
        return [int(child) for what, parent, child in self._lines() if what == "fork" and parent == str(pid)]

    def modules(self, pid: int | None = None) -> list[str]:
        """The modules that one process has imported, the command's own as a rule, in their order."""
        by = str(self._pid if pid is None else pid)
        return [name for what, who, name in self._lines() if what == "import" and who == by]

    def of_start(self) -> Modules:
        """The modules of each process of a graph that was started."""
        (guardian,) = self.children(self._pid)
        (supervisor,) = self.children(guardian)
        (preload,) = self.children(supervisor)
        supervisors = self.modules(supervisor)
        return {
            "up, the command": self.modules(),
            "up, the supervisor until nodes are started": supervisors[: supervisors.index(NEEDED_LATER)],
            "up, the preload process": self.modules(preload),
            "up, a node": self.modules(self.children(preload)[-1]),
        }


def _run(words: list[str], env: dict[str, str]) -> int:
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=env)
    process.wait(LIMIT)
    return process.pid


def wakes(processes: list[psutil.Process], seconds: float) -> float:
    """Wake-ups a second and process: how often one of its threads has waited for something."""

    def waited() -> int:
        found = 0
        for process in processes:
            for status in Path(f"/proc/{process.pid}/task").glob("*/status"):
                counted = re.search(r"^voluntary_ctxt_switches:\s*(\d+)", status.read_text(), re.MULTILINE)
                found += int(counted[1]) if counted else 0
        return found

    before, began = waited(), time.monotonic()
    time.sleep(seconds)
    return (waited() - before) / (time.monotonic() - began) / len(processes)


def count(folder: Path) -> tuple[Modules, int, float]:
    """The modules by unit, the forks of a start, and the wake-ups a second of an idle process."""
    up = Recorded(folder / "up", ["up", "-d", GRAPH])
    try:
        modules = up.of_start()
        for verb in VERBS:
            modules[verb] = Recorded(folder / verb.replace("/", "."), verb.split()).modules()
        time.sleep(SETTLE)
        (run,) = folder.glob(f"graphflow/*/{GRAPH}/run.json")
        supervisor = psutil.Process(int(json.loads(run.read_text())["pid"]))
        awake = wakes([supervisor, *supervisor.children(recursive=True)], SECONDS)
    finally:
        _run([sys.executable, "-m", "graphflow", "down"], env=dict(os.environ))
    return modules, up.forks, awake


def more_modules(now: Modules, baseline: dict[str, Any], version: str) -> list[str]:
    """The units that import more than they did, each with the modules that are new."""
    told = []
    for unit, names in now.items():
        then = baseline["modules"].get(unit, "").split()
        if version != baseline["python"]:
            names, then = ([n for n in some if n.partition(".")[0] == "graphflow"] for some in (names, then))
        if len(names) > GREW * len(then):
            new = ", ".join(sorted({*names} - {*then}))
            told.append(f"{unit}: {len(names)} modules, {len(then)} before; new: {new}")
    return told


def main() -> int:
    """Count, compare and say so; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--update", action="store_true", help=f"write {BASELINE.name} anew")
    options = parser.parse_args()
    version = "{}.{}".format(*sys.version_info)
    modules, forks, awake = count(own_machine())
    for unit, names in modules.items():
        print(f"{len(names):5} modules  {unit}")
    print(f"{forks:5} forks    of a start\n{awake:5.0f} wake-ups a second of an idle process")
    if options.update:
        written = {"python": version, "forks": forks, "modules": {unit: " ".join(n) for unit, n in modules.items()}}
        BASELINE.write_text(json.dumps(written, indent=1) + "\n")
        return 0
    baseline = json.loads(BASELINE.read_text())
    faults = more_modules(modules, baseline, version)
    if forks > baseline["forks"]:
        faults.append(f"a start forks {forks} times, {baseline['forks']} before")
    if awake > WAKES:
        faults.append(f"an idle process wakes {awake:.0f} times a second; {WAKES:.0f} are too many")
    for fault in faults:
        print(f"MORE: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

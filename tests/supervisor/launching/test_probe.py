"""Interfaces of classes, found out by importing them in another process."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from graphflow.errors import Problem
from graphflow.graph.plan import Plan
from graphflow.interface import Interface
from graphflow.supervisor.launching import probe as probe_module
from graphflow.supervisor.launching.probe import probe
from graphflow.supervisor.launching.probed import read_interfaces
from graphflow.supervisor.processes.preload import PROBE_LIMIT
from tests.cases import slow
from tests.conftest import PROGRAMS, alive
from tests.until import until


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with modules good and bad, away from the working directory."""
    folder = tmp_path / "project"
    (folder / "machines").mkdir(parents=True)
    shutil.copy(PROGRAMS / "supervisor" / "robot.py", folder / "machines")
    for name, text in {
        "raises": "def deep():\n    raise RuntimeError('no wheels')\n\n\ndeep()\n",
        "syntax": "class Robot(:\n    pass\n",
        "dies": "import os\nos._exit(3)\n",
        "hangs": "import time\nwhile True: time.sleep(1)\n",
    }.items():
        (folder / "machines" / f"{name}.py").write_text(text)
    monkeypatch.chdir(tmp_path)
    return folder


def found(project: Path, *classes: str) -> dict[str, Interface | Problem]:
    return read_interfaces(probe(classes, str(project)))


def test_what_a_class_declares(project: Path) -> None:
    """Parameters, topics and types come back as data; the class stays in the other process."""
    interface = found(project, "machines.robot:Robot")["machines.robot:Robot"]
    assert isinstance(interface, Interface)
    assert (interface.class_path, interface.place.file) == ("machines.robot:Robot", f"{project}/machines/robot.py")
    (rate,) = (p for p in interface.params if p.name == "rate")
    assert (rate.type, rate.default, rate.gt, rate.unit, rate.doc) == ("float", 10.0, 0.0, "Hz", "How often.")
    assert ("subscription", "words", "std_msgs/msg/String") in [(e.kind, e.name, e.type) for e in interface.endpoints]
    assert "machines.robot" not in sys.modules


@slow
@pytest.mark.parametrize(
    ("class_path", "problem"),
    [
        ("machines.robot:Robto", "module machines.robot has no class 'Robto'; did you mean 'Robot'?"),
        ("machines.dies:Robot", "the process that imported it was ended by exit code 3"),
    ],
)
def test_why_a_class_cannot_be_had(class_path: str, problem: str, project: Path) -> None:
    """The interfaces come back; for a process that wrote none, its end."""
    fault = found(project, class_path)[class_path]
    assert isinstance(fault, Problem)
    assert fault.message == problem


@slow
def test_one_failure_leaves_the_others(project: Path) -> None:
    """A module that cannot be imported does not keep the next from being looked at."""
    classes = found(project, "machines.raises:Robot", "machines.robot:Robot", "machines.syntax:Robot")
    assert [type(classes[c]) for c in sorted(classes)] == [Problem, Interface, Problem]


@slow
def test_an_import_that_does_not_end(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """There is a limit, and the problem says what to do instead."""
    monkeypatch.setattr(probe_module, "PROBE_LIMIT", 0.5)
    fault = found(project, "machines.hangs:Robot")["machines.hangs:Robot"]
    assert isinstance(fault, Problem)
    assert fault.message.endswith("do the work in the node, not at import")


@slow
def test_nothing_to_look_at() -> None:
    """A plan without classes has no Interfaces."""
    plan = Plan("empty", "f.yaml", "/nowhere", ())
    assert probe([n.class_path for n in plan.nodes], plan.root) == {}


@slow
@pytest.mark.real
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="no process groups here")
def test_what_an_import_starts_ends_with_it(tmp_path: Path) -> None:
    """A thread that never ends does not hold it up, and a child does not stay."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "busy.py").write_text(
        "import pathlib, subprocess, threading, time\n"
        "from graphflow import Node\n"
        "threading.Thread(target=time.sleep, args=(600,)).start()\n"
        "child = subprocess.Popen(['sleep', '600'])\n"
        f"pathlib.Path({str(tmp_path / 'pid')!r}).write_text(str(child.pid))\n"
        "class Busy(Node): ...\n"
    )
    began = time.monotonic()
    assert "problem" not in probe(["nodes.busy:Busy"], str(tmp_path))["nodes.busy:Busy"]
    assert time.monotonic() - began < PROBE_LIMIT / 2
    pid = int((tmp_path / "pid").read_text())
    until(lambda: not alive(pid), "its child has ended", PROBE_LIMIT)


@pytest.mark.real
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a child of its parent's end")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_an_import_ends_with_those_who_wait_for_it(project: Path, number: int) -> None:
    """However they end."""
    begins = f"probe.begin(['machines.hangs:Robot'], {str(project)!r})"
    text = "from graphflow.supervisor.launching import probe; import time; "
    text += f"print({begins}.pid, flush=True); time.sleep(600)"
    with subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE) as waiting:
        assert waiting.stdout is not None
        pid = int(waiting.stdout.readline())
        assert alive(pid)
        waiting.send_signal(number)
    until(lambda: not alive(pid), "the import has ended", PROBE_LIMIT)

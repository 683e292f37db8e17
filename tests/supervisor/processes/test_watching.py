"""Nodes that are started again when their source has changed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from graphflow.errors import SupervisorError
from graphflow.supervisor.processes.watching import Watch
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import GOOD, rows, write


class Desk:
    """A project whose files a test writes, and what is done about it."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.restarted: list[str] = []
        self.told: list[str] = []
        self._stamp = 1_000_000_000
        for name in ("a.py", "b.py", "helper.py", ".venv/x.py"):
            self.write(name, "x = 1\n")
        nodes = {root / "a.py": ["/a1", "/a2"], root / "b.py": ["/b"]}
        self.watch = Watch(root, nodes, self.restarted.append, self.told.append)

    def write(self, name: str, text: str) -> None:
        file = self.root / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        self._stamp += 1
        os.utime(file, (self._stamp, self._stamp))


def test_who_is_started_again(tmp_path: Path) -> None:
    """The nodes of the file, or all of them if it is one that they may import; nothing if nothing has changed."""
    desk = Desk(tmp_path)
    desk.watch.check()
    assert (desk.restarted, desk.told) == ([], [])
    desk.write("a.py", "x = 2\n")
    desk.watch.check()
    assert (desk.restarted, desk.told) == (["/a1", "/a2"], [f"{tmp_path / 'a.py'} has changed"])
    desk.watch.check()
    desk.write(".venv/x.py", "x = 2\n")
    desk.write("new.py", "x = 1\n")
    desk.watch.check()
    assert len(desk.restarted) == 2
    desk.write("helper.py", "x = 2\n")
    desk.watch.check()
    assert desk.restarted[2:] == ["/a1", "/a2", "/b"]


def test_half_a_thought(tmp_path: Path) -> None:
    """A file that is no Python yet restarts nothing; when it is, it does, also if it was gone for a moment."""
    desk = Desk(tmp_path)
    desk.write("a.py", "def f(:\n")
    desk.watch.check()
    assert desk.restarted == []
    assert desk.told == [f"{tmp_path / 'a.py'}:1: invalid syntax; nothing was restarted"]
    (tmp_path / "a.py").unlink()
    desk.watch.check()
    desk.write("a.py", "def f(): ...\n")
    desk.watch.check()
    assert desk.restarted == ["/a1", "/a2"]


def test_what_cannot_be_restarted(tmp_path: Path) -> None:
    """It is told why; the others are."""
    desk = Desk(tmp_path)
    done: list[str] = []

    def restart(name: str) -> None:
        if name == "/a1":
            raise SupervisorError("/a1 has not been started yet")
        done.append(name)

    watch = Watch(tmp_path, {tmp_path / "a.py": ["/a1", "/a2"]}, restart, desk.told.append)
    desk.write("a.py", "x = 2\n")
    watch.check()
    assert done == ["/a2"]
    assert "/a1 has not been started yet" in desk.told


@slow
@pytest.mark.real
def test_a_graph_that_is_worked_on(machine: Machine, project: Path) -> None:
    """A saved change is running a moment later."""
    up = machine.start("up", "--watch", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    before = {name: row["pid"] for name, row in rows(machine).items()}
    lab = project / "nodes" / "lab.py"
    lab.write_text(lab.read_text() + "\n# another thought\n")
    up.wait_for("lab.py has changed")
    machine.until(
        lambda: all(row["state"] == "ready" and row["pid"] != before[name] for name, row in rows(machine).items()),
        "both nodes are new",
    )
    assert up.end() == 0

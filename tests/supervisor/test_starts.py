"""Graphs that are being started: seen, waited for, and forgotten with their process."""

from __future__ import annotations

import os
import shutil
import signal
import threading
from pathlib import Path

import pytest

from graphflow.errors import SupervisorError
from graphflow.supervisor import starts
from graphflow.supervisor.rundir import runtime_root
from graphflow.supervisor.starts import Announcement, Start, starting, wait_started
from tests.cases import slow
from tests.conftest import PROGRAMS, Machine
from tests.supervisor.running import nothing_is_left, write


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user who has nothing running."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "run"))
    return tmp_path


def begun(file: Path | None) -> Announcement:
    announced = Announcement()
    announced.begin(file)
    return announced


def test_a_start_is_seen_until_it_is_done(here: Path) -> None:
    """With its process and its file; ending it twice is harmless."""
    announced = begun(None)
    assert [str(start) for start in starting()] == [f"a graph, which is being started by process {os.getpid()}"]
    announced.begin(here / "g.yaml")
    assert starting() == [Start(os.getpid(), str(here / "g.yaml"))]
    announced.end()
    announced.end()
    assert starting() == []
    assert not list(runtime_root().iterdir())


def test_a_start_whose_file_becomes_known(here: Path) -> None:
    """Is waited for all the same; a fork of its process does not keep it."""
    announced, told = begun(None), list[Start]()
    child = os.fork()
    if child == 0:
        announced.leave()
        signal.pause()
    ender = threading.Timer(0.01, announced.end)

    def tell(start: Start) -> None:
        told.append(start)
        announced.begin(here / "g.yaml")
        ender.start()

    try:
        assert wait_started(tell)
        ender.join()
        assert told == [Start(os.getpid(), "")]
        assert starting() == []
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


@pytest.mark.usefixtures("here")
def test_a_start_that_was_killed() -> None:
    """Leaves a file that nobody has locked, which is removed."""
    left = runtime_root() / "4194305.start"
    left.write_text("/g.yaml")
    assert starting() == []
    assert not left.exists()


def test_starts_are_waited_for(here: Path) -> None:
    """The chosen graphs are waited for; without one the wait ends at once."""
    told: list[Start] = []
    assert not wait_started(told.append)
    announced = begun(None)
    assert not wait_started(told.append, here / "g.yaml")
    announced.begin(here / "g.yaml")
    assert not wait_started(told.append, here / "other.yaml")
    ender = threading.Timer(0.01, announced.end)

    def on_wait(start: Start) -> None:
        told.append(start)
        ender.start()  # not earlier: the start must not have ended before the wait begins

    assert wait_started(on_wait, here / "g.yaml")
    ender.join()
    assert told == [Start(os.getpid(), str(here / "g.yaml"))]


def test_a_start_that_takes_too_long(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is an error that says how to break it off, with the exit code of a timeout."""
    monkeypatch.setattr(starts, "PATIENCE", 0.0)
    announced = begun(here / "g.yaml")
    with pytest.raises(SupervisorError, match=rf"is not up after 0 s; to cancel it: kill {os.getpid()}") as error:
        wait_started(lambda _: None)
    assert error.value.exit_code == 4
    announced.end()


@slow
@pytest.mark.real
def test_down_while_a_graph_is_being_started(machine: Machine, project: Path) -> None:
    """It is waited for and stopped, and the command that starts it fails."""
    shutil.copy(PROGRAMS / "supervisor" / "slow_import.py", project / "nodes")
    up = machine.start("up", "-d", write(project, "nodes:\n  /s: {class: nodes.slow_import:Late}\n"), cwd=project)
    machine.until(lambda: bool(list(machine.run_directory.glob("graphflow/*.start"))), "it begins")
    text = machine.look("down")
    assert f"waiting for {project}/lab.yaml, which is being started by process " in text
    assert "graph lab is down" in text
    assert up.wait() == (0 if "is up" in up.text else 1)
    nothing_is_left(machine, [])

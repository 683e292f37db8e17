"""`graphflow demo deadlock`."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from graphflow.cli.graphs import demo
from tests.cases import slow
from tests.conftest import PROJECT, Machine


def test_the_list_of_steps(machine: Machine) -> None:
    """The list has every pair of graphs exactly once, each with a heading."""
    lines = machine.look("demo", "deadlock", "--list").splitlines()
    names = [line.split()[0] for line in lines]
    assert sorted(names) == sorted(f.stem[:-6] for f in (PROJECT / "graphs" / "deadlock").glob("*_fixed.yaml"))
    assert all(len(line.split()) > 3 for line in lines)


def test_a_step_that_is_not_there(machine: Machine) -> None:
    """An unknown step is an error with the nearest one, before anything is shown."""
    text = machine.look("demo", "deadlock", "self_call", "corssing", code=2)
    assert text == "error: there is no step 'corssing'; did you mean 'crossing'?\n"


def test_a_step_is_shown_broken_and_fixed(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """The text of each file is shown, then the output of its nodes, each graph for its time."""
    ran: list[tuple[str, float]] = []

    def run(file: Path, seconds: float) -> Iterator[str]:
        ran.append((file.name, seconds))
        yield f"{file.stem} is at work"

    monkeypatch.setattr(demo, "_run", run)
    text = machine.look("demo", "deadlock", "crossing", "event")
    assert ran == [
        ("crossing_broken.yaml", 3.5),
        ("crossing_fixed.yaml", 3.5),
        ("event_broken.yaml", 4.0),
        ("event_fixed.yaml", 4.0),
    ]
    assert [line.split(":")[0] for line in text.splitlines() if line.startswith("===")] == [
        "=== crossing, broken",
        "=== crossing, fixed",
        "=== event, broken",
        "=== event, fixed",
    ]
    assert "    include: crossing_broken.yaml\n" in text
    assert "    event_fixed is at work\n" in text


def test_going_on_from_a_step(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """`--from` shows the step and those after it."""
    ran: list[str] = []

    def run(file: Path, seconds: float) -> Iterator[str]:
        ran.append(file.stem)
        yield ""

    monkeypatch.setattr(demo, "_run", run)
    machine.look("demo", "deadlock", "--from", "arrival_race")
    assert ran == ["arrival_race_broken", "arrival_race_fixed", "arrival_broken", "arrival_fixed"]


GRAPH = """\
import signal, sys, threading
ended = threading.Event()
signal.signal(signal.SIGINT, lambda *_: ended.set())
for line in sys.argv[1:]:
    print(line, flush=True)
if "end" not in sys.argv:
    ended.wait()
"""


@pytest.fixture
def graphs(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[subprocess.Popen[str]]]:
    """Replacements of graphs: programs that print the words of the file's stem, and end by Ctrl-C."""
    started: list[subprocess.Popen[str]] = []
    real = subprocess.Popen

    def start(command: list[str], **options: Any) -> subprocess.Popen[str]:
        assert command[1:4] == ["-m", "graphflow.cli.main", "up"]
        started.append(real([sys.executable, "-c", GRAPH, *Path(command[4]).stem.split(",")], **options))
        return started[-1]

    monkeypatch.setattr(subprocess, "Popen", start)
    yield started
    for process in started:
        assert process.stdout is not None
        process.stdout.close()


@slow
@pytest.mark.real
def test_a_graph_is_shown_for_its_time(graphs: list[subprocess.Popen[str]]) -> None:
    """The output is yielded as it arrives; then the graph is ended by Ctrl-C."""
    assert list(demo._run(Path("one,two.yaml"), 1.0)) == ["one", "two"]
    assert graphs[0].returncode == 0


@pytest.mark.real
def test_a_report_shortens_it(graphs: list[subprocess.Popen[str]], monkeypatch: pytest.MonkeyPatch) -> None:
    """A broken graph is ended soon after its deadlock is reported."""
    monkeypatch.setattr(demo, "_AFTER_REPORT", 0.0)
    assert list(demo._run(Path("one,DEADLOCK: two,three.yaml"), 100.0)) == ["one", "DEADLOCK: two"]
    assert graphs[0].returncode == 0


@pytest.mark.real
def test_a_graph_that_ends_by_itself(graphs: list[subprocess.Popen[str]]) -> None:
    """The step ends with its graph, however much time is left."""
    assert list(demo._run(Path("one,end.yaml"), 100.0)) == ["one", "end"]

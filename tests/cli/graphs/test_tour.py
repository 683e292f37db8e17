"""`graphflow demo` in the console: what follows what, and that nothing is left."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from graphflow.cli.graphs import tour
from graphflow.cli.graphs.examples import DEADLOCKS
from graphflow.errors import SupervisorError
from graphflow.supervisor.rundir import GraphRun
from tests.until import until

STEPS = DEADLOCKS[:2]


@pytest.fixture
def visits(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Examples that were seen, by file; how each is left is put there first as `-> how`."""
    seen: list[str] = []

    @contextmanager
    def up(file: Path) -> Iterator[SimpleNamespace]:
        assert file.is_file()
        assert (file.parents[2] / "nodes" / "deadlock").is_dir()
        seen.append(file.name)
        yield SimpleNamespace(domain=7)

    def open_console(run: Any, domain: int, *, layout: dict[str, Any]) -> SimpleNamespace:
        guide = layout["windows"][0]["root"]["of"][0]["options"]
        seen.append(guide["step"])
        assert bool(guide.get("fixed")) == ("fixed" in seen[-2])
        return SimpleNamespace(how=next(iter(sorted(w for w in seen if w.startswith("-> "))), "-> next")[3:])

    monkeypatch.setattr(tour, "_up", up)
    monkeypatch.setattr(tour, "open_console", open_console)
    return seen


def test_one_after_the_other(visits: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """A deadlock that the user ended is not shown fixed."""
    assert tour.tour(STEPS) == 0
    assert visits == ["self_call_broken.yaml", "1/2 self_call", "classic_broken.yaml", "2/2 classic"]
    assert "the tour is over" in capsys.readouterr().err


def test_what_was_not_ended_is_shown_repaired(visits: list[str]) -> None:
    """A deadlock that was not ended is shown fixed; the tour stops where the user leaves it."""
    visits.append("-> fixed")
    assert tour.tour(STEPS) == 0
    assert visits[1:] == ["self_call_broken.yaml", "1/2 self_call", "self_call_fixed.yaml", "1/2 self_call"]


@pytest.mark.parametrize(("how", "code"), [("detach", 0), ("stop", 0), ("failed", 1)])
def test_leaving_ends_it(how: str, code: int, visits: list[str]) -> None:
    """Leaving in any way ends the tour; a console that failed gives the exit code."""
    visits.append(f"-> {how}")
    assert tour.tour(STEPS) == code
    assert visits[1:] == ["self_call_broken.yaml", "1/2 self_call"]


@pytest.mark.real
def test_a_graph_that_does_not_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error has the graph's output, and its process has ended."""
    monkeypatch.setattr(tour, "running", list[GraphRun])
    says = "import sys; sys.exit('no such class')"
    monkeypatch.setattr(tour, "COMMAND", (sys.executable, "-c", says))
    began = time.monotonic()
    with pytest.raises(SupervisorError, match="no such class"), tour._up(tmp_path / "x.yaml"):
        raise AssertionError("it has not started")
    assert time.monotonic() - began < tour._START_LIMIT


@pytest.mark.real
def test_a_graph_that_does_not_end_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After its time."""
    started: list[subprocess.Popen[bytes]] = []
    real = subprocess.Popen

    def start(*words: Any, **options: Any) -> subprocess.Popen[bytes]:
        started.append(real(*words, **options))
        return started[-1]

    file = tmp_path / "x.yaml"
    run = GraphRun("id", "x", 0, 1, 0.0, 0.0, str(file), "", "", "", "")
    ready = tmp_path / "ready"
    stays = f"import signal, time; signal.signal(2, signal.SIG_IGN); open({str(ready)!r}, 'w'); time.sleep(60)"
    monkeypatch.setattr(subprocess, "Popen", start)
    monkeypatch.setattr(tour, "running", lambda: [run])
    monkeypatch.setattr(tour, "COMMAND", (sys.executable, "-c", stays))
    monkeypatch.setattr(tour, "_END_LIMIT", 0.5)
    with tour._up(file) as found:
        assert found is run
        until(ready.exists, limit=tour._START_LIMIT)
    assert started[0].returncode is not None

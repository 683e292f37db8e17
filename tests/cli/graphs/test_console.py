"""`attach`, `ls` and `console`: output without a terminal, without a graph, and when the console is left."""

from __future__ import annotations

import json
import os
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from graphflow.cli import exits
from graphflow.cli.graphs import console
from graphflow.cli.main import main
from graphflow.introspect.installation import requirement
from graphflow.supervisor import rundir
from graphflow.supervisor.rundir import GraphRun


def ends(*words: str) -> int:
    with pytest.raises(SystemExit) as end:
        main(words)
    assert isinstance(end.value.code, int)
    return end.value.code


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> GraphRun:
    started = rundir.start_time(os.getpid()) or 0.0
    began = time.time() - 61
    made = GraphRun("id", "lab", 7, os.getpid(), started, began, "lab.yaml", "s", str(tmp_path), "", "")
    monkeypatch.setattr(rundir, "running", lambda: [made])
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "7")
    rows = [{"node": "/a", "state": "ready"}, {"node": "/b", "state": "failed"}]
    monkeypatch.setattr(console, "graph_rows", lambda _: {"nodes": rows, "consoles": [{"name": "pts/3"}]})
    monkeypatch.setattr(console, "node_rows", lambda _: rows)
    return made


def test_ls(run: GraphRun, capsys: pytest.CaptureFixture[str]) -> None:
    """Each running graph with its nodes by state and its consoles; likewise as JSON."""
    assert ends("ls") == exits.OK
    head, row = capsys.readouterr().out.splitlines()
    assert head.split() == ["GRAPH", "DOMAIN", "NODES", "UP", "CONSOLES", "FILE"]
    assert row == "lab    7       1 running, 1 failed  1m01s  pts/3     lab.yaml"
    assert ends("ls", "--json") == exits.OK
    assert json.loads(capsys.readouterr().out)[0]["nodes"] == {"ready": 1, "failed": 1}


def test_nothing_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 3 and the command that starts a graph."""
    monkeypatch.setattr(rundir, "running", list)
    monkeypatch.setattr(console, "_anybody", lambda _: False)
    monkeypatch.setattr("graphflow.cli.output.is_terminal", lambda: True)
    for words in (["ls"], ["attach"], ["attach", "--graph", "x"], ["console"]):
        assert ends(*words) == exits.NOT_RUNNING
        assert "graphflow up" in capsys.readouterr().err


def test_the_newest_of_several(run: GraphRun, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a name, the newest run is chosen, as in tmux; otherwise the named one."""
    newer = replace(run, graph="newer", began=run.began + 1)
    shown: list[str] = []

    def show(chosen: GraphRun, domain: int, prefix: str | None) -> int:
        shown.append(chosen.graph)
        return exits.OK

    monkeypatch.setattr(rundir, "running", lambda: [newer, run])
    monkeypatch.setattr("graphflow.cli.output.is_terminal", lambda: True)
    monkeypatch.setattr(console, "show", show)
    assert ends("attach") == exits.OK
    assert ends("attach", "--graph", "lab") == exits.OK
    assert shown == ["newer", "lab"]


@pytest.mark.parametrize("verb", ["attach", "console"])
def test_without_a_terminal(verb: str, run: GraphRun, capsys: pytest.CaptureFixture[str]) -> None:
    """Without a terminal, the error names the alternatives."""
    assert ends(verb) == exits.USAGE
    assert "needs a terminal" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("how", "exit_code", "code", "said"),
    [
        ("detach", None, 0, "[detached from lab: 2 nodes keep running]   graphflow attach   |   graphflow down"),
        ("detach", 1, 1, "graph lab has ended; its logs are in"),
        ("failed", None, 1, "the console failed, but the graph keeps running"),
    ],
)
def test_how_it_was_left(
    how: str, exit_code: int | None, code: int, said: str, run: GraphRun, capsys: pytest.CaptureFixture[str]
) -> None:
    """Leaving prints what keeps running and how to return, or that the graph has ended, with its exit code."""
    assert console._report_end(run, how, exit_code) == code
    assert said in capsys.readouterr().err


def test_stopping_on_the_way_out(run: GraphRun, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopping from the console does what `graphflow down` does."""
    downs: list[Any] = []

    def take_down(run: GraphRun, *, now: bool) -> int:
        downs.append((run.graph, now))
        return 0

    monkeypatch.setattr(console, "take_down", take_down)
    assert console._report_end(run, "stop", None) == 0
    assert downs == [("lab", False)]


def test_the_web_needs_its_extra(
    run: GraphRun, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without the extra, the error has the command that installs it."""
    monkeypatch.setattr(console, "find_spec", lambda _: None)
    assert ends("console", "--web") == exits.USAGE
    assert f"pip install {requirement('web')}" in capsys.readouterr().err

"""Output of `up` while a graph comes up, runs and goes down, with the nodes' log files."""

from __future__ import annotations

import io
import json
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from graphflow.cli import exits, output
from graphflow.cli.graphs.streaming import LogReader, _Stream
from graphflow.supervisor.control.client import ControlClient
from graphflow.supervisor.rundir import GraphRun
from tests.cases import slow
from tests.cli.rows import node_row
from tests.conftest import Machine
from tests.supervisor.running import make_project, nothing_is_left, rows, supervisor_of, write


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A user's own project, with nodes that misbehave."""
    return make_project(tmp_path / "lab")


def append(file: Path, text: str) -> None:
    with file.open("a") as log:
        log.write(text)


def test_a_reader_goes_on_where_it_was(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Whole lines with the name of their node; half a line waits for its rest; a file may come later."""
    a, b = tmp_path / "a.log", tmp_path / "long.log"
    reader = LogReader([a, b], width=4)
    append(a, "one\ntwo\nthr")
    reader.show()
    assert capsys.readouterr().out == "a    | one\na    | two\n"
    append(a, "ee\n")
    append(b, "four\n")
    reader.show()
    assert capsys.readouterr().out == "a    | three\nlong | four\n"
    reader.show()
    assert capsys.readouterr().out == ""
    append(a, "five\n")
    reader.show()
    assert capsys.readouterr().out == "a    | five\n"


@pytest.mark.parametrize(("last", "shown"), [(2, ["2", "3"]), (9, ["1", "2", "3"]), (0, [])])
def test_only_the_last_lines(tmp_path: Path, capsys: pytest.CaptureFixture[str], last: int, shown: list[str]) -> None:
    """At most as many lines as exist are shown first; later ones are all shown."""
    file = tmp_path / "a.log"
    append(file, "1\n2\n3\n")
    reader = LogReader([file], width=1)
    reader.show(last=last)
    assert capsys.readouterr().out == "".join(f"a | {n}\n" for n in shown)
    append(file, "4\n5\n")
    reader.show()
    assert capsys.readouterr().out == "a | 4\na | 5\n"


def test_what_is_no_utf8_is_shown_all_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A node may write anything."""
    (tmp_path / "a.log").write_bytes(b"gr\xfc\xdfe\n")
    LogReader([tmp_path / "a.log"], width=1).show()
    assert capsys.readouterr().out == "a | gr\ufffd\ufffde\n"


def test_colours_are_for_terminals(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each node has its own there, unless NO_COLOR is set."""

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    for name in ("a", "b"):
        append(tmp_path / f"{name}.log", "x\n")
    files = [tmp_path / "a.log", tmp_path / "b.log"]
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setattr(sys, "stdout", terminal := Terminal())
    LogReader(files, width=1).show()
    assert terminal.getvalue() == "\x1b[36ma\x1b[0m | x\n\x1b[33mb\x1b[0m | x\n"
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(sys, "stdout", terminal := Terminal())
    LogReader(files, width=1).show()
    assert terminal.getvalue() == "a | x\nb | x\n"


def streaming(tmp_path: Path, *, detach: bool = False) -> _Stream:
    run = GraphRun("1", "lab", 7, 1, 0.0, 0.0, "lab.yaml", "", str(tmp_path), "", "")
    nodes = [node_row("/a", log=str(tmp_path / "a.log"))]
    client: Any = ControlClient.__new__(ControlClient)
    return _Stream(run, {"nodes.lab:Good": f"{tmp_path}/lab.py:3"}, nodes, client, detach, [])


@pytest.mark.parametrize(
    ("event", "told"),
    [
        ({"event": "step", "step": "spawn", "ok": True, "text": "turtle2"}, "step spawn done: turtle2\n"),
        ({"event": "step", "step": "spawn", "ok": False, "text": "no"}, "step spawn FAILED: no\n"),
        ({"event": "note", "text": "slow"}, "note: slow\n"),
        ({"event": "checked"}, ""),
        ({"event": "error", "message": "gone"}, "error: gone\n"),
        ({"event": "stopping", "reason": "Ctrl-C"}, "stopping (Ctrl-C); Ctrl-C again kills it\n"),
        ({"event": "stopping", "reason": "down"}, "stopping (down)\n"),
        ({"event": "exited", "unexpected": False}, ""),
        (
            {"event": "exited", "unexpected": True, "nodes": ["/a", "/b"], "pid": 5, "how": "SIGKILL", "error": "",
             "log": "a.log"},
            "error: /a, /b died, process 5, SIGKILL\n  its log: a.log\n",
        ),
        (
            {"event": "exited", "unexpected": True, "nodes": ["/a"], "pid": 5, "how": "exit code 70", "error": "no way",
             "log": "a.log"},
            "error: /a died, process 5, exit code 70: no way\n  its log: a.log\n",
        ),
    ],
)  # fmt: skip
def test_what_is_told_of_an_event(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], event: dict[str, Any], told: str
) -> None:
    """An event is a line on stderr, and the graph keeps running."""
    assert streaming(tmp_path)._show(event) is None
    assert capsys.readouterr() == ("", told)


def test_the_end_has_the_graphs_exit_code(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The end is reported with the graph's exit code; a detached graph that ends before it was up has failed."""
    assert streaming(tmp_path)._show({"event": "end", "exit_code": 1}) == 1
    assert capsys.readouterr().err == "graph lab has ended\n"
    assert streaming(tmp_path, detach=True)._show({"event": "end", "exit_code": 0}) == exits.FAILED


def test_events_for_programs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Events and logs are lines of JSON, beside the text on stderr, without events meant for consoles."""
    told = streaming(tmp_path)
    told._as_json = True
    for event in (
        {"event": "up", "seconds": 0.25},
        {"event": "consoles", "consoles": []},
        {"event": "note", "text": "x"},
    ):
        told._show(event)
    append(tmp_path / "a.log", "hello\n")
    LogReader([tmp_path / "a.log"], width=1, as_json=True).show()
    out, err = capsys.readouterr()
    up, note, log = map(json.loads, out.splitlines())
    assert (up["event"], up["graph"], up["nodes"][0]["node"], note) == (
        "up",
        "lab",
        "/a",
        {"event": "note", "text": "x"},
    )
    assert (log["event"], log["node"], log["text"]) == ("log", "a", "hello")
    assert "graph lab is up" in err


def test_a_reader_that_goes_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A graph in the background goes on, as behind `| head -1`; one in the foreground is ended by the error."""

    def closed(_: str) -> None:
        raise BrokenPipeError

    monkeypatch.setattr(output, "talk", closed)
    detached = streaming(tmp_path, detach=True)
    assert detached._show({"event": "up", "seconds": 0.25}) is None
    assert detached._show({"event": "checked"}) == exits.OK
    with pytest.raises(BrokenPipeError):
        streaming(tmp_path)._show({"event": "up", "seconds": 0.25})


def test_the_greeting(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """The greeting has the nodes, the places of their classes, and the next commands with the domain."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "7")
    monkeypatch.chdir(tmp_path)
    assert streaming(tmp_path)._show({"event": "up", "seconds": 0.25}) is None
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("graph lab is up: 1 node in domain 7, 0.25 s\n  /a  nodes.lab:Good  lab.py:3\n")
    assert "  graphflow node info /a  " in err
    assert f"Logs are in {tmp_path}\nStop with Ctrl-C.\n" in err
    assert "export" not in err
    streaming(tmp_path)._show({"event": "up", "seconds": 0.25, "pending": {"/a": "the end of /b"}})
    assert "\n  /a  nodes.lab:Good  waits for the end of /b\n" in capsys.readouterr().err

    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "8")
    detached = streaming(tmp_path, detach=True)
    assert detached._show({"event": "up", "seconds": 0.25}) is None
    assert detached._show({"event": "checked"}) == exits.OK
    assert detached._show({"event": "end", "exit_code": 0}) == exits.OK
    err = capsys.readouterr().err
    assert "  export GRAPHFLOW_DOMAIN=7  " in err
    assert "Open the console with: graphflow attach\nStop with: graphflow down\n" in err

    unnamed = streaming(tmp_path)
    unnamed._nodes = [{**unnamed._nodes[0], "is_named": False}]  # whose nodes have the names that its code gives them
    unnamed._show({"event": "up", "seconds": 0.25})
    err = capsys.readouterr().err
    assert "\n  a   nodes.lab:Good" in err
    assert "  graphflow node list  " in err
    assert "node info" not in err


@pytest.mark.real
def test_up_shows_the_logs_and_ctrl_c_stops_everything(machine: Machine) -> None:
    """The first command of the README: a greeting, log lines, Ctrl-C, exit code 0, nothing left."""
    up = machine.start("up", "graphs/talker_listener.yaml", "rate:=20.0")
    up.wait_for("I heard")
    text = up.wait_for("Stop with Ctrl-C")
    assert "graph talker_listener is up: 2 nodes" in text
    assert "graphflow topic list" in text
    pids = [row["pid"] for row in rows(machine).values()] + [supervisor_of(machine)["pid"]]

    assert up.end(signal.SIGINT) == 0

    assert "Traceback" not in up.text
    assert "graph talker_listener has ended" in up.text
    nothing_is_left(machine, pids)


@slow
@pytest.mark.real
def test_what_is_found_in_the_source_is_told_before_the_terminal_is_let_go(machine: Machine) -> None:
    """A detached graph reports findings in its source, as one in the foreground does."""
    text = machine.run("up", "-d", "graphs/deadlock/self_call_broken.yaml")
    assert "graph self_call_broken is up" in text
    assert "note: " in text
    assert "CERTAIN: timer tick of /narcissus awaits /narcissus/add" in text
    machine.look("down")


@pytest.mark.real
@pytest.mark.parametrize("how", [["-d"], []])
def test_what_is_odd_is_told_of_a_graph_that_does_not_come_up(machine: Machine, project: Path, how: list[str]) -> None:
    """Findings are reported, since they may be the reason: here a step calls a misspelt service."""
    steps = "steps:\n  ask: {after: /a, call: /aa/ask, type: std_srvs/srv/Trigger, timeout: 0.2}\n"
    up = machine.start("up", *how, write(project, f"nodes:\n  /a: {{class: nodes.lab:Good}}\n{steps}"), cwd=project)
    assert up.wait() == 1
    assert "step ask FAILED" in up.text
    assert "lab.yaml:4:26: no node of this graph offers the service /aa/ask; did you mean '/a/ask'?" in up.text
    nothing_is_left(machine, [])

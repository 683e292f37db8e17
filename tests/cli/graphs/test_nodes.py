"""`restart` and `stop`: single nodes of a graph that really runs."""

from __future__ import annotations

import json
import os
import signal
from unittest.mock import Mock

import pytest

from graphflow.cli import exits
from graphflow.cli.graphs import nodes
from graphflow.errors import SupervisorError
from tests.cases import slow
from tests.conftest import Machine, alive
from tests.supervisor.running import GOOD, make_project, rows, write

pytestmark = pytest.mark.real


@slow
def test_restart_and_stop(machine: Machine) -> None:
    """A node gets a new process, whether it ran, was killed or was stopped; the others keep running."""
    project = make_project(machine.run_directory / "lab")
    file = write(project, GOOD)
    machine.run("up", "-d", file, cwd=project)
    before = rows(machine)
    assert "/a is running again, process" in machine.look("restart", "a")
    after = rows(machine)
    assert after["/a"]["pid"] != before["/a"]["pid"]
    assert after["/b"]["pid"] == before["/b"]["pid"]
    assert after["/a"]["restarts"] == 1
    assert not alive(before["/a"]["pid"])

    assert "/a has ended" in machine.look("stop", "/a")
    assert rows(machine)["/a"]["state"] == "ended"
    assert "/a is running again" in machine.look("restart", "/a")

    os.kill(rows(machine)["/a"]["pid"], signal.SIGKILL)
    machine.until(lambda: rows(machine)["/a"]["state"] == "failed", "it is seen to have died")
    assert "/a is running again" in machine.look("restart", "/a")
    assert rows(machine)["/a"]["restarts"] == 3
    assert "has no node /aa; did you mean '/a'?" in machine.look("restart", "/aa", code=1)
    machine.look("down")


@slow
def test_the_last_node(machine: Machine) -> None:
    """The graph ends with it, which is no failure of the command that wanted it."""
    project = make_project(machine.run_directory / "lab")
    file = write(project, "nodes: {/a: {class: nodes.lab:Good}}\n")
    machine.run("up", "-d", file, cwd=project)
    assert machine.look("stop", "/a").startswith("/a has ended")


@slow
def test_a_node_that_runs_by_itself(machine: Machine) -> None:
    """The error says in which process a node outside all graphs runs."""
    node = machine.start("run", "nodes.talker:Talker", "-p", "rate:=20.0")
    node.wait_for("Publishing")
    told = machine.look("stop", "/talker", code=3)
    assert f"/talker was not started by `up`; it runs in process {node.pid}: " in told
    assert told.rstrip().endswith(f"; end it there with Ctrl-C, or by: kill {node.pid}")
    assert told.strip() in machine.look("node", "kill", "/talker", code=2).replace("Error", "error")
    assert "no graph is running" in machine.look("stop", "/talkr", code=3)
    project = make_project(machine.run_directory / "lab")
    machine.run("up", "-d", write(project, "nodes: {/a: {class: nodes.lab:Good}}\n"), cwd=project)
    assert told == machine.look("restart", "/talker", code=1)
    assert "has no node /talkr" in machine.look("restart", "/talkr", code=1)
    machine.look("down")
    assert node.end() == 0


def test_the_status_of_a_node(standing: Machine) -> None:
    """Its state, class and log with the end of it, or the same for programs."""
    lines = standing.look("status", "talker").splitlines()
    assert lines[0].startswith("/talker: ready for ")
    assert "  class: nodes.talker:Talker" in lines
    assert any(line.startswith("    [INFO]") for line in lines)
    found = json.loads(standing.look("status", "/talker", "--json"))
    assert (found["graph"], found["node"], found["state"], found["restarts"]) == ("standing", "/talker", "ready", 0)
    assert found["last_lines"]
    assert "has no node /tolker; did you mean '/talker'?" in standing.look("status", "tolker", code=1)


def test_words_that_are_no_nodes(standing: Machine) -> None:
    """A topic, a service and the graph itself are told as what they are."""
    wait = (
        "/chatter is a topic, and wait waits for nodes; a message is awaited by: graphflow topic echo --once /chatter"
    )
    assert wait in standing.look("wait", "chatter", code=1)
    assert "/chatter is a topic, and stop stops nodes\n" in standing.look("stop", "/chatter", code=1)
    assert "standing.yaml is a graph file, and stop stops nodes; the whole graph is stopped by" in standing.look(
        "stop", "standing.yaml", code=1
    )
    assert "all is no node, and status is about a node" in standing.look("status", "all", code=1)


def test_waiting(standing: Machine) -> None:
    """A ready node is not waited for; one that does not end is reported with its state and exit code 4."""
    standing.look("wait")
    standing.look("wait", "--ready", "talker", "/office/clerk")
    text = standing.look("wait", "--ended", "talker", "--timeout", "0.1", code=4)
    assert "after 0.1 s /talker is ready" in text
    [row] = json.loads(standing.look("wait", "talker", "--json"))
    assert (row["node"], row["state"]) == ("/talker", "ready")
    assert "give either --ready or --ended" in standing.look("wait", "--ready", "--ended", code=2)
    assert "has no node /tolker; did you mean '/talker'?" in standing.look("wait", "tolker", code=1)


def test_what_cannot_be_done(standing: Machine) -> None:
    """A command that cannot be carried out is an error."""
    text = standing.look("start", "/talker", code=1)
    assert "/talker runs already: it is ready; to start it again: graphflow restart /talker" in text
    assert "lab.yaml is a graph file; start it with: graphflow up lab.yaml" in standing.look(
        "start", "lab.yaml", code=2
    )


def test_waiting_for_nothing(machine: Machine) -> None:
    """Without a graph, `wait` waits for one to start; with `--ended`, all nodes have ended already."""
    assert "after 0.1 s no graph is running" in machine.look("wait", "--timeout", "0.1", code=4)
    machine.look("wait", "--ended")


def test_a_long_wait_is_explained(
    machine: Machine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Once, after a while."""
    monkeypatch.setattr(nodes, "SAID_AFTER", 0.0)
    monkeypatch.setattr(nodes, "choose", Mock(side_effect=SupervisorError("nothing", exits.NOT_RUNNING)))
    assert nodes._wait_for((), None, 0.6, ended=False)[1] == exits.TIMEOUT
    assert capsys.readouterr().err == "no graph is running; waiting for one for 0.6 s\n"


def test_some_lines_of_logs(standing: Machine) -> None:
    """Lines are filtered by level and time, of nodes named either way; an invalid time is an error."""
    assert "[INFO]" in standing.look("logs", "tutorial", "--since", "1h", "--level", "info")
    assert "[INFO]" not in standing.look("logs", "--node", "tutorial", "--level", "fatal")
    assert "write a duration such as 30s, 5m or 2h" in standing.look("logs", "tutorial", "--since", "soon", code=2)

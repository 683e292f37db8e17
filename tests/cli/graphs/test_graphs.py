"""`graphflow up`, `down`, `ps` and `logs`."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from graphflow.cli.graphs.graphs import _open_console, _table
from graphflow.errors import SupervisorError
from graphflow.supervisor.rundir import GraphRun, start_time
from tests.cases import slow
from tests.cli.rows import node_row
from tests.conftest import Machine, Program
from tests.supervisor.running import GOOD, make_project, nothing_is_left, rows, supervisor_of, write


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A user's own project, with nodes that misbehave."""
    return make_project(tmp_path / "lab")


@slow
@pytest.mark.real
def test_detached_graph_runs_on_and_down_stops_it(machine: Machine, project: Path) -> None:
    """`up -d` returns when the graph is up; `ps`, `logs` and `down` work from anywhere; `down` again says none runs."""
    text = machine.run("up", "-d", write(project, GOOD), cwd=project)
    assert "graph lab is up" in text
    assert {name: row["state"] for name, row in rows(machine).items()} == {"/a": "ready", "/b": "ready"}
    pids = [row["pid"] for row in rows(machine).values()] + [supervisor_of(machine)["pid"]]
    assert "red" in machine.run("service", "call", "/b/ask", "std_srvs/srv/Trigger")

    assert "graph 'nolab' is not running; did you mean 'lab'?" in machine.look("down", "nolab", code=3)
    said = "/a is a node of the graph lab; stop it with: graphflow stop /a"
    assert said in machine.look("down", "/a", code=2)
    assert "graph lab is down" in machine.run("down", "lab")

    nothing_is_left(machine, pids)
    assert "no graph is running" in machine.run("down", code=3)
    assert "no graph is running" in machine.run("ps", code=3)


@slow
@pytest.mark.real
def test_logs_of_a_graph_that_has_ended_can_be_read(machine: Machine) -> None:
    """`logs` shows the latest run; the error for a misspelt node suggests the nearest."""
    machine.run("up", "-d", "graphs/talker_listener.yaml", "rate:=50.0")
    machine.until(lambda: "I heard" in machine.look("logs"), "something was logged")
    machine.look("down")

    assert "I heard" in machine.run("logs", "/listener", "-n", "3")
    assert "did you mean 'talker'" in machine.look("logs", "talkr", code=1)


@slow
@pytest.mark.real
def test_logs_follow(machine: Machine) -> None:
    """`logs -f` prints new lines and ends with the graph."""
    machine.run("up", "-d", "graphs/talker_listener.yaml", "rate:=50.0")
    follow: Program = machine.start("logs", "-f", "/listener")
    follow.wait_for("I heard: [Hello World: 20]")
    machine.look("down")
    assert follow.wait() == 0


@slow
@pytest.mark.real
def test_private_keeps_a_graph_to_itself(machine: Machine) -> None:
    """`--private` uses a port and a domain of its own, and prints how other terminals reach them."""
    text = machine.run("up", "-d", "--private", "graphs/talker_listener.yaml")
    assert "nothing is running" in machine.look("node", "list", code=3)
    line = next(line for line in text.splitlines() if "export" in line)
    machine.env |= dict(word.split("=", 1) for word in line.split()[1:])
    assert machine.look("node", "list").split() == ["/listener", "/talker"]
    machine.look("down")


def test_the_table_of_ps() -> None:
    """Columns fit their contents; a node without a process has a dash, and a failed one its reason."""
    run = GraphRun("1", "lab", 0, 1, 0.0, 0.0, "lab.yaml", "", "", "", "")
    failed = node_row("/longer", "failed", detail="SIGKILL", pid=None)
    head, first, second = _table([(run, node_row("/a", pid=12)), (run, failed)])
    assert head.split() == ["GRAPH", "NODE", "STATE", "PID", "FOR", "CLASS"]
    assert first.split()[:4] == ["lab", "/a", "ready", "12"]
    assert "  failed (SIGKILL)  -    " in second
    assert head.index("CLASS") == first.index("nodes.lab") == second.index("nodes.lab")


def test_nothing_that_runs_is_found(machine: Machine) -> None:
    """Without a graph, the verbs exit with 3 and print how to start one."""
    assert machine.look("ps", code=3) == "error: no graph is running; start one with: graphflow up GRAPH.yaml\n"
    for words in (["down"], ["down", "--all"], ["logs"], ["ps", "--graph", "x"]):
        assert machine.look(*words, code=3).startswith("error: no graph is running")


@pytest.mark.real
def test_ps_of_a_graph(standing: Machine) -> None:
    """Every node with its state and class; processes that nodes share are the same."""
    lines = [line.split() for line in standing.look("ps").splitlines()]
    assert [line[1] for line in lines[1:]] == [
        "/talker",
        "/listener",
        "/fibonacci_server",
        "/office/clerk",
        "/office/auditor",
    ]
    assert {line[2] for line in lines[1:]} == {"ready"}
    assert len({line[3] for line in lines[1:]}) == 2
    named = [line.split() for line in standing.look("ps", "--graph", "standing").splitlines()]
    for_how_long = 4
    assert [line[:for_how_long] for line in named] == [line[:for_how_long] for line in lines]


def test_show_args(machine: Machine, tmp_path: Path) -> None:
    """`up -s` prints a file's arguments and starts nothing; problems of the file have their place."""
    file = tmp_path / "g.yaml"
    file.write_bytes(
        b"\xef\xbb\xbfargs:\n  gain: {default: 5.0, unit: 1/s, doc: How sharply.}\n"
        b"  name: {default: a, choices: [a, b]}\n  mode:\nnodes: {}\n"
    )
    assert machine.look("up", "-s", str(file)).splitlines() == [
        "Arguments (pass arguments as '<name>:=<value>'):",
        "",
        "    'gain':",
        "        How sharply. [1/s]",
        "        (default: 5.0)",
        "",
        "    'name':",
        "        no description given One of: ['a', 'b']",
        "        (default: 'a')",
        "",
        "    'mode':",
        "        no description given",
        "",
    ]
    for data, problem in (
        (b"nodes: {}", ""),
        (b"a: {", f"error: {file}:1:5: not valid YAML"),
        (b"\xe9", "is not UTF-8"),
    ):
        file.write_bytes(data)
        assert (problem or "no arguments") in machine.look("up", "-s", str(file), code=2 if problem else 0)


@slow
def test_a_part_of_a_graph_and_in_place_of_it(machine: Machine) -> None:
    """`--only` starts a node and what it needs; `--replace` stops what runs of the file first; logs can be chosen."""
    project = make_project(machine.run_directory / "lab")
    file = write(project, f"{GOOD}  /c: {{class: nodes.lab:Good, after: /a}}\n")
    machine.run("up", "-d", file, "--only", "c", cwd=project)
    before = rows(machine)
    assert list(before) == ["/a", "/c"]
    assert "has no node /d" in machine.run("up", "-d", file, "--replace", "--only", "d", cwd=project, code=2)
    machine.run("up", "-d", file, "--replace", cwd=project)
    assert list(rows(machine)) == ["/a", "/b", "/c"]
    machine.look("down")


@pytest.mark.parametrize("lives", [False, True])
def test_a_supervisor_that_was_killed_before_the_console(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], lives: bool
) -> None:
    """The supervisor's end is reported, unless it is alive and does not answer, which is another error."""

    def show(run: GraphRun, domain: int) -> int:
        raise SupervisorError("it does not answer")

    monkeypatch.setattr("graphflow.cli.graphs.console.show", show)
    monkeypatch.setattr("graphflow.cli.graphs.streaming.GONE_LIMIT", 0.0)
    pid = os.getpid() if lives else 2**22 + 1
    run = GraphRun("1", "lab", 0, pid, start_time(pid) or 0.0, 0.0, "lab.yaml", "", str(tmp_path), "", "")
    if lives:
        with pytest.raises(SupervisorError, match="it does not answer"):
            _open_console(run, lambda: "")
        return
    assert _open_console(run, lambda: "the supervisor was ended by signal SIGKILL") == 1
    assert "error: the supervisor was ended by signal SIGKILL\n" in capsys.readouterr().err

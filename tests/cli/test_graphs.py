"""`graphflow up`, `down`, `ps` and `logs`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Machine, Program
from tests.supervisor.running import GOOD, make_project, nothing_is_left, rows, supervisor_of, write

pytestmark = pytest.mark.real


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A user's own project, with nodes that misbehave."""
    return make_project(tmp_path / "lab")


def test_detached_graph_runs_on_and_down_stops_it(machine: Machine, project: Path) -> None:
    """`up -d` returns when the graph is up; `ps`, `logs` and `down` work from anywhere; `down` again says none runs."""
    text = machine.run("up", "-d", write(project, GOOD), cwd=project)
    assert "graph lab is up" in text
    assert {name: row["state"] for name, row in rows(machine).items()} == {"/a": "ready", "/b": "ready"}
    pids = [row["pid"] for row in rows(machine).values()] + [supervisor_of(machine)["pid"]]
    assert "red" in machine.run("service", "call", "/b/ask", "std_srvs/srv/Trigger")

    assert "graph lab is down" in machine.run("down")

    nothing_is_left(machine, pids)
    assert "no graph is running" in machine.run("down", code=3)
    assert "no graph is running" in machine.run("ps", code=3)


def test_logs_of_a_graph_that_has_ended_can_be_read(machine: Machine) -> None:
    """`logs` shows the latest run; a misspelt node is told which one was meant."""
    machine.run("up", "-d", "graphs/talker_listener.yaml", "rate:=50.0")
    machine.until(lambda: "I heard" in machine.look("logs"), "something was logged")
    machine.look("down")

    assert "I heard" in machine.run("logs", "/listener", "-n", "3")
    assert "did you mean 'talker'" in machine.look("logs", "talkr", code=2)


def test_logs_follow(machine: Machine) -> None:
    """`logs -f` goes on as more is written and ends with the graph."""
    machine.run("up", "-d", "graphs/talker_listener.yaml", "rate:=50.0")
    follow: Program = machine.start("logs", "-f", "/listener")
    follow.wait_for("I heard: [Hello World: 20]")
    machine.look("down")
    assert follow.wait() == 0


def test_private_keeps_a_graph_to_itself(machine: Machine) -> None:
    """`--private` takes a port and a domain of its own, and says how other terminals get there."""
    text = machine.run("up", "-d", "--private", "graphs/talker_listener.yaml")
    assert "nothing is running" in machine.look("node", "list", code=3)
    line = next(line for line in text.splitlines() if "export" in line)
    machine.env |= dict(word.split("=", 1) for word in line.split()[1:])
    assert machine.look("node", "list").split() == ["/listener", "/talker"]
    machine.look("down")

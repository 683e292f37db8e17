"""Graphs that really run: what ends them, and what is left afterwards."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import psutil
import pytest

from tests.cases import slow, some
from tests.conftest import Machine, alive
from tests.supervisor.running import GOOD, nothing_is_left, rows, supervisor_of, write

pytestmark = pytest.mark.real


@slow
@pytest.mark.parametrize("victim", some(["supervisor", "preload", "terminal"], "supervisor"))
def test_kill_minus_9_leaves_nothing_behind(machine: Machine, project: Path, victim: str) -> None:
    """After the death of any of them no node is left running, and the graph can be started again."""
    file = write(project, GOOD)
    up = machine.start("up", file, cwd=project)
    up.wait_for("Stop with Ctrl-C")
    nodes = [row["pid"] for row in rows(machine).values()]
    supervisor = supervisor_of(machine)["pid"]
    preload = int(Path(f"/proc/{nodes[0]}/stat").read_text().rpartition(")")[2].split()[1])
    guardian = psutil.Process(supervisor).ppid()
    target = {"supervisor": supervisor, "preload": preload, "terminal": up.pid}[victim]

    os.kill(target, signal.SIGKILL)

    family = [*nodes, supervisor, preload, guardian]
    machine.until(lambda: not any(alive(pid) for pid in family), "all processes are gone")
    code = up.wait()
    if victim != "terminal":
        assert code == 1
        assert f"process {target}, " in up.text
        assert "was ended by signal SIGKILL" in up.text
    machine.run("up", "-d", file, cwd=project)
    machine.look("down")


def test_a_node_that_is_killed_is_reported_and_the_others_go_on(machine: Machine, project: Path) -> None:
    """The terminal and `ps` say what happened to it."""
    up = machine.start("up", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    before = rows(machine)

    os.kill(before["/a"]["pid"], signal.SIGKILL)

    up.wait_for("/a died")
    assert "SIGKILL" in up.text
    after = rows(machine)
    assert after["/a"]["state"] == "failed"
    assert after["/b"]["state"] == "ready"
    assert up.end() == 1


@slow
def test_a_node_that_does_not_end_is_killed_and_a_second_ctrl_c_does_not_wait(machine: Machine, project: Path) -> None:
    """The ladder ends with SIGKILL; whoever is impatient presses again."""
    up = machine.start("up", write(project, "nodes:\n  /s: {class: nodes.lab:Stubborn}\n"), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    pid = rows(machine)["/s"]["pid"]

    up.process.send_signal(signal.SIGINT)
    up.wait_for("| [WARN]")
    assert alive(pid)
    assert up.end(signal.SIGINT) == 0

    nothing_is_left(machine, [pid])


def test_a_node_that_cannot_be_made_stops_the_start(machine: Machine, project: Path) -> None:
    """The others are stopped again, the reason is told, the exit code is 1."""
    text = "nodes:\n  /good: {class: nodes.lab:Good}\n  /bad: {class: nodes.lab:Refuses, after: /good}\n"
    up = machine.start("up", write(project, text), cwd=project)

    assert up.wait() == 1

    assert "no camera" in up.text
    nothing_is_left(machine, [])


def test_a_graph_whose_nodes_all_end_by_themselves_has_ended_well(machine: Machine, project: Path) -> None:
    """`shutdown` from within is no failure."""
    up = machine.start("up", write(project, "nodes:\n  /e: {class: nodes.lab:Ends}\n"), cwd=project)
    assert up.wait() == 0, up.text
    assert "done" in up.text


@slow
def test_a_large_graph_talks_through_the_rendezvous_and_says_so(machine: Machine) -> None:
    """Beyond what a mesh carries nodes are clients; they hear each other all the same."""
    pair = (
        "  /t{0}/talker: {{class: nodes.talker:Talker, params: {{rate: 20.0}}}}\n"
        "  /t{0}/ear: {{class: nodes.listener:Listener}}\n"
    )
    file = machine.run_directory / "large.yaml"
    file.write_text("nodes:\n" + "".join(pair.format(i) for i in range(13)))
    text = machine.run("up", "-d", str(file))
    assert "note: 26 processes are more than a mesh carries" in text
    for i in (0, 12):
        machine.until(lambda i=i: "I heard" in machine.look("logs", f"/t{i}/ear"), "it hears")  # type: ignore[misc]
    machine.look("down")


@slow
def test_a_stopped_terminal_that_is_killed_takes_its_graph_along(machine: Machine, project: Path) -> None:
    """Also when it had not read all that was told to it."""
    up = machine.start("up", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    found = rows(machine)
    up.process.send_signal(signal.SIGSTOP)
    os.kill(found["/a"]["pid"], signal.SIGKILL)
    machine.until(lambda: rows(machine)["/a"]["state"] == "failed", "it is seen")
    up.process.kill()
    nothing_is_left(machine, [row["pid"] for row in found.values()])

"""Graphs that really run: processes, signals, logs, and what is left afterwards."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
from pathlib import Path
from typing import Any

import psutil
import pytest

from graphflow.system import is_portable
from graphflow.transport.rendezvous import address
from tests.conftest import PROGRAMS, Machine, Program, alive

pytestmark = pytest.mark.real


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A user's own project: nodes that misbehave, each in one way."""
    root = tmp_path / "lab"
    (root / "nodes").mkdir(parents=True)
    (root / "pyproject.toml").touch()
    shutil.copy(PROGRAMS / "supervisor" / "lab.py", root / "nodes")
    return root


def write(project: Path, text: str, name: str = "lab.yaml") -> str:
    (project / name).write_text(text)
    return name


def rows(machine: Machine) -> dict[str, dict[str, Any]]:
    return {row["node"]: row for row in json.loads(machine.run("ps", "--json"))}


def supervisor_of(machine: Machine) -> dict[str, Any]:
    (file,) = machine.run_directory.glob("graphflow/*/*/run.json")
    run: dict[str, Any] = json.loads(file.read_text())
    return run


def nothing_is_left(machine: Machine, pids: list[int]) -> None:
    machine.until(lambda: not any(alive(pid) for pid in pids), "all processes are gone")
    machine.until(lambda: not list(machine.run_directory.glob("graphflow/*/*")), "the run directory is removed")


GOOD = "nodes:\n  /a: {class: nodes.lab:Good}\n  /b: {class: nodes.lab:Good, env: {COLOUR: red}}\n"


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


def test_the_same_graph_twice_is_an_error(machine: Machine, project: Path) -> None:
    """The second says since when it runs and how to stop it; the first is not touched."""
    file = write(project, GOOD)
    machine.run("up", "-d", file, cwd=project)

    text = machine.run("up", file, cwd=project, code=1)

    assert "graph lab is running already" in text
    assert "graphflow down --graph lab" in text
    assert set(rows(machine)) == {"/a", "/b"}
    machine.run("down")


def test_a_node_name_that_is_taken_is_refused_before_anything_starts(machine: Machine, project: Path) -> None:
    """The owner is named; two graphs with other names may run beside each other, and then `down` asks which."""
    machine.run("up", "-d", write(project, GOOD), cwd=project)

    text = machine.run("up", write(project, GOOD, "other.yaml"), cwd=project, code=1)
    assert "already in domain" in text
    assert f"process {rows(machine)['/a']['pid']}" in text

    machine.run("up", "-d", write(project, "nodes:\n  /c: {class: nodes.lab:Good}\n", "third.yaml"), cwd=project)
    assert "lab" in (text := machine.run("down", code=2))
    assert "--graph NAME" in text
    machine.run("down", "--graph", "third")
    machine.run("down")


@pytest.mark.parametrize("victim", ["supervisor", "preload", "terminal"])
def test_kill_minus_9_leaves_nothing_behind(machine: Machine, project: Path, victim: str) -> None:
    """Whoever of them dies: no node is left running, and the graph can be started again."""
    file = write(project, GOOD)
    up = machine.start("up", file, cwd=project)
    up.wait_for("Stop with Ctrl-C")
    nodes = [row["pid"] for row in rows(machine).values()]
    supervisor = supervisor_of(machine)["pid"]
    preload = int(Path(f"/proc/{nodes[0]}/stat").read_text().rpartition(")")[2].split()[1])
    target = {"supervisor": supervisor, "preload": preload, "terminal": up.pid}[victim]

    os.kill(target, signal.SIGKILL)

    machine.until(lambda: not any(alive(pid) for pid in [*nodes, supervisor, preload]), "all processes are gone")
    code = up.wait()
    if victim != "terminal":
        assert code == 1
        assert "died" in up.text
    machine.run("up", "-d", file, cwd=project)
    machine.run("down")


def test_a_node_that_is_killed_is_reported_and_the_others_go_on(machine: Machine, project: Path) -> None:
    """The terminal and `ps` say what happened to it."""
    up = machine.start("up", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    before = rows(machine)

    os.kill(before["/a"]["pid"], signal.SIGKILL)

    up.wait_for("/a has died")
    assert "SIGKILL" in up.text
    after = rows(machine)
    assert after["/a"]["state"] == "failed"
    assert after["/b"]["state"] == "ready"
    assert up.end() == 1


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


def test_an_error_in_a_task_ends_the_node_with_its_traceback(machine: Machine, project: Path) -> None:
    """When all nodes have ended the graph has, with code 1 if one failed."""
    up = machine.start("up", write(project, "nodes:\n  /c: {class: nodes.lab:Crashes}\n"), cwd=project)

    assert up.wait() == 1

    assert "the bridge is out" in up.text
    assert "Traceback" in up.text
    assert "exit code 70" in up.text
    assert "lab.py" in up.text


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
    assert up.wait() == 0
    assert "done" in up.text


def test_nodes_that_share_a_process_share_its_pid_and_its_end(machine: Machine, project: Path) -> None:
    """A crash ends the mates; nodes elsewhere go on."""
    text = (
        "nodes:\n  /a: {class: nodes.lab:Good, process: both}\n  /b: {class: nodes.lab:Good, process: both}\n"
        "  /c: {class: nodes.lab:Good}\n"
    )
    machine.run("up", "-d", write(project, text), cwd=project)
    found = rows(machine)
    assert found["/a"]["pid"] == found["/b"]["pid"] != found["/c"]["pid"]

    os.kill(found["/a"]["pid"], signal.SIGKILL)

    machine.until(lambda: rows(machine)["/b"]["state"] == "failed", "both are seen to have ended")
    assert rows(machine)["/c"]["state"] == "ready"
    machine.run("down")


@pytest.mark.parametrize(
    ("call", "expected"),
    [("/fails", "OSError: the disk is full"), ("/nowhere, type: std_srvs/srv/Trigger", "nobody offers the service")],
)
def test_a_failed_step_stops_the_graph(machine: Machine, project: Path, call: str, expected: str) -> None:
    """The step and the reason are told, everything is stopped again, the exit code is 1."""
    text = f"nodes:\n  /f: {{class: nodes.lab:Fails}}\nsteps:\n  ask: {{after: /f, call: {call}, timeout: 1.0}}\n"
    up = machine.start("up", write(project, text), cwd=project)

    assert up.wait() == 1

    assert "step ask FAILED" in up.text
    assert expected in up.text
    nothing_is_left(machine, [])


def test_fresh_interpreter_for_variables_that_need_one(machine: Machine, project: Path) -> None:
    """`env:` with PYTHON..., LD_... or MALLOC_... starts the node in an interpreter of its own."""
    text = "nodes:\n  /a: {class: nodes.lab:Good, env: {PYTHONHASHSEED: 7, COLOUR: blue}}\n"
    machine.run("up", "-d", write(project, text), cwd=project)
    pid = rows(machine)["/a"]["pid"]
    assert b"graphflow.supervisor.worker" in Path(f"/proc/{pid}/cmdline").read_bytes()
    assert "blue" in machine.run("service", "call", "/a/ask", "std_srvs/srv/Trigger")
    machine.run("down")
    nothing_is_left(machine, [pid])


def test_logs_of_a_graph_that_has_ended_can_be_read(machine: Machine) -> None:
    """`logs` shows the latest run; a misspelt node is told which one was meant."""
    machine.run("up", "-d", "graphs/talker_listener.yaml", "rate:=50.0")
    machine.until(lambda: "I heard" in machine.run("logs"), "something was logged")
    machine.run("down")

    assert "I heard" in machine.run("logs", "/listener", "-n", "3")
    assert "did you mean 'talker'" in machine.run("logs", "talkr", code=2)


def test_logs_follow(machine: Machine) -> None:
    """`logs -f` goes on as more is written and ends with the graph."""
    machine.run("up", "-d", "graphs/talker_listener.yaml", "rate:=50.0")
    follow: Program = machine.start("logs", "-f", "/listener")
    follow.wait_for("I heard: [Hello World: 20]")
    machine.run("down")
    assert follow.wait() == 0


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
        machine.until(lambda i=i: "I heard" in machine.run("logs", f"/t{i}/ear"), "it hears")  # type: ignore[misc]
    machine.run("down")


def test_private_keeps_a_graph_to_itself(machine: Machine) -> None:
    """`--private` takes a port and a domain of its own, and says how other terminals get there."""
    text = machine.run("up", "-d", "--private", "graphs/talker_listener.yaml")
    assert "nothing is running" in machine.run("node", "list", code=3)
    line = next(line for line in text.splitlines() if "export" in line)
    machine.env |= dict(word.split("=", 1) for word in line.split()[1:])
    assert machine.run("node", "list").split() == ["/listener", "/talker"]
    machine.run("down")


@pytest.mark.skipif(is_portable(), reason="the portable way has no preload process")
def test_the_preload_process_has_one_thread(machine: Machine, project: Path) -> None:
    """Otherwise forking it would be unsafe."""
    machine.run("up", "-d", write(project, GOOD), cwd=project)
    pid = rows(machine)["/a"]["pid"]
    preload = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1]
    assert len(list(Path(f"/proc/{preload}/task").iterdir())) == 1
    machine.run("down")


def test_a_log_folder_that_cannot_be_written_is_an_error_before_anything_starts(
    machine: Machine, project: Path
) -> None:
    """The text names the folder and the variable that moves it."""
    machine.env["ROS_LOG_DIR"] = "/proc/nowhere"
    text = machine.run("up", write(project, GOOD), cwd=project, code=1)
    assert "/proc/nowhere/lab" in text
    assert "ROS_LOG_DIR" in text
    nothing_is_left(machine, [])


def test_a_taken_port_is_an_error_before_anything_starts(machine: Machine, project: Path) -> None:
    """Whoever listens where the rendezvous should be is named, and no node is started."""
    _, port = address(machine.endpoint)
    with socket.create_server(("127.0.0.1", port)):
        text = machine.run("up", write(project, GOOD), cwd=project, code=1)
    assert f"process {os.getpid()}" in text
    assert "did not answer as Zenoh" in text
    assert "set GRAPHFLOW_RENDEZVOUS=tcp/127.0.0.1:OTHER_PORT" in text
    nothing_is_left(machine, [])


def test_ctrl_c_while_the_graph_comes_up_leaves_nothing(machine: Machine, project: Path) -> None:
    """A start that takes long can be broken off."""
    shutil.copy(PROGRAMS / "supervisor" / "slow_import.py", project / "nodes")
    up = machine.start("up", write(project, "nodes:\n  /s: {class: nodes.slow_import:Late}\n"), cwd=project)
    machine.until(lambda: bool(children(up.pid)), "the supervisor is there")
    supervisor = children(up.pid)
    machine.until(lambda: bool(children(supervisor[0])), "the preload process is there")
    preload = children(supervisor[0])

    up.end(signal.SIGINT)

    nothing_is_left(machine, [*supervisor, *preload])


def children(pid: int) -> list[int]:
    return [child.pid for child in psutil.Process(pid).children()]


def test_a_node_that_leaves_before_it_is_ready_has_failed(machine: Machine, project: Path) -> None:
    """Exit code 0 or not: what waits for it would wait for ever."""
    text = "nodes:\n  /gone: {class: nodes.lab:Leaves}\n  /good: {class: nodes.lab:Good, after: /gone}\n"
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 1
    assert "ended before it was ready: /gone" in up.text


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_what_a_node_has_started_goes_with_it(machine: Machine, project: Path, how: int) -> None:
    """A child process of a node does not outlive it, however the node ends."""
    up = machine.start("up", write(project, "nodes:\n  /p: {class: nodes.lab:Parent}\n"), cwd=project)
    machine.until(lambda: "child " in machine.run("logs", "/p", code=None), "it has a child")
    child = int(machine.run("logs", "/p").split("child ")[1].split(".")[0])
    assert alive(child)

    os.kill(rows(machine)["/p"]["pid"], how)

    machine.until(lambda: not alive(child), "the child is gone")
    up.wait()


def test_an_impossible_environment_fails_its_node_only(machine: Machine, project: Path) -> None:
    """The process that starts nodes survives what cannot be started."""
    text = 'nodes:\n  /bad: {class: nodes.lab:Good, env: {"LD_A=B": x}}\n'
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 1
    assert "cannot be started" in up.text


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

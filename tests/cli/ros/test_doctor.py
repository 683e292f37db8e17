"""`graphflow doctor`."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path

import pytest

from graphflow.rclpy import enabling
from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real

STANDING_FAULT = "/office/minutes: the publisher of /office/clerk offers less than the subscription of /office/auditor"


@pytest.fixture(autouse=True)
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    """A shell in which no ROS 2 is sourced."""
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def test_endpoints_that_do_not_fit(standing: Machine) -> None:
    """Incompatible endpoints are a fault, with exit code 1."""
    assert standing.look("doctor", code=1).startswith(STANDING_FAULT)
    found = json.loads(standing.look("wtf", "--json", code=1))
    assert [text[: len(STANDING_FAULT)] for text in found.pop("misfits")] == [STANDING_FAULT]
    found.pop("late")
    found.pop("starts")
    assert found.pop("hints") == [
        "/office/clerk calls /bank/add, which no node offers; available with that type: /office/clerk/add"
    ]
    others = (
        "deadlocks",
        "stalls",
        "unresponsive",
        "supervised",
        "unseen",
        "blocked",
        "silent",
        "rclpy",
        "health",
        "installation",
        "runs",
        "left",
        "unreadable",
        "kept_back",
    )
    assert found == {name: [] for name in others}


def test_nothing_runs(machine: Machine) -> None:
    """Without a graph, the installation is checked."""
    assert "no graph is running" in machine.look("doctor", code=3) or "nothing is running" in machine.look(
        "doctor", code=3
    )
    assert "PACKAGE VERSIONS" in machine.look("doctor", "-r")
    assert "no such command 'now'" in machine.look("doctor", "now", code=2)


@slow
def test_a_stopped_process(machine: Machine, tmp_path: Path) -> None:
    """A stopped process is reported at once, even if it is not a node's."""
    (tmp_path / "g.yaml").write_text("nodes: {/talker: {class: nodes.talker:Talker}, /p: {command: [sleep, '99']}}\n")
    machine.run("up", "-d", "g.yaml", cwd=tmp_path)
    pids = {row["node"]: row["pid"] for row in json.loads(machine.look("ps", "--json"))}
    assert machine.look("doctor") == "1 node, nothing wrong\n"
    for pid in pids.values():
        os.kill(pid, signal.SIGSTOP)
    try:
        text = machine.look("doctor", code=1)
        assert f"/talker (process {pids['/talker']}) did not answer: it is stopped: kill -CONT" in text
        assert f"/p (process {pids['/p']}) is stopped: kill -CONT {pids['/p']}" in text
        assert "nothing wrong" not in text
    finally:
        for pid in pids.values():
            os.kill(pid, signal.SIGCONT)
        machine.run("down", cwd=tmp_path)


@slow
def test_a_stopped_process_of_no_graph(machine: Machine) -> None:
    """A stopped process outside all graphs is reported, also by verbs that get no answer from it."""
    router = machine.start("router")
    machine.until(lambda: "nothing" not in machine.run("node", "list", code=None), "the router answers")
    talker = machine.start("run", "nodes.talker:Talker")
    talker.wait_for("Publishing")
    os.kill(talker.pid, signal.SIGSTOP)
    resume = f"is stopped: kill -CONT {talker.pid}"
    try:
        assert resume in machine.look("param", "get", "/talker", "rate", code=4)
        assert resume in machine.look("doctor", code=1)
        assert resume in machine.look("param", "get", "/nobody", "rate", code=1)
    finally:
        os.kill(talker.pid, signal.SIGCONT)
    assert talker.end() == 0
    router.end()


@slow
def test_a_graph_that_was_killed(machine: Machine, tmp_path: Path) -> None:
    """A killed graph is reported with the folder that it left."""
    (tmp_path / "g.yaml").write_text("nodes: {/talker: {class: nodes.talker:Talker}}\n")
    machine.run("up", "-d", "g.yaml", cwd=tmp_path)
    [run_file] = Path(machine.env["XDG_RUNTIME_DIR"]).glob("graphflow/*/*/run.json")
    run = json.loads(run_file.read_text())
    machine.run("down", cwd=tmp_path)
    run_file.parent.mkdir(parents=True, exist_ok=True)
    run_file.write_text(json.dumps({**run, "pid": 2**22 + 1, "guardian": 0}))
    text = machine.look("doctor", code=3)
    assert f"was killed and left {run_file.parent}" in text
    run_file.unlink()


def test_which_rclpy_wins_is_said(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """If there are two versions of rclpy, a note names the imported one; it is not a fault."""
    assert "rclpy" not in machine.look("doctor", code=3)
    monkeypatch.setattr(enabling, "elsewhere", lambda: "/opt/ros/rclpy/__init__.py")
    assert "import rclpy imports that of the ROS 2 in this shell, /opt/ros/rclpy" in machine.look("doctor", code=3)
    assert json.loads(machine.look("doctor", "--json", code=3).partition("\nerror")[0])["rclpy"]


def test_options_are_not_the_environment(standing: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """Options of this command are not reported as the shell's environment."""
    ros = {"AMENT_PREFIX_PATH": "/opt/ros/jazzy", "ROS_DISTRO": "jazzy", "RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}
    monkeypatch.setitem(standing.env, "ZENOH_CONFIG_OVERRIDE", "x")
    for name, value in ros.items():
        monkeypatch.setitem(standing.env, name, value)
    domain = standing.env["GRAPHFLOW_DOMAIN"]
    monkeypatch.delitem(standing.env, "GRAPHFLOW_DOMAIN")
    found = json.loads(standing.look("--domain", domain, "--wire", "kilted", "doctor", "--json", code=1))
    assert found["installation"] == []


@slow
def test_hints_as_faults(machine: Machine) -> None:
    """If they are wanted to be."""
    node = machine.start("run", "listener")
    machine.until(lambda: "/chatter" in machine.look("topic", "list", code=None), "it listens")
    text = machine.look("doctor")
    assert "subscribes to /chatter, which no node publishes" in text
    assert "1 node, no fault; the lines above may be intended" in text
    machine.look("doctor", "-iw", code=1)
    assert node.end() == 0

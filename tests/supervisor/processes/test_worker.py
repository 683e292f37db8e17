"""A process of the graph."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import threading
from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import GraphflowError, Place
from graphflow.graph.plan import PlannedNode, Rule, Setting
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.supervisor.processes import worker
from graphflow.supervisor.processes.orphaned import Orphan
from graphflow.supervisor.processes.worker import PIPE_BUF, PipeReporter, SocketReporter, _one_line, make_node
from graphflow.testing import Graph
from graphflow.testing.clock import settle
from nodes.talker import Talker
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import rows, write


@slow
@pytest.mark.real
def test_an_error_in_a_task_ends_the_node_with_its_traceback(machine: Machine, project: Path) -> None:
    """When all nodes have ended the graph has, with code 1 if one failed."""
    up = machine.start("up", write(project, "nodes:\n  /c: {class: nodes.lab:Crashes}\n"), cwd=project)

    assert up.wait() == 1

    assert "the bridge is out" in up.text
    assert "Traceback" in up.text
    assert "exit code 70" in up.text
    assert "lab.py" in up.text


@slow
@pytest.mark.real
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
    machine.look("down")


@slow
@pytest.mark.real
def test_a_node_that_leaves_before_it_is_ready_has_failed(machine: Machine, project: Path) -> None:
    """Exit code 0 or not: what waits for it would wait for ever."""
    text = "nodes:\n  /gone: {class: nodes.lab:Leaves}\n  /good: {class: nodes.lab:Good, after: /gone}\n"
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 1
    assert "ended before it was ready: /gone" in up.text


PLACE = Place("graph.yaml", 2, 3)


def planned(class_path: str = "nodes.talker:Talker", name: str = "/left/voice", **more: Any) -> PlannedNode:
    return PlannedNode(name, class_path, PLACE, PLACE, **more)


async def test_a_node_as_planned(graph: Graph) -> None:
    """Its name, parameters and remaps are the plan's; what is optional and not there is left out."""
    params = {"rate": Setting(5.0, PLACE), "greeting": Setting("Hi", PLACE, True), "other": Setting(1, PLACE, True)}
    node = make_node(planned(params=params, remaps=(Rule("chatter", "said", PLACE),)), PLACE.file)
    assert isinstance(node, Talker)
    assert (node.full_name, node.rate) == ("/left/voice", 5.0)
    heard = graph.tap(String, "/left/said")
    await graph.start(node)
    await graph.clock.advance(0.4)
    assert [m.data for m in heard] == ["Hi: 1", "Hi: 2"]


async def test_parameters_of_launch_files_that_a_node_does_not_have(graph: Graph, caplog: Any) -> None:
    """They are left out, and told where nothing else would have told them."""
    params = {"use_sim_time": Setting(False, PLACE, True, True), "raet": Setting(1, PLACE, True, True)}
    node = make_node(planned(params=params), PLACE.file)
    assert isinstance(node, Talker)
    told = "graph.yaml:2:3: there is no parameter 'raet'; it is left out; did you mean 'rate'?"
    assert caplog.messages == [told]


class Wheels(Node):
    """Declares its parameters in a loop."""

    def __init__(self) -> None:
        super().__init__()
        self.radii = [self.declare_parameter(f"{side}.radius", 0.1) for side in ("left", "right")]


async def test_optional_parameters_that_a_node_makes(graph: Graph, caplog: Any) -> None:
    """They are set; one that is like none of them is left out."""
    params = {name: Setting(0.2, PLACE, True, True) for name in ("left.radius", "left.radios")}
    node = make_node(planned(f"{Wheels.__module__}:Wheels", params=params), PLACE.file)
    assert node.parameters.get("left.radius") == 0.2
    assert [text.partition(";")[0] for text in caplog.messages] == [
        "graph.yaml:2:3: there is no parameter 'left.radios'"
    ]


@pytest.mark.parametrize(("level", "number"), [("debug", 10), ("error", 40), ("", 0)])
def test_the_level_of_its_log(level: str, number: int) -> None:
    """As the plan says, and the process's own where it says nothing."""
    node = make_node(planned(name=f"/logs_{number}", log_level=level), PLACE.file)
    assert core_of(node).log.level == number


@pytest.mark.parametrize(
    ("node", "told"),
    [
        (planned("nodes.talker:Talkr"), "did you mean 'Talker'"),
        (planned(params={"rate": Setting(-1.0, PLACE)}), "out of range"),
        (planned(params={"rate": Setting("fast", PLACE)}), "'fast' is not"),
    ],
)
def test_a_node_that_cannot_be_made(node: PlannedNode, told: str) -> None:
    """The error names what was meant."""
    with pytest.raises(GraphflowError, match=told):
        make_node(node, PLACE.file)


def test_a_report_keeps_in_one_piece() -> None:
    """A pipe that many write to mixes lines that are longer: an error is cut, the rest is not."""
    read, write = os.pipe()
    reporter = PipeReporter(write, -1, Orphan(0, -1, -1, ""))
    reporter.report({"event": "ready", "process": "/a", "node": "/a"})
    reporter.report({"event": "failed", "process": "/a", "error": "x" * 10_000})
    os.close(write)
    with open(read, "rb") as pipe:
        ready, failed = pipe.read().splitlines(keepends=True)
    assert json.loads(ready) == {"event": "ready", "process": "/a", "node": "/a"}
    assert PIPE_BUF // 2 < len(failed) <= PIPE_BUF
    assert json.loads(failed)["error"].strip("x") == ""


@pytest.fixture
def ends(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Exit codes of this process, were it a worker."""
    codes: list[int] = []
    monkeypatch.setattr(os, "_exit", codes.append)
    return codes


def until_it_has_listened() -> None:
    for thread in threading.enumerate():
        if thread.name == "graphflow-supervisor":
            thread.join(10.0)


async def test_a_worker_that_is_asked_to_stop(graphflow_runner: asyncio.Runner, ends: list[int]) -> None:
    """It shows its token first; a line asks it to stop, others are orders; when the line ends, so does it, at once."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        reporter = SocketReporter(server.getsockname()[1], "secret", "/a")
        stopped, orders = asyncio.Event(), list[bytes]()
        reporter.listen(stopped.set, orders.append)
        connection, _ = server.accept()
        with connection:
            reporter.report({"event": "beat", "process": "/a"})
            with connection.makefile("rb") as lines:
                assert json.loads(lines.readline()) == {"token": "secret", "process": "/a"}
                assert json.loads(lines.readline()) == {"event": "beat", "process": "/a"}
            assert not stopped.is_set()
            connection.sendall(b'{"do": "load"}\n{"do": "stop"}\n')
            async with asyncio.timeout(10.0):
                await stopped.wait()
            assert orders == [b'{"do": "load"}\n']
            assert ends == []
        until_it_has_listened()
    assert ends == [worker.EXIT_ERROR]
    reporter._socket.close()


async def test_a_worker_that_was_asked_before_it_could_stop(graphflow_runner: asyncio.Runner, ends: list[int]) -> None:
    """It stops as soon as it can."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        reporter = SocketReporter(server.getsockname()[1], "secret", "/a")
        connection, _ = server.accept()
        with connection:
            connection.sendall(b'{"do": "stop"}\n')
        until_it_has_listened()
    stopped: list[bool] = []
    reporter.listen(lambda: stopped.append(True), nothing)
    assert stopped == [True]
    reporter._socket.close()


def nothing(line: bytes) -> None:
    """No order is expected."""


class Attended(Orphan):
    """Of a worker whose preload process lives as long as the test."""

    def watch(self) -> None:
        return


async def test_orders_come_over_a_pipe(graphflow_runner: asyncio.Runner) -> None:
    """Whole lines, however they are cut; the end of the pipe is nothing."""
    read, write = os.pipe()
    heard: list[bytes] = []
    PipeReporter(-1, read, Attended(0, -1, read, "")).listen(lambda: None, heard.append)
    for part in (b'{"order": 1', b'}\n{"order"', b": 2}\n"):
        os.write(write, part)
        await settle()
    os.close(write)
    await settle()
    assert heard == [b'{"order": 1}', b'{"order": 2}']
    os.close(read)


def test_an_error_in_one_line() -> None:
    """One of ours speaks for itself, others say of what kind they are."""
    assert _one_line(GraphflowError("no such class")) == "no such class"
    assert _one_line(ValueError("no camera")) == "ValueError: no camera"


def test_an_error_that_was_raised_in_the_users_code() -> None:
    """Its line is told, once."""
    with pytest.raises(ValueError, match="camera") as caught:
        raise ValueError("no camera")
    line = f"{__file__}:{caught.tb.tb_lineno}"
    assert _one_line(caught.value) == f"ValueError: no camera ({line})"
    assert _one_line(GraphflowError(f"{line}: no").with_traceback(caught.tb)) == f"{line}: no"


@slow
@pytest.mark.real
def test_nobody_loads_nodes_over_the_network(machine: Machine, project: Path) -> None:
    """Unless the graph file allows it."""
    for head, is_offered in (("", False), ("net: {allow_control: true}\n", True)):
        machine.run("up", "-d", write(project, f"{head}nodes:\n  /a: {{class: nodes.lab:Good}}\n"), cwd=project)
        services = machine.look("service", "list", "--include-hidden-services")
        assert "/a/ask" in services
        assert ("_container/load_node" in services) is is_offered
        machine.look("down")

"""Lifecycle nodes in programs: brought to the state that the graph wants, and followed."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from graphflow import LifecycleNode, Node, TransitionRefused
from graphflow.errors import Place
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import START_LIMIT
from graphflow.msgs.lifecycle_msgs.msg import State
from graphflow.msgs.lifecycle_msgs.srv import GetState
from graphflow.supervisor.lifecycle_manager import LifecycleManager
from graphflow.supervisor.steps import StepRunner
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import rows


class Camera(LifecycleNode):
    """Is active, and otherwise does nothing."""


class Broken(LifecycleNode):
    async def on_activate(self) -> None:
        raise TransitionRefused("no camera")


def planned(name: str, state: str) -> PlannedNode:
    place = Place("g.yaml", 1, 1)
    return PlannedNode(name, "", place, place, command=("graphflow", "run", "p", "e"), lifecycle=state)


@asynccontextmanager
async def bringing(graph: Graph, name: str, state: str) -> AsyncIterator[list[Any]]:
    """The events while a node is brought to a state; the supervisor is a process of its own."""
    await graph.start(supervisor := Node("_supervisor"))
    heard: list[Any] = []
    steps = StepRunner(supervisor.context, {})
    manager = LifecycleManager(supervisor.context, steps, heard.append)
    manager.begin("p", planned(name, state))
    yield heard
    await manager.close()
    await steps.close()


@pytest.mark.parametrize(
    ("state", "passed"), [("unconfigured", []), ("inactive", ["inactive"]), ("active", ["inactive", "active"])]
)
async def test_a_node_is_brought_up(graph: Graph, state: str, passed: list[str]) -> None:
    """By the steps that lead there; each state is told, and then that it is ready."""
    await graph.start(node := Camera("camera"))
    async with bringing(graph, "/camera", state) as heard:
        await graph.clock.advance(1.0)
        assert node.lifecycle_state.label == state
        assert [event["state"] for event in heard if event["event"] == "lifecycle"] == passed
        assert heard[-1] == {"event": "ready", "process": "p", "node": "/camera"}


async def test_what_others_do_with_it_is_followed(graph: Graph) -> None:
    """After it is ready, too."""
    await graph.start(node := Camera("camera"))
    async with bringing(graph, "/camera", "active") as heard:
        await graph.clock.advance(1.0)
        await node.trigger_deactivate()
        await graph.clock.advance(0.1)
        assert heard[-1] == {"event": "lifecycle", "process": "p", "node": "/camera", "state": "inactive"}


async def test_a_step_that_does_not_succeed(graph: Graph) -> None:
    """It has failed, and where it is now is said."""
    await graph.start(Broken("camera"))
    async with bringing(graph, "/camera", "active") as heard:
        await graph.clock.advance(1.0)
        error = "/camera: activate did not succeed, and it is inactive; its log may say why"
        assert heard[-1] == {"event": "failed", "process": "p", "error": error}


async def test_a_program_that_is_slow(graph: Graph) -> None:
    """It is waited for."""
    async with bringing(graph, "/camera", "inactive") as heard:
        await graph.clock.advance(START_LIMIT / 2)
        await graph.start(Camera("camera"))
        await graph.clock.advance(1.0)
        assert heard[-1] == {"event": "ready", "process": "p", "node": "/camera"}


async def test_a_node_that_has_no_life_cycle(graph: Graph) -> None:
    """It is said before its process is given up."""
    await graph.start(Node("camera"))
    async with bringing(graph, "/camera", "active") as heard:
        await graph.clock.advance(START_LIMIT - 0.1)
        assert [event["error"] for event in heard] == ["/camera offers no get_state, as lifecycle nodes do; is it one?"]


@pytest.mark.parametrize(
    ("number", "error"),
    [
        (4, "/camera is finalized: it can only be started again"),
        (10, "/camera does not come to rest"),
        (77, "/camera does not come to rest"),
    ],
)
async def test_states_that_lead_nowhere(graph: Graph, number: int, error: str) -> None:
    """Whatever number is said, it is bounded in time, and told."""
    await graph.start(node := Node("camera"))
    answer = GetState.Response(current_state=State(id=number))
    node.create_service(GetState, "~/get_state", lambda request: answer)
    async with bringing(graph, "/camera", "active") as heard:
        await graph.clock.advance(START_LIMIT - 0.1)
        assert heard == [{"event": "failed", "process": "p", "error": error}]


async def test_a_process_that_has_ended(graph: Graph) -> None:
    """Nothing more is told of it."""
    await graph.start(supervisor := Node("_supervisor"))
    heard: list[Any] = []
    steps = StepRunner(supervisor.context, {})
    manager = LifecycleManager(supervisor.context, steps, heard.append)
    manager.begin("p", planned("/camera", "active"))
    await asyncio.sleep(0)
    manager.end("p")
    manager.end("p")
    await graph.start(Camera("camera"))
    await graph.clock.advance(START_LIMIT)
    assert heard == []
    await manager.close()
    await steps.close()


PROGRAM = """\
import rclpy
from rclpy.lifecycle import LifecycleNode

rclpy.init()
rclpy.spin(LifecycleNode("named_by_the_graph"))
"""


@slow
@pytest.mark.real
def test_rclpys_nodes(machine: Machine, tmp_path: Path) -> None:
    """A program's node is active before others start; and so is the next, after one that was killed."""
    package = tmp_path / "src" / "lab"
    (package / "scripts").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='3'><name>lab</name></package>\n")
    (package / "scripts" / "cam.py").write_text(PROGRAM)
    graph = tmp_path / "g.yaml"
    entry = "{pkg: lab, exec: cam.py, lifecycle: active, restart: {policy: always, delay: 0.05}}"
    graph.write_text(f"nodes:\n  /front/cam: {entry}\n  /after: {{command: [sleep, '600'], after: /front/cam}}\n")
    machine.run("up", "-d", str(graph), cwd=tmp_path)
    assert machine.look("lifecycle", "get", "/front/cam").strip() == "active [3]"
    machine.look("lifecycle", "set", "/front/cam", "deactivate")
    machine.until(lambda: rows(machine)["/front/cam"]["lifecycle"] == "inactive", "what others do is shown")
    os.kill(rows(machine)["/front/cam"]["pid"], signal.SIGKILL)
    machine.until(lambda: rows(machine)["/front/cam"]["restarts"] == 1, "it is started again")
    machine.until(lambda: rows(machine)["/front/cam"]["lifecycle"] == "active", "it is brought up again")
    machine.look("down")

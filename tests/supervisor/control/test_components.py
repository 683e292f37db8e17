"""Orders to workers: which are given, and what their answers change."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import Any

import pytest

from graphflow.errors import Place, SupervisorError
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import State
from graphflow.supervisor.control import components
from graphflow.supervisor.control.components import Components
from graphflow.supervisor.processes.process import Process
from graphflow.testing.clock import settle

pytestmark = pytest.mark.usefixtures("graphflow_runner")
HERE = Place("g.yaml", 1)


def node(name: str, **more: Any) -> PlannedNode:
    return PlannedNode(name, "nodes.talker:Talker", HERE, HERE, **more)


class Worker:
    """Stands for the starter: obeys, but for what its test wants otherwise."""

    def __init__(self) -> None:
        self.components: Components
        self.orders: list[dict[str, Any]] = []
        self.error = ""
        self.is_silent = False
        self.number = 10

    def send_order(self, process: str, order: dict[str, Any]) -> None:
        self.orders.append(order)
        if self.is_silent:
            return
        name = order["node"]["name"] if order["do"] == "load" else order["node"]
        self.number += 1
        told: Any = {
            "event": "obeyed",
            "process": process,
            "order": order["order"],
            "node": name,
            "number": self.number,
        }
        asyncio.get_running_loop().call_soon(self.components.on_event, told | {"error": self.error})


class Stage:
    def __init__(self) -> None:
        self.changes: list[tuple[str, str, bool]] = []
        self.worker = Worker()
        shared = Process("tutorial", [node("/a", process="tutorial"), node("/b", process="tutorial")], "log")
        alone, ended = Process("/c", [node("/c")], "log"), Process("/d", [node("/d")], "log")
        program = Process("/e", [replace(node("/e"), command=("top",))], "log")
        self.processes = [shared, alone, ended, program]
        for process in (shared, alone, program):
            process.state = State.READY
        ended.state = State.ENDED
        starter: Any = self.worker
        self.components = self.worker.components = Components(
            starter, self.processes, lambda p, n, joined: self.changes.append((p.name, n.name, joined))
        )


@pytest.mark.parametrize("container", ["tutorial", "/a", "a", "b"])
async def test_a_node_joins_a_process(container: str) -> None:
    """Which is named by its word, or by a node in it; the worker says which number it has there."""
    stage = Stage()
    assert await stage.components.load(container, node("/x")) == (11, "/x")
    process = stage.processes[0]
    assert [n.name for n in process.nodes] == ["/a", "/b", "/x"]
    assert process.nodes[-1].process == "tutorial"
    assert process.numbers == {"/a": 1, "/b": 2, "/x": 11}
    assert stage.changes == [("tutorial", "/x", True)]
    assert stage.worker.orders[0]["node"]["process"] == "tutorial"


async def test_a_node_leaves_a_process() -> None:
    """By its number; the others keep theirs."""
    stage = Stage()
    assert await stage.components.unload("tutorial", 1) == "/a"
    assert stage.processes[0].numbers == {"/b": 2}
    assert stage.changes == [("tutorial", "/a", False)]


@pytest.mark.parametrize(
    ("container", "name", "told"),
    [
        ("tutorail", "/x", "no process 'tutorail'; did you mean 'tutorial'"),
        ("/d", "/x", "/d is not running: ended"),
        ("/e", "/x", "/e is a foreign program, into which no node can be loaded"),
        ("tutorial", "/c", "the graph has a node /c already"),
    ],
)
async def test_what_cannot_be_loaded(container: str, name: str, told: str) -> None:
    """And nobody is given an order."""
    stage = Stage()
    with pytest.raises(SupervisorError, match=told):
        await stage.components.load(container, node(name))
    assert stage.worker.orders == []


@pytest.mark.parametrize(
    ("container", "number", "told"),
    [
        ("tutorial", 3, "tutorial has no component 3; there is 1 /a, 2 /b"),
        ("/c", 1, "/c is the last node of /c; to stop it: graphflow stop /c"),
    ],
)
async def test_what_cannot_be_unloaded(container: str, number: int, told: str) -> None:
    """An empty process would be of no use."""
    stage = Stage()
    with pytest.raises(SupervisorError, match=told):
        await stage.components.unload(container, number)
    assert stage.worker.orders == []


async def test_a_worker_that_fails_to() -> None:
    """Its error comes out, and nothing has changed."""
    stage = Stage()
    stage.worker.error = "no module named nodes.x"
    with pytest.raises(SupervisorError, match="no module named"):
        await stage.components.load("/c", node("/x"))
    assert stage.changes == []


async def test_a_worker_that_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not for ever; a node that has come up all the same is known, by whatever it is then called."""
    monkeypatch.setattr(components, "LIMIT", 0.05)
    stage = Stage()
    stage.worker.is_silent = True
    with pytest.raises(SupervisorError, match="/c did not answer within"):
        await stage.components.load("/c", node("/x"))
    number = stage.worker.orders[0]["order"]
    late: Any = {"event": "obeyed", "process": "/c", "order": number, "node": "/x", "number": 2, "error": ""}
    stage.components.on_event(late)
    stage.components.on_event(late)  # a second time it is nothing
    assert stage.changes == [("/c", "/x", True)]
    assert stage.processes[1].numbers == {"/c": 1, "/x": 2}


async def test_a_process_that_ends_meanwhile() -> None:
    """Is told at once."""
    stage = Stage()
    stage.worker.is_silent = True
    loading = asyncio.create_task(stage.components.load("/c", node("/x")))
    await asyncio.sleep(0)
    stage.components.lost(stage.processes[1])
    with pytest.raises(SupervisorError, match="its process has ended"):
        await loading


async def test_an_answer_of_another_process_is_none() -> None:
    """A worker speaks for itself only."""
    stage = Stage()
    stage.worker.is_silent = True
    loading = asyncio.create_task(stage.components.load("/c", node("/x")))
    await asyncio.sleep(0)
    forged: Any = {"event": "obeyed", "process": "tutorial", "order": stage.worker.orders[0]["order"]}
    stage.components.on_event(forged | {"node": "/x", "number": 1, "error": ""})
    await asyncio.sleep(0)
    assert not loading.done()
    stage.components.lost(stage.processes[1])
    with pytest.raises(SupervisorError):
        await loading


async def test_orders_to_one_process_wait_for_each_other() -> None:
    """A pipe holds one."""
    stage = Stage()
    stage.worker.is_silent = True
    tasks = [asyncio.create_task(stage.components.load("/c", node(name))) for name in ("/x", "/y")]
    await settle()
    assert len(stage.worker.orders) == 1
    stage.processes[1].state = State.ENDED
    stage.components.lost(stage.processes[1])
    first, second = await asyncio.gather(*tasks, return_exceptions=True)
    assert str(first) == "its process has ended"
    assert str(second).startswith("/c is not running")
    assert len(stage.worker.orders) == 1


async def test_two_nodes_of_one_name_at_once() -> None:
    """The second is refused while the first is on its way."""
    stage = Stage()
    stage.worker.is_silent = True
    first = asyncio.create_task(stage.components.load("/c", node("/x")))
    await asyncio.sleep(0)
    with pytest.raises(SupervisorError, match="the graph has a node /x already"):
        await stage.components.load("tutorial", node("/x"))
    first.cancel()


async def test_what_joins_without_an_order() -> None:
    """Loaded by ROS 2's service, for graphs that allow it."""
    stage = Stage()
    joined: Any = {"event": "joined", "process": "/c", "node": node("/x").to_json(), "number": 5}
    stage.components.on_event(joined)
    assert stage.processes[1].numbers == {"/c": 1, "/x": 5}
    stage.components.on_event({"event": "left", "process": "/c", "node": "/x"})
    assert stage.processes[1].numbers == {"/c": 1}
    assert stage.changes == [("/c", "/x", True), ("/c", "/x", False)]

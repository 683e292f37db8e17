"""ROS 2's component services, of a process that offers them."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import Context, Node
from graphflow.graph.plan import node_from_json
from graphflow.msgs.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from graphflow.msgs.rcl_interfaces.msg import Parameter, ParameterValue
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.process_nodes import Company
from graphflow.supervisor.control.container import Container
from graphflow.supervisor.control.orders import Orders
from graphflow.supervisor.processes.messages import NodeJson
from graphflow.supervisor.processes.worker import make_node
from graphflow.testing import Graph
from tests.conftest import PROJECT

pytestmark = pytest.mark.usefixtures("project_on_path")


@pytest.fixture
def project_on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(PROJECT))


class Stage:
    """A process with one node that offers the services."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.stop = StopRequest()
        context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
        company = Company(context, self.stop)
        self.told: list[Any] = []

        def make(described: NodeJson) -> Node:
            return make_node(node_from_json(described), "g.yaml")

        orders = Orders(company, "/first", make, self.told.append)
        first = Node("first")
        orders.count([first])
        Container(first, orders, "/first", str(PROJECT), self.told.append)
        self.running = asyncio.create_task(company.run([first]))

    async def load(self, plugin: str, **fields: Any) -> LoadNode.Response:
        request = LoadNode.Request(package_name="composition", plugin_name=plugin, **fields)
        return await self.graph.call(LoadNode, "/first/_container/load_node", request)

    async def unload(self, number: int) -> UnloadNode.Response:
        request = UnloadNode.Request(unique_id=number)
        return await self.graph.call(UnloadNode, "/first/_container/unload_node", request)

    async def end(self) -> None:
        self.stop.set()
        await self.running


async def test_a_node_is_loaded_listed_and_unloaded(graph: Graph) -> None:
    """With its name, namespace, remaps and parameters; the supervisor is told of both."""
    stage = Stage(graph)
    await graph.settle()
    sim = Parameter(name="rate", value=ParameterValue(type=3, double_value=5.0))
    answer = await stage.load(
        "composition::Talker", node_name="t", node_namespace="/room", remap_rules=["chatter:=b"], parameters=[sim]
    )
    assert (answer.success, answer.full_node_name, answer.unique_id) == (True, "/room/t", 2)
    listed = await graph.call(ListNodes, "/first/_container/list_nodes", ListNodes.Request())
    assert (listed.full_node_names, listed.unique_ids.tolist()) == (["/first", "/room/t"], [1, 2])
    assert stage.told[0]["event"] == "joined"
    assert stage.told[0]["node"]["params"]["rate"]["value"] == 5.0
    assert (await stage.unload(2)).success
    assert stage.told[1] == {"event": "left", "process": "/first", "node": "/room/t"}
    await stage.end()


@pytest.mark.parametrize(
    ("plugin", "fields", "told"),
    [
        ("composition::Talkr", {}, "there is no 'composition::Talkr' of the package 'composition' here"),
        ("nodes.no:Such", {}, "there is no module"),
        ("composition::Talker", {"node_name": "first"}, "there is a node /first already"),
        ("composition::Talker", {"node_name": "a b"}, "a b"),
        ("x" * 100_000, {}, "has 100000 characters; a name here has 255 at most"),
        ("composition::Talker", {"remap_rules": ["x"]}, "'x' is not a remap rule"),
        ("composition::Talker", {"remap_rules": ["chater:=b"]}, "did you mean 'chatter'?"),
        (
            "composition::Talker",
            {"parameters": [{"name": "rate", "value": {"type": 4, "string_value": "fast"}}]},
            "'fast'",
        ),
        (
            "composition::Talker",
            {"parameters": [{"name": "greeting", "value": {"type": 4, "string_value": "x" * 4000}}]},
            "too many parameters for this service",
        ),
    ],
)
async def test_what_cannot_be_loaded(graph: Graph, plugin: str, fields: dict[str, Any], told: str) -> None:
    """The one who asked is told why; nothing has changed."""
    stage = Stage(graph)
    await graph.settle()
    answer = await stage.load(plugin, **fields)
    assert not answer.success
    assert told in answer.error_message
    assert stage.told == []
    await stage.end()


@pytest.mark.parametrize(("number", "told"), [(7, "there is no node 7"), (1, "/first offers this service")])
async def test_what_cannot_be_unloaded(graph: Graph, number: int, told: str) -> None:
    """Each missing thing is named in the response."""
    stage = Stage(graph)
    await graph.settle()
    answer = await stage.unload(number)
    assert not answer.success
    assert told in answer.error_message
    await stage.end()

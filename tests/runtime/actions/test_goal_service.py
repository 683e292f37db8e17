"""The services of an action tell clients apart."""

from __future__ import annotations

from graphflow import Node
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.actions.goal_service import GoalService
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph


async def test_the_client_is_known(graph: Graph) -> None:
    """A request comes with its client's GID, with which the client's end is reported, too."""
    server, client = Node("server"), Node("client")
    asked: list[bytes] = []
    gone: list[bytes] = []

    def answer(request: AddTwoInts.Request, gid: bytes) -> AddTwoInts.Response:
        asked.append(gid)
        return AddTwoInts.Response(sum=request.a + request.b)

    core = core_of(server)
    service = core.add(GoalService(core, AddTwoInts, "/add", answer, "add", gone.append))
    adder = client.create_client(AddTwoInts, "/add")
    await graph.start(server, client)

    assert (await adder.call(AddTwoInts.Request(a=1, b=2))).sum == 3
    assert adder.entity is not None
    assert asked == [adder.entity.gid]
    assert service.is_inner
    await graph.stop(client)
    assert gone == asked

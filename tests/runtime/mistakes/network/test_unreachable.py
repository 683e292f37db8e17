"""A server that is announced, and that calls do not reach."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import ServiceUnavailable
from graphflow.msgs import registry
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.testing import Graph
from graphflow.transport.base import Session
from graphflow.wire import net
from graphflow.wire.liveliness import Entity, Kind
from tests.runtime.cast import Asker, client_of


def announce(session: Session, name: str, type_name: str, hash_: str) -> None:
    """Announce a server beyond a link: only its token passes."""
    entity = Entity(0, "far", 0, 1, Kind.SERVICE, "/", "far", name, type_name, hash_)
    session.announce(entity.token)


@pytest.mark.parametrize(
    ("allow", "told"),
    [
        (
            ["/spawn"],
            "/add does not pass the net profile /lab.yaml, which allows /spawn; if its node is on another",
        ),
        (["/add"], "/add: the server is announced but does not accept calls: .*, or the net profile of the other mach"),
        ([], "/add: the server is announced but does not accept calls: its process is starting or stopping$"),
    ],
)
async def test_who_keeps_calls_back(graph: Graph, allow: list[str], told: str) -> None:
    """The net profile of this machine or the other's, as far as is known."""
    client = await client_of(graph)
    session = client.host.context.session
    announce(session, "/add", AddTwoInts.NAME, registry.hash_of(AddTwoInts.NAME))
    if allow:
        session.announce(net.token(client.host.context.domain, "z5", "/lab.yaml", allow))
    call = asyncio.create_task(client.call(AddTwoInts.Request()))
    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable, match=told):
        await call


async def test_another_definition(graph: Graph) -> None:
    """It has the same name, and is none that a call could be sent to."""
    client = await client_of(graph)
    announce(client.host.context.session, "/add", AddTwoInts.NAME, "RIHS01_" + "0" * 64)
    call = asyncio.create_task(client.call(AddTwoInts.Request()))
    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable, match=f"/add: the server's {AddTwoInts.NAME} has a different definition"):
        await call


async def test_an_action(graph: Graph) -> None:
    """The reason is send_goal's."""
    asker = Asker()
    await graph.start(asker)
    type_name = f"{Fibonacci.NAME}_SendGoal"
    session = asker.fibonacci.host.context.session
    announce(session, "/fibonacci/_action/send_goal", type_name, registry.hash_of(type_name))
    sending = asyncio.ensure_future(asker.order(1))
    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable, match="/fibonacci/_action/send_goal: the server is announced but does not"):
        await sending

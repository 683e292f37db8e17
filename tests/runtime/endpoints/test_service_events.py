"""Service introspection."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import Client, Node, RemoteError, service
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.endpoints.services import ServiceServer
from graphflow.testing import Graph


class Adder(Node):
    """Add numbers, and publish events."""

    @service(AddTwoInts, "add", introspection="contents")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        if request.a < 0:
            raise ValueError("too small")
        return AddTwoInts.Response(sum=request.a + request.b)


class Asker(Node):
    """Call, and publish events."""

    adder = Client(AddTwoInts, "add", introspection="metadata")


def event_rows(tap: Any) -> list[Any]:
    return [
        (e.info.event_type, e.info.sequence_number, [r.a for r in e.request], [r.sum for r in e.response]) for e in tap
    ]


async def test_both_sides_of_a_call_are_told(graph: Graph) -> None:
    """Request and response, sent and received, with the client's GID and number; with contents on demand."""
    adder, asker = Adder(), Asker()
    tap = graph.tap(AddTwoInts.Event, "/add/_service_event")
    await graph.start(adder, asker)
    await asker.adder.call(AddTwoInts.Request(a=2, b=3))
    with pytest.raises(RemoteError):
        await asker.adder.call(AddTwoInts.Request(a=-1))
    await graph.settle()

    assert sorted(event_rows(tap)) == sorted(
        [
            (0, 1, [], []),
            (1, 1, [2], []),
            (2, 1, [], [5]),
            (3, 1, [], []),
            (0, 2, [], []),
            (1, 2, [-1], []),
        ]
    )
    assert asker.adder.entity is not None
    assert {bytes(e.info.client_gid) for e in tap} == {asker.adder.entity.gid}


async def test_introspection_is_off_by_default_and_can_be_switched(graph: Graph) -> None:
    """Events are announced and published only after it is switched on, and no more after it is switched off."""
    node = Node("node")
    server: ServiceServer[Any, Any] = node.create_service(AddTwoInts, "add", lambda r: AddTwoInts.Response(sum=1))
    await graph.start(node)
    tap = graph.tap(AddTwoInts.Event, "/add/_service_event")
    await graph.call(AddTwoInts, "/add", AddTwoInts.Request())
    assert not tap

    server.configure_introspection("metadata")
    await graph.settle()
    await graph.call(AddTwoInts, "/add", AddTwoInts.Request())
    assert [row[0] for row in event_rows(tap)] == [1, 2]

    server.configure_introspection("off")
    await graph.call(AddTwoInts, "/add", AddTwoInts.Request())
    assert len(tap) == 2
    with pytest.raises(ValueError, match="introspection must be off, metadata or contents, not 'on'"):
        server.configure_introspection("on")  # type: ignore[arg-type]

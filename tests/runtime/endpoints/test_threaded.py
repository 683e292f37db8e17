"""Endpoints for threads."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import Any

import pytest

from graphflow.errors import ClosedError, ServerLost
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import SERVICES, Qos
from graphflow.runtime.endpoints.service_events import ServiceEvent
from graphflow.runtime.endpoints.threaded import (
    ThreadedClient,
    ThreadedPublisher,
    ThreadedService,
    ThreadedSubscription,
)
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport.inbox import REQUESTS_BOUND, Inbox


class Ring:
    """A bell that counts rings."""

    def __init__(self) -> None:
        self.rung: deque[Inbox] = deque()
        self.pending = False

    def ring(self) -> None:
        self.pending = True


def nothing() -> None:
    """Ignore the call."""


async def until(condition: Any) -> None:
    async with asyncio.timeout(5):
        while not condition():
            await asyncio.sleep(0)


async def test_messages_pass_as_they_are_between_threads_endpoints_and_others(graph: Graph) -> None:
    """In one process by hand, and to others by the network; taken from any thread."""
    one, two, ring, heard = Node("one"), Node("two"), Ring(), list[str]()
    two.create_subscription(String, "t", lambda message: heard.append(message.data))
    await graph.start(one, two)
    core = core_of(one)
    publisher = core.add(ThreadedPublisher(core, String, "/t", Qos()))
    subscription = core.add(ThreadedSubscription(core, String, "/t", Qos(depth=2), ring, nothing))
    assert subscription.take() is None
    await publisher.wait_matched(2)
    for data in "abc":
        await asyncio.to_thread(publisher.put, String(data=data).to_bytes())
    assert ring.pending
    assert subscription.waiting == 2  # the queue is as deep as it was asked for
    taken = await asyncio.to_thread(subscription.take)
    assert taken is not None
    assert (String.from_bytes(taken.payload).data, taken.info.sequence) == ("b", 2)
    await until(lambda: heard == ["a", "b", "c"])
    subscription.close()
    assert subscription.take() is None
    publisher.close()
    with pytest.raises(ClosedError):
        publisher.put(String().to_bytes())


async def test_calls_and_answers(graph: Graph) -> None:
    """Each response has the number of its call; the loss of a server is reported."""
    one, two, ring, changes = Node("one"), Node("two"), Ring(), list[int]()
    await graph.start(one, two)
    core, other = core_of(one), core_of(two)
    changed = lambda: changes.append(1)  # noqa: E731
    client = core.add(ThreadedClient(core, AddTwoInts, "/add", Qos(), ring, nothing, changed))
    service = other.add(ThreadedService(other, AddTwoInts, "/add", Qos(), ring, nothing))
    await until(lambda: client.has_server)
    assert changes
    number = client.send(AddTwoInts.Request(a=2, b=3).to_bytes())
    asked = service.take()
    assert asked is not None
    assert (AddTwoInts.Request.from_bytes(asked.payload).b, asked.sequence) == (3, number)
    assert asked.call == client.call_id(number)
    service.answer(asked, AddTwoInts.Response(sum=5).to_bytes())
    await until(lambda: client.inbox.items)
    answered = client.take()
    assert answered is not None
    assert (answered.sequence, AddTwoInts.Response.from_bytes(answered.payload).sum) == (number, 5)
    assert (service.take(), answered.error) == (None, None)
    service.close()
    client.send(AddTwoInts.Request().to_bytes())
    await until(lambda: any(item.error is not None for item in client.inbox.items))
    [lost] = client.inbox.items  # that the first call is over was no second answer
    assert isinstance(lost.error, ServerLost)


async def test_introspection_tells_requests_and_responses(graph: Graph) -> None:
    """Of both sides, with their contents."""
    one, two, ring, events = Node("one"), Node("two"), Ring(), list[Any]()
    two.create_subscription(AddTwoInts.Event, "/add/_service_event", events.append)
    await graph.start(one, two)
    core = core_of(one)
    service = core.add(ThreadedService(core, AddTwoInts, "/add", Qos(), ring, nothing))
    client = core.add(ThreadedClient(core, AddTwoInts, "/add", Qos(), ring, nothing, nothing))
    service.configure_introspection("contents")
    await until(lambda: client.has_server)
    payload = AddTwoInts.Request(a=1, b=1).to_bytes()
    client.tell(ServiceEvent.REQUEST_SENT, client.send(payload), payload)  # nothing: it is off
    asked = service.take()
    assert asked is not None
    await until(lambda: any(e.name == "/add/_service_event" and e.matched for e in core_of(two).endpoints))
    await asyncio.to_thread(service.tell, ServiceEvent.REQUEST_RECEIVED, asked, payload)
    await until(lambda: events)
    assert events[0].request[0].a == 1
    assert events[0].info.event_type == ServiceEvent.REQUEST_RECEIVED


async def test_how_many_requests_may_wait(graph: Graph) -> None:
    """As many as for a service of the event loop."""
    node = Node("n")
    await graph.start(node)
    core = core_of(node)
    server: Any = core.add(ThreadedService(core, AddTwoInts, "/add", SERVICES, Ring(), nothing))
    assert server.inbox.depth == REQUESTS_BOUND

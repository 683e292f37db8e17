"""Nodes of this machine in other domains, where a node is alone in its own."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

from graphflow import Node, ServiceUnavailable
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.mistakes.network.other_domains import look_elsewhere
from graphflow.testing import Graph
from graphflow.wire.liveliness import Entity, Kind
from tests.runtime.cast import running_in

ALONE = "this domain, 0, has no other nodes; domain 7 has 1: "


@pytest.mark.parametrize(
    ("name", "way"),
    [("n", "if that is yours, join it with GRAPHFLOW_DOMAIN=7"), ("_graphflow_1", "graphflow --domain 7 ...")],
)
async def test_an_error_says_so(name: str, way: str, graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a service and of an action, with how a node, or a command, gets there."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "0")
    node = Node(name)
    adder, rabbits = node.create_client(AddTwoInts, "add"), node.create_action_client(Fibonacci, "fibonacci")
    await graph.start(node)
    for waiting in (adder.expect_ready(1.0), rabbits.expect_ready(1.0)):
        async with running_in(graph, 7):
            task = asyncio.create_task(waiting)
            await graph.clock.advance(1.0)
        with pytest.raises(ServiceUnavailable) as caught:
            await task
        assert str(caught.value).endswith(f"]; {ALONE}{way}")


@pytest.mark.parametrize(
    ("own", "node", "told"),
    [
        (0, "/n", "domain 5 has 1, domain 7 has 1: if that is yours, join it with GRAPHFLOW_DOMAIN=N"),
        (5, "/n", ""),
        (5, "/_graphflow_1", "domain 7 has 1: graphflow --domain 7 ..."),
        (9, "/n", ""),
    ],
)
def test_two_domains_that_were_chosen(own: int, node: str, told: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """They belong to two people, unless a command asks."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "0")
    tokens = [Entity(n, "a", 1, 1, Kind.NODE, "/", f"n{n}").token for n in (5, 7)]
    tokens = [token for token in tokens if not (own == 5 and "/5/" in token)]
    here: Any = SimpleNamespace(
        domain=own,
        cache=SimpleNamespace(nodes=lambda hidden: {}),
        session=SimpleNamespace(ask_tokens=lambda key, limit, answered: answered(tokens)),
    )
    found: list[str] = []
    look_elsewhere(here, node, found.append)
    assert found == [told and f"this domain, {own}, has no other nodes; {told}"]
    tokens.append(Entity(0, "a", 1, 1, Kind.NODE, "/", "other").token)
    if own:
        look_elsewhere(here, "/n", found.append)
        assert found[1].startswith(f"this domain, {own}, has no other nodes; domain 0 has 1: ")


async def test_an_error_where_it_is_not_alone(graph: Graph) -> None:
    """It does not mention other domains."""
    node = Node("n")
    adder = node.create_client(AddTwoInts, "add")
    await graph.start(node, Node("other"))
    async with running_in(graph, 7):
        task = asyncio.create_task(adder.expect_ready(1.0))
        await graph.clock.advance(1.0)
    with pytest.raises(ServiceUnavailable, match=r"AddTwoInts\]$"):
        await task

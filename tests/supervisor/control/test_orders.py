"""A worker carries out its orders."""

from __future__ import annotations

import asyncio
import json
from typing import Any

from graphflow import Context, GraphflowError, Node
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.process_nodes import Company
from graphflow.supervisor.control.orders import Orders
from graphflow.supervisor.processes.messages import Obeyed
from graphflow.testing import Graph
from tests.runtime.cast import Speaker
from tests.until import eventually


class Broken(Node):
    async def on_start(self) -> None:
        raise ValueError("no camera")


class Stage:
    """A company with one node, and orders for it."""

    def __init__(self, graph: Graph) -> None:
        session = graph.network.session(asyncio.get_running_loop())
        self.context = Context(session, clock=graph.clock)
        self.stop = StopRequest()
        self.company = Company(self.context, self.stop)
        self.told: list[Obeyed] = []
        self.orders = Orders(self.company, "/p", self.make, self.told.append)

    def make(self, described: dict[str, Any]) -> Node:
        if described["class"] == "unknown":
            raise GraphflowError("there is no such class")
        return Broken(described["name"]) if described["class"] == "broken" else Speaker(described["name"])

    async def obey(self, *orders: dict[str, Any]) -> list[Obeyed]:
        """Run for as long as the orders take."""
        first = Speaker("first")
        self.orders.count([first])
        running = asyncio.create_task(self.company.run([first]))
        obeying = asyncio.create_task(self.orders.run())
        for number, order in enumerate(orders, 1):
            self.orders.take(json.dumps({"order": number, **order}).encode())
        await eventually(lambda: len(self.told) >= len(orders))
        self.living = [node.full_name for node in self.company.nodes]
        self.stop.set()
        await running
        obeying.cancel()
        return self.told


def load(name: str, kind: str = "speaker") -> dict[str, Any]:
    return {"do": "load", "node": {"name": name, "class": kind}}


async def test_nodes_come_and_go(graph: Graph) -> None:
    """Each with a number that no other in the process has."""
    stage = Stage(graph)
    told = await stage.obey(load("a"), load("b"), {"do": "unload", "node": "/a"}, load("c"))
    assert [(t["order"], t["node"], t["number"], t["error"]) for t in told] == [
        (1, "/a", 2, ""),
        (2, "/b", 3, ""),
        (3, "/a", 0, ""),
        (4, "/c", 4, ""),
    ]
    assert stage.living == ["/first", "/b", "/c"]
    assert stage.orders.numbers == {"/first": 1, "/b": 3, "/c": 4}


async def test_what_goes_wrong_concerns_nobody_else(graph: Graph) -> None:
    """A class that is not there, a node that cannot start, one that was never loaded: each is told."""
    stage = Stage(graph)
    told = await stage.obey(load("a", "unknown"), load("b", "broken"), {"do": "unload", "node": "/z"}, load("c"))
    assert [t["error"] for t in told] == ["there is no such class", "no camera", "/z is not in this process", ""]
    assert stage.living == ["/first", "/c"]

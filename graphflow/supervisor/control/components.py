"""Nodes that are loaded into processes that run, and unloaded: each process of a graph is a container."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable, Collection
from dataclasses import replace
from typing import Any, NamedTuple

from graphflow.errors import SupervisorError
from graphflow.graph.plan import PlannedNode, node_from_json
from graphflow.machines.process import State
from graphflow.names import did_you_mean
from graphflow.supervisor.processes.process import Process
from graphflow.supervisor.processes.starter import Starter

LIMIT = 20.0
"""Seconds that a worker has to load or unload a node."""


class _Order(NamedTuple):
    """What a process was told to do."""

    process: Process
    node: PlannedNode | None
    """The node to load; None for one to unload."""
    answer: asyncio.Future[dict[str, Any]]


class Components:
    """The orders that a supervisor gives to its workers.

    Args:
        processes: All processes of the graph.
        changed: Called when a node has joined a process or left it: the process, the node, whether it joined.
    """

    def __init__(
        self,
        starter: Starter,
        processes: Collection[Process],
        changed: Callable[[Process, PlannedNode, bool], None],
    ) -> None:
        self._starter, self._changed = starter, changed
        self._processes = {process.name: process for process in processes}
        self._numbers = itertools.count(1)
        self._turns = {process.name: asyncio.Lock() for process in processes}
        """One order at a time is given to a process."""
        self._given: dict[int, _Order] = {}
        """Orders that have not been answered."""

    def heard(self, event: dict[str, Any]) -> None:
        """Take in an answer of a worker, or what has changed there without an order."""
        process = self._processes[event["process"]]
        if event["event"] == "joined":
            self._join(process, replace(node_from_json(event["node"]), process=process.name), event["number"])
        elif event["event"] == "left":
            self._leave(process, event["node"])
        elif (order := self._given.get(event["order"])) is not None and order.process is process:
            del self._given[event["order"]]
            if not event["error"]:  # it counts also when nobody waits any more
                if order.node is not None:
                    self._join(process, replace(order.node, name=event["node"]), event["number"])
                else:
                    self._leave(process, event["node"])
            if not order.answer.done():
                order.answer.set_result(event)

    def lost(self, process: Process) -> None:
        """A process has ended: nobody there will answer."""
        for number, order in list(self._given.items()):
            if order.process is process:
                del self._given[number]
                if not order.answer.done():
                    order.answer.set_result({"node": "", "error": "its process has ended"})

    async def load(self, container: str, node: PlannedNode) -> tuple[int, str]:
        """Load a node into a process; returns its number there, and its full name.

        Args:
            container: The word after `process:`, or a node that runs in the process.

        Raises:
            SupervisorError: There is no such process, it does not run, or the node cannot be made or started.
        """
        process = self._container(container)
        shared = replace(node, process=process.name)
        told = await self._order(process, {"do": "load", "node": shared.to_json()}, shared)
        return told["number"], told["node"]

    def _join(self, process: Process, node: PlannedNode, number: int) -> None:
        process.nodes.append(node)
        process.numbers[node.name] = number
        self._changed(process, node, True)

    def _leave(self, process: Process, name: str) -> None:
        (left,) = [node for node in process.nodes if node.name == name]
        process.nodes.remove(left)
        del process.numbers[name]
        self._changed(process, left, False)

    async def unload(self, container: str, number: int) -> str:
        """Unload a node from a process; returns its full name.

        Raises:
            SupervisorError: There is no such node there, or it is the last one.
        """
        process = self._container(container)
        name = next((name for name, known in process.numbers.items() if known == number), None)
        if name is None:
            there = ", ".join(f"{number} {name}" for name, number in process.numbers.items())
            raise SupervisorError(f"{container} has no component {number}; there is {there}")
        if len(process.nodes) == 1:
            raise SupervisorError(f"{name} is all that {container} has; to end it: graphflow stop {name}")
        await self._order(process, {"do": "unload", "node": name}, None)
        return name

    def _container(self, container: str) -> Process:
        found = self._processes.get(container)
        names = {node.name: process for process in self._processes.values() for node in process.nodes}
        process = found or self._processes.get(f"/{container}") or names.get(f"/{container.lstrip('/')}")
        if process is None:
            near = did_you_mean(container, [*self._processes, *names])
            raise SupervisorError(f"the graph has no process {container!r}{near}")
        if process.is_program:
            raise SupervisorError(f"{container} is a foreign program, into which no node can be loaded")
        return process

    def _refuse(self, process: Process, node: PlannedNode | None) -> None:
        """Refuse an order that cannot be carried out by now."""
        if process.state is not State.READY:
            raise SupervisorError(f"{process.name} is not running: {process.word}")
        coming = [order.node for order in self._given.values() if order.node is not None]
        there = [known for other in self._processes.values() for known in other.nodes]
        if node is not None and any(known.name == node.name for known in (*there, *coming)):
            raise SupervisorError(f"the graph has a node {node.name} already; give this one another name with -n NAME")

    async def _order(self, process: Process, order: dict[str, Any], node: PlannedNode | None) -> dict[str, Any]:
        number = next(self._numbers)
        try:
            async with asyncio.timeout(LIMIT), self._turns[process.name]:
                self._refuse(process, node)
                given = self._given[number] = _Order(process, node, asyncio.get_running_loop().create_future())
                self._starter.tell(process.name, {**order, "order": number})
                told = await given.answer
        except TimeoutError:
            raise SupervisorError(f"{process.name} did not answer within {LIMIT:.0f} s", exit_code=4) from None
        if told["error"]:
            raise SupervisorError(str(told["error"]))
        return told

"""Loading nodes into running processes, and unloading them: each process of a graph is a container."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable, Collection
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from graphflow.errors import SupervisorError
from graphflow.graph.plan import PlannedNode, node_from_json
from graphflow.machines.process import State
from graphflow.names import did_you_mean
from graphflow.supervisor.processes.process import Process
from graphflow.supervisor.processes.starter import Starter

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import ComponentEvent, Obeyed, Order

LIMIT = 20.0
"""Seconds that a worker has to load or unload a node."""


class _Pending(NamedTuple):
    """An order without an answer yet."""

    process: Process
    node: PlannedNode | None
    """The node to load; None for an order to unload."""
    answer: asyncio.Future[Obeyed]


class Components:
    """The orders of a supervisor to its workers.

    Args:
        processes: All processes of the graph.
        changed: Called with a process, a node, and whether the node has joined or left the process.
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
        """Locks, for a process gets one order at a time: its pipe has room for one."""
        self._pending: dict[int, _Pending] = {}

    def on_event(self, event: ComponentEvent) -> None:
        """Take in an answer of a worker, or a change there that was not ordered."""
        process = self._processes[event["process"]]
        if event["event"] == "joined":
            self._join(process, replace(node_from_json(event["node"]), process=process.name), event["number"])
        elif event["event"] == "left":
            self._leave(process, event["node"])
        elif (order := self._pending.get(event["order"])) is not None and order.process is process:
            del self._pending[event["order"]]
            if not event["error"]:  # the node is there even if the request has timed out
                if order.node is not None:
                    self._join(process, replace(order.node, name=event["node"]), event["number"])
                else:
                    self._leave(process, event["node"])
            if not order.answer.done():
                order.answer.set_result(event)

    def lost(self, process: Process) -> None:
        """Fail the order of a process that has ended."""
        for number, order in list(self._pending.items()):
            if order.process is process:
                del self._pending[number]
                if not order.answer.done():
                    order.answer.set_exception(SupervisorError("its process has ended"))

    async def load(self, container: str, node: PlannedNode) -> tuple[int, str]:
        """Load a node into a process; returns its number there and its full name.

        Args:
            container: The name after `process:`, or that of a node in the process.

        Raises:
            SupervisorError: There is no such process, it does not run, or the node cannot be made or started.
        """
        process = self._container(container)
        shared = replace(node, process=process.name)
        number = next(self._numbers)
        answer = await self._order(process, {"do": "load", "order": number, "node": shared.to_json()}, shared)
        return answer["number"], answer["node"]

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
            raise SupervisorError(f"{name} is the last node of {container}; to stop it: graphflow stop {name}")
        await self._order(process, {"do": "unload", "order": next(self._numbers), "node": name}, None)
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
        """Raise if an order cannot be carried out now."""
        if process.state is not State.READY:
            raise SupervisorError(f"{process.name} is not running: {process.state_name}")
        coming = [order.node for order in self._pending.values() if order.node is not None]
        there = [known for other in self._processes.values() for known in other.nodes]
        if node is not None and any(known.name == node.name for known in (*there, *coming)):
            raise SupervisorError(f"the graph has a node {node.name} already; give this one another name with -n NAME")

    async def _order(self, process: Process, order: Order, node: PlannedNode | None) -> Obeyed:
        try:
            async with asyncio.timeout(LIMIT), self._turns[process.name]:
                # Only now: while the order waited for its turn, the process may have ended, or the name been taken.
                self._refuse(process, node)
                answer: asyncio.Future[Obeyed] = asyncio.get_running_loop().create_future()
                self._pending[order["order"]] = _Pending(process, node, answer)
                self._starter.send_order(process.name, order)
                obeyed = await answer
        except TimeoutError:
            raise SupervisorError(f"{process.name} did not answer within {LIMIT:.0f} s", exit_code=4) from None
        if obeyed["error"]:
            raise SupervisorError(obeyed["error"])
        return obeyed

"""Orders: requests to a running worker to load a node into its process, or to unload one.

    {"order": 7, "do": "load", "node": {...}}     -> {"event": "obeyed", "order": 7, "node": name, "number": n}
    {"order": 8, "do": "unload", "node": name}       the same, or with "error": the reason

Orders are carried out one at a time, in the order of their arrival.
"""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from graphflow.errors import GraphflowError
from graphflow.runtime.node import Node
from graphflow.runtime.process_nodes import Company

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import NodeJson, Obeyed, Order

logger = logging.getLogger("graphflow.supervisor")


class Orders:
    """The orders to one worker.

    Args:
        process: The worker's process.
        make: Creates a node from its description.
        report: Sends the answer to the supervisor.
    """

    def __init__(
        self, company: Company, process: str, make: Callable[[NodeJson], Node], report: Callable[[Obeyed], object]
    ) -> None:
        self._company, self._process, self._make, self._report = company, process, make, report
        self.numbers: dict[str, int] = {}
        """The numbers by which the nodes of the process are unloaded, by full name."""
        self._waiting: asyncio.Queue[Order] = asyncio.Queue()

    def count(self, nodes: Sequence[Node]) -> None:
        """Number the first nodes of the process."""
        self.numbers = {node.full_name: number for number, node in enumerate(nodes, 1)}

    def take(self, line: bytes) -> None:
        """Queue an order."""
        self._waiting.put_nowait(json.loads(line))

    async def run(self) -> None:
        """Carry out orders as they come."""
        while True:
            order = await self._waiting.get()
            self._report(await self._obey(order))

    async def _obey(self, order: Order) -> Obeyed:
        answer: Obeyed = {
            "event": "obeyed",
            "process": self._process,
            "order": order["order"],
            "node": "",
            "number": 0,
            "error": "",
        }
        try:
            if order["do"] == "load":
                answer["number"], node = await self.load(order["node"])
            else:
                node = await self.unload(order["node"])
        except Exception as error:  # user code may raise anything: the answer carries it, and the other nodes go on
            logger.warning("%s: %s", order["do"], error, exc_info=not isinstance(error, GraphflowError))
            answer["error"] = f"{error}" or type(error).__name__
        else:
            answer["node"] = node.full_name
        return answer

    async def load(self, described: NodeJson) -> tuple[int, Node]:
        """Create and start a node in this process; returns its number and the node. Passes on any error of these."""
        node = self._make(described)
        await self._company.join(node)
        number = self.numbers[node.full_name] = 1 + max(self.numbers.values(), default=0)
        return number, node

    async def unload(self, name: str) -> Node:
        """Stop a node of this process.

        Raises:
            GraphflowError: The process has no such node.
        """
        for node in self._company.nodes:
            if node.full_name == name:
                del self.numbers[name]
                await self._company.leave(node)
                return node
        raise GraphflowError(f"{name} is not in this process")

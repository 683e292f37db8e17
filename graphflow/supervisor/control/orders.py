"""What a running worker is told to do: load a node into its process, or unload one.

    {"order": 7, "do": "load", "node": {...}}     -> {"event": "obeyed", "order": 7, "node": name, "number": n}
    {"order": 8, "do": "unload", "node": name}       the same, or with "error": why not

One order is carried out at a time, in the order of their coming.
"""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable, Sequence
from typing import Any

from graphflow.errors import GraphflowError
from graphflow.runtime.node import Node
from graphflow.runtime.process_nodes import Company

logger = logging.getLogger("graphflow.supervisor")


class Orders:
    """Carries out the orders of one worker.

    Args:
        make: Makes a node of what an order describes.
        tell: Tells the supervisor an event.
    """

    def __init__(self, company: Company, make: Callable[[dict[str, Any]], Node], tell: Callable[..., None]) -> None:
        self._company, self._make, self._tell = company, make, tell
        self.numbers: dict[str, int] = {}
        """The numbers by which the nodes of the process are unloaded, by full name."""
        self._waiting: asyncio.Queue[dict[str, Any]] = asyncio.Queue()

    def count(self, nodes: Sequence[Node]) -> None:
        """Give the first nodes of the process their numbers."""
        self.numbers = {node.full_name: number for number, node in enumerate(nodes, 1)}

    def take(self, line: bytes) -> None:
        """Take in an order."""
        self._waiting.put_nowait(json.loads(line))

    async def run(self) -> None:
        """Carry out orders as they come."""
        while True:
            order = await self._waiting.get()
            told = {"event": "obeyed", "order": order["order"]}
            try:
                if order["do"] == "load":
                    number, node = await self.load(order["node"])
                else:
                    number, node = 0, await self.unload(order["node"])
            except Exception as error:  # the one who asked is told; the other nodes go on
                logger.warning("%s: %s", order["do"], error, exc_info=not isinstance(error, GraphflowError))
                self._tell(**told, node="", number=0, error=f"{error}" or type(error).__name__)
            else:
                self._tell(**told, node=node.full_name, number=number, error="")

    async def load(self, described: dict[str, Any]) -> tuple[int, Node]:
        """Start a node in this process; returns its number, too. Raises what making or starting it raises."""
        node = self._make(described)
        await self._company.join(node)
        number = self.numbers[node.full_name] = 1 + max(self.numbers.values(), default=0)
        return number, node

    async def unload(self, name: str) -> Node:
        """Stop a node of this process.

        Raises:
            GraphflowError: It has no such node.
        """
        for node in self._company.nodes:
            if node.full_name == name:
                del self.numbers[name]
                await self._company.leave(node)
                return node
        raise GraphflowError(f"{name} is not in this process")

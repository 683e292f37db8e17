"""The nodes of one process: started beside each other, joined and left by others, and ended together."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from graphflow.runtime.context import Context
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.mistakes.errors.lost_errors import tell_lost_errors
from graphflow.runtime.mistakes.other_threads import tell_strangers
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of


class Company:
    """Nodes that run in one context until they are asked to stop, one fails, or all have ended themselves.

    Args:
        stop: Set when they are asked to stop.
        ready: Called with each of the first nodes once it has started.
    """

    def __init__(self, context: Context, stop: StopRequest, ready: Callable[[Node], None] | None = None) -> None:
        self._context, self._stop, self._ready = context, stop, ready
        self.nodes: list[Node] = []
        """The nodes, in the order in which they came; those that have ended themselves go with the others."""
        self._ends: dict[Node, asyncio.Task[None]] = {}
        """The nodes that run, and the task in which each end is waited for."""
        self._changed = asyncio.Event()
        """Set when a node has joined or left."""
        stop.when_set = self._begin_to_stop

    async def run(self, nodes: Sequence[Node]) -> None:
        """Run nodes, and those that join, to their end. The caller then closes the context.

        Raises:
            Exception: What ended a node.
        """
        self.nodes += nodes
        tell_lost_errors(self._context.loop)
        tell_strangers(self._context.loop)
        asked = asyncio.create_task(self._stop.wait())
        try:
            try:
                if await self._start(nodes, asked):
                    await self._see_through(asked)
            finally:
                asked.cancel()
                for end in self._ends.values():
                    end.cancel()
        finally:
            self._context.session.leave()
            for node in reversed(self.nodes):
                await core_of(node).stop()

    def _begin_to_stop(self) -> None:
        """Let the node that is stopped first begin nothing more; the others go on until it has ended."""
        running = [node for node in self.nodes if node in self._ends] or self.nodes
        for node in running[-1:]:
            for runner in core_of(node).begin_to_stop():
                if runner is not None:
                    runner.cancel()

    async def _see_through(self, asked: asyncio.Task[bool]) -> None:
        while self._ends and not asked.done():
            self._changed.clear()
            changed = asyncio.create_task(self._changed.wait())
            await asyncio.wait({asked, changed, *self._ends.values()}, return_when=asyncio.FIRST_COMPLETED)
            changed.cancel()
            for node, end in list(self._ends.items()):
                if end.done():
                    del self._ends[node]
                    end.result()

    async def _start(self, nodes: Sequence[Node], asked: asyncio.Task[bool]) -> bool:
        """Start the first nodes beside each other: one may wait for another's.

        Returns:
            Whether all are ready: False when they are asked to stop before.

        Raises:
            Exception: One could not start; the others are cancelled then.
        """
        starting = {asyncio.create_task(core_of(node).start(self._context)): node for node in nodes}
        left: set[asyncio.Task[Any]] = {asked, *starting}
        try:
            while asked in left and len(left) > 1:
                done, left = await asyncio.wait(left, return_when=asyncio.FIRST_COMPLETED)
                for task, node in starting.items():
                    if task in done and task.result() is None and self._ready is not None:
                        self._ready(node)
        finally:
            for task in starting:
                task.cancel()  # has no effect on one that is done
            await asyncio.gather(*starting, return_exceptions=True)
        for task, node in starting.items():
            if not task.cancelled():
                task.result()
                self._watch(node)
        return asked in left

    def _watch(self, node: Node) -> None:
        self._ends[node] = asyncio.create_task(core_of(node).wait_ended())
        self._changed.set()

    async def join(self, node: Node) -> None:
        """Start another node. Raises what its start raises; the others are not concerned."""
        await core_of(node).start(self._context)
        self.nodes.append(node)
        self._watch(node)

    async def leave(self, node: Node) -> None:
        """Stop one node; the others go on."""
        self.nodes.remove(node)
        if node in self._ends:
            self._ends.pop(node).cancel()
            self._changed.set()
        await core_of(node).stop()

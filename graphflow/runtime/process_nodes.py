"""The nodes of one process: started concurrently, joined and left by others, and ended together."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence

from graphflow.runtime.context import Context
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.mistakes.errors.kept_errors import report_kept_errors
from graphflow.runtime.mistakes.errors.lost_errors import log_lost_errors
from graphflow.runtime.mistakes.other_threads import report_foreign_calls
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of


class Company:
    """The nodes of one context, until a stop is requested, one fails, or all have ended.

    Args:
        stop: Set when the nodes must stop.
        ready: Called with each of the first nodes once it has started.
    """

    def __init__(self, context: Context, stop: StopRequest, ready: Callable[[Node], None] | None = None) -> None:
        self._context, self._stop, self._ready = context, stop, ready
        self.nodes: list[Node] = []
        """The nodes in order of arrival, including those that have ended themselves."""
        self._ends: dict[Node, asyncio.Task[None]] = {}
        """The running nodes, each with the task that waits for its end."""
        self._changed = asyncio.Event()
        """Set when a node joins or leaves."""
        stop.when_set = self._begin_to_stop

    async def run(self, nodes: Sequence[Node]) -> None:
        """Run the nodes, and those that join, until they end. The caller then closes the context.

        Raises:
            Exception: The error that ended a node.
        """
        self.nodes += nodes
        log_lost_errors(self._context.loop)
        report_kept_errors(self._context)
        report_foreign_calls(self._context.loop)
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
                self._stop.node_stopped()

    def _begin_to_stop(self) -> None:
        """Quiesce the node that stops first; the others keep running until it has ended."""
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
        """Start the first nodes concurrently: one may wait for another's services.

        Returns:
            Whether all have started; False if a stop was requested before.

        Raises:
            Exception: A node failed to start; the others are cancelled.
        """
        starting = {asyncio.create_task(core_of(node).start(self._context)): node for node in nodes}
        left: set[asyncio.Task[object]] = {asked, *starting}
        try:
            while asked in left and len(left) > 1:
                done, left = await asyncio.wait(left, return_when=asyncio.FIRST_COMPLETED)
                for task, node in starting.items():
                    if task in done and task.result() is None and self._ready is not None:
                        self._ready(node)
        finally:
            for task in starting:
                task.cancel()  # no effect on a task that is done
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
        """Start another node. Its errors are raised here and do not affect the other nodes."""
        await core_of(node).start(self._context)
        self.nodes.append(node)
        self._watch(node)

    async def leave(self, node: Node) -> None:
        """Stop one node; the others keep running."""
        self.nodes.remove(node)
        if node in self._ends:
            self._ends.pop(node).cancel()
            self._changed.set()
        await core_of(node).stop()

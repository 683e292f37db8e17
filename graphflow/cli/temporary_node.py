"""A hidden node for one command, which runs until its work is done or Ctrl-C."""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from graphflow.cli import output
from graphflow.runtime.context import Context
from graphflow.runtime.ending import StopRequest, catch_signals
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.transport.event_loop import loop


def run_with_node(
    work: Callable[[Node], Awaitable[int]],
    name: str | None = None,
    *,
    has_services: bool = False,
    parameters: Mapping[str, Any] | None = None,
) -> int:
    """Run `work` with a started hidden node; Ctrl-C ends it with code 0.

    Args:
        name: The node's name; the node is not hidden then.
        parameters: Values of its parameters, by name.
        has_services: Whether it has the standard services of a node, such as those for parameters and definitions.
    """
    return loop.run(_run(work, name or f"_graphflow_{os.getpid()}", has_services, parameters or {}))


class _Talk(logging.Handler):
    """Print warnings of graphflow's loggers as messages of the command."""

    def emit(self, record: logging.LogRecord) -> None:
        output.talk(self.format(record))


async def _run(
    work: Callable[[Node], Awaitable[int]], name: str, has_services: bool, parameters: Mapping[str, Any]
) -> int:
    stop = StopRequest()
    catch_signals(stop)
    context = await Context.open()
    context.unmatched.close()  # verbs report unmatched endpoints themselves
    context.search.watchdog.close()  # a late import may block the loop for a second, which delays no node of the user's
    talk = _Talk(logging.WARNING)
    logging.getLogger("graphflow").addHandler(talk)
    node: Node | None = None
    try:
        node = Node(name, start_parameter_services=has_services, enable_rosout=False, **parameters)
        await core_of(node).start(context)
        task = asyncio.ensure_future(work(node))
        stop.when_set = task.cancel
        if stop.is_set():
            task.cancel()
        await asyncio.wait([task])
        # Cancelled work may still return an exit code: `action send_goal` first cancels its goal.
        return 0 if task.cancelled() else task.result()
    finally:
        if node is not None:
            await core_of(node).stop()
        await context.close()
        logging.getLogger("graphflow").removeHandler(talk)

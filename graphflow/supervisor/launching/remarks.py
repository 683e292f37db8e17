"""Remarks for the clients of a graph that is coming up: on its files, and on the network."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graphflow.graph.checks.check import Interfaces
    from graphflow.graph.plan import Plan
    from graphflow.supervisor.supervisor import Supervisor


async def examine(supervisor: Supervisor, plan: Plan, interfaces: Interfaces) -> None:
    """Report oddities of the graph's files and, once it is up, the deadlocks that its source shows."""
    from graphflow.analysis.deadlock_check import findings, warnings
    from graphflow.graph.checks.loose_ends import loose_ends

    try:
        for remark in (*plan.remarks, *map(str, loose_ends(plan, interfaces))):
            supervisor.note(remark)  # at once: it may be the reason why the graph does not come up
        await supervisor.up.wait()
        ways = await asyncio.to_thread(findings, plan, interfaces) if plan.deadlock != "off" else []
        for text in warnings(ways, plan.file):
            supervisor.note(text)
    except Exception as error:  # a defect of the examination must not keep a graph from running
        logging.getLogger("graphflow.supervisor").error("the graph was not examined: %s", error, exc_info=error)
    finally:
        supervisor.clients.broadcast({"event": "checked"})  # `up -d` waits for it


def forward_network_logs(note: Callable[[str], None]) -> None:
    """Pass what the supervisor's process logs about the network on to the graph's clients."""

    class Forwarder(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            note(record.getMessage())

    for name in ("graphflow.link", "graphflow.rendezvous"):
        logging.getLogger(name).addHandler(Forwarder(logging.INFO))

"""Calls that got no answer in time: where their server is, as its process says."""

from __future__ import annotations

import asyncio
import json

from graphflow.deadlock.protocols import ProcessContext
from graphflow.deadlock.snapshot import Snapshot
from graphflow.errors import printable
from graphflow.machines.waits.explain import title
from graphflow.machines.waits.wait_graph import ActivityView, SetBy, WaitGraph, parts_of
from graphflow.machines.waits.wait_graph_json import from_json
from graphflow.wire.process import WAITS, answer_key

LIMIT = 0.2
"""Seconds for the server's process to say where it is; its error waits as long."""


async def where_served(process: ProcessContext, snapshot: Snapshot, call: str, server: str) -> str:
    """Return a sentence on the run that a call waits for; "" if the server's process does not know it.

    Args:
        snapshot: The maker of this process's snapshots.
        call: The id of the call, as in snapshots.
        server: The Zenoh id of the server's process.
    """
    if server == process.session.zid:
        return _described(snapshot.take(), call)
    answered: asyncio.Future[bytes] = process.loop.create_future()

    def receive(replies: list[bytes], _: bool) -> None:
        if not answered.done():
            answered.set_result(replies[0] if replies else b"{}")

    process.session.ask_reports(answer_key(process.domain, WAITS, server), LIMIT, receive)
    try:
        return _described(from_json(json.loads(await answered)), call)
    except (ValueError, KeyError, TypeError, RecursionError):  # no snapshot that can be read
        return ""


def _described(graph: WaitGraph, call: str) -> str:
    activities = [a for a in graph.activities.values() if a.place.file]
    for activity in activities:
        if activity.serves == call:
            return printable(f"{title(activity)} {_where(activity)}")
    for queue in graph.queues.values():
        before = [a for a in activities if not set(queue.needs).isdisjoint(a.holds)]
        if call in queue.calls and before:
            return printable(
                f"{queue.label} of {queue.node} begins after {title(before[0])}, which {_where(before[0])}"
            )
    return ""


def _where(activity: ActivityView) -> str:
    what = next((f" for {part.what}" for part in parts_of(activity.wait) if isinstance(part, SetBy)), "")
    since = f", for {activity.age:.0f} s so far" if activity.age >= 1.0 else ""
    return f"waits{what} in {activity.line}{since}"

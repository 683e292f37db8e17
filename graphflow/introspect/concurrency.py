"""Slots and waits in all processes of a domain, for `graphflow waits`, `groups` and `doctor`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypedDict

from graphflow.errors import CallTimeout, RemoteError
from graphflow.introspect.graph_view import View
from graphflow.machines.waits.explain import group_of, offer, title
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, explained
from graphflow.machines.waits.transform_waits import resolved
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    Join,
    Opening,
    SetBy,
    Slot,
    TransformWait,
    WaitGraph,
    joined,
)
from graphflow.machines.waits.wait_graph_json import from_json
from graphflow.wire.process import GROUPS, answer_key

HandlerRow = TypedDict(
    "HandlerRow",
    {
        "handler": str,
        "kind": str,
        "async": bool,
        "running": int,
        "waiting": int,
        "runs": int | None,
        "errors": int,
    },
)
"""A handler with its counters, as `deadlock.inspection` describes it."""


class GroupRow(TypedDict):
    """A group with its handlers, as `deadlock.inspection` describes it; without a name, the handlers in none."""

    name: str
    limit: int | None
    when_full: str
    thread: bool
    handlers: list[HandlerRow]


class Regrouping(TypedDict):
    """The groups of a node after a change, and the lines that make it permanent."""

    groups: list[GroupRow]
    where: str
    yaml: list[str]


class ActivityRow(TypedDict):
    """An activity that holds a slot or waits, for `graphflow waits`."""

    activity: str
    holds: str
    waits_for: str
    since: float
    """Seconds that it has waited or run."""
    left: float | None
    """Seconds until its wait times out; None if it does not."""
    place: str
    stuck: bool


class QueueRow(TypedDict):
    """A handler whose work is queued, for `graphflow waits`."""

    handler: str
    group: str
    held_by: list[str]
    waiting: int
    dropped: int


@dataclass
class ConcurrencyReport:
    """The combined answers of all processes."""

    graph: WaitGraph
    reports: list[str]
    """Explanations of current deadlocks."""
    nodes: dict[str, list[GroupRow]]
    """Groups by node, as `deadlock.inspection` describes them."""
    unreadable: int = 0
    processes: set[str] = field(default_factory=set)
    """Sessions that have answered."""
    stalls: list[str] = field(default_factory=list)
    """Explanations of groups that are occupied for long while others wait."""
    blocked: list[tuple[str, float]] = field(default_factory=list)
    """Nodes whose event loop is blocked now, and for at least how many seconds."""
    late: list[tuple[str, int, float]] = field(default_factory=list)
    """Nodes whose event loop was late: how often, and by at most how many seconds."""


def read(replies: list[bytes]) -> ConcurrencyReport:
    """Combine the answers; unreadable ones are counted."""
    graphs, found = [], ConcurrencyReport(WaitGraph(), [], {})
    for reply in replies:
        try:
            data = json.loads(reply)
            graphs.append(from_json(data))
            found.processes.add(str(data["process"]))
            found.stalls += [str(text) for text in data["stalls"]]
            found.reports += [str(text) for text in data["reports"]]
            found.nodes |= dict(data["nodes"])
            who = " and ".join(sorted(data["nodes"]))
            if data["blocked_for"]:
                found.blocked.append((who, float(data["blocked_for"])))
            if data["late"]:
                found.late.append((who, int(data["late"]), float(data["longest"])))
        except (ValueError, KeyError, TypeError, RecursionError):
            found.unreadable += 1
    found.graph = joined(graphs)
    return found


def unresponsive(waits: ConcurrencyReport, view: View) -> list[str]:
    """Describe processes with nodes that have not answered, with a possible reason."""
    found = []
    for zid, process in view.processes().items():
        nodes = sorted({e.node_name for e in view.cache if e.zid == zid} & set(view.cache.nodes(hidden=False)))
        if nodes and zid not in waits.processes:
            found.append(f"NODE UNRESPONSIVE: {' and '.join(nodes)} ({process}) did not answer: {process.why_silent}")
    return sorted(found)


def change_groups(view: View, node: str, requests: Sequence[Mapping[str, object]], timeout: float) -> Regrouping:
    """Change the groups of a node; return its new groups, and the lines of a graph file for them.

    Args:
        requests: See `deadlock.inspection`; at least one.
        timeout: Seconds for each.

    Raises:
        CallTimeout: The node does not answer.
        RemoteError: The node refuses a change.
    """
    zid = view.cache.owners(node)[0].zid
    for request in requests:
        try:
            answer = view.ask(answer_key(view.domain, GROUPS, zid), json.dumps(request).encode(), timeout)
        except TimeoutError:
            text = f"{node} did not answer within {timeout:g} s; its event loop may be blocked: see graphflow waits"
            raise CallTimeout(text) from None
        if answer.is_error:
            raise RemoteError.from_payload(answer.payload, node)
    regrouping: Regrouping = json.loads(answer.payload)
    return regrouping


def stuck(waits: ConcurrencyReport) -> set[str]:
    """Return the activities that seem deadlocked in this snapshot; a deadlock is only certain in a second one."""
    return {i for d in deadlocks(waits.graph) for i in (*d.ring, *d.victims)}


def rows(waits: ConcurrencyReport) -> list[ActivityRow]:
    """Describe every activity that holds a slot or waits, the longest first."""
    graph, dead = waits.graph, stuck(waits)
    found: list[ActivityRow] = []
    for a in sorted(graph.activities.values(), key=lambda a: -a.age):
        group = group_of(a, graph)
        if a.wait is FREE and not group:
            continue
        found.append(
            {
                "activity": title(a),
                "holds": group,
                "waits_for": describe(a.wait, graph),
                "since": round(a.age, 3),
                "left": None if a.left is None else round(a.left, 3),
                "place": f"{a.place} in {a.function}" if a.place.file else "",
                "stuck": a.id in dead,
            }
        )
    return found


def queued(waits: ConcurrencyReport) -> list[QueueRow]:
    """Describe the handlers whose work is queued for a slot."""
    found: list[QueueRow] = []
    for queue in waits.graph.queues.values():
        if queue.waiting:
            groups = [waits.graph.groups[name] for name in queue.needs if name in waits.graph.groups]
            holders = [title(a) for a in waits.graph.activities.values() if set(a.holds) & set(queue.needs)]
            name = f"{queue.label} of {queue.node}"
            found.append(
                {
                    "handler": name,
                    "group": next((g.name for g in groups if g.name), ""),
                    "held_by": holders,
                    "waiting": queue.waiting,
                    "dropped": queue.dropped,
                }
            )
    return found


def deadlocks(graph: WaitGraph) -> list[Deadlock]:
    """Return the deadlocks that a snapshot of all processes shows."""
    graph = resolved(graph)
    return explained(graph, deadlocked(graph))


def describe(condition: Condition, graph: WaitGraph) -> str:
    """Describe the condition for which an activity waits."""
    match condition:
        case Call(id=call, name=name):
            server = next((a for a in graph.activities.values() if a.serves == call), None)
            awaited = (
                f"the {'goal' if call.startswith('goal:') else 'response'} of {name}" if name else "the end of a goal"
            )
            return f"{awaited} (which {title(server)} is handling)" if server is not None else awaited
        case Slot(group=group):
            return f"a slot of group {graph.groups[group].name!r}" if group in graph.groups else "a slot"
        case Opening(service=service):
            return f"{offer(service)} to open"
        case Join(activity=activity):
            other: ActivityView | None = graph.activities.get(activity)
            return title(other) if other is not None else "another task"
        case SetBy(what=what) | TransformWait(what=what):
            return what
        case All(of=conditions):
            return " and ".join(describe(c, graph) for c in conditions)
        case AnyOf(of=conditions):
            return " or ".join(describe(c, graph) for c in conditions)
        case _:
            return ""

"""Reports of deadlocks and stalls: what each member holds, what it waits for and where, and the remedies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from graphflow.machines.waits.group_moves import queues_of
from graphflow.machines.waits.remedies import own_group, remedies, remedies_of
from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import (
    ActivityView,
    AnyOf,
    Call,
    Free,
    GroupView,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
)
from graphflow.machines.waits.wrapping import filled


def explanation(deadlock: Deadlock, graph: WaitGraph) -> str:
    """Return the report of a deadlock, in lines of up to 100 columns where its names allow it."""
    lines = [*filled("", _headline(deadlock, graph)), *_ring(deadlock, graph), *_victims(deadlock, graph)]
    return "\n".join([*lines, *_any_of(remedies(deadlock, graph))])


def hopeless(
    service: str,
    queue: QueueView,
    holders: list[ActivityView],
    graph: WaitGraph,
    between: Sequence[ActivityView] = (),
    others: int = 0,
) -> str:
    """Return the report of a call that can never be answered: every slot it needs is held by an activity awaiting it.

    Args:
        service: The full name of the service.
        queue: The queue at the server.
        holders: The activities that hold the slots.
        between: The runs in this process that lie on the chain of calls from a holder to this call.
        others: Number of such runs in other processes.
    """
    [group] = [graph.groups[name] for name in queue.needs if graph.groups[name].name] or [graph.groups[queue.needs[0]]]
    if not holders:  # they ended between the test and the snapshot
        return (
            f"DEADLOCK: {queue.label} of {queue.node} waits for {_slot(group)}, whose holders wait for this very call"
        )
    count = len(holders)
    who = f"{title(holders[0])} waits for itself" if count == 1 else f"{count} callbacks wait for themselves"
    lines = [f"DEADLOCK: {who}"]
    edge = Edge(holders[0].id, Call("", service), queue.id, group.id)
    for holder in holders:
        lines += _member(holder, edge, graph)
        is_direct = isinstance(holder.wait, Call) and holder.wait.name in ("", service)
        way_to_it = between if holder is holders[-1] else ()
        for server in way_to_it:
            lines += [f"    -> which {title(server)} must give", *_member(server, Edge("", server.wait), graph)]
        after = f", after {others} more callback{'s' * (others > 1)}" * bool(others)
        way = "" if is_direct or (way_to_it and not others) else f"which calls {service} in the end{after}, and "
        lines += filled("    -> ", [f"{way}{queue.label} of {queue.node}", *_needs(group, [holder], "waits for")])
    return "\n".join([*lines, *_any_of(remedies_of(holders[0], edge, graph))])


def again(head: str, times: int) -> str:
    """Return the headline for a deadlock whose full report has been logged before."""
    return head.replace("DEADLOCK:", f"DEADLOCK again ({times} times so far):", 1)


def stall(
    group: GroupView,
    holders: list[ActivityView],
    waiting: list[QueueView],
    dropped: dict[str, int],
    seconds: float,
    graph: WaitGraph,
) -> str:
    """Return the report of a group that the same runs hold for long.

    Args:
        dropped: By queue: the number of items it had dropped when the stall began.
    """
    who = " and ".join(title(a) + (f" ({a.line} in {a.function})" if a.place.file else "") for a in holders)
    slots = f"have held all {len(holders)} slots of group '{group.name}' of {group.node}"
    kept = slots if len(holders) > 1 else f"has held {_slot(group)}"
    lines = filled("", [f"STALL: {who}", f"{kept} for more than {seconds:.1f} s"])
    for queue in waiting:
        lost = queue.dropped - dropped.get(queue.id, 0)
        lines.append(f"  {queue.label} of {queue.node} waits for it: {queue.waiting} queued, {lost} dropped meanwhile")
    held = {a.handler for a in holders}
    others = [queue for queue in waiting if queue.handler not in held]
    if not others:
        return "\n".join(lines)
    return "\n".join([*lines, "If that is too long:", *own_group(others[:1], graph)])


def is_in_vain(deadlock: Deadlock, graph: WaitGraph) -> bool:
    """Whether the only end of a deadlock is the deadline of one of its own waits."""
    ways = zip(deadlock.ring, deadlock.edges, strict=True)
    bounded = [edge.via for name, edge in ways if graph.activities[name].left is not None]
    return any(isinstance(via, SetBy) and via.gives_up for via in bounded)


def title(activity: ActivityView) -> str:
    """Return the name of an activity in reports: `timer tick of /arm`."""
    return f"{activity.label} of {activity.node}"


def group_of(activity: ActivityView, graph: WaitGraph) -> str:
    """Return the name of the group whose slot an activity holds; empty for none."""
    return next((graph.groups[g].name for g in activity.holds if g in graph.groups and graph.groups[g].name), "")


def wanted(edge: Edge, graph: WaitGraph) -> str:
    """Return the noun phrase for what an activity waits for."""
    match edge.via:
        case Call(id=call) if call.startswith("tick:"):
            return "the next tick of its rate"
        case Call(name=name) if "/_action/" in name:
            return f"the response of {offer(name)}"
        case Call(id=call, name=name):
            return f"the {'result of action' if call.startswith('goal:') else 'response of service'} {name}"
        case Opening(service=service):
            return offer(service)
        case Slot():
            is_thread = edge.group in graph.groups and graph.groups[edge.group].sort == "executor"
            return "a thread, to go on" if is_thread else "its slot, to return to its group"
        case SetBy(what=what):
            return what
        case Join() if (other := graph.activities.get(edge.to)) and other.label.startswith("thread "):
            return f"{other.label}, which works for it"
        case Free():
            return "its event loop"
        case _:
            return "another task"


def offer(service: str) -> str:
    """Return a service's name with its kind; for a service inside an action, those of the action."""
    name, is_action, _ = service.partition("/_action/")
    return f"{'action' if is_action else 'service'} {name}"


def where(activity: ActivityView) -> str:
    """Return the place and the duration of a wait, in parentheses."""
    parts = [f"{activity.line} in {activity.function}"] if activity.place.file else []
    parts += [f"called in {activity.called}"] if activity.called else []
    parts += [f"for {activity.age:.2f} s"]
    parts += [] if activity.left is None else [f"times out in {max(0.0, activity.left):.1f} s"]
    return f"({', '.join(parts)})"


def _where(activity: ActivityView) -> list[str]:
    """Return the same as clauses, between which a line may break."""
    place, called, rest = where(activity).partition(" called in")
    return [f"  {place}", *([f"called in{rest}"] if called else [])]


def headline(deadlock: Deadlock, graph: WaitGraph) -> str:
    """Return the first sentence of the report, on one line."""
    return " ".join(_headline(deadlock, graph))


def _headline(deadlock: Deadlock, graph: WaitGraph) -> list[str]:
    """Return the clauses of the headline."""
    count, more = len(deadlock.ring), len(deadlock.victims)
    kind = "LIKELY DEADLOCK" if deadlock.is_likely else "DEADLOCK"
    are_starts = all(edge.group and graph.groups[edge.group].is_start for edge in deadlock.edges)
    who = f"the on_starts of {count} nodes" if are_starts else f"{count} callbacks"
    clauses = [f"{who} wait for each other in a ring"] if count > 1 else _alone(deadlock, graph)
    if is_in_vain(deadlock, graph):
        kind = "WAITS IN VAIN"
        left = min(a.left for a in map(graph.activities.__getitem__, deadlock.ring) if a.left is not None)
        clauses[-1] += ","
        clauses.append(f"until a deadline of its own ends that in {max(0.0, left):.1f} s")
    if deadlock.is_partial:
        clauses.append("(unless something else that they wait for fails)")
    if more:
        clauses[-1] += ";"
        clauses.append(f"{more} more wait{'s' if more == 1 else ''} for {'it' if count == 1 else 'them'}")
    return [f"{kind}: {clauses[0]}", *clauses[1:]]


def _alone(deadlock: Deadlock, graph: WaitGraph) -> list[str]:
    """Return the clauses for a ring of one: an activity that keeps itself waiting."""
    [name], [edge] = deadlock.ring, deadlock.edges
    who = title(graph.activities[name])
    if isinstance(edge.via, Opening):
        return [f"{who} waits for {wanted(edge, graph)}, which opens when on_start has returned"]
    if not isinstance(edge.via, SetBy):
        return [f"{who} waits for itself"]
    if beside := deadlock.beside.get(name):
        what = _all_wanted(graph.activities[name], [edge, *beside], graph)
        return [f"{who} waits for {what},", "and what could end that is kept out"]
    what = edge.via.what
    if edge.via.is_held:
        return [f"{who} waits for {what}, which it holds itself"]
    if edge.loop:
        return [f"{who} waits for {what},", "and what could end that needs the event loop, which it blocks"]
    if not edge.group and not edge.queue and edge.to == name:
        return [f"{who} waits for {what},", f"which its own code {edge.via.verb} only after that"]
    others = [queue for queue in queues_of(edge, graph) if queue.handler != graph.activities[name].handler]
    if not others:
        return [f"{who} waits for {what},", f"which only another run of it {edge.via.verb}"]
    kept = " and ".join(queue.work for queue in others)
    is_one = len(others) == 1
    if edge.group and graph.groups[edge.group].is_start:
        return [f"{who} waits for {what},", f"and {kept}, which {edge.via.verb} it, runs when on_start has returned"]
    verb = edge.via.verb if is_one else edge.via.verb.removesuffix("s")
    return [f"{who} waits for {what},", f"and {kept}, which {verb} it, {'is' if is_one else 'are'} kept out"]


def _ring(deadlock: Deadlock, graph: WaitGraph) -> Iterator[str]:
    for i, (name, edge) in enumerate(zip(deadlock.ring, deadlock.edges, strict=True)):
        beside = deadlock.beside.get(name, ())
        yield from _member(graph.activities[name], edge, graph, beside)
        back = " (back to the first)" if i == len(deadlock.ring) - 1 and len(deadlock.ring) > 1 else ""
        clauses = _reason(graph.activities[name], edge, graph, is_alone=not beside)
        yield from filled("    -> ", [*clauses[:-1], clauses[-1] + back])
        for other in beside:
            yield from filled("    -> ", _reason(graph.activities[name], other, graph, is_alone=False))


def _member(activity: ActivityView, edge: Edge, graph: WaitGraph, beside: Sequence[Edge] = ()) -> list[str]:
    """Return the lines on one member: what it holds, what it waits for, and where."""
    predicates = [_held(activity, graph)] if group_of(activity, graph) else []
    predicates += ["blocks the event loop"] if edge.loop and edge.to == activity.id else []
    # The activity's own wait names the call even where the edge was made up for the headline.
    via = edge if not (isinstance(activity.wait, Call) and isinstance(edge.via, Call)) else Edge("", activity.wait)
    waits = f"waits for {_all_wanted(activity, [via, *beside], graph)}"
    who = title(activity)
    clauses = [f"{who} {', '.join(predicates)}", f"and {waits}"] if predicates else [f"{who} {waits}"]
    return filled("  ", [*clauses, *_where(activity)])


def _all_wanted(activity: ActivityView, edges: Sequence[Edge], graph: WaitGraph) -> str:
    """Return the phrase for several conditions of one wait, joined by `and` or `or`."""
    joint = " or " if isinstance(activity.wait, AnyOf) else " and "
    return joint.join(dict.fromkeys(wanted(edge, graph) for edge in edges))


def _held(activity: ActivityView, graph: WaitGraph) -> str:
    """Return the verb phrase for the resources that an activity holds."""
    own = [graph.groups[name] for name in activity.holds if name in graph.groups and graph.groups[name].name]
    if not own[0].sort:
        return f"holds group '{own[0].name}'"
    held = [f"the {group.name}" for group in own if group.sort == "callback"]
    held += ["a thread" if group.limit != 1 else "the only thread" for group in own if group.sort == "executor"]
    return f"holds {' and '.join(held)}" if held else "runs"


def _reason(activity: ActivityView, edge: Edge, graph: WaitGraph, *, is_alone: bool = True) -> list[str]:
    """Return the clauses for why an activity waits for another.

    Args:
        is_alone: Whether the wait has no other parts.
    """
    other = graph.activities[edge.to]
    if edge.loop:
        return ["nothing can arrive while the event loop is blocked", f"by {title(other)}"]
    if isinstance(edge.via, SetBy) and edge.via.is_held and not edge.group:
        return [f"which {title(other)} holds"]
    if isinstance(edge.via, SetBy) and not edge.group and edge.to == activity.id:
        return [f"which {title(other)} itself {edge.via.verb} further on"]
    if not edge.group:
        return [f"{'which' if is_alone else wanted(edge, graph)} {title(other)} must give"]
    group = graph.groups[edge.group]
    queues = [queue for queue in queues_of(edge, graph) if edge.group in queue.needs]
    # Another run of the waiting handler itself is the last to mention: the others are what it was written to wait for.
    queues = [q for q in queues if q.handler != activity.handler] or queues
    who = " and ".join(queue.label for queue in queues) + f" of {queues[0].node}" if queues else "that"
    if group.is_start:
        return [who, f"{'opens' if isinstance(edge.via, Opening) else 'runs'} when {title(other)} has returned"]
    if not isinstance(edge.via, SetBy):
        return [who, *_needs(group, [other], "waits for")]
    verb, needs = edge.via.verb, "needs"
    if len(queues) > 1:
        verb, needs = verb.removesuffix("s"), "need"
    waiting, dropped = sum(q.waiting for q in queues), sum(q.dropped for q in queues)
    clauses = _needs(group, [other], f"{verb} {'it' if is_alone else edge.via.what} and {needs}")
    if group.sort:
        return [who, *clauses]
    return [who, *clauses[:-1], f"{clauses[-1]};", f"{waiting} queued, {dropped} dropped meanwhile"]


def _needs(group: GroupView, holders: Sequence[ActivityView], verb: str) -> list[str]:
    if group.sort == "spinner":
        return [f"{verb} {_slot(group)},", "and there is none"]
    return [f"{verb} {_slot(group)},", f"which {' and '.join(title(a) for a in holders)} holds"]


_SORTS = {
    "callback": "the {name} of {node}",
    "executor": "{threads} of the {name} of {node}",
    "spinner": "a thread that spins {node}",
}
"""Phrases for the resources of rclpy code that act as groups, by kind."""


def _slot(group: GroupView) -> str:
    if group.sort:
        threads = "the thread" if group.limit == 1 else f"one of the {group.limit} threads"
        return _SORTS[group.sort].format(name=group.name, node=group.node, threads=threads)
    if not group.name:
        return "its turn"
    if group.limit == 1:
        return f"group '{group.name}' of {group.node}"
    return f"one of the {group.limit} slots of group '{group.name}' of {group.node}"


def _victims(deadlock: Deadlock, graph: WaitGraph) -> Iterator[str]:
    for name in deadlock.victims:
        activity = graph.activities[name]
        yield from filled("  behind them: ", [title(activity), *_where(activity)])


def _any_of(fixes: list[str]) -> list[str]:
    changes = sum(line[2:3] != " " for line in fixes)  # a change goes on in lines further in
    heading = "This ends it:" if changes == 1 else "Any one of these ends it:"
    return [heading, *fixes] if fixes else []

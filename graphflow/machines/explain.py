"""A deadlock in words: who holds what and waits for what, where, and which one-line change ends it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import PurePath

from graphflow.errors import Place
from graphflow.machines.rings import Deadlock, Edge
from graphflow.machines.wait_graph import ActivityView, Call, Free, GroupView, QueueView, SetBy, Slot, WaitGraph


def explanation(deadlock: Deadlock, graph: WaitGraph) -> str:
    """The whole report."""
    return "\n".join(
        [_headline(deadlock), *_ring(deadlock, graph), *_victims(deadlock, graph), *_fixes(deadlock, graph)]
    )


def hopeless(service: str, queue: QueueView, holders: list[ActivityView], graph: WaitGraph) -> str:
    """Why a call to `service` can never be answered: all slots are held by activities that wait for it."""
    [group] = [graph.groups[name] for name in queue.needs if graph.groups[name].name] or [graph.groups[queue.needs[0]]]
    held = " and ".join(f"{title(a)}{where(a)}" for a in holders)
    edge = Edge(holders[0].id if holders else "", Call("", service), queue.id, group.id)
    head = f"{service} can never answer: {queue.label} of {queue.node} waits for {_slot(group)}, held by {held}"
    head = f"{head}, which waits for this very call"
    fixes = [*_fix(holders[0], edge, graph), *_release(holders[0], group)] if holders else []
    return "\n".join([head, "Any one of these ends it:", *fixes] if fixes else [head])


def stall(
    group: GroupView, holders: list[ActivityView], waiting: list[QueueView], dropped: dict[str, int], seconds: float
) -> str:
    """The report of a group that the same runs hold for long.

    Args:
        dropped: How many items each queue had dropped before.
    """
    who = " and ".join(title(a) + "".join(f" ({place})" for place in _place(a)) for a in holders)
    slots = f"have held all {len(holders)} slots of group '{group.name}' of {group.node}"
    kept = slots if len(holders) > 1 else f"has held {_slot(group)}"
    lines = [f"STALL: {who} {kept} for more than {seconds:.1f} s"]
    for queue in waiting:
        lost = queue.dropped - dropped.get(queue.id, 0)
        lines.append(f"  {queue.label} of {queue.node} waits for it: {queue.waiting} queued, {lost} dropped meanwhile")
    held = {method_of(a.label) for a in holders}
    others = [queue for queue in waiting if method_of(queue.label) not in held]
    return "\n".join([*lines, "If that is too long:", _own_group(others[0])] if others else lines)


def _headline(deadlock: Deadlock) -> str:
    count, more = len(deadlock.ring), len(deadlock.victims)
    who = "one callback waits for itself" if count == 1 else f"{count} callbacks wait for each other in a ring"
    word = "LIKELY DEADLOCK" if deadlock.is_likely else "DEADLOCK"
    condition = " (unless something else that they wait for fails)" if deadlock.is_partial else ""
    behind = f"; {more} more wait{'s' if more == 1 else ''} for {'it' if count == 1 else 'them'}" if more else ""
    return f"{word}: {who}{condition}{behind}"


def _ring(deadlock: Deadlock, graph: WaitGraph) -> Iterator[str]:
    for i, (name, edge) in enumerate(zip(deadlock.ring, deadlock.edges, strict=True)):
        activity = graph.activities[name]
        group = group_of(activity, graph)
        deeds = [f"holds group '{group}'"] if group else []
        deeds += ["blocks the event loop"] if edge.loop and edge.to == name else []
        doing = f" {', '.join(deeds)} and" if deeds else ""
        yield f"  {title(activity)}{doing} waits for {wanted(edge)}{where(activity)}"
        back = " (back to the first)" if i == len(deadlock.ring) - 1 and len(deadlock.ring) > 1 else ""
        yield f"    -> {_reason(edge, graph)}{back}"


def title(activity: ActivityView) -> str:
    """What an activity is called: `timer tick of /arm`."""
    return f"{activity.label} of {activity.node}"


def group_of(activity: ActivityView, graph: WaitGraph) -> str:
    """The name of the group whose slot an activity holds; empty for none."""
    return next((graph.groups[g].name for g in activity.holds if g in graph.groups and graph.groups[g].name), "")


def wanted(edge: Edge) -> str:
    """What an activity waits for."""
    match edge.via:
        case Call(id=call, name=name):
            return f"the {'result of action' if call.startswith('goal:') else 'response of service'} {name}"
        case Slot():
            return "its slot, to return to its group"
        case SetBy(what=what):
            return what
        case Free():
            return "its event loop"
        case _:
            return "another task"


def where(activity: ActivityView) -> str:
    """Where an activity waits, and for how long."""
    words = [*_place(activity), f"for {activity.age:.2f} s"]
    if activity.left is not None:
        words.append(f"times out in {max(0.0, activity.left):.1f} s")
    return f"   ({', '.join(words)})"


def _place(activity: ActivityView) -> Iterator[str]:
    if activity.place.file:
        yield f"{Place(PurePath(activity.place.file).name, activity.place.line)} in {activity.function}"


def _reason(edge: Edge, graph: WaitGraph) -> str:
    other = graph.activities[edge.to]
    if edge.loop:
        return f"nothing can arrive while the event loop is blocked by {title(other)}"
    if isinstance(edge.via, SetBy) and edge.via.is_held and not edge.group:
        return f"which {title(other)} holds"
    if not edge.group:
        return f"which {title(other)} must give"
    queue = graph.queues.get(edge.queue)
    who = "that" if queue is None else f"{queue.label} of {queue.node}"
    verb = "sets it and needs" if isinstance(edge.via, SetBy) else "waits for"
    more = ""
    if queue is not None and isinstance(edge.via, SetBy):
        more = f"; {queue.waiting} queued, {queue.dropped} dropped meanwhile"
    return f"{who} {verb} {_slot(graph.groups[edge.group])}, which {title(other)} holds{more}"


def _slot(group: GroupView) -> str:
    if not group.name:
        return "its turn"
    if group.limit == 1:
        return f"group '{group.name}' of {group.node}"
    return f"one of the {group.limit} slots of group '{group.name}' of {group.node}"


def _victims(deadlock: Deadlock, graph: WaitGraph) -> Iterator[str]:
    for name in deadlock.victims:
        activity = graph.activities[name]
        yield f"  behind them: {title(activity)}{where(activity)}"


def _fixes(deadlock: Deadlock, graph: WaitGraph) -> list[str]:
    found: list[str] = []
    for i, (name, edge) in enumerate(zip(deadlock.ring, deadlock.edges, strict=True)):
        activity, wanted_of_it = graph.activities[name], graph.groups.get(deadlock.edges[i - 1].group)
        for fix in (*_fix(activity, edge, graph), *_release(activity, wanted_of_it)):
            if fix not in found:
                found.append(fix)
    # Advice of the same kind for several members of a ring is given once: following it once is enough.
    kinds: dict[str, str] = {}
    for fix in found:
        kinds.setdefault(fix.split()[0], fix)
    return ["Any one of these ends it:", *kinds.values()] if kinds else []


def _fix(activity: ActivityView, edge: Edge, graph: WaitGraph) -> Iterator[str]:
    if edge.loop:
        other = graph.activities[edge.to]
        at = Place(PurePath(other.place.file).name, other.place.line)
        wait = "await the call" if isinstance(edge.via, Call) else "await, as in `await self.clock.sleep(0.05)`,"
        yield f"  {wait} in {at}"
        handler = method_of(other.label)
        yield (
            f"  let {handler} run in a thread, in the graph file\n"
            f"      {other.node}: {{concurrency: {{blocking: {{handlers: [{handler}], thread: true}}}}}}\n"
            f"    or in the class: thread=True where {handler} is declared"
        )
        return
    queue, group = graph.queues.get(edge.queue), graph.groups.get(edge.group)
    if isinstance(edge.via, SetBy) and edge.via.is_held:
        other = graph.activities[edge.to]
        at = Place(PurePath(other.place.file).name, other.place.line)
        yield f"  leave {edge.via.what} before the await in {at}"
    if queue is None or group is None:
        return
    handler = method_of(queue.label)
    if queue.label.startswith("reply "):
        yield f"  let replies through: declare the client of {handler} without group="
        queue, handler = replace(queue, node=activity.node, is_declared=True), method_of(activity.label)
    if group.name and (queue.node, handler) != (activity.node, method_of(activity.label)):
        yield _own_group(replace(queue, label=handler))
    if group.name:
        if group.limit is not None and not isinstance(edge.via, SetBy):
            yield _larger(group, sum(group.id in a.holds for a in graph.activities.values()) + 1)
    elif queue.label.startswith("action "):
        yield f"  let several goals run at a time: policy='parallel' where {handler} is declared"
    elif not isinstance(edge.via, SetBy):
        own = f"{handler}_group"
        made = f"{own} = Group(None), and group={own} where it is declared"
        made = made if queue.is_declared else "group=Group(None) where it is made"
        yield f"  let several runs of {handler} overlap: {made}"


def _release(activity: ActivityView, wanted: GroupView | None) -> Iterator[str]:
    """Releasing a slot helps where the previous activity in the ring wants it."""
    if wanted is not None and wanted.name and activity.is_async:
        place = Place(PurePath(activity.place.file).name, activity.place.line)
        yield f"  release the slot while waiting, in {place}: async with self.group.released(): ..."


def _larger(group: GroupView, limit: int) -> str:
    made = f"Group({limit}{', thread=True' if group.is_threaded else ''})"
    text = "  allow more runs, if its handlers share no state"
    if not group.is_declared:
        return f"{text}: {made} where {group.node} makes the group called {group.name} here"
    return (
        f"{text}\n      {group.node}: {{concurrency: {{{group.name}: {{limit: {limit}}}}}}}\n"
        f"    or in the class: {group.name} = {made}"
    )


def _own_group(queue: QueueView) -> str:
    handler = method_of(queue.label)
    own = f"{handler}_group"
    if not queue.is_declared:
        return f"  give {handler} of {queue.node} a group of its own: group=Group(1) where it is made"
    return (
        f"  give {handler} a group of its own, in the graph file\n"
        f"      {queue.node}: {{concurrency: {{{own}: [{handler}]}}}}\n"
        f"    or in the class: {own} = Group(1), and group={own} where {handler} is declared"
    )


def method_of(label: str) -> str:
    """The method in an activity's or a queue's label: `tick` of `timer tick`."""
    return label.split()[-1]

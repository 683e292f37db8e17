"""Remedies for code written for rclpy, in terms of its callback groups, executors and futures.

The model is the same; the resources are a callback group (one slot), an executor (one slot per thread) and a thread
that spins, which a node without an executor lacks altogether.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, Join, QueueView, SetBy, WaitGraph
from graphflow.machines.waits.wrapping import filled

_REENTRANT = "callback_group=ReentrantCallbackGroup()"
_EXCLUSIVE = "callback_group=MutuallyExclusiveCallbackGroup()"


class Member(NamedTuple):
    """A member of a ring."""

    edge: Edge
    """Reason why the member before it waits for it."""
    wait: Edge
    """Reason why it cannot proceed itself."""


def members_of(deadlock: Deadlock, graph: WaitGraph) -> tuple[list[Member], list[Member]]:
    """Return the members whose callback group or thread another one wants, and those that block their own responses.

    The latter wait for a response whose delivery needs what they hold: no change elsewhere would free them.
    """
    found = [Member(deadlock.edges[i - 1], edge) for i, edge in enumerate(deadlock.edges)]
    holding = [way for way in found if way.edge.group and graph.groups[way.edge.group].sort]
    return holding, [way for way in found if _keeps_its_answer_out(way, graph)]


def _keeps_its_answer_out(way: Member, graph: WaitGraph) -> bool:
    holder = graph.activities[way.edge.to]
    reply = _reply_queue(holder, way.wait, graph)
    if reply is None or _is_spun_inside(holder, reply, graph):
        return False
    return any(group.id in holder.holds for group in _full(reply, graph))


def in_rclpys_words(holding: Sequence[Member], alone: Sequence[Member], graph: WaitGraph) -> Iterator[str]:
    """Yield the remedies: for one member, or for all that block their own responses."""
    for way in holding:
        needs = [graph.groups[name] for name in _needs(way.edge, graph)]
        if any(group.sort == "spinner" for group in needs):
            yield from _spun(way, graph)
            return
    chosen = alone or holding[:1]
    without = [_without_waiting(graph.activities[way.edge.to], way.wait, graph) for way in chosen]
    if all(without):
        yield _text(*_joined(without))
    for way in chosen:
        reply = _reply_queue(graph.activities[way.edge.to], way.wait, graph)
        if reply is not None and _is_spun_inside(graph.activities[way.edge.to], reply, graph):
            return  # spinning inside takes the node from its executor for good: nothing else helps
        if _waits_for_itself(graph.activities[way.edge.to], way.wait, graph):
            return  # each further run would wait as well, and take one more thread
    apart = _apart(chosen, graph)
    if apart:
        yield _text(*apart)


def _needs(edge: Edge, graph: WaitGraph) -> tuple[str, ...]:
    queue = _queue_of(edge, graph)
    return queue.needs if queue is not None else (edge.group,)


def _queue_of(edge: Edge, graph: WaitGraph) -> QueueView | None:
    """Return the queue that waits for the holder of an edge's group."""
    if not isinstance(edge.via, SetBy):
        return graph.queues.get(edge.queue)
    holder = graph.activities[edge.to]
    queues = [graph.queues[name] for name in edge.via.queues if name in graph.queues]
    return min(queues, key=lambda one: one.label == holder.label, default=None)


def _joined(ways: Sequence[Sequence[str]]) -> Iterator[str]:
    """Join the clauses of several changes that only help together."""
    for i, clauses in enumerate(ways):
        first, *rest = clauses
        yield f"and {first}" if i else first
        if rest and i + 1 < len(ways):
            rest[-1] += ";"
        yield from rest


def _spun(way: Member, graph: WaitGraph) -> Iterator[str]:
    """Yield the remedies for a thread that waits while nothing spins the node."""
    holder, place = graph.activities[way.edge.to], graph.activities[way.edge.to].line
    if (
        holder.function == "__init__"
        and isinstance(way.wait.via, SetBy)
        and (later := _after_init(way.wait.via, graph))
    ):
        yield _text(f"do not wait for {way.wait.via.what} in __init__, in {place}:", *later)
        return
    reply = _reply_queue(holder, way.wait, graph)
    waiting = [_queue_of(way.edge, graph), reply]
    unspun = [queue for queue in waiting if queue is not None and _is_unspun(queue, graph)]
    nodes = list(dict.fromkeys(queue.node for queue in unspun)) or [graph.groups[way.edge.group].node or "the node"]
    has_executor = any(graph.groups[name].sort == "executor" for name in _needs(way.edge, graph))
    if len(nodes) > 1 and not has_executor:
        start = "threading.Thread(target=executor.spin, daemon=True).start()"
        both = " and ".join(nodes)
        yield _text(
            f"let another thread spin {both}, once, before {place}:", f"executor.add_node(...) for each, then {start}"
        )
        return
    if reply is not None and reply not in unspun:
        both = "executor.add_node(...) for both nodes, executor.spin_until_future_complete(future)"
        yield _text(f"spin {nodes[0]} as well while waiting, in {place}:", both)
    elif isinstance(way.wait.via, Call) and not way.wait.via.id.startswith("tick:"):
        spin = "rclpy.spin_until_future_complete(node, future)"
        yield _text(f"spin while waiting, in {place}:", f"future = {_asynchronous(way.wait.via)},", spin)
    spin = "executor.spin" if has_executor else "rclpy.spin, args=(node,)"
    start = f"threading.Thread(target={spin}, daemon=True).start(),"
    once = f"once, before {place} and any loop around it"
    yield _text(f"let another thread spin {nodes[0]}, {once}:", start, "in place of any spin that comes later")


def _after_init(wait: SetBy, graph: WaitGraph) -> list[str]:
    """Return the clauses for continuing in a callback what a constructor waits to do, since it runs before any spin."""
    others = " or ".join(_handlers(wait.queues, graph))
    is_value = re.fullmatch(r"self\.\w+", wait.what) is not None
    timer = f"or in a timer, which returns at once until {wait.what} is set" if is_value else "or in a timer"
    if wait.what.startswith("the transform "):  # which tf2's own subscriptions hear
        return ["look it up in a timer, and without a timeout"]
    return [f"go on in {others},", timer] if others else []


def _is_unspun(queue: QueueView, graph: WaitGraph) -> bool:
    return any(graph.groups[name].sort == "spinner" for name in queue.needs if name in graph.groups)


def _without_waiting(holder: ActivityView, edge: Edge, graph: WaitGraph) -> list[str]:
    """Return the clauses for doing the same without waiting; empty if there is no such way."""
    place, handler = holder.line, holder.handler
    answers = holder.label.partition(" ")[0] in ("service", "action")
    if holder.is_inner:
        return []  # it is rclpy's, and calls a method of the user's that has to return
    match edge.via:
        case Call(id=call) if call.startswith("tick:"):
            return [f"do not sleep in {place}:", "create_timer(period, callback) calls back at a rate"]
        case Call() | SetBy() if holder.is_async:
            made = f"{_REENTRANT} where {handler} and what it awaits are made"
            return [f"let others run while {handler} awaits in {place}:", made]
        case Call() as call if answers:
            wait = f"make {handler} async def, and await {_asynchronous(call)},"
            return [f"do not block in {place}:", wait, f"both with {_REENTRANT}"]
        case Call() as call:
            later = "then future.add_done_callback(...)"
            return [f"do not block in {place}:", f"future = {_asynchronous(call)},", later]
        case Join():
            return [f"return from {handler} instead of waiting in {place}:", "the thread ends by itself then"]
        case SetBy(verb="hears"):
            now = f"look it up with rclpy.time.Time() and without a timeout in {place},"
            return [now, f"and again when {handler} is called next"]
        case SetBy(what=what, is_held=False, queues=queues):
            others = " or ".join(_handlers([name for name in queues if name != _own(holder, graph)], graph))
            others = others or (
                "its next call" if _waits_for_itself(holder, edge, graph) else "the callback that sets it"
            )
            if answers:
                future = f"and await a rclpy.task.Future that {others} sets"
                return [f"do not block in {place}:", f"make {handler} async def with {_EXCLUSIVE},", future]
            return [f"return from {handler} instead of waiting for {what} in {place},", f"and go on in {others}"]
    return []


def _waits_for_itself(holder: ActivityView, wait: Edge, graph: WaitGraph) -> bool:
    """Whether a callback waits for what only its own next run would set."""
    return isinstance(wait.via, SetBy) and {*wait.via.queues} == {_own(holder, graph)}


def _own(holder: ActivityView, graph: WaitGraph) -> str:
    """Return the id of the queue of an activity's own handler; empty if there is none."""
    own = (holder.node, holder.label)
    return next((queue.id for queue in graph.queues.values() if (queue.node, queue.label) == own), "")


def _handlers(queues: Sequence[str], graph: WaitGraph) -> list[str]:
    """Return the phrases for the handlers of some queues."""
    known = [graph.queues[name] for name in queues if name in graph.queues]
    return [queue.work for queue in known]


_OF_PARAMETERS = {"get_parameters", "set_parameters", "set_parameters_atomically", "list_parameters"}
_OF_PARAMETERS |= {"describe_parameters", "get_parameter_types"}


def _asynchronous(call: Call) -> str:
    """Return the asynchronous counterpart of a blocking call."""
    if call.id.startswith("goal:"):
        return "client.send_goal_async(goal)"
    name = call.name.rpartition("/")[2]
    if "/_action/" not in call.name:
        return f"client.{name}(...)" if name in _OF_PARAMETERS else "client.call_async(request)"
    names = {"send_goal": "client.send_goal_async(goal)", "get_result": "goal_handle.get_result_async()"}
    return names.get(name, "goal_handle.cancel_goal_async()")


def _reply_queue(holder: ActivityView, edge: Edge, graph: WaitGraph) -> QueueView | None:
    """Return the queue through which the response to a holder's own call must come."""
    if not isinstance(edge.via, Call):
        return None
    node, label = holder.node, f"reply {edge.via.name.partition('/_action/')[0]}"
    return next((q for q in graph.queues.values() if (q.node, q.label) == (node, label)), None)


def _is_spun_inside(holder: ActivityView, reply: QueueView, graph: WaitGraph) -> bool:
    """Whether a callback spins its own node: the response then needs another executor than the one it holds."""
    mine, wanted = (
        {name for name in names if name in graph.groups and graph.groups[name].sort == "executor"}
        for names in (holder.holds, reply.needs)
    )
    return bool(mine and wanted) and mine.isdisjoint(wanted)


def _apart(ways: Sequence[Member], graph: WaitGraph) -> list[str]:
    """Return the clauses that let the awaited callbacks run beside the holders: other groups, more threads."""
    moved: list[tuple[ActivityView, bool]] = []
    clients: list[str] = []
    executors: dict[str, int] = {}
    for edge, wait in ways:
        holder = graph.activities[edge.to]
        queue, reply = _queue_of(edge, graph), _reply_queue(holder, wait, graph)
        if queue is None and edge.group and graph.groups[edge.group].sort:
            return [f"use more threads: MultiThreadedExecutor(num_threads={_held(graph, edge.group) + 1})"]
        full = [group for one in (queue, reply) if one is not None for group in _full(one, graph)]
        if any(group.sort == "callback" and group.id in holder.holds for group in full):
            is_itself = queue is not None and queue.label == holder.label
            if is_itself and isinstance(wait.via, Join):
                return []  # a further run would wait for the same
            if not holder.is_inner:
                moved.append((holder, is_itself))
            elif reply is not None and isinstance(wait.via, Call):
                clients.append(f"the client of {wait.via.name} in {holder.node}")
            else:
                return []
        executors |= {group.id: _held(graph, group.id) + 1 for group in full if group.sort == "executor"}
    if any(_runs_twice(name, graph) for name in executors):
        return []  # more threads would wait as these do
    clauses = [f"make {' and '.join(clients)}", f"with {_EXCLUSIVE}"] if clients else []
    if moved:
        who = " and ".join(f"{_named(holder)} of {holder.node}" for holder, _ in moved)
        kind = _REENTRANT if any(is_itself for _, is_itself in moved) else _EXCLUSIVE
        clauses = [f"make {who}", f"with {kind}{' each' if len(moved) > 1 else ''}"]
    if executors:
        each = " each" if len(executors) > 1 else ""
        more = f"spin{each} with MultiThreadedExecutor(num_threads={max(executors.values())})"
        clauses = [*clauses[:-1], f"{clauses[-1]},", f"and {more}"] if clauses else [more]
    return clauses


def _runs_twice(executor: str, graph: WaitGraph) -> bool:
    """Whether several of an executor's threads run the same handler, and others may come to."""
    labels = [(a.node, a.label) for a in graph.activities.values() if executor in a.holds]
    return len(labels) > len({*labels})


def _named(holder: ActivityView) -> str:
    """Return a callback's name, or a phrase for a lambda."""
    kind = holder.label.partition(" ")[0]
    return holder.handler if holder.handler.isidentifier() else f"the {kind} that waits in {holder.line}"


def _full(queue: QueueView, graph: WaitGraph) -> list[GroupView]:
    groups = [graph.groups[name] for name in queue.needs if name in graph.groups]
    return [group for group in groups if group.limit is not None and _held(graph, group.id) >= group.limit]


def _held(graph: WaitGraph, group: str) -> int:
    return sum(group in activity.holds for activity in graph.activities.values())


def _text(*clauses: str) -> str:
    return "\n".join(filled("  ", clauses))

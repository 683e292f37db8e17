"""One-line changes, in rclpy's words, that end a deadlock of code that is written for it."""

from __future__ import annotations

from collections.abc import Iterator

from graphflow.machines.clauses import filled
from graphflow.machines.rings import Edge
from graphflow.machines.wait_graph import ActivityView, Call, GroupView, QueueView, SetBy, WaitGraph

_REENTRANT = "callback_group=ReentrantCallbackGroup()"
_EXCLUSIVE = "callback_group=MutuallyExclusiveCallbackGroup()"


def in_rclpys_words(edge: Edge, holder_edge: Edge, graph: WaitGraph) -> Iterator[str]:
    """The changes that end a wait for a callback group, for a thread of an executor, or for any that spins.

    Args:
        edge: The wait.
        holder_edge: Why the one that has what is waited for cannot go on.
    """
    holder, queue = graph.activities[edge.to], graph.queues.get(edge.queue)
    if queue is None and isinstance(edge.via, SetBy):
        queue = next((graph.queues[name] for name in edge.via.queues if name in graph.queues), None)
    needs = [graph.groups[name] for name in (queue.needs if queue is not None else (edge.group,))]
    if any(group.sort == "spinner" for group in needs):
        yield from _spun(holder, holder_edge, needs)
        return
    yield from _without_waiting(holder, holder_edge, graph)
    reply = _reply_queue(holder, holder_edge, graph)
    if reply is not None and _is_spun_inside(holder, reply, graph):
        return  # which takes the node from its executor for good: nothing else helps
    if queue is not None:
        yield from _apart(queue, reply, graph)
    else:
        yield _text(f"use more threads: MultiThreadedExecutor(num_threads={_held(graph, edge.group) + 1})")


def _spun(holder: ActivityView, holder_edge: Edge, needs: list[GroupView]) -> Iterator[str]:
    """Have somebody spin while a thread waits."""
    place = holder.line
    if isinstance(holder_edge.via, Call) and not holder_edge.via.id.startswith("tick:"):
        spin = "rclpy.spin_until_future_complete(node, future)"
        yield _text(f"spin while waiting, in {place}:", f"future = client.{_asynchronous(holder_edge.via)},", spin)
    node = next((group.node for group in needs if group.node), "the node")
    spin = "executor.spin" if any(group.sort == "executor" for group in needs) else "rclpy.spin, args=(node,)"
    start = f"threading.Thread(target={spin}, daemon=True).start()"
    yield _text(f"let another thread spin {node} before {place}:", start)


def _without_waiting(holder: ActivityView, edge: Edge, graph: WaitGraph) -> Iterator[str]:
    """The same work by a callback that does not keep what others need."""
    place, handler = holder.line, holder.handler
    match edge.via:
        case Call(id=call) if call.startswith("tick:"):
            yield _text(f"do not sleep in {place}:", "create_timer(period, callback) calls back at a rate")
        case Call() | SetBy() if holder.is_async:
            made = f"{_REENTRANT} where {handler} and what it awaits are made"
            yield _text(f"let others run while {handler} awaits in {place}:", made)
        case Call() as call if holder.label.partition(" ")[0] in ("service", "action"):
            wait = f"make {handler} async def, and await client.{_asynchronous(call)},"
            yield _text(f"do not block in {place}:", wait, f"both with {_REENTRANT}")
        case Call() as call:
            yield _text(
                f"do not block in {place}:",
                f"future = client.{_asynchronous(call)},",
                "then future.add_done_callback(...)",
            )
        case SetBy(what=what, is_held=False, queues=queues):
            others = " or ".join(graph.queues[name].handler for name in queues if name in graph.queues)
            yield _text(f"return from {handler} instead of waiting for {what} in {place},", f"and go on in {others}")


def _asynchronous(call: Call) -> str:
    """The call that does not block in place of one that does."""
    if call.id.startswith("goal:"):
        return "send_goal_async(goal)"
    part = call.name.partition("/_action/")[2]
    names = {"send_goal": "send_goal_async(goal)", "get_result": "get_result_async()"}
    return names.get(part, "cancel_goal_async()") if part else "call_async(request)"


def _reply_queue(holder: ActivityView, edge: Edge, graph: WaitGraph) -> QueueView | None:
    """Where the answer to a call of the holder's own will be waiting."""
    if not isinstance(edge.via, Call):
        return None
    node, label = holder.node, f"reply {edge.via.name.partition('/_action/')[0]}"
    return next((q for q in graph.queues.values() if (q.node, q.label) == (node, label)), None)


def _is_spun_inside(holder: ActivityView, reply: QueueView, graph: WaitGraph) -> bool:
    """Whether a callback spins its own node: what that waits for needs another executor than the callback has."""
    mine, wanted = (
        {name for name in names if name in graph.groups and graph.groups[name].sort == "executor"}
        for names in (holder.holds, reply.needs)
    )
    return bool(mine and wanted) and mine.isdisjoint(wanted)


def _apart(queue: QueueView, reply: QueueView | None, graph: WaitGraph) -> Iterator[str]:
    """Let what waits run beside what keeps it out."""
    kept, clauses = [], []
    for one in (queue, reply):
        if one is not None and any(group.sort == "callback" for group in _full(one, graph)):
            is_reply = one.label.startswith("reply ")
            kept.append(f"the client of {one.handler}" if is_reply else one.handler)
    if kept:
        who = f"{' and '.join(dict.fromkeys(kept))} of {queue.node}"
        clauses += [f"make {who}", f"with {_EXCLUSIVE}{' each' if len({*kept}) > 1 else ''}"]
    executor = next((group for group in _full(queue, graph) if group.sort == "executor"), None)
    if executor is not None:
        number = _held(graph, executor.id) + 1
        more = f"spin with MultiThreadedExecutor(num_threads={number})"
        clauses = [*clauses[:-1], f"{clauses[-1]},", f"and {more}"] if clauses else [more]
    if clauses:
        yield _text(*clauses)


def _full(queue: QueueView, graph: WaitGraph) -> list[GroupView]:
    groups = [graph.groups[name] for name in queue.needs if name in graph.groups]
    return [group for group in groups if group.limit is not None and _held(graph, group.id) >= group.limit]


def _held(graph: WaitGraph, group: str) -> int:
    return sum(group in activity.holds for activity in graph.activities.values())


def _text(*clauses: str) -> str:
    return "\n".join(filled("  ", clauses))

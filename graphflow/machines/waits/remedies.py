"""Remedies: one-line changes in the graph file, in the class or at the wait, each of which ends a deadlock.

Of the conditions that are necessary for deadlock (mutual exclusion, hold and wait, no preemption, circular wait), each
kind of remedy removes one from the ring: a group of its own or a thread removes the exclusion, a larger limit adds
units of the resource, `released()` removes hold and wait, and one lock order removes the circle.

Source: Coffman, Elphick and Shoshani, "System deadlocks", ACM Computing Surveys 3 (1971).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from graphflow.machines.waits.group_fixes import Limit, Thread, larger
from graphflow.machines.waits.group_moves import moves
from graphflow.machines.waits.rclpy_remedies import in_rclpys_words, members_of
from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, QueueView, SetBy, WaitGraph
from graphflow.machines.waits.wrapping import filled


def remedies(deadlock: Deadlock, graph: WaitGraph) -> list[str]:
    """Return the remedies, each as lines; of one kind that would help at several members, the first."""
    found: list[str] = []
    holding, alone = members_of(deadlock, graph)
    if alone:  # no change elsewhere would free these
        return list(in_rclpys_words(holding, alone, graph))
    for move in moves(deadlock, graph)[:1]:
        queues = [q for q in graph.queues.values() if q.node == move.node and q.handler in move.handlers]
        found += own_group(queues, graph)
    for i, (name, edge) in enumerate(zip(deadlock.ring, deadlock.edges, strict=True)):
        activity, wanted_of_it = graph.activities[name], graph.groups.get(deadlock.edges[i - 1].group)
        if not (edge.group and graph.groups[edge.group].sort):
            found += [*_changes(edge, graph), *_release(activity, wanted_of_it)]
    if holding:
        found += in_rclpys_words(holding, alone, graph)
    return _one_of_a_kind(found)


def remedies_of(activity: ActivityView, edge: Edge, graph: WaitGraph) -> list[str]:
    """Return the remedies for an activity that waits for itself."""
    queue, group = graph.queues[edge.queue], graph.groups[edge.group]
    is_other = (queue.node, queue.handler) != (activity.node, activity.handler)
    own = own_group([queue], graph) if group.name and is_other else []
    return _one_of_a_kind([*own, *_changes(edge, graph), *_release(activity, group)])


def own_group(queues: Sequence[QueueView], graph: WaitGraph) -> Iterator[str]:
    """Yield the remedy that gives handlers of a node a common group of their own."""
    node, handlers = queues[0].node, list(dict.fromkeys(queue.handler for queue in queues))
    who, own = " and ".join(handlers), f"{handlers[0]}_group"
    its = "a group of its own" if len(handlers) == 1 else "a group of their own"
    if not all(queue.is_declared for queue in queues):
        made = "it is made" if len(handlers) == 1 else "they are made"
        yield _text(f"give {who} of {node} {its}:", f"group=Group(1) where {made}")
        return
    regrouping = graph.regrouping(node).moved(handlers, own)
    declared = "is declared" if len(handlers) == 1 else "are declared"
    yield _text(
        f"give {who} {its},",
        regrouping.where,
        yaml=regrouping.lines(node, "      "),
        instead=(f"or in the class: {own} = Group(1),", f"and group={own} where {who} {declared}"),
    )


def _one_of_a_kind(fixes: Sequence[str]) -> list[str]:
    """Keep the first remedy of each kind; the verb tells the kind."""
    kinds: dict[str, str] = {}
    for fix in fixes:
        kinds.setdefault(fix.split()[0], fix)
    return list(kinds.values())


def _changes(edge: Edge, graph: WaitGraph) -> Iterator[str]:
    """Yield the remedies that remove one edge of the ring."""
    if edge.loop:
        yield from _off_the_loop(edge, graph)
        return
    queue, group = graph.queues.get(edge.queue), graph.groups.get(edge.group)
    if group is not None and group.is_start:
        yield _text(f"let on_start return: move the wait in {graph.activities[edge.to].line} into a @task")
        return
    if isinstance(edge.via, SetBy) and edge.via.is_held:
        yield from _apart_from_the_lock(edge.via.what, graph.activities[edge.to])
    if isinstance(edge.via, SetBy) and edge.via.verb == "offers" and group is None:
        yield _text(f"make {edge.via.what} before {graph.activities[edge.to].line} waits for it")
    if queue is not None and group is not None:
        yield from _more_runs(edge, queue, group, graph)


def _more_runs(edge: Edge, queue: QueueView, group: GroupView, graph: WaitGraph) -> Iterator[str]:
    """Yield the remedies that let the awaited handler run although the group is full."""
    if queue.has_answers:
        yield _text("let replies through:", f"declare the client of {queue.handler} without group=")
    if group.name:
        if (limit := larger(edge, graph)) is not None:
            yield _larger(group, limit, graph)
    elif queue.label.startswith("action "):
        yield _text("let several goals run at a time:", f"policy='parallel' where {queue.handler} is declared")
    elif not isinstance(edge.via, SetBy) or not edge.via.is_held:
        own = f"{queue.handler}_group"
        made = [f"{own} = Group(None),", f"and group={own} where it is declared"]
        made = made if queue.is_declared else ["group=Group(None) where it is made"]
        yield _text(f"let several runs of {queue.handler} overlap:", *made)


def _apart_from_the_lock(lock: str, holder: ActivityView) -> Iterator[str]:
    """Yield the remedy for a lock whose holder waits: hold it for less code, or always take locks in one order."""
    wait, other = "await" if holder.is_async else "wait", holder.wait
    if isinstance(other, SetBy) and other.is_held:
        if other.what != lock:
            yield _text(f"take {lock} and {other.what} in the same order everywhere")
        elif holder.is_async:
            yield _text(f"do not take {lock} again in {holder.line}:", "asyncio's locks cannot be entered twice")
        else:
            yield _text(f"let {lock} be a threading.RLock(), which can be entered again from within")
        return
    yield _text(f"move the {wait} in {holder.line}", f"to where it does not hold {lock}")


def _off_the_loop(edge: Edge, graph: WaitGraph) -> Iterator[str]:
    """Yield the remedies for an activity that blocks the event loop."""
    blocker = graph.activities[edge.to]
    wait = "await the call" if isinstance(edge.via, Call) else "await, as in `await self.clock.sleep(0.05)`,"
    yield _text(f"{wait} in {blocker.line}")
    if blocker.is_async:  # only a `def` handler can run in a thread
        return
    handler = blocker.handler
    regrouping = Thread(blocker.node, (handler,)).made_in(graph.regrouping(blocker.node))
    yield _text(
        f"let {handler} run in a thread,",
        regrouping.where,
        yaml=regrouping.lines(blocker.node, "      "),
        instead=("or in the class:", f"thread=True where {handler} is declared"),
    )


def _release(activity: ActivityView, wanted: GroupView | None) -> Iterator[str]:
    """Yield the remedy that releases an activity's slot during its wait, if the one before it in the ring wants it."""
    if wanted is not None and wanted.name and not wanted.sort and activity.is_async:
        yield _text(
            f"release the slot while waiting, in {activity.line}:",
            "async with self.group.released(): ...",
            "(self.group is the group of the running handler)",
        )


def _larger(group: GroupView, limit: Limit, graph: WaitGraph) -> str:
    made = f"Group({limit.limit}{', thread=True' if group.is_threaded else ''})"
    text = "allow more runs, if its handlers share no state"
    if not group.is_declared:
        return _text(f"{text}:", f"{made} where {group.node} makes the group called {group.name} here")
    regrouping = limit.made_in(graph.regrouping(group.node))
    yaml = regrouping.lines(group.node, "      ")
    return _text(f"{text},", regrouping.where, yaml=yaml, instead=(f"or in the class: {group.name} = {made}",))


def _text(*clauses: str, yaml: Sequence[str] = (), instead: Sequence[str] = ()) -> str:
    """Format a remedy: a sentence, the lines to paste, and an alternative to them."""
    return "\n".join([*filled("  ", clauses), *yaml, *(filled("    ", instead) if instead else [])])

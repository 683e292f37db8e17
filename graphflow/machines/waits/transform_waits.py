"""Waits for transforms, as waits for the handlers that send some."""

from __future__ import annotations

from dataclasses import replace

from graphflow.machines.waits.wait_graph import (
    FREE,
    All,
    AnyOf,
    Condition,
    SetBy,
    TransformWait,
    WaitGraph,
    parts_of,
)


def resolved(graph: WaitGraph) -> WaitGraph:
    """Replace the waits for transforms: each waits for the handlers and activities that may send some.

    Where the snapshot lacks a process with nodes, or no code is seen to send the very transform, something else may end
    the wait, such as a node that has yet to start: it is `FREE`.
    """
    if not any(isinstance(part, TransformWait) for a in graph.activities.values() for part in parts_of(a.wait)):
        return graph
    senders = _Senders(graph)
    waiting = {id_: replace(a, wait=senders.replaced(a.wait)) for id_, a in graph.activities.items()}
    return replace(graph, activities=waiting)


class _Senders:
    """The handlers and activities of a snapshot that may send transforms."""

    def __init__(self, graph: WaitGraph) -> None:
        self._processes = {q.process for q in graph.queues.values()} | {a.process for a in graph.activities.values()}
        self._queues = [queue for queue in graph.queues.values() if queue.sends is not None]
        self._activities = [activity for activity in graph.activities.values() if activity.sends is not None]

    def replaced(self, condition: Condition) -> Condition:
        """Return a condition with its waits for transforms replaced."""
        match condition:
            case TransformWait():
                return self._senders_of(condition)
            case All(of=parts):
                return All(tuple(map(self.replaced, parts)))
            case AnyOf(of=parts):
                return AnyOf(tuple(map(self.replaced, parts)))
        return condition

    def _senders_of(self, wait: TransformWait) -> Condition:
        queues = {queue.id: set(queue.sends or ()) for queue in self._queues if wait.node in ("", queue.node)}
        running = {one.id: set(one.sends or ()) for one in self._activities if wait.node in ("", one.node)}
        texts = [*queues.values(), *running.values()]
        sends_it = bool(texts) if wait.node else any(found.issuperset(wait.frames) for found in texts)
        if not sends_it or not self._processes.issuperset(wait.processes):
            return FREE
        return SetBy(wait.what, tuple(sorted(queues)), tuple(sorted(running)), verb="sends")

"""The vertices of a snapshot: stable ids for runs, tasks, queues and groups, and the calls behind queued items.

Ids begin with the process's session id, so that snapshots of several processes can be merged, and are never reused, on
which the comparison of two rounds relies.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from graphflow.deadlock.asyncio_frames import TaskLike
from graphflow.deadlock.protocols import ProcessContext, Subject
from graphflow.errors import DecodeError
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Run, Runner
from graphflow.machines.waits.wait_graph import GroupView, call_id, goal_id
from graphflow.wire import attachment

Item: TypeAlias = Any
"""Item of a runner's queue: a request, a goal, a reply or a message, by the runner's kind."""


class Vertices:
    """The ids of one snapshot, and its groups.

    Args:
        zid: The id of the process's session.
        number_of: Returns the number of a task, which no other task ever has.
    """

    def __init__(self, zid: str, number_of: Callable[[TaskLike], int]) -> None:
        self._zid, self._number_of = zid, number_of
        self.groups: dict[str, GroupView] = {}
        """Groups that were named so far, by id."""

    def run_id(self, run: Run) -> str:
        """Return the id of a run."""
        return f"{self._zid}:{run.number}"

    def task_id(self, task: TaskLike) -> str:
        """Return the id of a task or a run."""
        return self.run_id(task) if isinstance(task, Run) else f"{self._zid}:t{self._number_of(task)}"

    def queue_id(self, runner: Runner) -> str:
        """Return the id of a runner's queue."""
        return f"{self._zid}:q{runner.number}"

    def slots(self, node: Subject, runner: Runner, group: HandlerGroup | None) -> tuple[str, ...]:
        """Add the groups of which a run in `group` takes a slot, its own queue included; return their ids."""
        named = () if group is None else (self.group_id(node, group),)
        if not runner.is_serial:
            return named
        own = f"{self._zid}:own{runner.number}"
        self.groups[own] = GroupView(own, "", node.full_name, 1)
        return (*named, own)

    def group_id(self, node: Subject, group: HandlerGroup) -> str:
        """Add a group; return its id."""
        id_ = f"{self._zid}:{node.full_name}:{group.name}"
        # A group that cancels its running handler for a new one is never full for good.
        limit = None if group.when_full == "cancel_running" else group.limit
        name = group.name if group in node.groups.by_name.values() else ""  # a group of the runtime's own
        is_declared = name in node.groups.known
        self.groups[id_] = GroupView(id_, name, node.full_name, limit, is_declared, group.is_threaded)
        return id_


def call_of(runner: Runner, item: Item) -> str:
    """Return the id of the call or goal that an item of a queue stands for; empty if it is neither."""
    if runner.spec.kind == "service":
        try:
            sequence, _, gid = attachment.fields((item.attachment or b"")[: attachment.SIZE])
        except DecodeError:
            return ""
        return call_id(gid, sequence)
    if runner.spec.kind == "reply":
        return str(item.call)
    return goal_id(item.goal_id) if runner.spec.kind == "action" else ""


def arrived_calls(process: ProcessContext) -> dict[int, list[str]]:
    """Return the calls that have arrived but not reached the loop, by the number of the runner they are for."""
    found: dict[int, list[str]] = {}
    for runner, gid, sequence in process.arrived():
        found.setdefault(runner.number, []).append(call_id(gid, sequence))
    return found

"""The start of a node as a resource: `on_start` holds a slot that every handler of the node needs.

Handlers begin, and services open, when `on_start` has returned. In the wait-for graph it therefore acts as a group of
limit 1 that the start holds.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePath

from graphflow.analysis.user_code import innermost
from graphflow.deadlock.asyncio_frames import TaskLike, frames_of
from graphflow.deadlock.protocols import Subject
from graphflow.errors import Place
from graphflow.machines.waits.wait_graph import GroupView, QueueView


def start_of(node: Subject, zid: str) -> GroupView:
    """Return the group that `on_start` of a node holds until it returns."""
    return GroupView(f"{zid}:{node.full_name}:on_start", "", node.full_name, is_start=True)


def place_of(task: TaskLike | None) -> str:
    """Return the user's line at which a suspended task waits: `(drive.py:12 in on_start)`; empty if there is none."""
    frame = None if task is None else innermost(frames_of(task))
    if frame is None:
        return ""
    return f"({Place(PurePath(frame.f_code.co_filename).name, frame.f_lineno)} in {frame.f_code.co_name})"


def unopened(node: Subject, zid: str) -> Iterator[QueueView]:
    """Yield a queue for each handler that a node will run once its `on_start` has returned; none exists yet."""
    if node.starting is None:
        return
    start = start_of(node, zid).id
    for number, part in enumerate(node.unopened):
        name = f"{start}:{number}"
        yield QueueView(name, part.title, node.full_name, (start,), process=zid, opens=part.services)

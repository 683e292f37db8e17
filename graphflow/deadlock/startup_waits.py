"""What `on_start` keeps out: handlers begin and services open when it has returned, as if it held a slot they need."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePath
from typing import Any

from graphflow.analysis.user_code import innermost
from graphflow.deadlock.asyncio_frames import frames_of
from graphflow.deadlock.protocols import Subject
from graphflow.errors import Place
from graphflow.machines.waits.wait_graph import GroupView, QueueView


def start_of(node: Subject, zid: str) -> GroupView:
    """What `on_start` of a node holds until it returns."""
    return GroupView(f"{zid}:{node.full_name}:on_start", "", node.full_name, is_start=True)


def place_of(task: Any) -> str:
    """The user's line in which a suspended task waits: `(drive.py:12 in on_start)`; empty if there is none."""
    frame = innermost(frames_of(task))
    if frame is None:
        return ""
    return f"({Place(PurePath(frame.f_code.co_filename).name, frame.f_lineno)} in {frame.f_code.co_name})"


def unopened(node: Subject, zid: str) -> Iterator[QueueView]:
    """The queues of what a node will run once its `on_start` has returned; none of them is there yet."""
    if node.starting is None:
        return
    start = start_of(node, zid).id
    for number, part in enumerate(node.unopened):
        name = f"{start}:{number}"
        yield QueueView(name, part.title, node.full_name, (start,), process=zid, opens=part.services)

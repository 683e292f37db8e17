"""How waits are reached: from an activity, through the tasks that it waits for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from graphflow.deadlock import asyncio_frames as aio
from graphflow.deadlock.frames import Frame
from graphflow.deadlock.protocols import Subject


@dataclass(frozen=True, slots=True)
class Way:
    """How a wait was reached: from a run of a handler, through the tasks that it waits for."""

    node: Subject
    root: Any
    """The activity."""
    frames: tuple[Frame, ...] = ()
    """The frames of all of them, the outermost first."""
    tasks: frozenset[int] = frozenset()
    """The ids of those tasks."""
    is_bounded: bool = False
    """Whether one of them gives up after some time, or may."""


class Subtask(NamedTuple):
    """A task of the user's that an activity waits for, directly or through others."""

    task: Any
    limit_ns: int | None
    """When the first of those that wait for it gives up, in nanoseconds of the clock."""
    is_bounded: bool
    """Whether one of them gives up after some time, or may."""


def subtasks(activity: Any, limit_of: Callable[[Any], int | None]) -> Iterator[Subtask]:
    """The tasks that an activity waits for, and those that they wait for.

    Args:
        limit_of: Says when a task gives up waiting.
    """
    seen = {id(activity)}
    todo = [Subtask(activity, None, False)]
    while todo:
        above = todo.pop()
        found = [task for task in aio.awaited_tasks(above.task) if id(task) not in seen]
        if not found:
            continue
        seen |= set(map(id, found))
        limit_ns = min((n for n in (above.limit_ns, limit_of(above.task)) if n is not None), default=None)
        is_bounded = above.is_bounded or limit_ns is not None or aio.may_give_up(above.task)
        below = [Subtask(task, limit_ns, is_bounded) for task in found]
        yield from below
        todo += below

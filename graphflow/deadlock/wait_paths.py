"""Paths from an activity to its wait, through the tasks that it waits for.

Tasks that a user creates are not vertices of the wait-for graph by themselves: `await task` is followed into the task,
and its wait becomes the activity's. `WaitPath` records the tasks on the way, so that none is followed twice, and their
deadlines; `subtasks` enumerates the tasks at the other end.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from graphflow.analysis.frames import Frame
from graphflow.deadlock import asyncio_frames as aio
from graphflow.deadlock.asyncio_frames import TaskLike
from graphflow.deadlock.closed_world.wakers import method_of
from graphflow.deadlock.protocols import Subject
from graphflow.executor.clock import ClockTimeout
from graphflow.times import to_ns

LimitOf: TypeAlias = Callable[[TaskLike], int | None]
"""Function for the time at which a task gives up waiting, in nanoseconds of the clock; None for never."""


@dataclass(frozen=True, slots=True)
class WaitPath:
    """The path from a run of a handler to its wait, through the tasks that it waits for."""

    node: Subject
    root: TaskLike | None
    """The activity; None for a handler that runs synchronously on the loop."""
    frames: tuple[Frame, ...] = ()
    """Frames of the activity and of the tasks, the outermost first."""
    tasks: frozenset[int] = frozenset()
    """Ids (`id()`) of the activity and the tasks."""
    is_bounded: bool = False
    """Whether one of them has a deadline, or may have one."""


class Subtask(NamedTuple):
    """A task of the user's that an activity waits for, directly or through others."""

    task: TaskLike
    limit_ns: int | None
    """Time of the first deadline of the tasks that wait for it, in nanoseconds of the clock."""
    is_bounded: bool
    """Whether one of them has a deadline, or may have one."""


def subtasks(activity: TaskLike, limit_of: LimitOf) -> Iterator[Subtask]:
    """Yield the tasks that an activity waits for, and those that they wait for."""
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


def gathered(
    methods: AbstractSet[str],
    activities: Iterable[TaskLike],
    limit_of: LimitOf,
    loop: asyncio.AbstractEventLoop,
) -> list[Subtask] | None:
    """Return the tasks of some methods that activities wait for.

    Returns:
        None if other tasks run these methods, too: when one part of a `gather` fails, the rest run on unawaited.
    """
    found = [below for above in activities for below in subtasks(above, limit_of) if method_of(below.task) in methods]
    known = {id(below.task) for below in found}
    living = [task for task in asyncio.all_tasks(loop) if method_of(task) in methods]
    return found if all(id(task) in known for task in living) else None


def limit_of(task: TaskLike, now_ns: int, now: float) -> int | None:
    """Return the time at which a task gives up waiting, in nanoseconds of the clock; None for never.

    Args:
        now_ns: The time by that clock.
        now: The time by the loop's clock, which asyncio's timeouts use.
    """
    found: list[float] = []
    for coroutine in aio.coroutines(task):
        found += aio.deadlines(coroutine)
        for context in aio.entered(coroutine):
            if isinstance(context, ClockTimeout):
                return context.until_ns
    seconds = min(found, default=None)
    return None if seconds is None else now_ns + to_ns(max(0.0, seconds - now))

"""How waits are reached: from an activity, through the tasks that it waits for."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from typing import Any, NamedTuple

from graphflow.analysis.frames import Frame
from graphflow.deadlock import asyncio_frames as aio
from graphflow.deadlock.closed_world.wakers import method_of
from graphflow.deadlock.protocols import Subject
from graphflow.executor.clock import ClockTimeout
from graphflow.times import to_ns


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


def gathered(
    methods: AbstractSet[str],
    activities: Iterable[Any],
    limit_of: Callable[[Any], int | None],
    loop: asyncio.AbstractEventLoop,
) -> list[Subtask] | None:
    """The tasks of some methods that activities wait for.

    Returns:
        None if there are others: a `gather` in which one fails leaves the rest behind.
    """
    found = [below for above in activities for below in subtasks(above, limit_of) if method_of(below.task) in methods]
    known = {id(below.task) for below in found}
    living = [task for task in asyncio.all_tasks(loop) if method_of(task) in methods]
    return found if all(id(task) in known for task in living) else None


def limit_of(task: Any, now_ns: int, now: float) -> int | None:
    """When a task gives up waiting, in nanoseconds of the clock; None for never.

    Args:
        now_ns: The time by that clock.
        now: The time by the loop's.
    """
    found: list[float] = []
    for coroutine in aio.coroutines(task):
        found += aio.deadlines(coroutine)
        for context in aio.entered(coroutine):
            if isinstance(context, ClockTimeout):
                return context.until_ns
    seconds = min(found, default=None)
    return None if seconds is None else now_ns + to_ns(max(0.0, seconds - now))

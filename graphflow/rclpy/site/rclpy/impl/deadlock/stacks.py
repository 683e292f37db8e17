"""What the threads of this process are doing, read from their stacks: whose callbacks they run, and who spins."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from types import FrameType
from typing import Any

from graphflow.analysis.frames import Frame, stack_from
from graphflow.analysis.user_code import is_ours, is_users
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.spinning import Run, Spinning

_STEP = Run._step.__code__
_NEXT = Spinning.next.__code__
_SPINS = (
    SingleThreadedExecutor._graphflow_do_one.__code__,
    MultiThreadedExecutor._graphflow_do_one.__code__,
    Executor.spin_until_future_complete.__code__,
)
_OURS = ("graphflow-", "executor-")
"""How the names of threads begin that run no code of users', or only an executor's."""


@dataclass
class Level:
    """A part of a thread's stack: a run of a callback and what it has called, or what comes before the first."""

    run: Run | None
    frames: list[Frame] = field(default_factory=list)
    """The outermost first."""
    waiting: Any = None
    """The executor that waits for something to do in it."""

    @property
    def innermost(self) -> Frame | None:
        """The last frame of the user's own code."""
        return next((f for f in reversed(self.frames) if is_users(f.f_code.co_filename)), None)


@dataclass
class Stack:
    """What a thread is doing."""

    thread: threading.Thread
    levels: list[Level]
    """The outermost first; each but the first is one run of a callback."""
    spins: list[Executor]
    """The executors that it spins."""
    is_given: bool
    """Whether it spins for as long as the context lasts."""

    @property
    def is_idle(self) -> bool:
        """Whether it waits for something to do, and for nothing else."""
        return self.levels[-1].waiting is not None and self.levels[-1].run is None

    @property
    def is_users(self) -> bool:
        """Whether it is a thread of the program's own: none of a pool."""
        return not self.thread.name.startswith(_OURS)

    @property
    def may_spin(self) -> bool:
        """Whether the program's own code may yet have it spin what nobody spins."""
        return self.is_users and not (self.is_idle and self.is_given)


def stacks() -> Iterator[Stack]:
    """Those of all threads that run code of users', or that spin."""
    frames = sys._current_frames()
    me = threading.get_ident()
    for thread in threading.enumerate():
        frame = frames.get(thread.ident or 0)
        if frame is None or thread.ident == me or thread.name.startswith("graphflow-"):
            continue
        if isinstance(thread, threading._DummyThread) or thread.name.endswith("(pyo3-closure)"):  # Zenoh's
            continue
        stack = _read(thread, frame)
        if stack.is_users or len(stack.levels) > 1:
            yield stack


def _read(thread: threading.Thread, innermost: FrameType) -> Stack:
    levels, spins, is_given = [Level(None)], list[Executor](), False
    for frame in stack_from(innermost):
        if frame.f_code is _STEP:
            levels.append(Level(frame.f_locals["self"]))
        elif frame.f_code in _SPINS:
            spins.append(frame.f_locals["self"])
        elif frame.f_code.co_name == "spin" and is_ours(frame.f_code.co_filename):
            is_given = True
        levels[-1].frames.append(frame)
        if frame.f_code is _NEXT:
            levels[-1].waiting = frame.f_locals["self"].executor
    return Stack(thread, levels, spins, is_given)


def standing() -> dict[int, tuple[int, int]]:
    """Where threads stand that run code of users': the identity of the innermost frame of it, and the line, by thread.

    It costs a walk along the end of each stack. Threads that only wait for something to do are left out.
    """
    found: dict[int, tuple[int, int]] = {}
    for thread, innermost in sys._current_frames().items():
        frame: FrameType | None = innermost
        while frame is not None and frame.f_code is not _NEXT:
            if is_users(frame.f_code.co_filename):
                found[thread] = id(frame), frame.f_lineno
                break
            frame = frame.f_back
        else:
            if frame is not None and is_in_run(frame):  # it spins within a callback
                found[thread] = id(frame), 0
    return found


def is_in_run(frame: FrameType) -> bool:
    """Whether a callback, not the thread itself, has called what runs in a frame."""
    above: FrameType | None = frame
    while above is not None:
        if above.f_code is _STEP:
            return True
        above = above.f_back
    return False

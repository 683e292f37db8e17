"""The threads of this process, read from their stacks: the callbacks they run, and the executors they spin."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from types import FrameType

from graphflow.analysis.frames import Frame, stack_from, uncollected
from graphflow.analysis.user_code import is_ours, is_users
from rclpy.executors import SPINS, Executor
from rclpy.impl.spinning import STEP, Run, Spinning

_NEXT = Spinning.next.__code__
_OURS = ("graphflow-", "executor-")
"""Prefixes of the names of threads that run no user code, or only an executor's."""


@dataclass
class Level:
    """A section of a thread's stack: a callback's run and its calls, or the part before the first run."""

    run: Run | None
    frames: list[Frame] = field(default_factory=list)
    """The frames, outermost first."""
    waiting: object = None
    """The executor that waits for work in this section."""

    @property
    def innermost(self) -> Frame | None:
        """The innermost frame of user code."""
        return next((f for f in reversed(self.frames) if is_users(f.f_code.co_filename)), None)


@dataclass
class Stack:
    """The stack of a thread."""

    thread: threading.Thread
    levels: list[Level]
    """The sections, outermost first; each but the first is one run of a callback."""
    spins: list[Executor]
    """The executors that the thread spins."""
    is_given: bool
    """Whether it spins for as long as the context lasts."""

    @property
    def is_idle(self) -> bool:
        """Whether it waits only for work."""
        return self.levels[-1].waiting is not None and self.levels[-1].run is None

    @property
    def is_users(self) -> bool:
        """Whether it is one of the program's own threads: not a pool's."""
        return not self.thread.name.startswith(_OURS)

    @property
    def may_spin(self) -> bool:
        """Whether the program's own code may still spin what nothing spins yet."""
        return self.is_users and not (self.is_idle and self.is_given)


def stacks() -> Iterator[Stack]:
    """Return the stacks of all threads that run user code, or that spin."""
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
        if frame.f_code is STEP:
            levels.append(Level(frame.f_locals["self"]))
        elif frame.f_code in SPINS:
            spins.append(frame.f_locals["self"])
        elif frame.f_code.co_name == "spin" and is_ours(frame.f_code.co_filename):
            is_given = True
        levels[-1].frames.append(frame)
        if frame.f_code is _NEXT:
            levels[-1].waiting = frame.f_locals["self"].executor
    return Stack(thread, levels, spins, is_given)


def standing() -> dict[int, tuple[int, int]]:
    """Return, by thread, the identity and line of the innermost frame of user code.

    The cost is a walk along the end of each stack. Threads that only wait for work are omitted.
    """
    found: dict[int, tuple[int, int]] = {}
    with uncollected():
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
    """Whether a frame's code was called by a callback, not by the thread itself."""
    above: FrameType | None = frame
    while above is not None:
        if above.f_code is STEP:
            return True
        above = above.f_back
    return False

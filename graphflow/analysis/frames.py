"""Safe copies of frames, for code that inspects coroutines and threads while they run.

The locals of a coroutine's frame lie in the coroutine object. CPython 3.13 reads freed memory if they are requested
after the coroutine was closed (gh-125723), which another thread may do at any moment. Hence nothing keeps a frame to
read it later: a `Frame` is a copy, made while the coroutine is known to be suspended. Between that test and the copy
there must be no call and no loop, because only at those does CPython switch to another thread; CPython 3.11 also does
in a garbage collection, which `uncollected` holds back.
"""

from __future__ import annotations

import gc
import inspect
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from types import CodeType, CoroutineType, FrameType, GeneratorType
from typing import Any

_OWNED = inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR
"""Flags of code whose frames lie in a generator or coroutine object."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A copy of a frame at one moment, with CPython's names. Copies of one frame are equal."""

    f_code: CodeType
    f_lineno: int
    f_locals: dict[str, Any]
    """Local variables; empty if they could not be read safely."""
    f_globals: dict[str, Any]
    original: FrameType
    """The frame itself, for comparisons; its locals must not be read."""
    f_lasti: int = -1
    """Offset of the current instruction; negative if it is not known."""

    @property
    def column(self) -> int | None:
        """Start of the current expression in its line, as syntax trees count it; None if it is not known."""
        positions = islice(self.f_code.co_positions(), max(self.f_lasti, 0) // 2, None)
        return next((column for _, _, column, _ in positions), None) if self.f_lasti >= 0 else None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Frame) and self.original is other.original

    def __hash__(self) -> int:
        return id(self.original)


@contextmanager
def uncollected() -> Iterator[None]:
    """Hold garbage collection back while frames of other threads are read; needed in CPython 3.11 alone.

    There a collection begins within any allocation, even inside `f_locals` and `f_back`, and runs the callbacks of weak
    references, so that other threads run: a function returns, and its frame is then read where it no longer is. From
    3.12 on a collection begins between two instructions only.
    """
    if sys.version_info >= (3, 12) or not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def running(frame: FrameType) -> Frame:
    """Copy a frame from the stack of a thread, which may run on meanwhile.

    A function's frame outlives the function. A generator's frame has a caller as long as it runs, and keeps it when it
    ends by itself; one without a caller is suspended or was closed, and its locals are left alone.
    """
    code, lineno, lasti = frame.f_code, frame.f_lineno or 0, frame.f_lasti
    names: dict[str, Any] = {}
    if not code.co_flags & _OWNED or frame.f_back is not None:
        names = {**frame.f_locals}
    return Frame(code, lineno, names, frame.f_globals, frame, lasti)


def suspended(owner: object) -> Frame | None:
    """Copy the frame of a suspended coroutine or generator; None for one that has ended, or for another object.

    The two branches differ in an attribute only, yet must not share code: a call in between could switch threads.
    """
    with uncollected():
        if isinstance(owner, CoroutineType):
            frame = owner.cr_frame
            if frame is None:
                return None
            names = {**frame.f_locals}
        elif isinstance(owner, GeneratorType):
            frame = owner.gi_frame
            if frame is None:
                return None
            names = {**frame.f_locals}
        else:
            return None
    return Frame(frame.f_code, frame.f_lineno or 0, names, frame.f_globals, frame, frame.f_lasti)


def code_of(owner: object) -> CodeType | None:
    """Return the code of a suspended coroutine or generator; None for one that has ended, or for another object."""
    # By attribute: Cython's coroutines have them, too, and are instances of none of CPython's types.
    frame = getattr(owner, "cr_frame", None) or getattr(owner, "gi_frame", None) or getattr(owner, "ag_frame", None)
    return None if frame is None else frame.f_code


def awaited(owner: object) -> Iterator[object]:
    """Yield a suspended coroutine and those that it awaits, the outermost first.

    An asynchronous generator ends the chain: whoever iterates over it can leave its loops at any `yield`, so they say
    nothing about the wait.
    """
    while owner is not None:
        yield owner
        owner = getattr(owner, "cr_await", None) or getattr(owner, "gi_yieldfrom", None)


def stack_of(thread: int) -> list[Frame]:
    """Copy the frames of a running thread, the outermost first."""
    return stack_from(sys._current_frames().get(thread))


def stack_from(innermost: FrameType | None) -> list[Frame]:
    """Copy a frame of a running thread and its callers, the outermost first."""
    frames: list[Frame] = []
    frame = innermost
    with uncollected():
        while frame is not None:
            frames.append(running(frame))
            frame = frame.f_back
    return frames[::-1]

"""Copies of frames, taken while the owner of their locals is known to be there.

The locals of a generator's or coroutine's frame lie in the generator. CPython 3.13 reads freed memory when it is asked
for them after the generator was closed (gh-125723), which another thread may do at any moment. So nothing keeps a frame
to look into it later: a `Frame` is a copy, made where no other thread can run in between. Between the look at the owner
and the copy there is no call and no loop, and only at those does CPython let another thread have the GIL.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from types import CodeType, CoroutineType, FrameType, GeneratorType
from typing import Any

_OWNED = inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR
"""Flags of code whose frames lie in a generator of some kind."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A frame as it was at one moment, under the names that CPython uses. Copies of one frame are equal."""

    f_code: CodeType
    f_lineno: int
    f_locals: dict[str, Any]
    """Empty where they could not be read safely."""
    f_globals: dict[str, Any]
    original: FrameType
    """To compare frames by; never to be read."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Frame) and self.original is other.original

    def __hash__(self) -> int:
        return id(self.original)


def running(frame: FrameType) -> Frame:
    """Copy a frame from the stack of a thread, which may run on meanwhile.

    A function's frame survives its end. A generator's has a caller as long as it runs, and keeps it if it ends by
    itself; one without a caller is suspended or was closed, and is not looked into.
    """
    code, lineno = frame.f_code, frame.f_lineno or 0
    names: dict[str, Any] = {}
    if not code.co_flags & _OWNED or frame.f_back is not None:
        names = {**frame.f_locals}
    return Frame(code, lineno, names, frame.f_globals, frame)


def suspended(owner: Any) -> Frame | None:
    """Copy the frame of a suspended coroutine or generator; None for one that has ended, or is of another kind."""
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
    return Frame(frame.f_code, frame.f_lineno or 0, names, frame.f_globals, frame)


def code_of(owner: Any) -> CodeType | None:
    """The code of a suspended coroutine or generator; None for one that has ended, or is of another kind."""
    frame = getattr(owner, "cr_frame", None) or getattr(owner, "gi_frame", None) or getattr(owner, "ag_frame", None)
    return None if frame is None else frame.f_code


def awaited(owner: Any) -> Iterator[Any]:
    """A suspended coroutine and those that it awaits, the outermost first.

    They end before an asynchronous generator: its loops can be left by who iterates over it, and so tell nothing.
    """
    while owner is not None:
        yield owner
        owner = getattr(owner, "cr_await", None) or getattr(owner, "gi_yieldfrom", None)


def stack_of(thread: int) -> list[Frame]:
    """The frames of a running thread, the outermost first."""
    return stack_from(sys._current_frames().get(thread))


def stack_from(innermost: FrameType | None) -> list[Frame]:
    """A frame of a running thread and those that called it, the outermost first."""
    frames: list[Frame] = []
    frame = innermost
    while frame is not None:
        frames.append(running(frame))
        frame = frame.f_back
    return frames[::-1]

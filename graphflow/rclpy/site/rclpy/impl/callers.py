"""The line of user code that made a call, and its use of the call's result."""

from __future__ import annotations

import dis
import sys
from itertools import pairwise, takewhile
from types import FrameType
from typing import NamedTuple

from graphflow.analysis.user_code import is_users, short_place
from graphflow.errors import Place


class Caller(NamedTuple):
    """A line of user code."""

    frame: FrameType
    line: int
    """The line's number at the time of the call; the frame moves on."""

    @property
    def place(self) -> Place:
        """The line as `file.py:12`."""
        return short_place(self.frame.f_code.co_filename, self.line)

    @property
    def drops_result(self) -> bool:
        """Whether the code discards the result of the call it is in."""
        later = (step for step in dis.get_instructions(self.frame.f_code) if step.offset > self.frame.f_lasti)
        return next((step.opname for step in later), "") == "POP_TOP"

    @property
    def is_chained(self) -> bool:
        """Whether the code calls a method on the result of the call it is in, as in `ask().result()`."""
        # `f_lasti` is the offset of the call that is under way; it needs no source, which may have changed.
        steps = [s for s in dis.get_instructions(self.frame.f_code) if s.offset <= self.frame.f_lasti]
        before = [s.opname for s in steps if s.opname not in _FILLERS]
        return len(before) > 2 and before[-2] in ("LOAD_METHOD", "LOAD_ATTR") and before[-3].startswith("CALL")

    @property
    def reads(self) -> set[str]:
        """The attributes that the code reads of the call's result, directly or through its variable."""
        steps = [s for s in dis.get_instructions(self.frame.f_code) if s.opname not in _FILLERS]
        later = [s for s in steps if s.offset > self.frame.f_lasti]
        if not later or later[0].opname in _READS:
            return {s.argval for s in later[:1]}
        if not later[0].opname.startswith(_STORES):
            return set()
        name = _names(later[0])[0]
        kept = takewhile(lambda s: s is later[0] or not (s.opname.startswith(_STORES) and name in _names(s)), later)
        return {
            reads.argval
            for step, reads in pairwise(kept)
            if reads.opname in _READS and any(word in step.opname for word in _LOADS) and _names(step)[-1] == name
        }


def _names(step: dis.Instruction) -> tuple[str, ...]:
    """Return the variables of an instruction; some instructions store one and load another."""
    return step.argval if isinstance(step.argval, tuple) else (step.argval,)


_READS = ("LOAD_ATTR", "LOAD_METHOD")
_LOADS = ("LOAD_FAST", "LOAD_NAME", "LOAD_GLOBAL", "LOAD_DEREF")
_STORES = ("STORE_FAST", "STORE_NAME", "STORE_GLOBAL", "STORE_DEREF")
_FILLERS = ("CACHE", "PRECALL", "PUSH_NULL", "EXTENDED_ARG")
"""Instructions that some versions of Python insert between others."""


def caller(depth: int) -> Caller | None:
    """Return the code `depth` frames above; None if it is graphflow's or Python's own."""
    frame = sys._getframe(depth + 1)
    return Caller(frame, frame.f_lineno) if is_users(frame.f_code.co_filename) else None


def stack_level() -> int:
    """Return the `stacklevel` with which a warning names the user's line; 1 if there is none."""
    frame: FrameType | None = sys._getframe(1)
    level = 1
    while frame is not None:
        if is_users(frame.f_code.co_filename):
            return level
        frame, level = frame.f_back, level + 1
    return 1

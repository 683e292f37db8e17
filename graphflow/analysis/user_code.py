"""Which code is the user's own, for errors and reports to point at."""

from __future__ import annotations

import asyncio
import inspect
import linecache
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path, PurePath
from types import FrameType, TracebackType
from typing import NamedTuple

from graphflow.analysis.frames import Frame
from graphflow.errors import Place

_OURS = str(Path(__file__).parents[1])
_DEMOS = str(Path(_OURS, "demos"))
"""Where an installed graphflow has its nodes, which are as users would write them."""
_NOT_THEIRS = ("graphflow", "rclpy", "builtins", "typing", "abc")
_COMPILED = (".pyx", ".pxi")
"""Ends of the files that Cython names in tracebacks; they are relative, and seldom there."""
_PYTHONS = sysconfig.get_path("stdlib")


def is_users_module(name: str) -> bool:
    """Whether a module holds classes of users; the nodes that come with graphflow count as theirs."""
    return name.partition(".")[0] not in _NOT_THEIRS or name.startswith("graphflow.nodes.")


def is_users_object(thing: object) -> bool:
    """Whether something is of a class of the user's, with attributes of its own; a node's message is none."""
    file = getattr(sys.modules.get(type(thing).__module__), "__file__", None)
    return file is not None and is_users(file) and hasattr(thing, "__dict__")


def is_users(file: str) -> bool:
    """Whether a source file is neither graphflow's nor Python's own, nor that of compiled code, such as uvloop's."""
    is_made = file.startswith("<") and "/" in file  # <std_msgs/msg/String>: a codec
    if is_ours(file) or is_made or file.startswith("<frozen") or file.endswith(_COMPILED):
        return False
    return not file.startswith(_PYTHONS) or "site-packages" in file


def _is_users_frame(frame: FrameType) -> bool:
    """Whether a frame is of the user's code; a method that `dataclass` writes belongs to the module of its class."""
    file = frame.f_code.co_filename
    return is_users(file) and (file != "<string>" or is_users_module(frame.f_globals.get("__name__", "")))


def is_installed(file: str) -> bool:
    """Whether a source file belongs to an installed package."""
    return not {"site-packages", "dist-packages"}.isdisjoint(PurePath(file).parts)


def is_ours(file: str) -> bool:
    """Whether a source file is graphflow's own."""
    return file.startswith(_OURS) and not file.startswith(_DEMOS)


def short_place(file: str, line: int) -> Place:
    """A line of a file, which goes by its name alone: `lamp.py:12`."""
    return Place(PurePath(file).name, line)


def innermost(frames: Iterable[Frame]) -> Frame | None:
    """The last of the frames that is the user's own code; the outermost comes first."""
    found = None
    for frame in frames:
        if is_users(frame.f_code.co_filename):
            found = frame
    return found


def users_frame(frame: FrameType | None) -> FrameType | None:
    """A frame, or the nearest of those that have led to it, that is the user's own code; None where there is none."""
    while frame is not None and not is_users(frame.f_code.co_filename):
        frame = frame.f_back
    return frame


def called_by_loop(frames: Sequence[Frame]) -> Sequence[Frame]:
    """The part of a stack that an event loop has called; all of it where there is none."""
    begun = [i for i, frame in enumerate(frames) if frame.f_code is asyncio.Runner.run.__code__]
    return frames[begun[-1] + 1 :] if begun else frames


class Pause(NamedTuple):
    """Where a loop that polls pauses. A thread that runs it may be seen anywhere in it, but is there nearly always."""

    frame: Frame
    line: int


class Where(NamedTuple):
    """Where something waits, for reports."""

    place: Place
    """The user's own code."""
    function: str
    is_async: bool
    """Whether `await` is allowed there."""
    called: str
    """The line by which the node's method came to wait elsewhere: `drive.py:12 in tick`; empty if it waits itself."""


def where(frames: Sequence[Frame], instance: object, pause: Pause | None = None) -> Where:
    """Where code waits whose frames, the outermost first, these are.

    Args:
        instance: The node.
        pause: That of the loop in which it waits, if one of the frames is the loop's.
    """
    line = None
    if pause is not None and pause.frame in frames:
        frames, line = frames[: frames.index(pause.frame) + 1], pause.line
    frame = innermost(frames)
    if frame is None:
        return Where(Place(""), "", False, "")
    place = Place(frame.f_code.co_filename, line or frame.f_lineno)
    is_async = bool(frame.f_code.co_flags & inspect.CO_COROUTINE)
    return Where(place, frame.f_code.co_name, is_async, _called_in(frames, instance))


def _called_in(frames: Iterable[Frame], instance: object) -> str:
    own = [frame for frame in frames if is_users(frame.f_code.co_filename)]
    of_it = [frame for frame in own if frame.f_locals.get("self") is instance]
    if not of_it or of_it[0] is own[-1]:
        return ""
    code = of_it[0].f_code
    return f"{Place(PurePath(code.co_filename).name, of_it[0].f_lineno)} in {code.co_name}"


def users_part(error: BaseException) -> TracebackType | None:
    """An error's traceback without graphflow's frames, as far as it goes through the user's; whole if it does not.

    It ends with the frames in which the error was raised, unless graphflow's code has raised it in words of its own:
    then it is about what the user's last line has asked for.
    """
    parts = list(parts_of(error.__traceback__))
    own = [place for place, part in enumerate(parts) if _is_users_frame(part.tb_frame)]
    end = own[-1] + 1 if own and is_refusal(parts[-1]) else len(parts)
    begins = next((i for i, part in enumerate(parts) if not is_ours(part.tb_frame.f_code.co_filename)), 0)
    last = own[-1] if own else begins
    kept = None
    for place, part in reversed([*enumerate(parts)][begins:end]):
        if place >= last or not is_ours(part.tb_frame.f_code.co_filename):
            kept = TracebackType(kept, part.tb_frame, part.tb_lasti, part.tb_lineno)
    return kept


def parts_of(trace: TracebackType | None) -> Iterator[TracebackType]:
    """The frames of a traceback, the outermost first."""
    while trace is not None:
        yield trace
        trace = trace.tb_next


def is_refusal(part: TracebackType, *words: str) -> bool:
    """Whether graphflow's code has raised an error in words of its own here: about arguments of the caller's.

    Args:
        words: Statements besides `raise` that do so, such as `assert`.
    """
    code = part.tb_frame.f_code
    is_own = is_ours(code.co_filename) or not (is_users(code.co_filename) or code.co_filename.startswith(_PYTHONS))
    line = linecache.getline(code.co_filename, part.tb_lineno).lstrip()
    return is_own and line.startswith(tuple(f"{word} " for word in ("raise", *words)))


def place_in(error: BaseException) -> str:
    """The last line of the user's own code that an error passed through, as `file:line`; empty if there is none.

    Lines of installed packages count only where there is no other: the user's nodes may be installed.
    """
    place, is_theirs, trace = "", False, error.__traceback__
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if _is_users_frame(trace.tb_frame) and not (is_theirs and is_installed(file)):
            place, is_theirs = f"{file}:{trace.tb_lineno}", not is_installed(file)
        trace = trace.tb_next
    return place

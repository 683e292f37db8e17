"""The border between users' code and libraries, so that errors and reports point to a line of the user's."""

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
from graphflow.errors import GraphFileError, Place

_OURS = str(Path(__file__).parents[1])
_DEMOS = str(Path(_OURS, "demos"))
"""Folder of the demo nodes, which are written like users' and count as theirs."""
_NOT_THEIRS = ("graphflow", "rclpy", "builtins", "typing", "abc")
_COMPILED = (".pyx", ".pxi")
"""Suffixes of the files that Cython names in tracebacks; they are relative, and seldom exist."""
_PYTHONS = sysconfig.get_path("stdlib")
_LOOPS = (asyncio.Runner.run.__code__, asyncio.BaseEventLoop.run_forever.__code__)
"""Functions that run an event loop; uvloop's have no frames."""


def is_users_module(name: str) -> bool:
    """Whether a module is a user's; the nodes that come with graphflow count as users'."""
    return name.partition(".")[0] not in _NOT_THEIRS or name.startswith("graphflow.nodes.")


def is_users_object(thing: object) -> bool:
    """Whether an object has a class of the user's, and attributes of its own; a message has not."""
    file = getattr(sys.modules.get(type(thing).__module__), "__file__", None)
    return file is not None and is_users(file) and hasattr(thing, "__dict__")


def is_users(file: str) -> bool:
    """Whether a source file is neither graphflow's, nor Python's own, nor one of compiled code, such as uvloop's."""
    is_made = file.startswith("<") and "/" in file  # <std_msgs/msg/String>: a codec
    if is_ours(file) or is_made or file.startswith("<frozen") or file.endswith(_COMPILED):
        return False
    return not file.startswith(_PYTHONS) or "site-packages" in file


def is_users_frame(frame: Frame | FrameType) -> bool:
    """Whether a frame is of the user's code, and not of a method that `dataclass` or `namedtuple` has generated."""
    code = frame.f_code
    if code.co_filename != "<string>":
        return is_users(code.co_filename)
    module = str(frame.f_globals.get("__name__", ""))
    is_generated = code.co_qualname.startswith("__create_fn__.") or module.startswith("namedtuple_")
    return is_users_module(module) and not is_generated


def is_installed(file: str) -> bool:
    """Whether a source file belongs to an installed package."""
    return not {"site-packages", "dist-packages"}.isdisjoint(PurePath(file).parts)


def is_ours(file: str) -> bool:
    """Whether a source file is graphflow's own."""
    return file.startswith(_OURS) and not file.startswith(_DEMOS)


def short_place(file: str, line: int) -> Place:
    """Return the place of a line without the file's folder: `lamp.py:12`."""
    return Place(PurePath(file).name, line)


def innermost(frames: Iterable[Frame]) -> Frame | None:
    """Return the last of the frames that is the user's own code; the outermost frame comes first."""
    found = None
    for frame in frames:
        if is_users_frame(frame):
            found = frame
    return found


def users_frame(frame: FrameType | None) -> FrameType | None:
    """Return the nearest frame of the user's own code, among a frame and its callers; None if there is none."""
    while frame is not None and not is_users_frame(frame):
        frame = frame.f_back
    return frame


def variable_of(thing: object, frames: Iterable[Frame | FrameType], otherwise: str) -> str:
    """Return the name of a local variable that holds an object, of the first frame that has one.

    Args:
        otherwise: The result if none of them has.
    """
    held = (name for frame in frames for name, value in list(frame.f_locals.items()) if value is thing)
    return next(held, otherwise)


def called_by_loop(frames: Sequence[Frame]) -> Sequence[Frame]:
    """Return the part of a stack that an event loop has called; the whole stack if no loop is in it."""
    begun = [i for i, frame in enumerate(frames) if frame.f_code in _LOOPS]
    return frames[begun[-1] + 1 :] if begun else frames


class Pause(NamedTuple):
    """The line at which a polling loop pauses: a snapshot may find its thread at any line, but nearly always there."""

    frame: Frame
    line: int


class Where(NamedTuple):
    """The position of a wait in the user's code, for reports."""

    place: Place
    function: str
    is_async: bool
    """Whether `await` is allowed there."""
    called: str
    """Line at which the node's method called the function that waits: `drive.py:12 in tick`; empty if it is its own."""


def where(frames: Sequence[Frame], instance: object, pause: Pause | None = None) -> Where:
    """Return the position of a wait.

    Args:
        frames: The frames of the code that waits, the outermost first.
        instance: The node.
        pause: The pause of the polling loop in which it waits, if it is in one.
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
    own = [frame for frame in frames if is_users_frame(frame)]
    of_it = [frame for frame in own if frame.f_locals.get("self") is instance]
    if not of_it or of_it[0] is own[-1]:
        return ""
    code = of_it[0].f_code
    return f"{Place(PurePath(code.co_filename).name, of_it[0].f_lineno)} in {code.co_name}"


def users_part(error: BaseException) -> TracebackType | None:
    """Return an error's traceback without graphflow's frames; the whole one if it contains no frame of the user's.

    It ends with the frames in which the error was raised. If graphflow's code raised the error itself, to refuse an
    argument, it ends with the user's last line, which the error is about.
    """
    parts = list(parts_of(error.__traceback__))
    own = [place for place, part in enumerate(parts) if is_users_frame(part.tb_frame)]
    end = own[-1] + 1 if own and is_refusal(parts[-1]) else len(parts)
    begins = next((i for i, part in enumerate(parts) if not is_ours(part.tb_frame.f_code.co_filename)), 0)
    last = own[-1] if own else begins
    kept = None
    for place, part in reversed([*enumerate(parts)][begins:end]):
        if place >= last or not is_ours(part.tb_frame.f_code.co_filename):
            kept = TracebackType(kept, part.tb_frame, part.tb_lasti, part.tb_lineno)
    return kept


def parts_of(trace: TracebackType | None) -> Iterator[TracebackType]:
    """Yield the parts of a traceback, the outermost first."""
    while trace is not None:
        yield trace
        trace = trace.tb_next


def is_refusal(part: TracebackType, *statements: str) -> bool:
    """Whether library code raised an error here by a statement of its own, about arguments of the caller.

    Args:
        statements: Keywords besides `raise` that do so, such as `assert`.
    """
    code = part.tb_frame.f_code
    is_own = is_ours(code.co_filename) or not (is_users(code.co_filename) or code.co_filename.startswith(_PYTHONS))
    line = linecache.getline(code.co_filename, part.tb_lineno).lstrip()
    return is_own and line.startswith(tuple(f"{keyword} " for keyword in ("raise", *statements)))


def place_in(error: BaseException) -> str:
    """Return the last line of the user's own code that an error passed through, as `file:line`; empty if none.

    Lines of installed packages count only if there is no other: the user's nodes may be installed. An error about a
    file has places there, which say more than that of the line that read it.
    """
    if isinstance(error, GraphFileError):
        return ""
    place, is_theirs, trace = "", False, error.__traceback__
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if is_users_frame(trace.tb_frame) and not (is_theirs and is_installed(file)):
            place, is_theirs = f"{file}:{trace.tb_lineno}", not is_installed(file)
        trace = trace.tb_next
    return place

"""Which code is the user's own, for errors and reports to point at."""

from __future__ import annotations

import sysconfig
from collections.abc import Iterable
from pathlib import Path
from types import FrameType, TracebackType

_OURS = str(Path(__file__).parents[1])
_PYTHONS = sysconfig.get_path("stdlib")


def is_users(file: str) -> bool:
    """Whether a source file is neither graphflow's nor Python's own."""
    if file.startswith((_OURS, "<frozen")) or (file.startswith("<") and "/" in file):  # <std_msgs/msg/String>: a codec
        return False
    return not file.startswith(_PYTHONS) or "site-packages" in file


def innermost(frames: Iterable[FrameType]) -> FrameType | None:
    """The last of the frames that is the user's own code; the outermost comes first."""
    found = None
    for frame in frames:
        if is_users(frame.f_code.co_filename):
            found = frame
    return found


def users_part(error: BaseException) -> TracebackType | None:
    """An error's traceback without graphflow's frames at its beginning; whole if there are no others."""
    rest = error.__traceback__
    while rest is not None and rest.tb_frame.f_code.co_filename.startswith(_OURS):
        rest = rest.tb_next
    return rest or error.__traceback__


def place_in(error: BaseException) -> str:
    """The last line of the user's own code that an error passed through, as `file:line`; empty if there is none."""
    place, trace = "", error.__traceback__
    while trace is not None:
        if is_users(trace.tb_frame.f_code.co_filename):
            place = f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}"
        trace = trace.tb_next
    return place

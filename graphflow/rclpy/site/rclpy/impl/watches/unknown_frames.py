"""Lookups that fail again and again: of a frame that does not exist, or of a time whose transform is on its way.

Programs log their errors without the notes.
"""

from __future__ import annotations

import logging
import sys
import time

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.errors import ExtrapolationError, TransformError, UnknownFrame

WARN_AFTER = 5.0
"""Seconds from the first failed lookup of a frame: its first transform may be on its way."""
GAP = 2.5
"""Longest pause in seconds between failed lookups of a time that count as one series."""
AHEAD_NS = 10**9
"""Nanoseconds by which a requested time may be later than the newest transform, as `now()` is."""
_FRAMES_BOUND = 100
_AHEAD = ""
_WAYS = (
    "as with now(): ask for the newest one, rclpy.time.Time(), or wait, timeout=Duration(seconds=1.0), in a "
    "MultiThreadedExecutor(num_threads=2)"
)
logger = logging.getLogger("graphflow")


class UnknownFrames:
    """The frames of one buffer that were looked up in vain."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}
        self._told: set[str] = set()
        self._last = 0.0
        """The monotonic time of the latest failed lookup."""

    def lookup_failed(self, error: TransformError) -> None:
        """Note a failed lookup; report its frame once, with the known ones, or that it asks for a time too early."""
        if isinstance(error, UnknownFrame):
            what, text = error.frame, str(error)
        elif isinstance(error, ExtrapolationError) and 0 < error.requested_ns - error.newest_ns < AHEAD_NS:
            what, text = _AHEAD, f"the transform for that time is not there yet, {_WAYS}"
        else:
            return
        now = time.monotonic()
        if what == _AHEAD and now - self._last > GAP:
            self._since.pop(what, None)  # only now and then
        self._last = now
        if what in self._told or len(self._since) >= _FRAMES_BOUND:
            return
        if now - self._since.setdefault(what, now) < WARN_AFTER:
            return
        self._told.add(what)
        frame = users_frame(sys._getframe(1))
        place = "" if frame is None else f"{short_place(frame.f_code.co_filename, frame.f_lineno)}: "
        logger.warning("%s%s", place, text)

    def lookup_succeeded(self) -> None:
        """Note that a lookup has found its transform, so that the time it asks for is not too early for good."""
        self._since.pop(_AHEAD, None)

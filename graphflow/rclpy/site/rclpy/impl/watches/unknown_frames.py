"""Lookups that fail since a frame does not exist, as a misspelt one: programs log their errors without its notes."""

from __future__ import annotations

import logging
import sys
import time

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.errors import TransformError, UnknownFrame

WARN_AFTER = 5.0
"""Seconds from the first failed lookup of a frame: its first transform may be on its way."""
_FRAMES_BOUND = 100
logger = logging.getLogger("graphflow")


class UnknownFrames:
    """The frames of one buffer that were looked up in vain."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}
        self._told: set[str] = set()

    def lookup_failed(self, error: TransformError) -> None:
        """Note a failed lookup; report its frame once, with the known ones."""
        if not isinstance(error, UnknownFrame) or len(self._since) >= _FRAMES_BOUND or error.frame in self._told:
            return
        now = time.monotonic()
        if now - self._since.setdefault(error.frame, now) < WARN_AFTER:
            return
        self._told.add(error.frame)
        frame = users_frame(sys._getframe(1))
        place = "" if frame is None else f"{short_place(frame.f_code.co_filename, frame.f_lineno)}: "
        logger.warning("%s%s", place, error)

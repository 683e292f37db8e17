"""Loops that go on for as long as a server is there, as in `while client.wait_for_service():`, told as they run."""

from __future__ import annotations

import atexit
import logging
from contextlib import suppress
from types import CodeType, FrameType

from graphflow.analysis.user_code import short_place

logger = logging.getLogger("graphflow")
_loops: set[CodeType] = set()
"""The functions with such a loop that has been told."""


def is_reported(code: CodeType) -> bool:
    """Whether such a loop of a function has been told."""
    return code in _loops


class Successes:
    """The successful waits of one client."""

    def __init__(self) -> None:
        self._last: tuple[CodeType, int] | None = None
        """The function and line that waited last."""

    def note(self, frame: FrameType) -> None:
        """Note a wait in a frame; warn if the frame waits again in the same line, and that is such a loop's.

        The warning comes again when the program ends, since the output of the loop hides the first.
        """
        last, self._last = self._last, (frame.f_code, frame.f_lineno)
        if last != self._last or is_reported(frame.f_code):
            return
        from graphflow.analysis.mistakes.calls.inverted_waits import inverted_waits  # most programs never need it
        from graphflow.analysis.syntax import syntax_of

        with suppress(OSError, SyntaxError, ValueError):  # its source is not available
            file = frame.f_code.co_filename
            if text := dict(inverted_waits(syntax_of(file).module)).get(frame.f_lineno):
                _loops.add(frame.f_code)
                told = f"{short_place(file, frame.f_lineno)}: {text}"
                logger.warning("%s", told)
                atexit.register(logger.warning, "%s", told)

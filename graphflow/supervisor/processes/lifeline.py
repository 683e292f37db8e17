"""The lifeline between `graphflow up` and its supervisor: a pipe that shows the end of the command."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from contextlib import suppress

LET_GO = b"-"
"""The byte by which the command lets the graph outlive it."""


class Lifeline:
    """The supervisor's end of the lifeline.

    Args:
        pipe: The reading end.
        cut: As for `on_cut`, until that is called.
    """

    def __init__(self, pipe: int, cut: Callable[[], object]) -> None:
        self._pipe = pipe
        self._cut = cut
        self._left: Callable[[], object] = _ignore

    def watch(self) -> None:
        """Start watching, on a thread; the preload process must have been forked before, from a single thread."""
        threading.Thread(target=self._wait, name="graphflow-lifeline", daemon=True).start()

    def _wait(self) -> None:
        with suppress(OSError):
            if os.read(self._pipe, 1) == LET_GO:
                os.read(self._pipe, 1)  # until the command ends
                self._left()
                return
        self._cut()

    def on_cut(self, cut: Callable[[], object], left: Callable[[], object] | None = None) -> None:
        """Set the functions to call, on any thread, when the command ends.

        Args:
            cut: Called if the command has not let go.
            left: Called if it has.
        """
        self._cut, self._left = cut, left or _ignore


def _ignore() -> None:
    """Do nothing about a command that has let go."""

"""The lifeline between `graphflow up` and its supervisor: a pipe whose other end shows how the command ends."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from contextlib import suppress

LET_GO = b"-"
"""What the command sends over the lifeline to let the graph go on without it."""


class Lifeline:
    """The supervisor's end of the lifeline.

    Args:
        pipe: Where the command's end shows.
        told: As for `on_cut`, until that is called.
    """

    def __init__(self, pipe: int, told: Callable[[], object]) -> None:
        self._pipe = pipe
        self._told = told
        self._left: Callable[[], object] = _nothing

    def watch(self) -> None:
        """Begin to watch it, on a thread of its own; which must not be before the preload process is forked."""
        threading.Thread(target=self._wait, name="graphflow-lifeline", daemon=True).start()

    def _wait(self) -> None:
        with suppress(OSError):
            if os.read(self._pipe, 1) == LET_GO:
                os.read(self._pipe, 1)
                self._left()
                return
        self._told()

    def on_cut(self, told: Callable[[], object], left: Callable[[], object] | None = None) -> None:
        """Have functions called, on any thread, when the command ends from now on.

        Args:
            told: For one that has not let go.
            left: For one that has.
        """
        self._told, self._left = told, left or _nothing


def _nothing() -> None:
    """Nobody needs to know that the command has ended."""

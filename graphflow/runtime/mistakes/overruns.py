"""Timers whose runs keep outlasting their periods, so that most periods are silently skipped."""

from __future__ import annotations

from collections.abc import Iterable

from graphflow.deadlock.asyncio_frames import TaskLike
from graphflow.deadlock.startup_waits import place_of
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS

RUNS = 3
"""Successive overruns before a warning: the first run or two may only be slow to start."""
SECONDS = 3.0
"""Total seconds of these runs before a warning."""
_WAY = "give it a longer period, or start the long work with self.spawn(...)"


class Overruns:
    """The overruns of one timer.

    Args:
        title: The timer's name in messages.
    """

    def __init__(self, host: Host, title: str) -> None:
        self._host, self._title = host, title
        self._runs = 0
        """Successive overruns so far."""
        self._skipped = 0
        """Periods skipped since the first of them."""
        self._since_ns = 0
        self._text = ""
        self._has_warned = False

    def begins(self, skipped: int) -> None:
        """Note the start of a run.

        Args:
            skipped: Periods skipped by the previous run.
        """
        if not skipped:
            self._runs = self._skipped = 0
            self._text = ""

    def in_the_way(self, runs: Iterable[TaskLike], skipped: int, now_ns: int, period_ns: int) -> None:
        """Note that a run has outlasted a period and continues.

        Args:
            runs: The run, if it can be inspected.
            skipped: Periods skipped by now.
        """
        if skipped == 1:
            if not self._runs:
                self._since_ns = now_ns
            self._runs += 1
        self._skipped += 1
        seconds = (now_ns - self._since_ns) / NANOSECONDS
        if self._runs < RUNS or seconds < SECONDS or self._text:
            return
        place = next(filter(None, map(place_of, runs)), "")
        every = f"{period_ns / NANOSECONDS:g} s"
        self._text = (
            f"{self._title} is due every {every}, but its runs take longer{place and ' '}{place}; "
            f"{self._skipped} periods were skipped in {seconds:.1f} s: {_WAY}"
        )
        if not self._has_warned:
            self._has_warned = True
            self._host.log.warning("%s", self._text)

    def complaints(self) -> list[str]:
        """Return the warnings about the timer."""
        return [self._text] if self._text else []

"""Timers whose own runs take longer than their periods, again and again: most periods are skipped, without an error."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from graphflow.deadlock.startup_waits import place_of
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS

RUNS = 3
"""Runs in a row that outlast a period before that is told: one or two may be what only the first needs."""
SECONDS = 3.0
"""Seconds that they have taken together by then."""
_WAY = "give it a longer period, or start what takes long by self.spawn(...)"


class Overruns:
    """The runs of one timer that have outlasted its period.

    Args:
        title: The timer's name in messages.
    """

    def __init__(self, host: Host, title: str) -> None:
        self._host, self._title = host, title
        self._runs = 0
        """In a row, up to now."""
        self._skipped = 0
        """Periods since the first of them."""
        self._since_ns = 0
        self._text = ""
        self._is_told = False

    def begins(self, skipped: int) -> None:
        """A run begins.

        Args:
            skipped: Periods that the run before it has outlasted.
        """
        if not skipped:
            self._runs = self._skipped = 0
            self._text = ""

    def in_the_way(self, runs: Iterable[Any], skipped: int, now_ns: int, period_ns: int) -> None:
        """A run goes on that has outlasted a period.

        Args:
            runs: That run, while it can be looked at.
            skipped: Periods that it has outlasted by now.
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
            f"{self._title} is due every {every}, and its runs take longer{place and ' '}{place}; "
            f"{self._skipped} periods were skipped in {seconds:.1f} s: {_WAY}"
        )
        if not self._is_told:
            self._is_told = True
            self._host.log.warning("%s", self._text)

    def complaints(self) -> list[str]:
        """What is to be said of the timer now."""
        return [self._text] if self._text else []

"""QoS events of an endpoint: counterparts, incompatible policies, missed deadlines, lost messages and liveliness.

Source: rmw's event types; DDS 1.4, 2.2.4.1 (statuses).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

from graphflow.executor.clock import Alarm, Clock

QosEventKind = Literal[
    "matched",
    "incompatible_qos",
    "incompatible_type",
    "message_lost",
    "deadline_missed",
    "liveliness_changed",
    "liveliness_lost",
]


class QosEvent(NamedTuple):
    """An event that an endpoint detected."""

    kind: QosEventKind
    total: int
    """Number of occurrences at this endpoint; for `message_lost`, of messages."""
    change: int = 1
    """Increase of `total` by this event; for `matched` and `liveliness_changed`, of `current`, where it may be -1."""
    current: int = 0
    """For `matched`: the current counterparts. For `liveliness_changed`: the alive publishers."""
    detail: str = ""
    """The counterpart's node, or the incompatible policies."""


OnEvent = Callable[[QosEvent], object]


class SilenceTimer:
    """A timer that calls `silent` once per period without a `touch`.

    A touch only reads the clock; the pending alarm computes the time since then.
    """

    __slots__ = ("_alarm", "_clock", "_last_ns", "_period_ns", "_silent")

    def __init__(self, clock: Clock, period_ns: int, silent: Callable[[], None]) -> None:
        self._clock, self._period_ns, self._silent = clock, period_ns, silent
        self._last_ns = 0
        self._alarm: Alarm | None = None

    @property
    def is_running(self) -> bool:
        return self._alarm is not None

    def start(self) -> None:
        """Start a period. Starting twice is harmless."""
        if self._alarm is None:
            self.touch()
            self._arm()

    def touch(self) -> None:
        """Note a sign of life."""
        self._last_ns = self._clock.monotonic_ns()

    def stop(self) -> None:
        """Stop until the next `start`."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def move(self, clock: Clock) -> None:
        """Switch to another clock and restart a pending period."""
        was_running = self.is_running
        self.stop()
        self._clock = clock
        if was_running:
            self.start()

    def _arm(self) -> None:
        self._alarm = self._clock.call_at(self._last_ns + self._period_ns, self._look)

    def _look(self) -> None:
        if self._clock.monotonic_ns() >= self._last_ns + self._period_ns:
            self.touch()
            self._arm()
            self._silent()
        else:
            self._arm()

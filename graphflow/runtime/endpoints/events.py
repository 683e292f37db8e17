"""What an endpoint notices about the other end: what came and went, what does not fit, what is late, lost or silent.

Source: rmw's event types; DDS 1.4, 2.2.4.1 (statuses).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NamedTuple

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
    """One thing an endpoint noticed."""

    kind: QosEventKind
    total: int
    """How often the event has happened to this endpoint; for `message_lost`, the number of messages."""
    change: int = 1
    """By how much `total` has grown with this event; for `matched` and `liveliness_changed`, `current`: may be -1."""
    current: int = 0
    """For `matched`: current counterparts. For `liveliness_changed`: publishers that are alive."""
    detail: str = ""
    """The counterpart's node, or the policies that do not fit."""


OnEvent = Callable[[QosEvent], Any]


class SilenceTimer:
    """Calls `silent` once a period for as long as `touch` is not called.

    A touch costs one look at the clock: the pending alarm finds out how long it has been.
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
        """Begin a period. Starting twice is harmless."""
        if self._alarm is None:
            self.touch()
            self._arm()

    def touch(self) -> None:
        """Something was heard."""
        self._last_ns = self._clock.monotonic_ns()

    def stop(self) -> None:
        """Stop watching, until the next `start`."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def move(self, clock: Clock) -> None:
        """Switch to another clock; a period under way begins again."""
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

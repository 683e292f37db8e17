"""Timers, and the rates at which they pace threads."""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from graphflow.rclpy.wake import Wake
from rclpy._rclpy_pybind11 import RCLError, TimerCancelledError
from rclpy.callback_groups import CallbackGroup
from rclpy.clock import Clock
from rclpy.exceptions import InvalidHandle, ROSInterruptException
from rclpy.handle import Handle
from rclpy.impl.mistakes.origins import Created
from rclpy.impl.mistakes.timer_arguments import warn_of_argument
from rclpy.impl.reexports import passed_on
from rclpy.time import Time
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from graphflow.rclpy.node_bridge import NodeBell
    from rclpy.clock_type import ClockType
    from rclpy.context import Context


class TimerInfo:
    """The times at which a call was due, and at which it came."""

    def __init__(self, *, expected_call_time: int, actual_call_time: int, clock_type: ClockType) -> None:
        self.expected_call_time = Time(nanoseconds=max(0, expected_call_time), clock_type=clock_type)
        self.actual_call_time = Time(nanoseconds=actual_call_time, clock_type=clock_type)


class Timer(Created):
    """Has an executor call `callback` periodically by a clock. Missed periods are skipped; the phase is kept.

    Args:
        callback: Takes no argument, or a `TimerInfo`.
        autostart: Whether it starts at once, or at its first `reset`.

    Raises:
        RCLError: The period is negative.
    """

    def __init__(
        self,
        callback: Callable[..., object] | None,
        callback_group: CallbackGroup | None,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
        bell: NodeBell | None = None,
    ) -> None:
        self._context = get_default_context() if context is None else context
        if timer_period_ns < 0:
            raise RCLError("Failed to create timer: timer period must be non-negative")
        self._clock, self._period_ns, self._bell = clock, int(timer_period_ns), bell
        self._is_canceled = not autostart
        self._lock = threading.Lock()
        self._last_ns = clock.now_ns()
        self._next_ns = self._last_ns + self._period_ns
        self._handle = Handle(_nothing)
        self._callback: Callable[..., object] | None = None
        self._takes_info = False
        self.callback = callback
        self.callback_group = callback_group
        clock.watch(self)

    @property
    def callback(self) -> Callable[..., object] | None:
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., object] | None) -> None:
        self._callback = value
        self._takes_info = value is not None and _takes_one(value)
        if value is not None and self._takes_info:
            warn_of_argument(value)

    @property
    def handle(self) -> Handle:
        return self._handle

    @property
    def clock(self) -> Clock:
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        with self._lock:
            self._period_ns = int(value)
        self._recheck()

    def is_ready(self) -> bool:
        """Whether a call is due."""
        with self._handle:
            return not self._is_canceled and self._clock.now_ns() >= self._next_ns

    def is_canceled(self) -> bool:
        with self._handle:
            return self._is_canceled

    def cancel(self) -> None:
        """Stop the timer until `reset`."""
        with self._handle:
            self._is_canceled = True

    def reset(self) -> None:
        """Start a new period now."""
        with self._handle, self._lock:
            self._is_canceled = False
            self._last_ns = self._clock.now_ns()
            self._next_ns = self._last_ns + self._period_ns
        self._recheck()

    def time_since_last_call(self) -> int:
        """Return the nanoseconds since the last call."""
        with self._handle:
            return self._clock.now_ns() - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Return the nanoseconds until the next call; negative if overdue, None for a cancelled timer."""
        with self._handle:
            return None if self._is_canceled else self._next_ns - self._clock.now_ns()

    def clock_moved(self) -> None:
        """React to a jump of the clock, which may make the timer due."""
        now_ns = self._clock.now_ns()
        with self._lock:
            # Else it would stand still until the clock has caught up; rcl starts a new period there, too.
            if self._next_ns - now_ns > self._period_ns:  # it went back
                self._last_ns, self._next_ns = now_ns, now_ns + self._period_ns
        self._recheck()

    def _recheck(self) -> None:
        if self._bell is not None:
            self._bell.wake()

    def seconds_left(self) -> float | None:
        """Return the seconds until it is due; None if that does not depend on this machine's time."""
        # /clock wakes the executor by `clock_moved`; a wait by the wall clock would only poll.
        if self._is_canceled or self._handle.is_destroyed or self._clock.is_set_from_outside:
            return None
        return (self._next_ns - self._clock.now_ns()) / 1e9

    def has_work(self) -> bool:
        return not self._handle.is_destroyed and self.is_ready()

    def take_work(self) -> Callable[[], object] | None:
        """Take the call that is due."""
        with self._lock:
            now_ns = self._clock.now_ns()
            if self._is_canceled or self._handle.is_destroyed or now_ns < self._next_ns:
                return None
            expected_ns, self._last_ns = self._next_ns, now_ns
            # Whole periods are added, so the phase is kept; a period of 0 is due again at once.
            behind = (now_ns - self._next_ns) // self._period_ns if self._period_ns else 0
            self._next_ns += self._period_ns * (behind + 1)
        # After the period was advanced: the timer would be due for ever otherwise.
        if self.callback is None:
            return None
        if self._takes_info:
            kind = self._clock.clock_type
            info = TimerInfo(expected_call_time=expected_ns, actual_call_time=now_ns, clock_type=kind)
            return partial(self.callback, info)
        return self.callback

    def destroy(self) -> None:
        """End the timer. Call `Node.destroy_timer` instead."""
        self._handle.destroy_when_not_in_use()


def _takes_one(callback: Callable[..., object]) -> bool:
    """Whether a callback takes a `TimerInfo`."""
    try:
        inspect.signature(callback).bind()
    except TypeError:
        return True
    except ValueError:  # no signature to be read
        return False
    return False


class Rate:
    """Paces a thread: `sleep` returns once per period. The timer's executor must be spinning meanwhile."""

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer, self._context = timer, context
        self._sleepers: dict[Wake, None] = {}
        self._has_ticked = False
        """Whether the timer has fired since the last sleep: the next one then returns at once."""
        self._lock = threading.Lock()
        self._is_destroyed = False
        timer.callback = self._tick

    @property
    def timer(self) -> Timer:
        """The timer that paces it. graphflow's own."""
        return self._timer

    def _tick(self) -> None:
        with self._lock:
            self._has_ticked = True
            for sleeper in self._sleepers:
                sleeper.set()

    def destroy(self) -> None:
        """End all sleeps. Call `Node.destroy_rate` instead."""
        self._is_destroyed = True
        self._timer.destroy()
        self._tick()

    def sleep(self) -> None:
        """Block until the timer fires; return at once if it has fired since the last sleep.

        Raises:
            ROSInterruptException: The context was shut down.
        """
        life = self._context.life
        if life is None or not life.is_ok:
            raise ROSInterruptException
        if self._is_destroyed:
            raise InvalidHandle("the rate was destroyed")
        if self._timer.is_canceled():
            raise TimerCancelledError("the timer of the rate was cancelled")
        wake = Wake()
        with self._lock:
            self._sleepers[wake] = None
            if self._has_ticked:
                wake.set()
        life.on_end(wake)
        try:
            wake.wait()
        finally:
            life.forget(wake)
            with self._lock:
                del self._sleepers[wake]
                # As rclpy's event, which the last sleeper clears: a tick while nobody sleeps counts for the next.
                self._has_ticked &= bool(self._sleepers)
        if not life.is_ok:
            raise ROSInterruptException


def _nothing() -> None:
    """Do nothing."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

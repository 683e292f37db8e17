"""Clocks: wall time, simulated time, and monotonic time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, Self, TypedDict
from weakref import WeakSet

from graphflow.rclpy.wake import Wake
from rclpy._rclpy_pybind11 import ClockChange
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.exceptions import NotInitializedException
from rclpy.handle import Handle
from rclpy.time import Time
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from rclpy.context import Context

__all__ = ["Clock", "ClockChange", "ClockType", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]


class JumpThreshold:
    """The jumps of a clock that a callback wants to be notified of.

    Args:
        min_forward: The smallest forward jump to report; None for none. Must be positive.
        min_backward: The smallest backward jump to report; None for none. Must be negative.
        on_clock_change: Whether to report that simulated time begins or ends.

    Raises:
        ValueError: A duration has the wrong sign, or no jump at all is selected.
    """

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward, self.min_backward, self.on_clock_change = min_forward, min_backward, on_clock_change

    def covers(self, change: ClockChange, delta_ns: int) -> bool:
        """Whether a jump is to be reported."""
        if change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        ahead = self.min_forward is not None and delta_ns >= self.min_forward.nanoseconds
        return ahead or (self.min_backward is not None and delta_ns <= self.min_backward.nanoseconds)


class TimeJump:
    """A jump of a clock."""

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        self._clock_change, self._delta = clock_change, delta

    @property
    def clock_change(self) -> ClockChange:
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """The size of the jump."""
        return self._delta


class TimeJumpDictionary(TypedDict):
    """A jump as rcl reports it."""

    clock_change: ClockChange
    delta: int


class JumpHandle:
    """A registration for jumps, until it is unregistered."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[..., None] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        if pre_callback is not None and not callable(pre_callback):
            raise ValueError("pre_callback must be callable if given")
        if post_callback is not None and not callable(post_callback):
            raise ValueError("post_callback must be callable if given")
        self._clock: Clock | None = clock
        self.threshold, self.pre_callback, self.post_callback = threshold, pre_callback, post_callback
        clock.jump_handles.append(self)

    def unregister(self) -> None:
        """Stop being notified. Idempotent."""
        clock, self._clock = self._clock, None
        if clock is not None:
            clock.jump_handles.remove(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()


class Watches(Protocol):
    """An observer of a clock's movements: a timer's executor, or a sleeping thread."""

    def clock_moved(self) -> None: ...


class Clock:
    """A clock of some type; for ROS_TIME, a `ROSClock` is created. Raises TypeError unless given a `ClockType`."""

    _clock_type: ClockType
    jump_handles: list[JumpHandle]
    _watching: WeakSet[Any]
    _override_ns: int
    _is_overridden: bool
    _handle: Handle
    _moving: threading.RLock

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Self:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        # As in rclpy: only a ROSClock has an override, which a clock of ROS time needs.
        kind: Any = ROSClock if clock_type is ClockType.ROS_TIME and not issubclass(cls, ROSClock) else cls
        self: Self = object.__new__(kind)
        self._clock_type = clock_type
        self.jump_handles = []
        self._watching = WeakSet()
        self._override_ns = 0
        self._is_overridden = False
        self._handle = Handle(_nothing)
        self._moving = threading.RLock()
        return self

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        """Do nothing: `__new__` initializes everything, for subclasses that skip `__init__`."""

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    @property
    def handle(self) -> Handle:
        return self._handle

    def __repr__(self) -> str:
        return f"Clock(clock_type={self.clock_type.name})"

    def now_ns(self) -> int:
        """The time in nanoseconds."""
        if self._clock_type is ClockType.STEADY_TIME:
            return time.monotonic_ns()
        return self._override_ns if self._is_overridden else time.time_ns()

    def now(self) -> Time:
        """Return the current time."""
        return Time(nanoseconds=self.now_ns(), clock_type=self._clock_type)

    @property
    def is_set_from_outside(self) -> bool:
        """Whether the clock shows a time that is set from outside, and stands still in between."""
        return self._is_overridden

    def watch(self, watcher: Watches) -> None:
        """Notify `watcher` whenever simulated time moves, begins or ends."""
        self._watching.add(watcher)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Call `pre_callback()` before and `post_callback(TimeJump)` after each jump that the threshold covers."""
        after = post_callback
        if after is not None and callable(after):
            wanted = after

            def adapted(jump: TimeJumpDictionary) -> None:
                wanted(TimeJump(jump["clock_change"], Duration(nanoseconds=jump["delta"])))

            return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=adapted)
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=after)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Sleep until a time of this clock.

        Returns:
            Whether that time was reached: False if the context was shut down, or simulated time began or ended.

        Raises:
            ValueError: The time is of another clock type.
            NotInitializedException: The context is not initialized, or has ended.
        """
        context = get_default_context() if context is None else context
        life = context.life
        if life is None or not context.ok():
            raise NotInitializedException
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        # Before the time is read, so that a jump in between wakes the sleep.
        sleeper = _Sleeper(self)
        life.on_end(sleeper.wake)
        was_overridden = self._is_overridden
        try:
            # rclpy ends a sleep when simulated time begins or ends: `until` would mean another time from then on.
            while context.ok() and self._is_overridden is was_overridden:
                left_ns = until.nanoseconds - self.now_ns()
                if left_ns <= 0:
                    return True
                sleeper.wake.wait(None if self._is_overridden else left_ns / 1e9)
            return False
        finally:
            life.forget(sleeper.wake)

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Sleep for a duration of this clock's time. Returns and raises as `sleep_until`."""
        until_ns = max(0, self.now_ns() + rel_time.nanoseconds)
        return self.sleep_until(Time(nanoseconds=until_ns, clock_type=self._clock_type), context)


class _Sleeper:
    def __init__(self, clock: Clock) -> None:
        self.wake = Wake()
        clock.watch(self)

    def clock_moved(self) -> None:
        self.wake.set()


class ROSClock(Clock):
    """The clock of nodes: wall time, or simulated time if `use_sim_time` is true."""

    def __new__(cls, **_: object) -> Self:
        return super().__new__(cls, clock_type=ClockType.ROS_TIME)

    def __init__(self, **_: object) -> None:
        """Take no arguments: the type is ROS_TIME."""

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clock shows the time set by `set_ros_time_override`."""
        return self._is_overridden

    def activate_override(self, enabled: bool) -> None:
        """Begin or end to show the time set by `set_ros_time_override`. graphflow's own."""
        if enabled is self._is_overridden:
            return
        change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
        self._jump(change, 0, lambda: setattr(self, "_is_overridden", enabled))

    def _set_ros_time_is_active(self, enabled: bool) -> None:  # rclpy's name, which tests of programs use
        self.activate_override(enabled)

    def set_ros_time_override(self, time: Time) -> None:
        """Set the time that the clock shows while its override is active."""
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time).__name__}")
        new_ns = time.nanoseconds
        delta_ns = new_ns - self._override_ns if self._is_overridden else 0
        self._jump(ClockChange.ROS_TIME_NO_CHANGE, delta_ns, lambda: setattr(self, "_override_ns", new_ns))

    def _jump(self, change: ClockChange, delta_ns: int, move: Callable[[], None]) -> None:
        with self._moving:
            # As in rcl, a new override of an inactive clock is no jump: the clock does not show it.
            is_told = self._is_overridden or change is not ClockChange.ROS_TIME_NO_CHANGE
            covered = [j for j in list(self.jump_handles) if is_told and j.threshold.covers(change, delta_ns)]
            for jump in covered:
                if jump.pre_callback is not None:
                    jump.pre_callback()
            move()
            for jump in covered:
                if jump.post_callback is not None:
                    jump.post_callback({"clock_change": change, "delta": delta_ns})
        for watcher in list(self._watching):
            watcher.clock_moved()


def _nothing() -> None:
    """Do nothing."""

"""Points in time."""

from __future__ import annotations

from typing import TYPE_CHECKING, overload

from graphflow.times import warn_of_two_clocks
from rclpy.clock_type import ClockType
from rclpy.constants import S_TO_NS
from rclpy.duration import Duration

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time as TimeMessage


class Time:
    """A point in time on a clock of some type, in whole nanoseconds.

    Args:
        seconds: Added to `nanoseconds`.

    Raises:
        ValueError: A number is negative.
        OverflowError: It does not fit in 64 bits.
        TypeError: Not a clock type.
    """

    def __init__(
        self, *, seconds: float = 0, nanoseconds: float = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if total >= 2**63:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self._nanoseconds, self._clock_type = total, clock_type

    @property
    def nanoseconds(self) -> int:
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Return whole seconds, and the remaining nanoseconds."""
        return divmod(self._nanoseconds, S_TO_NS)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self.nanoseconds}, clock_type={self.clock_type.name})"

    def __add__(self, other: Duration) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        try:
            return Time(nanoseconds=self._nanoseconds + other.nanoseconds, clock_type=self._clock_type)
        except OverflowError:
            raise OverflowError("Addition leads to overflow in C storage.") from None

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...
    @overload
    def __sub__(self, other: Duration) -> Time: ...
    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            self._refuse_other_clock(other, "Can't subtract times with different clock types")
            warn_of_two_clocks(self._nanoseconds, other.nanoseconds)
            return Duration(nanoseconds=self._nanoseconds - other.nanoseconds)
        if not isinstance(other, Duration):
            return NotImplemented
        try:
            return Time(nanoseconds=self._nanoseconds - other.nanoseconds, clock_type=self._clock_type)
        except ValueError:
            raise ValueError("Subtraction leads to negative time.") from None

    def _refuse_other_clock(self, other: Time, text: str = "Can't compare times with different clock types") -> None:
        if self._clock_type != other.clock_type:
            error = TypeError(text)
            if ClockType.SYSTEM_TIME in (self._clock_type, other.clock_type):
                way = "self.get_clock().now(), or Time(..., clock_type=self.get_clock().clock_type)"
                error.add_note(f"note: Time() is of the system's clock, and a node has one of its own: write {way}")
            raise error

    # Equality raises for another clock type, too, as in rclpy: False would hide the mistake.
    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        self._refuse_other_clock(other)
        return self._nanoseconds == other.nanoseconds

    def __hash__(self) -> int:
        return hash((self._nanoseconds, self._clock_type))

    def __lt__(self, other: Time) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        self._refuse_other_clock(other)
        return self._nanoseconds < other.nanoseconds

    def __le__(self, other: Time) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        self._refuse_other_clock(other)
        return self._nanoseconds <= other.nanoseconds

    def __gt__(self, other: Time) -> bool:
        return other < self if isinstance(other, Time) else NotImplemented

    def __ge__(self, other: Time) -> bool:
        return other <= self if isinstance(other, Time) else NotImplemented

    def to_msg(self) -> TimeMessage:
        """Convert to builtin_interfaces/msg/Time."""
        from builtin_interfaces.msg import Time as TimeMessage

        sec, nanosec = self.seconds_nanoseconds()
        return TimeMessage(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg: TimeMessage, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Convert a builtin_interfaces/msg/Time. Raises TypeError for anything else."""
        if not hasattr(msg, "nanosec"):
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)

"""Durations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy.constants import S_TO_NS

if TYPE_CHECKING:
    from builtin_interfaces.msg import Duration as DurationMessage

_INFINITE = 2**63 - 1


class Duration:
    """A duration in whole nanoseconds; may be negative.

    Args:
        seconds: Added to `nanoseconds`.

    Raises:
        OverflowError: It does not fit in 64 bits.
    """

    def __init__(self, *, seconds: float = 0, nanoseconds: float = 0) -> None:
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -(2**63) <= total < 2**63:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self._nanoseconds = total

    @property
    def nanoseconds(self) -> int:
        return self._nanoseconds

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self.nanoseconds})"

    def __str__(self) -> str:
        return "Infinite" if self._nanoseconds == _INFINITE else f"{self.nanoseconds} nanoseconds"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Duration) and self._nanoseconds == other.nanoseconds

    def __hash__(self) -> int:
        return hash(self._nanoseconds)

    def __lt__(self, other: Duration) -> bool:
        return self._nanoseconds < other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __le__(self, other: Duration) -> bool:
        return self._nanoseconds <= other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __gt__(self, other: Duration) -> bool:
        return self._nanoseconds > other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def __ge__(self, other: Duration) -> bool:
        return self._nanoseconds >= other.nanoseconds if isinstance(other, Duration) else NotImplemented

    def to_msg(self) -> DurationMessage:
        """Convert to builtin_interfaces/msg/Duration."""
        from builtin_interfaces.msg import Duration as DurationMessage

        # Floored: `nanosec` is unsigned, so -0.5 s is sec=-1, nanosec=500000000.
        sec, nanosec = divmod(self._nanoseconds, S_TO_NS)
        return DurationMessage(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg: DurationMessage) -> Duration:
        """Convert a builtin_interfaces/msg/Duration. Raises TypeError for anything else."""
        if not hasattr(msg, "nanosec"):
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)

    def get_c_duration(self) -> Duration:
        """Return the duration itself; rclpy's internal handle has no equivalent."""
        return self


Infinite = Duration(nanoseconds=_INFINITE)
"""The duration without limit."""

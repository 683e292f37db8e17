"""Points in time."""

from __future__ import annotations

import pytest
from builtin_interfaces.msg import Time as TimeMessage

from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.time import Time


def test_times_and_spans_are_added_and_subtracted() -> None:
    """On their own clock; never before its beginning or beyond 64 bits."""
    late = Time(seconds=2, clock_type=ClockType.STEADY_TIME)
    assert late + Duration(seconds=1) == Duration(seconds=1) + late == Time(seconds=3, clock_type=late.clock_type)
    assert late - Time(seconds=0.5, clock_type=late.clock_type) == Duration(seconds=1.5)
    assert (late - Duration(seconds=1)).nanoseconds == 10**9
    with pytest.raises(ValueError, match="negative"):
        late - Duration(seconds=3)
    with pytest.raises(OverflowError):
        Time(nanoseconds=2**63 - 1) + Duration(nanoseconds=1)
    with pytest.raises(TypeError):
        late + 3  # type: ignore[operator]


def test_times_of_different_clocks_cannot_be_compared() -> None:
    """Not even for being the same."""
    ros, system = Time(seconds=1, clock_type=ClockType.ROS_TIME), Time(seconds=1)
    for compare in (lambda: ros == system, lambda: ros < system, lambda: ros >= system, lambda: ros - system):
        with pytest.raises(TypeError, match="different clock types"):
            compare()
    assert ros != 1
    assert Time(seconds=1) < Time(seconds=2)
    assert Time(seconds=2) > Time(seconds=1)


@pytest.mark.parametrize("given", [{"seconds": -1}, {"nanoseconds": -1}])
def test_no_time_is_negative(given: dict[str, int]) -> None:
    """It counts from a clock's beginning."""
    with pytest.raises(ValueError, match="must not be negative"):
        Time(**given)  # type: ignore[arg-type]


def test_messages_are_of_ros_time() -> None:
    """Unless another clock is named."""
    point = Time(nanoseconds=1_500_000_000, clock_type=ClockType.ROS_TIME)
    assert point.to_msg() == TimeMessage(sec=1, nanosec=500_000_000)
    assert Time.from_msg(point.to_msg()) == point
    assert point.seconds_nanoseconds() == (1, 500_000_000)
    assert repr(point) == "Time(nanoseconds=1500000000, clock_type=ROS_TIME)"
    with pytest.raises(TypeError):
        Time.from_msg(3)
    with pytest.raises(TypeError):
        Time(clock_type=3)  # type: ignore[arg-type]

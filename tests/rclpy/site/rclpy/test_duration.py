"""Spans of time."""

from __future__ import annotations

import pytest
from builtin_interfaces.msg import Duration as DurationMessage

from rclpy.duration import Duration, Infinite


def test_seconds_and_nanoseconds_are_added() -> None:
    """In whole nanoseconds; what does not fit 64 bits is refused."""
    assert Duration(seconds=1.5, nanoseconds=5).nanoseconds == 1_500_000_005
    assert Duration(seconds=-1).nanoseconds == -(10**9)
    with pytest.raises(OverflowError):
        Duration(nanoseconds=2**63)


def test_a_message_has_whole_seconds_rounded_down() -> None:
    """So its nanoseconds are never negative."""
    message = Duration(nanoseconds=-1).to_msg()
    assert message == DurationMessage(sec=-1, nanosec=999_999_999)
    assert Duration.from_msg(message) == Duration(nanoseconds=-1)
    with pytest.raises(TypeError):
        Duration.from_msg(3)


def test_spans_are_compared_with_spans_only() -> None:
    """Others are unequal, and neither longer nor shorter."""
    one, two = Duration(seconds=1), Duration(seconds=2)
    assert one < two <= two
    assert two > one >= one
    assert one != 1
    assert len({one, Duration(seconds=1)}) == 1
    with pytest.raises(TypeError):
        assert one < 3  # type: ignore[operator]


def test_they_can_be_read() -> None:
    """Also the one without an end."""
    assert repr(Duration(nanoseconds=5)) == "Duration(nanoseconds=5)"
    assert (str(Duration(nanoseconds=5)), str(Infinite)) == ("5 nanoseconds", "Infinite")

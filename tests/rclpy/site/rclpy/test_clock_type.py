"""The kinds of clocks."""

from rclpy.clock_type import ClockType


def test_they_have_rcls_numbers() -> None:
    """Which messages and tools show."""
    assert [kind.value for kind in ClockType] == [0, 1, 2, 3]

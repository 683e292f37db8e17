"""Levels of log lines."""

from rclpy.impl.logging_severity import LoggingSeverity


def test_they_have_rcutils_numbers() -> None:
    """Which /rosout carries."""
    assert [level.value for level in LoggingSeverity] == [0, 10, 20, 30, 40, 50]

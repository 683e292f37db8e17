"""Numbers that rclpy names."""

from rclpy.constants import S_TO_NS


def test_a_second_has_a_milliard_nanoseconds() -> None:
    """Which is what code multiplies by."""
    assert S_TO_NS == 10**9

"""The default context, and the like."""

from __future__ import annotations

import pytest

import rclpy
from rclpy import utilities


def test_after_its_end_the_default_context_is_another() -> None:
    """So a program may begin again; what has not begun cannot end."""
    with pytest.raises(RuntimeError, match="must be initialized"):
        utilities.shutdown()
    rclpy.init()
    first = utilities.get_default_context()
    assert utilities.ok()
    utilities.shutdown()
    assert utilities.get_default_context() is not first
    assert not utilities.ok()
    utilities.try_shutdown()


def test_a_context_that_begins_again_while_it_ends() -> None:
    """It stays the default: a callback of an executor may still be in `shutdown` when the program goes on."""

    def again() -> None:
        rclpy.init()

    rclpy.init()
    context = utilities.get_default_context()
    context.on_shutdown(again)
    utilities.shutdown()
    assert utilities.get_default_context() is context
    assert utilities.ok()


def test_what_is_for_ros_is_removed_from_a_command_line() -> None:
    """And the rest is left as it is; what is wrong is an error."""
    words = ["me", "-x", "--ros-args", "-r", "a:=b", "--", "last"]
    assert utilities.remove_ros_args(words) == ["me", "-x", "last"]
    with pytest.raises(RuntimeError):
        utilities.remove_ros_args(["me", "--ros-args", "-r", "no-rule"])


def test_the_middleware_is_rmw_zenoh() -> None:
    """The only one there is."""
    assert utilities.get_available_rmw_implementations() == {"rmw_zenoh_cpp"}


@pytest.mark.parametrize(("seconds", "nanoseconds"), [(None, -1), (-3, -1), (0.5, 500_000_000)])
def test_a_time_limit_in_nanoseconds(seconds: float | None, nanoseconds: int) -> None:
    """-1 is none."""
    assert utilities.timeout_sec_to_nsec(seconds) == nanoseconds

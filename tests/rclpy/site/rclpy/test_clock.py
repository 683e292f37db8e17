"""Clocks."""

from __future__ import annotations

import threading
import time

import pytest

import rclpy
from graphflow.rclpy.wake import Wake
from rclpy.clock import Clock, ClockChange, JumpThreshold, ROSClock, TimeJump
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.exceptions import NotInitializedException
from rclpy.time import Time


def test_each_type_has_its_time() -> None:
    """ROS time is the time of day as long as nobody sets it."""
    assert abs(Clock().now().nanoseconds - time.time_ns()) < 10**9
    assert abs(Clock(clock_type=ClockType.STEADY_TIME).now_ns() - time.monotonic_ns()) < 10**9
    ros = Clock(clock_type=ClockType.ROS_TIME)
    assert isinstance(ros, ROSClock)
    assert abs(ros.now_ns() - time.time_ns()) < 10**9
    ros.set_ros_time_override(Time(seconds=5))
    ros._set_ros_time_is_active(True)
    assert ros.now() == Time(seconds=5, clock_type=ClockType.ROS_TIME)
    with pytest.raises(TypeError):
        Clock(clock_type=1)  # type: ignore[arg-type]


def test_jumps_are_told_to_those_they_concern() -> None:
    """Before and after; ahead, back, and when simulated time begins or ends."""
    clock, told = ROSClock(), list[tuple[str, ClockChange, float]]()

    def want(name: str, ahead: float | None, back: float | None, *, change: bool) -> None:
        def after(jump: TimeJump) -> None:
            told.append((name, jump.clock_change, jump.delta.nanoseconds / 1e9))

        forward = None if ahead is None else Duration(seconds=ahead)
        backward = None if back is None else Duration(seconds=back)
        threshold = JumpThreshold(min_forward=forward, min_backward=backward, on_clock_change=change)
        clock.create_jump_callback(threshold, post_callback=after)

    want("ahead", 1.0, None, change=False)
    want("back", None, -1.0, change=False)
    want("change", None, None, change=True)
    clock._set_ros_time_is_active(True)
    for seconds in (10.0, 10.5, 12.0, 3.0):
        clock.set_ros_time_override(Time(seconds=seconds))
    clock._set_ros_time_is_active(False)
    clock.set_ros_time_override(Time(seconds=99))
    assert told == [
        ("change", ClockChange.ROS_TIME_ACTIVATED, 0.0),
        ("ahead", ClockChange.ROS_TIME_NO_CHANGE, 10.0),
        ("ahead", ClockChange.ROS_TIME_NO_CHANGE, 1.5),
        ("back", ClockChange.ROS_TIME_NO_CHANGE, -9.0),
        ("change", ClockChange.ROS_TIME_DEACTIVATED, 0.0),
    ]


def test_a_handle_is_told_until_it_is_unregistered() -> None:
    """Or its block was left; there must be something to call, and something to tell."""
    clock, told = ROSClock(), list[int]()
    threshold = JumpThreshold(min_forward=Duration(seconds=1), min_backward=None)
    with clock.create_jump_callback(threshold, pre_callback=lambda: told.append(1)) as handle:
        clock._set_ros_time_is_active(True)
    clock._set_ros_time_is_active(False)
    handle.unregister()
    assert told == [1]
    with pytest.raises(ValueError, match="must be callable"):
        clock.create_jump_callback(threshold)
    with pytest.raises(ValueError, match="must be enabled"):
        JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False)
    with pytest.raises(ValueError, match="min_forward"):
        JumpThreshold(min_forward=Duration(), min_backward=None)


def test_a_sleep_lasts_until_its_time_has_come() -> None:
    """By simulated time too, though nobody spins; a time of another clock's is refused."""
    rclpy.init()
    began = time.monotonic()
    assert Clock().sleep_for(Duration(seconds=0.02))
    assert time.monotonic() - began >= 0.02
    clock = ROSClock()
    clock._set_ros_time_is_active(True)
    threading.Timer(0.02, clock.set_ros_time_override, (Time(seconds=7),)).start()
    assert clock.sleep_until(Time(seconds=6, clock_type=ClockType.ROS_TIME))
    assert clock.now_ns() == 7 * 10**9
    with pytest.raises(ValueError, match="clock type does not match"):
        clock.sleep_until(Time(seconds=1))


@pytest.mark.parametrize("cause", ["shutdown", "change"])
def test_a_sleep_is_cut_off(cause: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the end of the context, or when simulated time begins; then it says that its time has not come."""
    rclpy.init()
    clock = ROSClock()
    cut = rclpy.shutdown if cause == "shutdown" else lambda: clock._set_ros_time_is_active(True)
    wait = Wake.wait

    def cut_and_wait(self: Wake, timeout: float | None = None) -> bool:
        monkeypatch.undo()
        threading.Thread(target=cut).start()
        return wait(self, timeout)

    monkeypatch.setattr(Wake, "wait", cut_and_wait)
    assert not clock.sleep_for(Duration(seconds=30))


def test_nobody_sleeps_without_a_context() -> None:
    """It could not be woken."""
    with pytest.raises(NotInitializedException):
        Clock().sleep_for(Duration(seconds=1))

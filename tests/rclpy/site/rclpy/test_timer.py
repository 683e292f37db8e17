"""Timers and rates."""

from __future__ import annotations

import threading
from typing import Any

import pytest

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.clock import ROSClock
from rclpy.exceptions import InvalidHandle, ROSInterruptException
from rclpy.node import Node
from rclpy.time import Time
from rclpy.timer import TimerInfo
from tests.rclpy.conftest import Spinner


class ByHand(ROSClock):
    """A clock that a test sets."""

    def go(self, seconds: float) -> None:
        self._set_ros_time_is_active(True)
        self.set_ros_time_override(Time(seconds=seconds))


def test_a_timer_keeps_its_phase_and_skips_what_it_missed(node: Node) -> None:
    """By its own clock."""
    clock, calls = ByHand(), list[int]()
    clock.go(100)
    timer = node.create_timer(1.0, lambda: calls.append(1), clock=clock)
    assert not timer.is_ready()
    assert timer.time_until_next_call() == 10**9
    clock.go(103.5)
    assert timer.is_ready()
    work = timer.take_work()
    assert work is not None
    work()
    assert timer.time_until_next_call() == 500_000_000
    assert timer.time_since_last_call() == 0
    assert timer.take_work() is None
    clock.go(50)  # it went back: a whole period begins
    assert timer.time_until_next_call() == 10**9


def test_a_canceled_timer_is_not_due_until_it_is_reset(node: Node) -> None:
    """Nor is one that was not started."""
    clock = ByHand()
    clock.go(1)
    timer = node.create_timer(1.0, print, clock=clock)
    timer.cancel()
    clock.go(5)
    assert timer.is_canceled()
    assert not timer.is_ready()
    assert timer.time_until_next_call() is None
    timer.reset()
    assert timer.time_until_next_call() == 10**9
    assert node.create_timer(1.0, print, autostart=False).is_canceled()
    timer.timer_period_ns = 5
    assert timer.timer_period_ns == 5
    assert node.destroy_timer(timer)
    with pytest.raises(InvalidHandle):
        timer.is_ready()


def test_a_callback_may_ask_when_it_was_due(node: Node) -> None:
    """And when it came."""
    clock, infos = ByHand(), list[TimerInfo]()
    clock.go(10)

    def called(info: TimerInfo) -> None:
        infos.append(info)

    timer = node.create_timer(1.0, called, clock=clock)
    clock.go(11.25)
    work: Any = timer.take_work()
    work()
    assert infos[0].expected_call_time.nanoseconds == 11 * 10**9
    assert infos[0].actual_call_time.nanoseconds == 11_250_000_000


def test_a_rate_lets_its_thread_go_on_once_a_period(node: Node, spin: Spinner) -> None:
    """While somebody spins; until it is destroyed."""
    rate, woken = node.create_rate(100.0), list[int]()

    def keep() -> None:
        rate.sleep()
        woken.append(1)

    thread = threading.Thread(target=keep)
    thread.start()
    spin(lambda: woken)
    thread.join()
    slow = node.create_rate(0.001)
    thread = threading.Thread(target=slow.sleep)
    thread.start()
    while not slow._sleepers:
        pass
    assert node.destroy_rate(slow)
    thread.join()
    with pytest.raises(InvalidHandle):
        slow.sleep()
    with pytest.raises(ValueError, match="must be > 0"):
        node.create_rate(0.0)


def test_a_rate_whose_time_has_come_does_not_sleep(node: Node) -> None:
    """What has passed since the last sleep counts, so that a thread may spin and sleep in turn."""
    rate = node.create_rate(100.0)
    for _ in range(3):
        rclpy.spin_once(node, timeout_sec=10)
        rate.sleep()
    rclpy.spin_once(node, timeout_sec=10)
    rclpy.spin_once(node, timeout_sec=10)
    rate.sleep()
    assert not rate._has_ticked


def test_a_rate_is_cut_off_by_the_end_of_the_context(node: Node) -> None:
    """By an error that says so."""
    rate = node.create_rate(0.001)
    threading.Timer(0.02, rclpy.shutdown).start()
    with pytest.raises(ROSInterruptException):
        rate.sleep()
    with pytest.raises(ROSInterruptException):
        rate.sleep()


def test_a_negative_period(node: Node) -> None:
    """Is refused, as by rcl."""
    with pytest.raises(RCLError, match="timer period must be non-negative"):
        node.create_timer(-1.0, lambda: None)

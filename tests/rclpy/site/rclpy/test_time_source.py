"""Simulated time."""

from __future__ import annotations

import threading
import time

import pytest
from rosgraph_msgs.msg import Clock as ClockMessage

from rclpy.clock import Clock, ROSClock
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from rclpy.time_source import TimeSource
from tests.until import until


def set_simulated(node: Node, value: object) -> bool:
    return bool(node.set_parameters([Parameter("use_sim_time", value=value)])[0].successful)


def test_a_nodes_clock_goes_by_clock_messages_though_nobody_spins(node: Node) -> None:
    """While `use_sim_time` is true, which takes nothing but true and false."""
    publisher, clock = node.create_publisher(ClockMessage, "/clock", 1), node.get_clock()
    assert set_simulated(node, True)
    assert clock.now().nanoseconds == 0
    message = ClockMessage()
    message.clock.sec = 7
    until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(message)
    until(lambda: clock.now().nanoseconds == 7 * 10**9)
    message.clock.sec = 8
    threading.Timer(0.02, publisher.publish, (message,)).start()
    assert clock.sleep_for(Duration(seconds=0.5))
    assert not set_simulated(node, 3)
    assert set_simulated(node, False)
    assert abs(clock.now().nanoseconds - time.time_ns()) < 10**9
    until(lambda: publisher.get_subscription_count() == 0)


def test_clocks_are_attached_to_it(node: Node) -> None:
    """Those of ROS time, also later ones; it goes by another node once it is moved."""
    source, clock = TimeSource(node=node), ROSClock()
    source.attach_clock(clock)
    set_simulated(node, True)
    assert clock.ros_time_is_active
    message = ClockMessage()
    message.clock.sec = 5
    source.clock_callback(message)
    late = ROSClock()
    source.attach_clock(late)
    assert late.now() == clock.now() == Time(seconds=5, clock_type=clock.clock_type)
    source.attach_node(Node("other"))
    assert not clock.ros_time_is_active
    with pytest.raises(ValueError, match="ROS_TIME"):
        source.attach_clock(Clock())
    with pytest.raises(TypeError):
        source.attach_node(3)

"""From broadcasters to a buffer."""

from __future__ import annotations

import threading
import time

import pytest
from tf2_msgs.msg import TFMessage
from tf2_py.core import message
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformException, TransformListener

import rclpy
from graphflow.tf.poses import Pose
from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from tests.until import until

S = 10**9


def at(parent: str, frame: str, x: float) -> object:
    return message(Pose((x, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), parent, frame, S)


def test_what_is_said_can_be_looked_up(node: Node) -> None:
    """What does not move was said before anybody listened."""
    StaticTransformBroadcaster(node).sendTransform(at("base", "laser", 0.5))
    buffer = Buffer()
    listener = TransformListener(buffer, node)
    moving = TransformBroadcaster(node)
    until(moving.pub_tf.get_subscription_count)
    moving.sendTransform([at("odom", "base", 2.0), at("map", "odom", 30.0)])
    limit = time.monotonic() + 10
    while not buffer.can_transform("map", "laser", Time()) and time.monotonic() < limit:
        rclpy.spin_once(node, timeout_sec=0.1)
    assert buffer.lookup_transform("map", "laser", Time()).transform.translation.x == 32.5
    listener.unregister()
    assert moving.pub_tf.get_subscription_count() == 0


def test_it_may_spin_its_node_itself(node: Node) -> None:
    """Then a look-up may wait anywhere; the thread ends when it is told to."""
    buffer = Buffer()
    listener = TransformListener(buffer, node, spin_thread=True)
    StaticTransformBroadcaster(node).sendTransform(at("base", "laser", 0.5))
    found = buffer.lookup_transform("base", "laser", Time(), Duration(seconds=10))
    assert found.transform.translation.x == 0.5
    listener.unregister()
    listener.dedicated_listener_thread.join(10)
    assert not listener.dedicated_listener_thread.is_alive()
    assert threading.current_thread() is threading.main_thread()


def test_only_what_does_not_move(node: Node) -> None:
    """Where nothing else is wanted."""
    listener = TransformListener(Buffer(), node, static_only=True)
    assert listener.tf_sub is None
    assert node.count_subscribers("/tf") == 0
    with pytest.raises(TransformException):
        listener.buffer.lookup_transform_core("a", "b", Time())


def test_time_that_jumps_back(node: Node) -> None:
    """The buffer is cleared, except for the static transforms."""
    node.set_parameters([Parameter("use_sim_time", value=True)])
    buffer = Buffer()
    listener = TransformListener(buffer, node)
    clock = node.get_clock()
    assert isinstance(clock, ROSClock)
    listener.static_callback(TFMessage(transforms=[at("base", "laser", 0.5)]))
    for second in (100, 5):
        clock.set_ros_time_override(Time(seconds=second, clock_type=ClockType.ROS_TIME))
        moved = message(Pose((float(second), 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), "odom", "base", second * S)
        listener.callback(TFMessage(transforms=[moved]))
    found = buffer.lookup_transform("odom", "laser", Time())
    assert found.transform.translation.x == 5.5
    assert found.header.stamp.sec == 5

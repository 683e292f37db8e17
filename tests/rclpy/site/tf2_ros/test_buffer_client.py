"""A buffer in another process, asked by an action."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error
from tf2_py.core import message
from tf2_ros import Buffer, BufferClient, LookupException, TimeoutException, TransformException

import rclpy
from graphflow.tf.poses import IDENTITY
from rclpy.action import ActionServer
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time

S = 10**9


@pytest.fixture
def client(node: Node) -> Iterator[BufferClient]:
    """One that asks a server in the same node, whose buffer knows one transform."""
    buffer = Buffer()
    buffer.set_transform_static(message(IDENTITY, "odom", "base", S))

    def answer(handle: Any) -> Any:
        goal, result = handle.request, LookupTransform.Result()
        try:
            if goal.advanced:
                times = Time.from_msg(goal.target_time), Time.from_msg(goal.source_time)
                asked = (goal.target_frame, times[0], goal.source_frame, times[1], goal.fixed_frame)
                result.transform = buffer.lookup_transform_full(*asked)
            else:
                result.transform = buffer.lookup_transform(goal.target_frame, goal.source_frame, Time())
        except TransformException as error:
            result.error = TF2Error(error=TF2Error.LOOKUP_ERROR, error_string=str(error))
        handle.succeed()
        return result

    made = BufferClient(node, "tf2_buffer", timeout_padding=Duration(seconds=20))
    with pytest.raises(TimeoutException, match="not ready"):
        made.lookup_transform("odom", "base", Time())
    server = ActionServer(node, LookupTransform, "tf2_buffer", answer)
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)

    def spin() -> None:
        try:
            executor.spin()
        except ExternalShutdownException:  # the test has ended
            return

    thread = threading.Thread(target=spin)
    thread.start()
    assert made.action_client.wait_for_server(10)
    yield made
    made.destroy()
    server.destroy()
    executor.shutdown()
    rclpy.try_shutdown()
    thread.join(10)


def test_it_asks(client: BufferClient) -> None:
    """And has the answers of the buffer, or its errors."""
    known = client.lookup_transform("odom", "base", Time())
    assert (known.header.frame_id, known.child_frame_id, known.transform.rotation.w) == ("odom", "base", 1.0)
    full = client.lookup_transform_full("odom", Time(), "base", Time().to_msg(), "odom", Duration(seconds=1))
    assert full.transform == known.transform
    assert client.can_transform("odom", "base", Time())
    assert client.can_transform_full("odom", Time(), "base", Time(), "odom")
    assert not client.can_transform("odom", "nothing", Time())
    assert not client.can_transform_full("odom", Time(), "nothing", Time(), "odom")
    with pytest.raises(LookupException, match="nothing"):
        client.lookup_transform("odom", "nothing", Time())

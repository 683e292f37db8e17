"""The buffer of a node."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest
from tf2_msgs.srv import FrameGraph
from tf2_py.core import message
from tf2_ros import Buffer, LookupException

import rclpy
from graphflow.tf.poses import IDENTITY
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time

S = 10**9
BASE = message(IDENTITY, "odom", "base", S)


def test_it_waits_for_a_transform() -> None:
    """As long as it may, and not longer."""
    buffer = Buffer()
    with pytest.raises(LookupException):
        buffer.lookup_transform("odom", "base", Time(), Duration(seconds=0.01))
    began = time.monotonic()
    threading.Timer(0.05, buffer.set_transform, [BASE]).start()
    assert buffer.lookup_transform("odom", "base", Time(), Duration(seconds=30)) == BASE
    assert time.monotonic() - began < 20
    assert buffer.can_transform("odom", "base", Time()) is True
    assert buffer.can_transform("odom", "nothing", Time(), return_debug_tuple=True)[0] is False
    asked = ("base", Time(seconds=1), "base", Time(seconds=1), "odom")
    assert buffer.can_transform_full(*asked)
    assert buffer.lookup_transform_full(*asked).transform == BASE.transform


def test_futures_are_done_when_there_is_one(node: Node, spin: Callable[..., None]) -> None:
    """And coroutines go on; who waits no more is forgotten."""
    buffer = Buffer()
    future = buffer.wait_for_transform_async("odom", "base", Time())
    cancelled = buffer.wait_for_transform_full_async("odom", Time(), "base", Time(), "odom")
    cancelled.cancel()
    found: list[object] = []

    async def look() -> None:
        found.append(await buffer.lookup_transform_async("odom", "base", Time()))
        found.append(await buffer.lookup_transform_full_async("odom", Time(), "base", Time(), "odom"))

    timer = node.create_timer(0.001, look)
    rclpy.spin_once(node, timeout_sec=5)
    timer.cancel()
    assert not future.done()
    buffer.set_transform_static(BASE)
    assert future.result() is True
    until = time.monotonic() + 10
    while len(found) < 2 and time.monotonic() < until:
        rclpy.spin_once(node, timeout_sec=0.05)
    assert len(found) == 2
    assert buffer._graphflow_waiting == {}
    assert buffer.wait_for_transform_async("odom", "base", Time()).done()


def test_the_end_of_its_node_ends_waiting(node: Node) -> None:
    """Whatever time is left."""
    buffer = Buffer(node=node)
    began = time.monotonic()
    threading.Timer(0.05, rclpy.shutdown).start()
    with pytest.raises(LookupException):
        buffer.lookup_transform("odom", "base", Time(), Duration(seconds=60))
    assert time.monotonic() - began < 30


def test_it_answers_which_frames_there_are(node: Node) -> None:
    """By tf2's service."""
    buffer = Buffer(node=node)
    buffer.set_transform(BASE)
    client = node.create_client(FrameGraph, "tf2_frames")
    assert client.wait_for_service(10)
    future = client.call_async(FrameGraph.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=10)
    answer = future.result()
    assert answer is not None
    assert "base: " in answer.frame_yaml


def test_a_number_in_place_of_a_duration() -> None:
    """Its error has the duration."""
    seconds: Any = 1.0
    with pytest.raises(TypeError, match=r"takes a Duration, not 1.0: write timeout=Duration\(seconds=1.0\)"):
        Buffer().lookup_transform("map", "base", Time(), seconds)

"""Clients of services."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from tests.rclpy.conftest import Spinner


def add(request: Any, response: Any) -> Any:
    response.sum = request.a + request.b
    return response


def sum_of(future: Any) -> int:
    return int(future.result().sum)


def test_a_call_is_answered_when_somebody_spins(node: Node, spin: Spinner) -> None:
    """By its future, or, from another thread, by the call itself."""
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    assert client.service_name == "/add"
    assert client.wait_for_service(5)
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    assert not future.done()
    assert client.get_pending_request(1) is future
    spin(future.done)
    assert sum_of(future) == 5
    answers: list[Any] = []
    thread = threading.Thread(target=lambda: answers.append(client.call(AddTwoInts.Request(a=4))))
    thread.start()
    spin(lambda: answers)
    thread.join()
    assert answers[0].sum == 4
    with pytest.raises(TypeError):
        client.call_async("no request")
    with pytest.raises(KeyError):
        client.get_pending_request(1)


def test_without_a_server_nobody_answers(node: Node) -> None:
    """Waiting for one ends in time, and a call that is given one returns nothing."""
    client = node.create_client(AddTwoInts, "add")
    began = time.monotonic()
    assert not client.wait_for_service(timeout_sec=0.02)
    assert client.call(AddTwoInts.Request(), timeout_sec=0.02) is None
    assert time.monotonic() - began >= 0.04
    assert not client.pending_requests


def test_nobody_is_asked_for_servers_after_the_end(node: Node) -> None:
    """So that a loop of `wait_for_service` ends."""
    client = node.create_client(AddTwoInts, "add")
    threading.Timer(0.02, rclpy.shutdown).start()
    with pytest.raises(RCLError, match="failed to check service availability"):
        client.wait_for_service()
    with pytest.raises(RCLError):
        client.service_is_ready()


def test_a_call_that_blocks_ends_with_the_context(node: Node) -> None:
    """So that a program can end."""
    client = node.create_client(AddTwoInts, "add")
    threading.Timer(0.02, rclpy.shutdown).start()
    assert client.call(AddTwoInts.Request()) is None


def test_introspection_is_switched_on_for_both_sides(node: Node, spin: Spinner) -> None:
    """Four events of one call."""
    from example_interfaces.srv import AddTwoInts as Service

    events: list[Any] = []
    server, client = node.create_service(Service, "add", add), node.create_client(Service, "add")
    node.create_subscription(Service.Event, "/add/_service_event", events.append, 10)
    for one in (server, client):
        one.configure_introspection(node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS)
    client.wait_for_service(5)
    client.call_async(Service.Request(a=1))
    spin(lambda: len(events) == 4)
    assert sorted(event.info.event_type for event in events) == [0, 1, 2, 3]

"""Servers of services."""

from __future__ import annotations

from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts

from rclpy.node import Node
from tests.rclpy.conftest import Spinner


def sum_of(future: Any) -> int:
    return int(future.result().sum)


def test_callbacks_may_be_coroutine_functions(node: Node, spin: Spinner) -> None:
    """And answer when they have ended."""

    async def add(request: Any, response: Any) -> Any:
        response.sum = request.a + 1
        return response

    server = node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    client.wait_for_service(5)
    future = client.call_async(AddTwoInts.Request(a=2))
    spin(future.done)
    assert sum_of(future) == 3
    assert server.service_name == "/add"


def test_what_is_no_response_leaves_spin(node: Node, spin: Spinner) -> None:
    """And the caller waits on, as in ROS 2."""
    node.create_service(AddTwoInts, "add", lambda request, response: None)
    client = node.create_client(AddTwoInts, "add")
    client.wait_for_service(5)
    future = client.call_async(AddTwoInts.Request())
    with pytest.raises(TypeError, match="must return its response"):
        spin(future.done)
    assert not future.done()


def test_a_request_may_be_taken_by_hand(node: Node) -> None:
    """With whose it is."""
    server = node.create_service(AddTwoInts, "add", print)
    client = node.create_client(AddTwoInts, "add")
    client.wait_for_service(5)
    client.call_async(AddTwoInts.Request(a=7))
    request, header = server.handle.service_take_request(AddTwoInts.Request)  # type: ignore[attr-defined]
    assert request.a == 7
    assert header.request_id[1] == 1
    assert header.source_timestamp > 0
    assert server.handle.service_take_request(AddTwoInts.Request) == (None, None)  # type: ignore[attr-defined]
    assert node.destroy_service(server)

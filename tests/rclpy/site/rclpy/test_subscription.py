"""Subscriptions."""

from __future__ import annotations

from typing import Any

import pytest
from std_msgs.msg import String

from rclpy.node import Node
from rclpy.serialization import serialize_message
from tests.rclpy.conftest import Spinner


def test_callbacks_take_a_message_and_perhaps_what_came_beside_it(node: Node, spin: Spinner) -> None:
    """Or its bytes; and may be coroutine functions."""
    got: list[Any] = []

    async def awaited(message: String) -> None:
        got.append(message.data)

    node.create_subscription(String, "t", lambda message, info: got.append(info), 10)
    node.create_subscription(String, "t", got.append, 10, raw=True)
    node.create_subscription(String, "t", awaited, 10)
    node.create_publisher(String, "t", 10).publish(String(data="a"))
    spin(lambda: len(got) == 3)
    assert got[0]["publication_sequence_number"] == 1
    assert got[0]["received_timestamp"] >= got[0]["source_timestamp"] > 0
    assert got[1:] == [serialize_message(String(data="a")), "a"]
    with pytest.raises(RuntimeError, match="one argument"):
        node.create_subscription(String, "t", lambda: None, 10)


def test_the_queue_is_as_deep_as_asked_for(node: Node, spin: Spinner) -> None:
    """The newest are kept; a subscription may also be asked for its messages."""
    heard: list[str] = []
    node.create_subscription(String, "t", lambda message: heard.append(message.data), 2)
    taken = node.create_subscription(String, "t", print, 5)
    publisher = node.create_publisher(String, "t", 10)
    for data in "abcd":
        publisher.publish(String(data=data))
    found = taken.handle.take_message(String, False)  # type: ignore[attr-defined]
    assert found[0] == String(data="a")
    spin(lambda: len(heard) == 2)
    assert heard == ["c", "d"]
    assert taken.get_publisher_count() == 1


def test_what_is_no_message_of_the_type_is_counted(node: Node, spin: Spinner) -> None:
    """And nobody is called."""
    heard: list[Any] = []
    subscription = node.create_subscription(String, "t", heard.append, 10)
    subscription._do(subscription.endpoint.take() or _broken())
    assert (heard, subscription.endpoint.malformed) == ([], 1)


def _broken() -> Any:
    from graphflow.runtime.endpoints.threaded import Taken
    from graphflow.wire.attachment import MessageInfo

    return Taken(b"\0\1\0\0\xff\0\0\0", MessageInfo(1, 1, bytes(16)))

"""A wait for one message of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graphflow.rclpy import node_bridge
from graphflow.rclpy.node_bridge import NodeBell
from graphflow.rclpy.wake import Wake
from graphflow.runtime.endpoints.threaded import ThreadedSubscription
from rclpy.impl.nodes import internals_of
from rclpy.impl.reexports import passed_on
from rclpy.qos import QoSProfile, to_graphflow, validated
from rclpy.serialization import deserialize_message
from rclpy.type_support import check_is_valid_msg_type

if TYPE_CHECKING:
    from rclpy.node import Node


class _Waking(NodeBell):
    """A bell that wakes one thread."""

    def __init__(self, wake: Wake) -> None:
        super().__init__()
        self._wake = wake

    def ring(self) -> None:
        self.pending = True
        self._wake.set()


def wait_for_message(
    msg_type: Any, node: Node, topic: str, *, qos_profile: QoSProfile | int = 1, time_to_wait: float = -1
) -> tuple[bool, Any]:
    """Block until a message arrives; no thread has to spin.

    Args:
        time_to_wait: Seconds; -1 for no limit.

    Returns:
        Whether one arrived, and the message.
    """
    check_is_valid_msg_type(msg_type)
    life, wake, name = node.context.life, Wake(), node.resolve_topic_name(topic)
    assert life is not None  # a node has joined it
    bell, qos = _Waking(wake), to_graphflow(validated(qos_profile))
    endpoint = node_bridge.add(
        internals_of(node).node, lambda core: ThreadedSubscription(core, msg_type, name, qos, bell, _nothing)
    )
    life.on_end(wake)

    def is_over() -> bool:
        bell.attend()
        return endpoint.waiting > 0 or not life.is_ok

    try:
        wake.wait_until(is_over, None if time_to_wait < 0 else time_to_wait)
        taken = endpoint.take() if life.is_ok else None
        return (False, None) if taken is None else (True, deserialize_message(taken.payload, msg_type))
    finally:
        life.forget(wake)
        if life.is_ok:
            node_bridge.remove(endpoint)


def _nothing() -> None:
    """Do nothing: the waiting thread takes the messages."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

"""Messages published by a program that ends before any subscription has had time to match.

In ROS 2 they are lost silently.
"""

from __future__ import annotations

import logging
import time
from typing import TYPE_CHECKING

from graphflow.qos import Durability
from rclpy.impl.failing import failure
from rclpy.impl.nodes import internals_of

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.endpoints.threaded import ThreadedPublisher
    from rclpy.node import Node
    from rclpy.publisher import Publisher

BRIEF = 3.0
"""The lifetime in seconds below which a node is reported: one that lives longer had time to match."""
logger = logging.getLogger("graphflow")


def attend(life: ContextState) -> None:
    """Report lost messages when a node of a context leaves."""
    life.on_leaving.append(_tell)


def _tell(node: Node) -> None:
    inner = internals_of(node)
    if failure() is not None or inner.life.was_interrupted or time.monotonic() - inner.begun > BRIEF:
        return
    for publisher in inner.publishers:
        endpoint = publisher.endpoint
        if publisher.made_at is not None and 0 < endpoint.published == endpoint.unheard:
            many = "message that was published" if endpoint.published == 1 else "messages that were published"
            way = "if one should have, publish when publisher.get_subscription_count() is not 0"
            text = f"%s: no subscription has received the %d %s; {way}"
            logger.warning(text, endpoint.name, endpoint.published, many)
        elif endpoint.published and _is_kept_for_nobody(endpoint) and _is_users(publisher):
            text = (
                "%s: %s ends, and with it the message that it keeps for late subscriptions: keep it running, with "
                "rclpy.spin(node)"
            )
            logger.warning(text, endpoint.name, node.get_fully_qualified_name())


def _is_users(publisher: Publisher) -> bool:
    """Whether the user's code has created a publisher, itself or by a StaticTransformBroadcaster."""
    return publisher.made_at is not None or publisher.endpoint.name == "/tf_static"


def _is_kept_for_nobody(endpoint: ThreadedPublisher) -> bool:
    """Whether a publisher keeps messages for late subscriptions, and has had no subscription."""
    return endpoint.qos.durability is Durability.TRANSIENT_LOCAL and not endpoint.event_total("matched")

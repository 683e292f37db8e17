"""Nodes that end before anybody has received the messages that they keep for late subscriptions."""

from __future__ import annotations

import logging
from collections.abc import Iterable

from graphflow.names import is_hidden
from graphflow.qos import Durability
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.part import Part


def warn_of_kept(parts: Iterable[Part], log: logging.Logger, node: str) -> None:
    """Log the first publisher of a node that ends itself which keeps a message and has had no subscription.

    Args:
        node: The node's full name.
    """
    for part in parts:
        if not isinstance(part, TopicPublisher) or part.name == "/rosout" or is_hidden(part.name):
            continue
        if part.qos.durability is Durability.TRANSIENT_LOCAL and part.published and not part.event_total("matched"):
            log.warning("%s ends, and with it the message that it keeps on %s: keep it running", node, part.name)
            return

"""The topics of a running graph, followed into a recording."""

from __future__ import annotations

import asyncio
import logging
import time
from dataclasses import replace

from graphflow.bag.reader import Bag
from graphflow.errors import DecodeError, GraphflowError
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.qos import BEST_AVAILABLE
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.node import Node
from graphflow.viewer.rerun.archetypes import is_shown
from graphflow.viewer.rerun.recording import Recording
from graphflow.wire.liveliness import Kind

logger = logging.getLogger("graphflow")

LOOK = 0.5
"""Seconds between two looks for new topics."""
TOPICS_BOUND = 500
"""Topics that are followed, at most."""


class Following:
    """Subscribes to all topics that Rerun can show, and logs their messages."""

    def __init__(self, node: Node, recording: Recording) -> None:
        self._node, self._recording = node, recording
        self._subscriptions: dict[str, TopicSubscription[Message]] = {}
        self.count = 0
        """The number of messages logged."""

    async def run(self) -> None:
        """Follow the graph until cancelled."""
        while True:
            await asyncio.sleep(LOOK)  # first, since a subscription adapts to the publishers that are known
            self.look()

    def look(self) -> None:
        """Subscribe to topics that are new."""
        cache = self._node.context.cache
        for topic, types in cache.topics().items():
            if not cache.endpoints(Kind.PUBLISHER, topic):
                continue
            type_name = next((name for name in types if is_shown(name)), "")
            if not type_name or topic in self._subscriptions or len(self._subscriptions) >= TOPICS_BOUND:
                continue
            try:
                self._subscriptions[topic] = self._follow(topic, type_name)
            except GraphflowError as error:
                logger.warning("%s is not shown: %s", topic, error)

    def _follow(self, topic: str, type_name: str) -> TopicSubscription[Message]:
        def take(message: Message) -> None:
            self.count += 1
            self._recording.add(topic, type_name, message, time.time_ns())

        qos = replace(BEST_AVAILABLE, depth=50)
        return self._node.create_subscription(registry.interface_class(type_name), topic, take, qos)


def replay(bag: Bag, recording: Recording) -> int:
    """Log the messages of a bag; returns their number.

    Raises:
        BagError: The bag is damaged.
    """
    count = 0
    for record in bag.records():
        type_name = record.topic.type
        if not is_shown(type_name):
            continue
        try:
            message = registry.codec(type_name).decode(record.data)
        except DecodeError:
            continue  # of another version of the type
        recording.add(record.topic.name, type_name, message, record.log_ns)
        count += 1
    recording.close()
    return count

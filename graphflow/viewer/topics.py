"""Topics as channels of viewers: subscribed to while a client watches, and forwarded without decoding."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from graphflow.bag.formats.definitions import fetch
from graphflow.errors import UsageFault, printable
from graphflow.names import is_hidden
from graphflow.qos import BEST_AVAILABLE
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawSubscription
from graphflow.runtime.node import Node
from graphflow.viewer.client import Client
from graphflow.viewer.protocol import Subscription, control_message, message_head
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

logger = logging.getLogger("graphflow")

BOUND = 5_000
"""Maximum topics shown, and maximum subscriptions of one client."""
QOS = replace(BEST_AVAILABLE, depth=100)

Key = tuple[str, str]
"""A topic's name and type; a topic with two types becomes two channels."""


class _Channel(NamedTuple):
    id: int
    entity: Entity
    definition: str

    @property
    def fields(self) -> dict[str, object]:
        """The channel in the protocol's form."""
        entity = self.entity
        schema = {"schemaName": entity.type, "schemaEncoding": "ros2msg", "schema": self.definition}
        return {"id": self.id, "topic": entity.name, "encoding": "cdr", **schema}


class Topics:
    """The topics of a graph as channels.

    Args:
        broadcast: Sends a message to all clients.
    """

    def __init__(self, node: Node, broadcast: Callable[[str], object]) -> None:
        self._node, self._broadcast = node, broadcast
        self._ids = itertools.count(1)
        self._shown: dict[Key, _Channel] = {}
        self._by_id: dict[int, Key] = {}
        self._pending: dict[Key, asyncio.Task[None]] = {}
        self._rejected: set[Key] = set()
        self._subscriptions: dict[tuple[Client, int], tuple[Key, RawSubscription]] = {}
        self._is_full = False

    def update(self) -> None:
        """Advertise new topics, and withdraw those that are gone."""
        current: dict[Key, Entity] = {}
        for entity in self._node.context.cache.endpoints(Kind.PUBLISHER):
            if not is_hidden(entity.name):
                current.setdefault((entity.name, entity.type), entity)
        for key in self._pending.keys() - current.keys():
            self._pending[key].cancel()
        if gone := self._shown.keys() - current.keys():
            self._hide(gone)
        self._rejected &= current.keys()
        for key in sorted(current.keys() - self._shown.keys() - self._pending.keys() - self._rejected):
            if len(self._shown) + len(self._pending) >= BOUND:
                if not self._is_full:
                    logger.warning("only %s topics are shown", BOUND)
                self._is_full = True
                return
            self._pending[key] = asyncio.ensure_future(self._show(key, current[key]))

    async def _show(self, key: Key, entity: Entity) -> None:
        try:
            definition = await fetch(self._node, entity)
        except Exception as error:  # the type comes from another process and may be malformed in any way
            self._rejected.add(key)
            logger.warning("%s is not shown: %s", printable(entity.name), printable(str(error)))
            return
        finally:
            self._pending.pop(key, None)
        channel = self._shown[key] = _Channel(next(self._ids), entity, definition)
        self._by_id[channel.id] = key
        self._broadcast(control_message("advertise", channels=[channel.fields]))

    def _hide(self, gone: set[Key]) -> None:
        for owner, (key, subscription) in list(self._subscriptions.items()):
            if key in gone:
                subscription.close()
                del self._subscriptions[owner]
        ids = [self._shown.pop(key).id for key in gone]
        for number in ids:
            del self._by_id[number]
        self._broadcast(control_message("unadvertise", channel_ids=ids))

    def greet(self, client: Client) -> None:
        """Advertise all channels to a new client."""
        client.send_control(control_message("advertise", channels=[channel.fields for channel in self._shown.values()]))

    def subscribe(self, client: Client, wanted: Subscription) -> None:
        """Forward the messages of a channel to a client.

        Each watching client has a subscription of its own, so that it receives the last messages of a latched topic.

        Raises:
            UsageFault: There is no such channel, or the number is in use.
        """
        key, owner = self._by_id.get(wanted.channel_id), (client, wanted.id)
        if key is None:
            raise UsageFault(f"there is no channel {wanted.channel_id}")
        if owner in self._subscriptions:
            raise UsageFault(f"subscription {wanted.id} exists already")
        if sum(who is client for who, _ in self._subscriptions) >= BOUND:
            raise UsageFault(f"a viewer cannot subscribe to more than {BOUND} topics")
        entity = self._shown[key].entity

        def arrived(payload: bytes, info: MessageInfo) -> None:
            is_time = 0 < info.source_ns < 1 << 63
            head = message_head(wanted.id, info.source_ns if is_time else self._node.clock.time_ns())
            client.send_message(wanted.id, head + payload)

        subscription = raw.subscribe(self._node, entity.type, entity.name, arrived, QOS, type_hash=entity.hash)
        self._subscriptions[owner] = key, subscription

    def unsubscribe(self, client: Client, number: int) -> None:
        """Stop forwarding a channel to a client."""
        if (client, number) in self._subscriptions:
            self._subscriptions.pop((client, number))[1].close()
            client.forget(number)

    def leave(self, client: Client) -> None:
        """End all subscriptions of a client."""
        for who, number in list(self._subscriptions):
            if who is client:
                self.unsubscribe(client, number)

    def close(self) -> None:
        """Cancel everything under way."""
        for task in self._pending.values():
            task.cancel()

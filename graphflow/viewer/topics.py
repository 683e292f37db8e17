"""Topics as channels of viewers: subscribed to while a client watches, and forwarded without decoding."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

from graphflow.bag.formats.definitions import asked
from graphflow.errors import UsageFault, printable
from graphflow.names import is_hidden
from graphflow.qos import BEST_AVAILABLE
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawSubscription
from graphflow.runtime.node import Node
from graphflow.viewer.client import Client
from graphflow.viewer.protocol import Subscription, message_head, told
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

logger = logging.getLogger("graphflow")

BOUND = 5_000
"""Maximum topics shown, and maximum subscriptions of one client."""
HEARD = replace(BEST_AVAILABLE, depth=100)

Key = tuple[str, str]
"""A topic's name and type; a topic with two types becomes two channels."""


class _Channel(NamedTuple):
    id: int
    entity: Entity
    definition: str

    @property
    def words(self) -> dict[str, Any]:
        """The channel in the protocol's form."""
        said = {"id": self.id, "topic": self.entity.name, "encoding": "cdr", "schemaName": self.entity.type}
        return {**said, "schema": self.definition, "schemaEncoding": "ros2msg"}


class Topics:
    """The topics of a graph as channels.

    Args:
        tell: Sends a message to all clients.
    """

    def __init__(self, node: Node, tell: Callable[[str], object]) -> None:
        self._node, self._tell = node, tell
        self._ids = itertools.count(1)
        self._shown: dict[Key, _Channel] = {}
        self._by_id: dict[int, Key] = {}
        self._coming: dict[Key, asyncio.Task[None]] = {}
        self._left_out: set[Key] = set()
        self._looks: dict[tuple[Client, int], tuple[Key, RawSubscription]] = {}
        self._is_full = False

    def look(self) -> None:
        """Advertise new topics, and withdraw those that are gone."""
        there: dict[Key, Entity] = {}
        for entity in self._node.context.cache.endpoints(Kind.PUBLISHER):
            if not is_hidden(entity.name):
                there.setdefault((entity.name, entity.type), entity)
        for key in self._coming.keys() - there.keys():
            self._coming[key].cancel()
        if gone := self._shown.keys() - there.keys():
            self._hide(gone)
        self._left_out &= there.keys()
        for key in sorted(there.keys() - self._shown.keys() - self._coming.keys() - self._left_out):
            if len(self._shown) + len(self._coming) >= BOUND:
                if not self._is_full:
                    logger.warning("only %s topics are shown", BOUND)
                self._is_full = True
                return
            self._coming[key] = asyncio.ensure_future(self._show(key, there[key]))

    async def _show(self, key: Key, entity: Entity) -> None:
        try:
            definition = await asked(self._node, entity)
        except Exception as error:  # the type comes from another process and may be malformed in any way
            self._left_out.add(key)
            logger.warning("%s is not shown: %s", printable(entity.name), printable(str(error)))
            return
        finally:
            self._coming.pop(key, None)
        channel = self._shown[key] = _Channel(next(self._ids), entity, definition)
        self._by_id[channel.id] = key
        self._tell(told("advertise", channels=[channel.words]))

    def _hide(self, gone: set[Key]) -> None:
        for look, (key, subscription) in list(self._looks.items()):
            if key in gone:
                subscription.close()
                del self._looks[look]
        ids = [self._shown.pop(key).id for key in gone]
        for number in ids:
            del self._by_id[number]
        self._tell(told("unadvertise", channel_ids=ids))

    def greet(self, client: Client) -> None:
        """Advertise all channels to a new client."""
        client.say(told("advertise", channels=[channel.words for channel in self._shown.values()]))

    def subscribe(self, client: Client, wanted: Subscription) -> None:
        """Forward the messages of a channel to a client.

        Each watching client has a subscription of its own, so that it receives the last messages of a latched topic.

        Raises:
            UsageFault: There is no such channel, or the number is in use.
        """
        key, look = self._by_id.get(wanted.channel_id), (client, wanted.id)
        if key is None:
            raise UsageFault(f"there is no channel {wanted.channel_id}")
        if look in self._looks:
            raise UsageFault(f"the subscription {wanted.id} is there already")
        if sum(who is client for who, _ in self._looks) >= BOUND:
            raise UsageFault(f"a viewer looks at no more than {BOUND} topics")
        entity = self._shown[key].entity

        def arrived(payload: bytes, info: MessageInfo) -> None:
            is_time = 0 < info.source_ns < 1 << 63
            head = message_head(wanted.id, info.source_ns if is_time else self._node.clock.time_ns())
            client.show(wanted.id, head + payload)

        subscription = raw.subscribe(self._node, entity.type, entity.name, arrived, HEARD, type_hash=entity.hash)
        self._looks[look] = key, subscription

    def unsubscribe(self, client: Client, number: int) -> None:
        """Stop forwarding a channel to a client."""
        if (client, number) in self._looks:
            self._looks.pop((client, number))[1].close()
            client.forget(number)

    def leave(self, client: Client) -> None:
        """End all subscriptions of a client."""
        for who, number in list(self._looks):
            if who is client:
                self.unsubscribe(client, number)

    def close(self) -> None:
        """Cancel everything under way."""
        for task in self._coming.values():
            task.cancel()

"""Publishers on behalf of viewers, such as for the commands of an on-screen joystick."""

from __future__ import annotations

import json

from graphflow.errors import UsageFault
from graphflow.msgs import registry
from graphflow.msgs.values import from_plain
from graphflow.names import expand
from graphflow.qos import DEFAULT
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawPublisher
from graphflow.runtime.node import Node
from graphflow.viewer.client import Client
from graphflow.viewer.protocol import ClientChannel, Message

BOUND = 200
"""Maximum publishers of all clients together."""
ENCODINGS = ("cdr", "json")
"""Accepted encodings of messages."""


class Publications:
    """The publishers of all clients. Errors are raised as GraphflowError, with a text for the client."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publishers: dict[tuple[Client, int], tuple[RawPublisher, str]] = {}

    def __len__(self) -> int:
        return len(self._publishers)

    def announce(self, client: Client, announced: ClientChannel) -> None:
        """Create a publisher for a client."""
        if announced.encoding not in ENCODINGS:
            raise UsageFault(f"{announced.topic}: messages must be encoded as cdr or json, not {announced.encoding!r}")
        if "/msg/" not in registry.full_name(announced.schema_name):
            raise UsageFault(f"{announced.topic}: {announced.schema_name} is not a message type")
        self.withdraw(client, announced.id)
        if len(self._publishers) >= BOUND:
            raise UsageFault(f"viewers already have {BOUND} publishers")
        topic, type_name = expand(announced.topic, "/", self._node.name), registry.full_name(announced.schema_name)
        publisher = raw.advertise(self._node, type_name, topic, DEFAULT)
        self._publishers[client, announced.id] = publisher, announced.encoding

    def publish(self, client: Client, message: Message) -> None:
        """Publish a client's message."""
        if (client, message.channel_id) not in self._publishers:
            raise UsageFault(f"channel {message.channel_id} was not advertised")
        publisher, encoding = self._publishers[client, message.channel_id]
        data = message.data
        if encoding == "json":
            type_ = registry.interface_class(publisher.type_name)
            try:
                data = from_plain(type_, json.loads(data)).to_bytes()
            except (ValueError, RecursionError) as error:
                raise UsageFault(f"{publisher.name}: {error}") from None
        else:
            # Only to check it: the publisher sends whatever it is given.
            registry.codec(publisher.type_name).decode(data)
        publisher.publish(data)

    def withdraw(self, client: Client, number: int) -> None:
        """Close a client's publisher, if there is one."""
        if (client, number) in self._publishers:
            self._publishers.pop((client, number))[0].close()

    def leave(self, client: Client) -> None:
        """Close all publishers of a client."""
        for owner, number in list(self._publishers):
            if owner is client:
                self.withdraw(client, number)

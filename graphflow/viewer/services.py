"""The services of a graph as services of viewers."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Callable
from typing import NamedTuple

from graphflow.bag.formats.definitions import known
from graphflow.errors import GraphflowError, UnknownInterface, UsageFault, printable
from graphflow.introspect.messages.definitions import asked_sources
from graphflow.msgs import registry
from graphflow.msgs.base import Message, Service
from graphflow.runtime.node import Node
from graphflow.viewer.client import Client
from graphflow.viewer.protocol import Call, control_message, response_frame
from graphflow.wire.liveliness import Entity, Kind

logger = logging.getLogger("graphflow")

LIMIT = 60.0
"""Seconds that a call may take."""
BOUND = 2_000
"""Maximum services shown."""

Key = tuple[str, str]
"""A service's name and type; a node may announce any type under any name."""


class _Shown(NamedTuple):
    id: int
    name: str
    type: str

    @property
    def fields(self) -> dict[str, object]:
        """The service in the protocol's form."""
        service = registry.service_schema(self.type)
        parts = {"request": service.request.name, "response": service.response.name}
        return {"id": self.id, "name": self.name, "type": self.type, **{p: _schema(name) for p, name in parts.items()}}


def _schema(name: str) -> dict[str, str]:
    return {"encoding": "cdr", "schemaName": name, "schemaEncoding": "ros2msg", "schema": known(name)}


class Services:
    """The services of a graph, except those that every node has.

    Args:
        broadcast: Sends a message to all clients.
    """

    def __init__(self, node: Node, broadcast: Callable[[str], object]) -> None:
        self._node, self._broadcast = node, broadcast
        self._ids = itertools.count(1)
        self._shown: dict[Key, _Shown] = {}
        self._pending: dict[Key, asyncio.Task[None]] = {}
        self._rejected: set[Key] = set()

    def update(self) -> None:
        """Advertise new services, and withdraw those that are gone."""
        cache = self._node.context.cache
        current: dict[Key, Entity] = {}
        for name in sorted(cache.offered()[0]):
            for entity in cache.endpoints(Kind.SERVICE, name):
                if len(current) < BOUND:
                    current.setdefault((name, entity.type), entity)
        for key in self._pending.keys() - current.keys():
            self._pending[key].cancel()
        gone = [self._shown.pop(key).id for key in self._shown.keys() - current.keys()]
        if gone:
            self._broadcast(control_message("unadvertiseServices", service_ids=gone))
        self._rejected &= current.keys()
        for key in current.keys() - self._shown.keys() - self._pending.keys() - self._rejected:
            self._pending[key] = asyncio.ensure_future(self._show(key, current[key]))

    async def _show(self, key: Key, entity: Entity) -> None:
        try:
            try:
                registry.full_name(entity.type)
            except UnknownInterface:
                registry.adopt(entity.type, entity.hash, await asked_sources(self._node, entity))
            service = _Shown(next(self._ids), entity.name, entity.type)
            fields = service.fields
        except Exception as error:  # the type comes from another process and may be malformed in any way
            self._rejected.add(key)
            logger.warning("%s is not shown: %s", printable(entity.name), printable(str(error)))
            return
        finally:
            self._pending.pop(key, None)
        self._shown[key] = service
        self._broadcast(control_message("advertiseServices", services=[fields]))

    def greet(self, client: Client) -> None:
        """Advertise all services to a new client."""
        client.send_control(
            control_message("advertiseServices", services=[service.fields for service in self._shown.values()])
        )

    async def call(self, client: Client, call: Call) -> None:
        """Call a service for a client, and send the response or the failure."""
        try:
            client.send_control(response_frame(call, await self._call(call)))
        except GraphflowError as error:
            failure = {"service_id": call.service_id, "call_id": call.call_id, "message": printable(str(error))}
            client.send_control(control_message("serviceCallFailure", **failure))

    async def _call(self, call: Call) -> bytes:
        if call.encoding != "cdr":
            raise UsageFault(f"requests must be encoded as cdr, not {call.encoding!r}")
        service = next((s for s in self._shown.values() if s.id == call.service_id), None)
        if service is None:
            raise UsageFault(f"there is no service {call.service_id}")
        request = registry.codec(registry.service_schema(service.type).request.name).decode(call.data)
        type_: type[Service[Message, Message]] = registry.interface_class(service.type)
        client = self._node.create_client(type_, service.name)
        try:
            return (await client.call(request, timeout=LIMIT)).to_bytes()
        finally:
            client.close()

    def close(self) -> None:
        """Cancel everything under way."""
        for task in self._pending.values():
            task.cancel()

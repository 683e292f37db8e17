"""The services of a graph as services of viewers."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Callable
from typing import Any, NamedTuple

from graphflow.bag.formats.definitions import known
from graphflow.errors import GraphflowError, UnknownInterface, UsageFault, printable
from graphflow.introspect.messages.definitions import asked_sources
from graphflow.msgs import registry
from graphflow.runtime.node import Node
from graphflow.viewer.client import Client
from graphflow.viewer.protocol import Call, answer_frame, told
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
    def words(self) -> dict[str, Any]:
        """The service in the protocol's form."""
        service = registry.service_schema(self.type)
        parts = {"request": service.request.name, "response": service.response.name}
        return {"id": self.id, "name": self.name, "type": self.type, **{p: _schema(name) for p, name in parts.items()}}


def _schema(name: str) -> dict[str, str]:
    return {"encoding": "cdr", "schemaName": name, "schemaEncoding": "ros2msg", "schema": known(name)}


class Services:
    """The services of a graph, except those that every node has.

    Args:
        tell: Sends a message to all clients.
    """

    def __init__(self, node: Node, tell: Callable[[str], object]) -> None:
        self._node, self._tell = node, tell
        self._ids = itertools.count(1)
        self._shown: dict[Key, _Shown] = {}
        self._coming: dict[Key, asyncio.Task[None]] = {}
        self._left_out: set[Key] = set()

    def look(self) -> None:
        """Advertise new services, and withdraw those that are gone."""
        cache = self._node.context.cache
        there: dict[Key, Entity] = {}
        for name in sorted(cache.offered()[0]):
            for entity in cache.endpoints(Kind.SERVICE, name):
                if len(there) < BOUND:
                    there.setdefault((name, entity.type), entity)
        for key in self._coming.keys() - there.keys():
            self._coming[key].cancel()
        gone = [self._shown.pop(key).id for key in self._shown.keys() - there.keys()]
        if gone:
            self._tell(told("unadvertiseServices", service_ids=gone))
        self._left_out &= there.keys()
        for key in there.keys() - self._shown.keys() - self._coming.keys() - self._left_out:
            self._coming[key] = asyncio.ensure_future(self._show(key, there[key]))

    async def _show(self, key: Key, entity: Entity) -> None:
        try:
            try:
                registry.full_name(entity.type)
            except UnknownInterface:
                registry.adopt(entity.type, entity.hash, await asked_sources(self._node, entity))
            service = _Shown(next(self._ids), entity.name, entity.type)
            words = service.words
        except Exception as error:  # the type comes from another process and may be malformed in any way
            self._left_out.add(key)
            logger.warning("%s is not shown: %s", printable(entity.name), printable(str(error)))
            return
        finally:
            self._coming.pop(key, None)
        self._shown[key] = service
        self._tell(told("advertiseServices", services=[words]))

    def greet(self, client: Client) -> None:
        """Advertise all services to a new client."""
        client.say(told("advertiseServices", services=[service.words for service in self._shown.values()]))

    async def call(self, client: Client, call: Call) -> None:
        """Call a service for a client, and send the response or the failure."""
        try:
            client.say(answer_frame(call, await self._answer(call)))
        except GraphflowError as error:
            failure = {"service_id": call.service_id, "call_id": call.call_id, "message": printable(str(error))}
            client.say(told("serviceCallFailure", **failure))

    async def _answer(self, call: Call) -> bytes:
        if call.encoding != "cdr":
            raise UsageFault(f"requests come as cdr here, not as {call.encoding!r}")
        service = next((s for s in self._shown.values() if s.id == call.service_id), None)
        if service is None:
            raise UsageFault(f"there is no service {call.service_id}")
        request = registry.codec(registry.service_schema(service.type).request.name).decode(call.data)
        client: Any = self._node.create_client(registry.interface_class(service.type), service.name)
        try:
            response: bytes = (await client.call(request, timeout=LIMIT)).to_bytes()
            return response
        finally:
            client.close()

    def close(self) -> None:
        """Cancel everything under way."""
        for task in self._coming.values():
            task.cancel()

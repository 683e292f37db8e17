"""A viewer for tests: a client of Foxglove's WebSocket protocol, and a robot to view.

Source: the protocol's specification, foxglove/ws-protocol, version of the subprotocol `foxglove.sdk.v1`.
"""

from __future__ import annotations

import asyncio
import json
import struct
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any, NamedTuple

from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from graphflow import Node, Param, Publisher, Qos, service, subscription
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import SetBool
from graphflow.qos import Durability
from graphflow.testing import Graph
from graphflow.viewer.bridge import Bridge
from tests.until import eventually

LIMIT = 10.0
"""Seconds to wait for anything."""


class Robot(Node):
    """Publishes, listens, serves."""

    speed = Publisher(Twist, "speed")
    map = Publisher(String, "map", qos=Qos(depth=1, durability=Durability.TRANSIENT_LOCAL))
    gain = Param(1.0, ge=0.0, le=5.0)
    title = Param("robot")
    limit = Param(2.0)

    def __init__(self, name: str = "robot") -> None:
        super().__init__(name)
        self.heard: list[Twist] = []

    @subscription(Twist, "cmd_vel")
    def drive(self, twist: Twist) -> None:
        self.heard.append(twist)

    @service(SetBool, "power")
    def power(self, request: SetBool.Request) -> SetBool.Response:
        if not request.data:
            raise ValueError("the robot cannot be switched off")
        return SetBool.Response(success=True, message="on")


class Shown(NamedTuple):
    """A message as a viewer gets it."""

    subscription: int
    log_ns: int
    payload: bytes


class Viewer:
    """One client: its requests, and the messages it has received."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self.info: dict[str, Any] = {}
        self.channels: dict[str, dict[str, Any]] = {}
        """By topic."""
        self.services: dict[str, dict[str, Any]] = {}
        self.offers: set[tuple[str, str]] = set()
        """Names and types of services."""
        self.messages: list[Shown] = []
        self.statuses: list[str] = []
        self.assets: dict[int, tuple[int, str, bytes]] = {}
        """Status, error and data of files, by request."""
        self.parameters: dict[str, Any] = {}
        self.graph: dict[str, Any] = {}
        self.answers: dict[int, bytes] = {}
        self.failures: dict[int, str] = {}
        self.times: list[int] = []
        self.states: list[tuple[int, int, float, int]] = []
        """States of playback: the state, the time, the speed, and whether it answers a request for a time."""
        self._reading = asyncio.ensure_future(self._read())

    async def _read(self) -> None:
        async for message in self._socket:
            if isinstance(message, bytes):
                self._take_bytes(message)
            else:
                self._take(json.loads(message))

    def _take_bytes(self, data: bytes) -> None:
        if data[0] == 1:
            number, ns = struct.unpack_from("<IQ", data, 1)
            self.messages.append(Shown(number, ns, data[13:]))
        elif data[0] == 2:
            self.times.append(struct.unpack_from("<Q", data, 1)[0])
        elif data[0] == 3:
            _, call, length = struct.unpack_from("<III", data, 1)
            assert data[13 : 13 + length] == b"cdr"
            self.answers[call] = data[13 + length :]
        elif data[0] == 5:
            self.states.append(struct.unpack_from("<BQfB", data, 1))
        elif data[0] == 4:
            number, status, length = struct.unpack_from("<IBI", data, 1)
            self.assets[number] = status, data[10 : 10 + length].decode(), data[10 + length :]

    def _take(self, said: dict[str, Any]) -> None:
        match said.pop("op"):
            case "serverInfo":
                self.info = said
            case "advertise":
                self.channels |= {channel["topic"]: channel for channel in said["channels"]}
            case "unadvertise":
                gone = said["channelIds"]
                self.channels = {t: c for t, c in self.channels.items() if c["id"] not in gone}
            case "advertiseServices":
                self.services |= {service["name"]: service for service in said["services"]}
                self.offers |= {(service["name"], service["type"]) for service in said["services"]}
            case "unadvertiseServices":
                gone = said["serviceIds"]
                self.services = {n: s for n, s in self.services.items() if s["id"] not in gone}
            case "serviceCallFailure":
                self.failures[said["callId"]] = said["message"]
            case "parameterValues":
                self.parameters |= {p["name"]: p.get("value") for p in said["parameters"]}
            case "connectionGraphUpdate":
                for part, (key, members) in {
                    "publishedTopics": ("name", "publisherIds"),
                    "subscribedTopics": ("name", "subscriberIds"),
                    "advertisedServices": ("name", "providerIds"),
                }.items():
                    kept = self.graph.setdefault(part, {})
                    kept |= {entry[key]: entry[members] for entry in said.get(part, [])}
            case "status":
                self.statuses.append(said["message"])

    async def until(self, condition: Callable[[], object], limit: float = LIMIT) -> None:
        """Wait until something holds."""
        await eventually(condition, limit=limit)

    async def send(self, op: str, **fields: Any) -> None:
        await self._socket.send(json.dumps({"op": op, **fields}))

    async def say(self, message: str | bytes) -> None:
        """Send a raw message."""
        await self._socket.send(message)

    async def subscribe(self, number: int, topic: str) -> None:
        """Subscribe to a topic."""
        await self.until(lambda: topic in self.channels)
        await self.send("subscribe", subscriptions=[{"id": number, "channelId": self.channels[topic]["id"]}])

    async def publish(self, channel: int, data: bytes) -> None:
        await self._socket.send(struct.pack("<BI", 1, channel) + data)

    async def call(self, number: int, name: str, payload: bytes, encoding: bytes = b"cdr") -> None:
        """Call a service."""
        await self.until(lambda: name in self.services)
        head = struct.pack("<BIII", 2, self.services[name]["id"], number, len(encoding))
        await self._socket.send(head + encoding + payload)


@asynccontextmanager
async def viewer(port: int, origin: str = "") -> AsyncIterator[Viewer]:
    """A client of the server on a local port."""
    protocols = [Subprotocol("foxglove.sdk.v1")]
    page = Origin(origin) if origin else None
    url = f"ws://127.0.0.1:{port}"
    async with connect(url, subprotocols=protocols, origin=page, open_timeout=LIMIT, proxy=None) as socket:
        found = Viewer(socket)
        await found.until(lambda: found.info)
        try:
            yield found
        finally:
            found._reading.cancel()


class Served(NamedTuple):
    """A server and its port."""

    bridge: Bridge
    port: int


@asynccontextmanager
async def served(
    graph: Graph, *nodes: Node, is_read_only: bool = False, pages: tuple[str, ...] = ()
) -> AsyncIterator[Served]:
    """Start nodes, and the server that shows them."""
    node = Node("bridge")
    await graph.start(*nodes, node)
    bridge = Bridge(node, "lab", is_read_only=is_read_only, pages=frozenset(pages))
    try:
        yield Served(bridge, await bridge.open("127.0.0.1", 0))
    finally:
        await bridge.close()

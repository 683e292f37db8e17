"""A bag for viewers: its messages are sent at the pace, and from the time, that a viewer chooses.

All viewers see one playback. One that connects, and one that goes to another time, gets the latest message of each
topic until then, as far as it is near or the topic has few.
"""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Iterator
from functools import partial
from itertools import islice

from graphflow.bag.contents import Record
from graphflow.bag.reader import Bag
from graphflow.errors import BagError, UsageFault
from graphflow.viewer import protocol
from graphflow.viewer.client import Client
from graphflow.viewer.protocol import PlaybackControl, control_message, message_head
from graphflow.viewer.server import ViewerServer
from graphflow.viewer.topics import BOUND

logger = logging.getLogger("graphflow")

LOOK_BACK_NS = 2_000_000_000
"""Nanoseconds before a time that are searched for the latest messages."""
FEW = 100
"""Messages of a topic up to which the latest is found however old it is: maps, descriptions, static transforms."""
FEW_BYTES = 64 << 20
"""Bytes that such topics may have together."""
AT_ONCE = 200
"""Messages that are read at once."""
TICK = 0.05
"""Seconds between two reports of the time."""
SLOWEST, FASTEST = 0.01, 100.0


class Playback:
    """Plays a bag to viewers from `open` to `close`.

    Args:
        name: The name of the server in viewers.
        pages: Origins of further web pages that may connect.

    Raises:
        BagError: The bag has no messages.
    """

    def __init__(self, bag: Bag, name: str, pages: frozenset[str] = frozenset()) -> None:
        if not bag.contents.message_count:
            raise BagError(f"{bag.path}: it has no messages")
        self._bag, self._name = bag, name
        self._viewers = ViewerServer(self, pages)
        topics = [topic for topic in bag.contents.topics.values() if topic.encoding == "cdr" and topic.definition]
        self._channels = {topic.name: number for number, topic in enumerate(topics[:BOUND], 1)}
        """Numbers of channels by topic."""
        self.left_out = sorted(bag.contents.topics.keys() - self._channels.keys())
        """Topics without a definition of their type, which a viewer could not read."""
        self._subscriptions: dict[Client, dict[int, str]] = {}
        """By client: its subscriptions by their numbers, each with its topic."""
        self._few: list[Record] = []
        """The messages of topics that have few."""
        self._is_playing, self._speed = False, 1.0
        self.now_ns = bag.contents.start_ns
        """The time in the bag, nanoseconds since 1970."""
        self._changed = asyncio.Event()
        self._running: asyncio.Task[None] | None = None

    async def open(self, host: str, port: int) -> int:
        """Start the server; return its port.

        Raises:
            TransportError: The server cannot listen there.
            BagError: The bag cannot be read.
        """
        self._few = await asyncio.to_thread(self._topics_with_few)
        found = await self._viewers.open(host, port)
        self._running = asyncio.ensure_future(self._run())
        return found

    async def close(self) -> None:
        """Stop the server and disconnect the viewers."""
        if self._running is not None:
            self._running.cancel()
        await self._viewers.close()

    async def ended(self) -> None:
        """Wait for an error in the bag, which is raised. Raises BagError."""
        assert self._running is not None
        await self._running

    # clients

    def greet(self, client: Client) -> None:
        """Tell a new client the span of the bag, its topics and the state of playback."""
        contents = self._bag.contents
        client.send_control(
            control_message(
                "serverInfo",
                name=self._name,
                capabilities=["time", "playbackControl", "assets"],
                metadata={},
                data_start_time=_stamp(contents.start_ns),
                data_end_time=_stamp(contents.end_ns),
            )
        )
        channels = [self._fields(name, number) for name, number in self._channels.items()]
        client.send_control(control_message("advertise", channels=channels))
        client.send_control(self._state(None))
        self._subscriptions[client] = {}

    def _fields(self, name: str, number: int) -> dict[str, object]:
        topic = self._bag.contents.topics[name]
        schema = {"schemaName": topic.type, "schemaEncoding": "ros2msg", "schema": topic.definition}
        return {"id": number, "topic": name, "encoding": "cdr", **schema}

    def leave(self, client: Client) -> None:
        """Forget a client that has left."""
        self._subscriptions.pop(client, None)

    def handle(self, client: Client, request: protocol.ClientMessage) -> None:
        """Carry out a client's request.

        Raises:
            UsageFault: The bag has no such channel, or can only be watched.
        """
        match request:
            case protocol.Subscribe():
                for wanted in request.subscriptions:
                    self._subscribe(client, wanted)
            case protocol.Unsubscribe():
                for number in request.subscription_ids:
                    self._subscriptions[client].pop(number, None)
                    client.forget(number)
            case PlaybackControl():
                self._control(request)
            case protocol.GetParameters():
                client.send_control(control_message("parameterValues", parameters=[], id=request.id))
            case protocol.FollowParameters() | protocol.FollowGraph():
                pass  # a bag has neither
            case _:
                raise UsageFault("a bag can only be watched")

    def _subscribe(self, client: Client, wanted: protocol.Subscription) -> None:
        topic = next((name for name, number in self._channels.items() if number == wanted.channel_id), None)
        subscriptions = self._subscriptions[client]
        if topic is None:
            raise UsageFault(f"there is no channel {wanted.channel_id}")
        if wanted.id in subscriptions or len(subscriptions) >= BOUND:
            raise UsageFault(f"subscription {wanted.id} exists already, or there are too many")
        subscriptions[wanted.id] = topic
        client.spawn(partial(self._send_latest, client, {topic}))

    def _control(self, request: PlaybackControl) -> None:
        start_ns, end_ns = self._bag.contents.start_ns, self._bag.contents.end_ns
        if not math.isfinite(request.speed) or request.speed <= 0:
            raise UsageFault(f"a bag cannot be played at {request.speed:g} times its speed")
        self._speed = min(FASTEST, max(SLOWEST, request.speed))
        self._is_playing = request.is_playing
        if request.sought_ns is not None:
            self.now_ns = min(end_ns, max(start_ns, request.sought_ns))
        elif request.is_playing and self.now_ns >= end_ns:
            self.now_ns = start_ns
        self._viewers.broadcast(self._state(request))
        if request.sought_ns is not None:
            self._viewers.broadcast(protocol.time_frame(self.now_ns))
            for client, subscriptions in self._subscriptions.items():
                client.spawn(partial(self._send_latest, client, {*subscriptions.values()}))
        self._changed.set()

    def _state(self, request: PlaybackControl | None) -> bytes:
        is_over = self.now_ns >= self._bag.contents.end_ns
        status = protocol.PLAYING if self._is_playing else protocol.ENDED if is_over else protocol.PAUSED
        return protocol.playback_frame(status, self.now_ns, self._speed, request)

    # messages

    def _topics_with_few(self) -> list[Record]:
        names = {name for name in self._channels if self._bag.contents.counts.get(name, 0) <= FEW}
        found, size = [], 0
        for record in self._bag.records(names) if names else ():
            size += len(record.data)
            if size > FEW_BYTES:
                break
            found.append(record)
        return found

    async def _send_latest(self, client: Client, topics: set[str]) -> None:
        """Send the latest message of some topics at the present time."""
        now_ns = self.now_ns
        latest = {r.topic.name: r for r in self._few if r.log_ns <= now_ns and r.topic.name in topics}
        near = await asyncio.to_thread(self._latest_near, topics, now_ns)
        for record in {**latest, **near}.values():
            self._send_to(client, record)

    def _latest_near(self, topics: set[str], now_ns: int) -> dict[str, Record]:
        records = self._bag.records(topics, max(0, now_ns - LOOK_BACK_NS), now_ns + 1) if topics else ()
        return {record.topic.name: record for record in records}

    def _send_to(self, client: Client, record: Record) -> None:
        for number, topic in self._subscriptions.get(client, {}).items():
            if topic == record.topic.name:
                client.send_message(number, message_head(number, record.log_ns) + record.data)

    async def _run(self) -> None:
        """Play whenever a viewer wants it.

        Raises:
            BagError: The bag cannot be read further.
        """
        while True:
            self._changed.clear()
            if self._is_playing:
                await self._play()
            else:
                await self._changed.wait()

    async def _play(self) -> None:
        """Play from the present time, until the bag ends or a viewer changes something."""
        began, from_ns, speed = time.monotonic_ns(), self.now_ns, self._speed
        records = self._bag.records({*self._channels}, from_ns)
        while some := await asyncio.to_thread(_next_of, records):
            for record in some:
                while (left := (record.log_ns - from_ns) / speed - (time.monotonic_ns() - began)) > 0:
                    self.now_ns = min(record.log_ns, from_ns + round((time.monotonic_ns() - began) * speed))
                    if await self._is_interrupted(min(left / 1e9, TICK)):
                        return
                    self._viewers.broadcast(protocol.time_frame(self.now_ns))
                self.now_ns = max(self.now_ns, record.log_ns)
                for client in self._subscriptions:
                    self._send_to(client, record)
            if await self._is_interrupted(0):  # others get their turn, however fast it plays
                return
        self.now_ns, self._is_playing = self._bag.contents.end_ns, False
        self._viewers.broadcast(protocol.time_frame(self.now_ns))
        self._viewers.broadcast(self._state(None))

    async def _is_interrupted(self, seconds: float) -> bool:
        """Wait for some seconds; return whether a viewer has changed something meanwhile."""
        try:
            async with asyncio.timeout(seconds):
                await self._changed.wait()
        except TimeoutError:
            return False
        return True


def _next_of(records: Iterator[Record]) -> list[Record]:
    return list(islice(records, AT_ONCE))


def _stamp(ns: int) -> dict[str, int]:
    return {"sec": ns // 10**9, "nsec": ns % 10**9}

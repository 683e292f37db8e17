"""Plays a bag into a running graph: serialized messages go from the files to the network as they are.

Messages are sent at the moments at which they were received, by a clock that starts once: what one message is late
does not make the next one late.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

from graphflow.bag.contents import Record, Topic
from graphflow.bag.missing import check_messages, remarks
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import EVENTS, Choice
from graphflow.bag.typed import learn
from graphflow.errors import BagError, InvalidName
from graphflow.msgs import registry
from graphflow.names import check_full_name
from graphflow.qos import CLOCK, DEFAULT, Durability, History, Qos, Reliability
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawPublisher
from graphflow.runtime.node import Node
from graphflow.times import to_ns
from graphflow.wire.profile import wire_profile, wire_type

logger = logging.getLogger("graphflow")

COMMANDS = ("/_action/send_goal", "/_action/cancel_goal", "/_action/get_result", EVENTS)
"""Ends of topics that make others act, or tell of those who did."""
STEP_NS = 20_000_000
"""Longest time that the player sleeps while it looks at its keys."""
MIN_RATE, MAX_RATE = 0.001, 1000.0
"""How much slower and faster than it was a bag can be played."""
REST = 0.01
"""Seconds between two rounds of a loop: a bag of one message must not fill the network."""
AT_ONCE = 100
"""Messages that are sent before others have a turn of the loop."""
KEPT = 1000
"""Messages that a publisher keeps for those who come late, at most."""


@dataclass
class PlayOptions:
    """How a bag is played."""

    rate: float = 1.0
    loop: bool = False
    start_offset: float = 0.0
    """Seconds of the bag that are left out at its beginning."""
    duration: float | None = None
    """Seconds of the bag that are played."""
    until_ns: int | None = None
    """Up to which time it is played, nanoseconds since 1970; None for its end."""
    delay: float = 0.0
    """Seconds before the first message, in which subscriptions can find the publishers."""
    clock_hz: float = 0.0
    """How often the time of the bag is published on /clock; 0 for not."""
    is_paused: bool = False
    allows_commands: bool = False
    choice: Choice = field(default_factory=lambda: Choice(all=True, hidden=True))
    remaps: Mapping[str, str] = field(default_factory=dict)
    """New names by those in the bag."""
    qos: Mapping[str, Qos] = field(default_factory=dict)
    """Profiles by names in the bag, in place of those that the bag has."""
    clock_topics: frozenset[str] = frozenset()
    """Topics with each of whose messages the time is published on /clock, too."""
    clocks_all: bool = False
    """Whether that is so for every message."""


class Player:
    """Plays a bag through a node.

    Args:
        node: It runs.
        bag: What is played.

    Raises:
        BagError: Nothing of what was asked for is in the bag, or it asks for a command.
    """

    def __init__(self, node: Node, bag: Bag, options: PlayOptions) -> None:
        self._node, self._bag, self._options = node, bag, options
        self.rate = options.rate
        self.is_paused = options.is_paused
        self.played = 0
        """Messages sent."""
        self.refused: list[str] = []
        """Topics that are not played, each with its reason."""
        self.absent = remarks([bag], options.choice, {*options.remaps, *options.clock_topics})
        """Sentences about names in the options that the bag does not have."""
        self.now_ns = bag.contents.start_ns
        """Where in the bag it is, nanoseconds since 1970."""
        self._steps = 0
        self._sought: int | None = None
        self._is_clocked = options.clocks_all or bool(options.clock_topics)
        self._topics = dict(self._chosen())
        self._publishers: dict[str, RawPublisher] = {}
        if not self._topics:
            why = "; ".join(self.refused or self.absent) or f"it has {', '.join(bag.contents.topics) or 'none'}"
            raise BagError(f"{bag.path}: there is nothing to play: {why}")
        self._check_types()
        check_messages([bag], self._topics, (), *self._span)
        for name, topic in self._topics.items():
            self._publishers[name] = raw.advertise(
                node,
                topic.type,
                options.remaps.get(name, name),
                options.qos.get(name) or offered(topic),
                type_hash=_hash(topic),
            )
        self._clock: Any = None
        if options.clock_hz or self._is_clocked:
            type_ = registry.interface_class("rosgraph_msgs/msg/Clock")
            self._clock = node.create_publisher(type_, "/clock", CLOCK)

    def _check_types(self) -> None:
        """Check that a topic under a new name is of the type that this has, in the graph and in the bag."""
        new_names, there = self._options.remaps, self._node.context.cache.topics(hidden=True)
        for name, topic in self._topics.items():
            if name not in new_names:
                continue
            goes = new_names[name]
            beside = [other.type for n, other in self._topics.items() if new_names.get(n, n) == goes]
            own = (topic.type, wire_type(topic.type, wire_profile()))
            taken = next((type_ for type_ in (*there.get(goes, ()), *beside) if type_ not in own), None)
            if taken is not None:
                text = f"{name} is of type {topic.type}, and {goes} of type {taken}; give it another name with -m"
                raise BagError(f"{self._bag.path}: {text}")

    def _chosen(self) -> Iterator[tuple[str, Topic]]:
        for name, topic in self._bag.contents.topics.items():
            choice = self._options.choice
            if not (choice.wants(name, topic.type) or (choice.all and name.endswith(EVENTS))):
                continue
            goes = self._options.remaps.get(name, name)
            if any(goes.endswith(end) for end in COMMANDS) and not self._options.allows_commands:
                self.refused.append(f"{name} would have others act; to play it: --allow-commands")
            elif topic.encoding != "cdr":
                self.refused.append(f"{name} is serialized as {topic.encoding!r}, not as CDR")
            elif goes == "/clock" and (self._options.clock_hz or self._is_clocked):
                self.refused.append(f"{name} is published by --clock")
            else:
                try:
                    check_full_name(goes)
                    _hash(topic)
                except (InvalidName, BagError) as error:
                    self.refused.append(f"{name}: {error}")
                else:
                    yield name, topic

    @property
    def _span(self) -> tuple[int, int | None]:
        """The part of the bag to play: from one time up to another, nanoseconds since 1970."""
        options, start_ns = self._options, self._bag.contents.start_ns + to_ns(self._options.start_offset)
        ends = [] if options.until_ns is None else [options.until_ns + 1]  # ROS 2 plays what is at that very time
        ends += [] if options.duration is None else [start_ns + to_ns(options.duration)]
        return start_ns, min(ends, default=None)

    @property
    def end_ns(self) -> int:
        """Where the bag ends."""
        return self._bag.contents.end_ns

    @property
    def topics(self) -> list[str]:
        """The names that are played to."""
        return [publisher.name for publisher in self._publishers.values()]

    async def run(self) -> None:
        """Play to the end, once or for ever.

        Raises:
            BagError: The bag cannot be read on.
        """
        clock = asyncio.ensure_future(self._tell_time()) if self._options.clock_hz else None
        try:
            await self._node.clock.sleep(self._options.delay)
            while True:
                before = self.played
                await self._play_once()
                if not self._options.loop or self.played == before:
                    return
                await self._node.clock.sleep(REST)
        finally:
            if clock is not None:
                clock.cancel()

    # commands

    def step(self, count: int = 1) -> None:
        """Send the next messages, if it is paused."""
        if self.is_paused:
            self._steps += count

    async def burst(self, count: int) -> None:
        """Send the first messages at once: so many, or for 0 all; returns when they are sent.

        Raises:
            BagError: The bag cannot be read on.
        """
        await self._node.clock.sleep(self._options.delay)
        for number, record in enumerate(self._bag.records(self._topics, *self._span)):
            if count and number == count:
                return
            self.now_ns = record.log_ns
            self._send(record)
            if number % AT_ONCE == 0:
                await asyncio.sleep(0)

    def seek(self, time_ns: int) -> None:
        """Go on from another moment of the bag."""
        self._sought = time_ns

    # playing

    async def _play_once(self) -> None:
        start, end = self._span
        while True:
            self._sought = None
            await self._play(start, end)
            if self._sought is None:
                return
            start = self._sought

    async def _play(self, start_ns: int, end_ns: int | None) -> None:
        clock = self._node.clock
        records = self._bag.records(self._topics, start_ns, end_ns)
        first = next(records, None)
        if first is None:
            return
        self.now_ns = max(start_ns, self._bag.contents.start_ns)
        began_ns, at_ns, rate, was_paused = clock.monotonic_ns(), self.now_ns, self.rate, False
        count = 0
        for record in chain((first,), records):
            while self._sought is None:
                if rate != self.rate or was_paused:  # from here on by another measure
                    began_ns, at_ns, rate, was_paused = clock.monotonic_ns(), self.now_ns, self.rate, False
                if not self.is_paused:
                    self._steps = 0
                if self.is_paused:
                    if self._steps:
                        self._steps -= 1
                        break
                    was_paused = True
                    await clock.sleep(STEP_NS / 1e9)
                    continue
                passed_ns = round((clock.monotonic_ns() - began_ns) * rate)
                ahead_ns = record.log_ns - at_ns - passed_ns
                if ahead_ns <= 0:
                    break
                self.now_ns = at_ns + passed_ns
                await clock.sleep(min(round(ahead_ns / rate), STEP_NS) / 1e9)
                count = 0
            if self._sought is not None:
                return
            self.now_ns = record.log_ns
            self._send(record)
            count += 1
            if count % AT_ONCE == 0:
                await asyncio.sleep(0)

    def _send(self, record: Record) -> None:
        if self._is_clocked and (self._options.clocks_all or record.topic.name in self._options.clock_topics):
            self._publish_time()
        self._publishers[record.topic.name].publish(record.data)
        self.played += 1

    async def _tell_time(self) -> None:
        async for _ in self._node.clock.every(hz=self._options.clock_hz):
            self._publish_time()

    def _publish_time(self) -> None:
        from graphflow.msgs.builtin_interfaces.msg import Time
        from graphflow.msgs.rosgraph_msgs.msg import Clock

        self._clock.publish(Clock(clock=Time(sec=min(self.now_ns // 10**9, 2**31 - 1), nanosec=self.now_ns % 10**9)))


def offered(topic: Topic) -> Qos:
    """What a topic is played with: what fits all who listened to its publishers."""
    if not topic.qos:
        return DEFAULT
    latched = all(qos.durability is Durability.TRANSIENT_LOCAL for qos in topic.qos)
    return Qos(
        depth=min(max(qos.depth for qos in topic.qos), KEPT),
        reliability=min(qos.reliability for qos in topic.qos) if topic.qos else Reliability.RELIABLE,
        durability=Durability.TRANSIENT_LOCAL if latched else Durability.VOLATILE,
        history=History.KEEP_LAST,
    )


def _hash(topic: Topic) -> str:
    """RIHS01 of a topic's type.

    Raises:
        BagError: The bag does not say, and the type is not known.
    """
    try:
        learn(topic)  # so that others can ask this process for the definition
    except BagError:
        if not topic.hash:
            raise
    return topic.hash or registry.hash_of(topic.type)

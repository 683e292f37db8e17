"""The player of bags: serialized messages go from the files to the network unchanged.

Messages are sent at the moments of their reception, by a clock that starts once: the delay of one message does not
delay the next one.
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
"""Suffixes of topics that make nodes act, or report that they did."""
STEP_NS = 20_000_000
"""Longest sleep of the player, in nanoseconds, between two checks of its commands."""
MIN_RATE, MAX_RATE = 0.001, 1000.0
"""Slowest and fastest rate of playback."""
REST = 0.01
"""Shortest time of a round of a loop, in seconds: a bag of one message must not flood the network."""
AT_ONCE = 100
"""Number of messages that are sent before other tasks get a turn of the loop."""
KEPT = 1000
"""Largest number of messages that a publisher keeps for late subscriptions."""


@dataclass
class PlayOptions:
    """The options of playback."""

    rate: float = 1.0
    loop: bool = False
    start_offset: float = 0.0
    """Seconds of the bag that are skipped at its beginning."""
    duration: float | None = None
    """Seconds of the bag that are played."""
    until_ns: int | None = None
    """Last time that is played, nanoseconds since 1970; None for the bag's end."""
    delay: float = 0.0
    """Seconds before the first message, in which subscriptions discover the publishers."""
    clock_hz: float = 0.0
    """Frequency in Hz at which the time of the bag is published on /clock; 0 for never."""
    is_paused: bool = False
    allows_commands: bool = False
    choice: Choice = field(default_factory=lambda: Choice(all=True, hidden=True))
    remaps: Mapping[str, str] = field(default_factory=dict)
    """New names by names in the bag."""
    qos: Mapping[str, Qos] = field(default_factory=dict)
    """Profiles by names in the bag, in place of the recorded ones."""
    clock_topics: frozenset[str] = frozenset()
    """Topics whose messages trigger publishing the time on /clock."""
    clocks_all: bool = False
    """Whether every message triggers it."""


@dataclass(slots=True)
class _Pace:
    """The relation of bag time to the clock, since playback began or was last paused or changed its rate."""

    began_ns: int
    """Time on the monotonic clock."""
    at_ns: int
    """Time in the bag at that moment."""
    rate: float
    was_paused: bool = False

    def bag_time(self, now_ns: int) -> int:
        """Return the time in the bag.

        Args:
            now_ns: Nanoseconds on the monotonic clock.
        """
        return self.at_ns + round((now_ns - self.began_ns) * self.rate)


class Player:
    """The playback of a bag through a node.

    Args:
        node: A node that runs.
        bag: The bag to play.

    Raises:
        BagError: The bag has none of the chosen topics, or its options name a command.
    """

    def __init__(self, node: Node, bag: Bag, options: PlayOptions) -> None:
        self._node, self._bag, self._options = node, bag, options
        self.rate = options.rate
        self.is_paused = options.is_paused
        self.played = 0
        """Number of messages sent."""
        self.refused: list[str] = []
        """Topics that are not played, with the reasons."""
        self.absent = remarks([bag], options.choice, {*options.remaps, *options.clock_topics})
        """Remarks on names in the options that the bag does not have."""
        self.now_ns = bag.contents.start_ns
        """The position in the bag, nanoseconds since 1970."""
        self._steps = 0
        self._sought: int | None = None
        self._is_clocked = options.clocks_all or bool(options.clock_topics)
        self._topics = dict(self._chosen())
        self._publishers: dict[str, RawPublisher] = {}
        if not self._topics:
            why = "; ".join(self.refused or self.absent) or f"its topics: {', '.join(bag.contents.topics) or 'none'}"
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
        """Check that a renamed topic has the same type in the bag and in the graph."""
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

    @property
    def unheard(self) -> list[str]:
        """The topics, as they are played, that have had no subscription."""
        return sorted(p.name for p in self._publishers.values() if p.published and not p.event_total("matched"))

    def _chosen(self) -> Iterator[tuple[str, Topic]]:
        for name, topic in self._bag.contents.topics.items():
            choice = self._options.choice
            if not (choice.wants(name, topic.type) or (choice.all and name.endswith(EVENTS))):
                continue
            goes = self._options.remaps.get(name, name)
            if any(goes.endswith(end) for end in COMMANDS) and not self._options.allows_commands:
                self.refused.append(f"{name} would make nodes act; to play it: --allow-commands")
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
        """Return the part of the bag to play: its start, and the time before which it ends, nanoseconds since 1970."""
        options, start_ns = self._options, self._bag.contents.start_ns + to_ns(self._options.start_offset)
        ends = [] if options.until_ns is None else [options.until_ns + 1]  # ROS 2 includes messages at that very time
        ends += [] if options.duration is None else [start_ns + to_ns(options.duration)]
        return start_ns, min(ends, default=None)

    @property
    def end_ns(self) -> int:
        """The time at which playback of the bag ends."""
        return self._bag.contents.end_ns

    @property
    def topics(self) -> list[str]:
        """The names under which topics are played."""
        return [publisher.name for publisher in self._publishers.values()]

    async def run(self) -> None:
        """Play to the end, once or in a loop.

        Raises:
            BagError: The bag cannot be read further.
        """
        clock = asyncio.ensure_future(self._publish_clock()) if self._options.clock_hz else None
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
        """Send the next messages, if playback is paused."""
        if self.is_paused:
            self._steps += count

    async def burst(self, count: int) -> None:
        """Send the first messages at once, or all for 0; returns when they are sent.

        Raises:
            BagError: The bag cannot be read further.
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
        """Continue at another time of the bag."""
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
        pace = _Pace(clock.monotonic_ns(), self.now_ns, self.rate)
        count = 0
        for record in chain((first,), records):
            while self._sought is None:
                if pace.rate != self.rate or pace.was_paused:
                    pace = _Pace(clock.monotonic_ns(), self.now_ns, self.rate)
                if self.is_paused:
                    if self._steps:
                        self._steps -= 1
                        break
                    pace.was_paused = True
                    await clock.sleep(STEP_NS / 1e9)
                    continue
                self._steps = 0
                now_ns = pace.bag_time(clock.monotonic_ns())
                ahead_ns = record.log_ns - now_ns
                if ahead_ns <= 0:
                    break
                self.now_ns = now_ns
                await clock.sleep(min(round(ahead_ns / pace.rate), STEP_NS) / 1e9)
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

    async def _publish_clock(self) -> None:
        async for _ in self._node.clock.every(hz=self._options.clock_hz):
            self._publish_time()

    def _publish_time(self) -> None:
        from graphflow.msgs.builtin_interfaces.msg import Time
        from graphflow.msgs.rosgraph_msgs.msg import Clock

        self._clock.publish(Clock(clock=Time(sec=min(self.now_ns // 10**9, 2**31 - 1), nanosec=self.now_ns % 10**9)))


def offered(topic: Topic) -> Qos:
    """Return the profile to play a topic with: one compatible with all subscriptions of its recorded publishers."""
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
    """Return RIHS01 of a topic's type.

    Raises:
        BagError: The bag does not give it, and the type is not known.
    """
    try:
        learn(topic)  # so that this process can return the definition to others
    except BagError:
        if not topic.hash:
            raise
    return topic.hash or registry.hash_of(topic.type)

"""The recorder of topics: serialized messages go from the network into the files unchanged.

The loop takes messages in; a thread compresses and writes them. Between the two is a cache of bounded size: if the disk
is too slow, messages are dropped and counted, and nothing else waits.
"""

from __future__ import annotations

import asyncio
import logging
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace

from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats.definitions import fetch
from graphflow.bag.recording.latched import LatchedMessages
from graphflow.bag.recording.rate_limit import RateLimit
from graphflow.bag.topic_choice import EVENTS, Choice
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError, GraphflowError, printable
from graphflow.names import did_you_mean
from graphflow.qos import BEST_AVAILABLE, Qos
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawSubscription
from graphflow.runtime.node import Node
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

logger = logging.getLogger("graphflow")

CACHE = 100 << 20
"""Default size of the cache in bytes."""
WRITE_EVERY = 0.05
"""Seconds in which messages are collected, so that the writing thread does not wake up for each."""
SEARCH_EVERY = 0.1
"""Seconds between two searches for new topics."""
SUBSCRIPTION_QOS = replace(BEST_AVAILABLE, depth=1000)
"""The profile of subscriptions for which none is given."""
OVERHEAD = 256
"""Overhead of a message in the cache, in bytes."""
SENDERS_BOUND = 10_000
"""Largest number of publishers whose sequence numbers are followed."""


class Recorder:
    """The recording of a node's graph into a bag.

    Args:
        node: A node that runs.
        writer: The bag. The recorder closes it.
        choice: The topics to record.
        cache: Size of the cache in bytes.
        discovery: Whether topics that appear later are recorded, too.
        qos: Subscription profiles by topic, in place of compatible ones.
        unpublished: Whether topics that only have subscriptions are in the bag.
        leaves: Whether topics without other subscriptions are recorded.
        rates: Largest number of messages per second, by topic.
        snapshot: Whether nothing is written before `take_snapshot`; the cache has the last messages until then.
        on_topic: Called with a line on each topic.
    """

    def __init__(
        self,
        node: Node,
        writer: BagWriter,
        choice: Choice,
        *,
        cache: int = CACHE,
        discovery: bool = True,
        qos: Mapping[str, Qos] | None = None,
        unpublished: bool = False,
        leaves: bool = True,
        rates: Mapping[str, float] | None = None,
        snapshot: bool = False,
        on_topic: Callable[[str], object] = logger.info,
    ) -> None:
        self._node, self._writer, self._choice = node, writer, choice
        self._cache, self._is_discovering, self._is_snapshot, self._on_topic = cache, discovery, snapshot, on_topic
        self._qos = qos or {}
        self._gates = {name: RateLimit(rate) for name, rate in (rates or {}).items()}
        self._kinds = (Kind.PUBLISHER, Kind.SUBSCRIPTION) if unpublished else (Kind.PUBLISHER,)
        self._records_leaves = leaves
        self.is_paused = False
        """Whether incoming messages are ignored."""
        self.recorded = self.dropped = self.lost = 0
        """Counts: messages taken in, messages dropped by a full cache, gaps in publishers' sequence numbers."""
        self.failed: asyncio.Future[BagError] = asyncio.get_running_loop().create_future()
        """The reason why nothing can be written any more."""
        self._loop = asyncio.get_running_loop()
        self._subscriptions: dict[str, RawSubscription] = {}
        self._topics: dict[str, Topic] = {}
        self._left_out: set[tuple[str, str]] = set()
        """Other types of topics that are recorded."""
        self._undefined: dict[str, list[tuple[bytes, int, MessageInfo]]] = {}
        """Messages of topics whose definitions are still being fetched."""
        self._undefined_bytes = 0
        self._has_waited = False
        self._last: dict[tuple[str, bytes], int] = {}
        self._new: list[Topic] = []
        """Topics that are not in the bag yet."""
        self._queue: deque[Record] = deque()
        self._kept = LatchedMessages(writer.repeats)
        """Messages that begin a snapshot, although they have left the cache."""
        self._waiting = 0
        """Size of the queue in bytes."""
        self._work = threading.Condition()
        self._is_ending = self._is_writing_snapshot = False
        self._split_after: int | None = None
        """Number of queued messages that belong to the old file, if a split is requested."""
        self._tasks: set[asyncio.Task[None]] = set()
        self._thread = threading.Thread(target=self._write, name="graphflow-recorder", daemon=True)

    @property
    def topics(self) -> int:
        """The number of recorded topics."""
        return len(self._subscriptions)

    @property
    def missing(self) -> list[str]:
        """Topics that were named and have not appeared."""
        events = {f"{service}{EVENTS}" for service in self._choice.services}
        return sorted((self._choice.topics | events) - self._subscriptions.keys())

    @property
    def unused_options(self) -> list[str]:
        """Sentences about topics that have a rate or are to be repeated, but are not recorded."""
        named = {"a rate": self._gates, "messages to repeat": self._writer.repeats.topics}
        return [
            f"{name} has {what}, but is not recorded{did_you_mean(name, self._subscriptions)}"
            for what, names in named.items()
            for name in sorted(names)
            if name not in {*self._subscriptions, *self.missing}
        ]

    @property
    def size(self) -> int:
        """Size of the bag so far in bytes."""
        return self._writer.size

    async def run(self) -> None:
        """Record until cancelled or until writing fails, then finish the bag.

        Raises:
            BagError: The bag could not be written to its end.
        """
        cache, is_new = self._node.context.cache, asyncio.Event()
        stop = self._node.context.on_change(lambda _: is_new.set())
        self.failed.add_done_callback(lambda _: is_new.set())
        self._thread.start()
        try:
            while not self.failed.done():
                for kind in self._kinds:
                    for entity in cache.endpoints(kind):
                        self._consider(entity)
                if not self._is_discovering:
                    await asyncio.wait([self.failed])
                    break
                is_new.clear()
                await is_new.wait()
                await asyncio.wait([self.failed], timeout=SEARCH_EVERY)
        finally:
            stop()
            await self._end()
            await asyncio.sleep(0)  # the thread's last callback is on its way
            if self.failed.done():
                raise self.failed.result()

    async def _end(self) -> None:
        for subscription in self._subscriptions.values():
            self.dropped += subscription.dropped
            subscription.close()
        for task in self._tasks:
            task.cancel()
        try:
            for name in list(self._undefined):
                self._release(name, self._topic(name, ""))
        finally:
            with self._work:
                self._is_ending = True
                self._work.notify()
            await asyncio.to_thread(self._thread.join)

    # commands

    def split(self) -> None:
        """Continue in a new file; messages so far go to the old one."""
        with self._work:
            self._split_after = len(self._queue)
            self._work.notify()

    def take_snapshot(self) -> bool:
        """Write the cache; False if everything is written anyway."""
        with self._work:
            self._is_writing_snapshot = self._is_snapshot
            self._work.notify()
        return self._is_snapshot

    # topics

    def _consider(self, entity: Entity) -> None:
        known = self._subscriptions.get(entity.name)
        if known is not None:
            if known.type_name != entity.type and (entity.name, entity.type) not in self._left_out:
                self._left_out.add((entity.name, entity.type))
                logger.warning("%s is of type %s, too; only %s is recorded", entity.name, entity.type, known.type_name)
            return
        if not self._choice.wants(entity.name, entity.type):
            return
        if entity.zid == self._node.context.session.zid:  # the recorder's own topic
            return
        if not self._records_leaves and not self._has_subscription(entity.name):
            return

        def arrived(payload: bytes, info: MessageInfo) -> None:
            self._arrived(entity.name, payload, info)

        try:
            self._subscriptions[entity.name] = raw.subscribe(
                self._node,
                entity.type,
                entity.name,
                arrived,
                self._qos.get(entity.name, SUBSCRIPTION_QOS),
                type_hash=entity.hash,
            )
        except (GraphflowError, ValueError) as error:  # another process may announce any type
            if (entity.name, entity.type) not in self._left_out:
                self._left_out.add((entity.name, entity.type))
                logger.warning("%s cannot be recorded: %s", printable(entity.name), printable(str(error)))
            return
        self._undefined[entity.name] = []
        self._on_topic(f"Subscribed to topic '{entity.name}'")
        task = asyncio.ensure_future(self._define(entity))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _has_subscription(self, name: str) -> bool:
        own = self._node.context.session.zid
        return any(e.zid != own for e in self._node.context.cache.endpoints(Kind.SUBSCRIPTION, name))

    async def _define(self, entity: Entity) -> None:
        """Fetch the definition of a topic's type, and release its messages."""
        try:
            definition = await fetch(self._node, entity)
        except Exception as error:  # another process may answer anything
            definition, why = "", printable(str(error))
            logger.warning("%s is recorded without the definition of %s: %s", entity.name, entity.type, why)
        self._release(entity.name, self._topic(entity.name, definition))

    def _topic(self, name: str, definition: str) -> Topic:
        publishers = self._node.context.cache.endpoints(Kind.PUBLISHER, name)
        subscription = self._subscriptions[name]
        offered = tuple(dict.fromkeys(entity.qos for entity in publishers))
        return Topic(name, subscription.type_name, subscription.type_hash, definition, offered)

    # messages

    def _arrived(self, name: str, payload: bytes, info: MessageInfo) -> None:
        if self.is_paused:
            # A pause is no gap.
            self._last.clear()
            return
        now_ns = self._node.clock.time_ns()
        if now_ns <= 0:
            self._report_wait()
            return
        self._follow(name, info)
        gate = self._gates.get(name)
        if gate is not None and not gate.passes(now_ns):
            return
        waiting = self._undefined.get(name)
        if waiting is None:
            self._take(Record(self._topics[name], now_ns, _sent(info, now_ns), info.sequence, payload))
        elif self._undefined_bytes + len(payload) + OVERHEAD <= self._cache:
            self._undefined_bytes += len(payload) + OVERHEAD
            waiting.append((payload, now_ns, info))
        else:
            self.dropped += 1

    def _report_wait(self) -> None:
        """Report, once, that nothing is recorded before simulated time has begun."""
        if not self._has_waited:
            self._has_waited = True
            self._on_topic("Waiting for the first message on /clock; nothing is recorded before it")

    def _follow(self, name: str, info: MessageInfo) -> None:
        """Count the gaps in a publisher's sequence numbers."""
        key = (name, info.gid)
        last = self._last.get(key)
        if last is None and len(self._last) >= SENDERS_BOUND:
            return
        if last is not None and info.sequence > last + 1:
            self.lost += info.sequence - last - 1
        self._last[key] = info.sequence

    def _release(self, name: str, topic: Topic) -> None:
        """Release the messages of a topic that waited for its definition."""
        self._topics[name] = topic
        with self._work:
            self._new.append(topic)
        for payload, now_ns, info in self._undefined.pop(name, []):
            self._undefined_bytes -= len(payload) + OVERHEAD
            self._take(Record(topic, now_ns, _sent(info, now_ns), info.sequence, payload))

    def _take(self, record: Record) -> None:
        with self._work:
            size = len(record.data) + OVERHEAD
            if self._is_snapshot:
                while self._queue and self._waiting + size > self._cache:
                    oldest = self._queue.popleft()
                    self._waiting -= len(oldest.data) + OVERHEAD
                    self._kept.put(oldest)
            elif self._waiting + size > self._cache:
                self.dropped += 1
                return
            self._queue.append(record)
            was_low = self._waiting < self._cache // 4
            self._waiting += size
            self.recorded += 1
            # Already at a quarter, so that a burst is written before `WRITE_EVERY` has passed and the cache is full.
            if was_low and self._waiting >= self._cache // 4:
                self._work.notify()

    # the thread

    def _write(self) -> None:
        try:
            while self._write_some():
                pass
            self._writer.close()
        except Exception as error:  # any error: the thread has no caller
            failure = error if isinstance(error, BagError) else BagError(f"{self._writer.folder}: {error!r}")
            try:
                self._writer.salvage()
            finally:
                self._loop.call_soon_threadsafe(self._fail, failure)

    def _fail(self, error: BagError) -> None:
        if not self.failed.done():
            self.failed.set_result(error)

    def _write_some(self) -> bool:
        """Write queued messages; False after the last."""
        with self._work:
            if not self._is_ending:
                self._work.wait(WRITE_EVERY)
            is_ending, split_after = self._is_ending, self._split_after
            topics, self._new = self._new, []
            batch: list[Record] = []
            if not self._is_snapshot or self._is_writing_snapshot:
                batch = list(self._queue)
                self._queue.clear()
                self._waiting = 0
            if self._is_snapshot and batch:
                repeated = list(self._kept.before(batch[0].log_ns, batch))
                for record in batch:
                    self._kept.put(record)
                batch = [*repeated, *batch]
                split_after = None if split_after is None else split_after + len(repeated)
            self._split_after, self._is_writing_snapshot = None, False
        # Without the lock: a slow disk must not hold up the loop.
        for topic in topics:
            self._writer.declare(topic)
        if split_after is not None:
            for record in batch[:split_after]:
                self._writer.add(record)
            self._writer.split()
        for record in batch[split_after:]:
            self._writer.add(record)
        self._writer.keep_up()
        return not is_ending


def _sent(info: MessageInfo, now_ns: int) -> int:
    """Return the time of sending; now, if the sender's is impossible."""
    return info.source_ns if 0 < info.source_ns < 1 << 63 else now_ns

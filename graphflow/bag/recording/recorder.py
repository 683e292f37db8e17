"""Records topics of a running graph: serialized messages go from the network into the files as they are.

The loop takes messages in; a thread packs and writes them. Between the two is a cache of limited size: when the disk
cannot keep up messages are dropped and counted, and nothing else waits.
"""

from __future__ import annotations

import asyncio
import logging
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace

from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats.definitions import asked
from graphflow.bag.recording.latched import LatchedMessages
from graphflow.bag.recording.rate_limit import RateLimit
from graphflow.bag.topic_choice import EVENTS, Choice
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError, GraphflowError, printable
from graphflow.qos import BEST_AVAILABLE, Qos
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawSubscription
from graphflow.runtime.node import Node
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

logger = logging.getLogger("graphflow")

CACHE = 100 << 20
"""Bytes that may wait to be written."""
WRITE_EVERY = 0.05
"""Seconds that a message may wait for others to be written with it: the thread that writes is not woken for each."""
LOOK_EVERY = 0.1
"""Seconds between two looks for new topics."""
HEARD = replace(BEST_AVAILABLE, depth=1000)
OVERHEAD = 256
"""Bytes that a message takes beside its own."""
SENDERS_BOUND = 10_000
"""Publishers whose sequence numbers are followed."""


class Recorder:
    """Records from a node's graph into a bag.

    Args:
        node: It runs.
        writer: Where to. The recorder closes it.
        choice: What is recorded.
        cache: Bytes that may wait to be written.
        discovery: Whether topics that appear later are recorded, too.
        qos: Profiles by topic, to listen with in place of one that fits.
        unpublished: Whether topics are in the bag that are only listened to.
        leaves: Whether topics are recorded that nobody else listens to.
        rates: Messages a second that are recorded at most, by topic.
        snapshot: Whether nothing is written before `take_snapshot`; the cache holds the last messages until then.
        told: Called with a line on each topic.
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
        told: Callable[[str], object] = logger.info,
    ) -> None:
        self._node, self._writer, self._choice = node, writer, choice
        self._cache, self._is_discovering, self._is_snapshot, self._tell = cache, discovery, snapshot, told
        self._qos = qos or {}
        self._gates = {name: RateLimit(rate) for name, rate in (rates or {}).items()}
        self._kinds = (Kind.PUBLISHER, Kind.SUBSCRIPTION) if unpublished else (Kind.PUBLISHER,)
        self._records_leaves = leaves
        self.is_paused = False
        """Whether what comes is left out."""
        self.recorded = self.dropped = self.lost = 0
        """Messages taken in; those that found the cache full; gaps in the numbers of publishers."""
        self.failed: asyncio.Future[BagError] = asyncio.get_running_loop().create_future()
        """Has why nothing can be written any more."""
        self._loop = asyncio.get_running_loop()
        self._subscriptions: dict[str, RawSubscription] = {}
        self._topics: dict[str, Topic] = {}
        self._left_out: set[tuple[str, str]] = set()
        """Other types of topics that are recorded."""
        self._held: dict[str, list[tuple[bytes, int, MessageInfo]]] = {}
        """Messages of topics whose definitions have not come yet."""
        self._held_bytes = 0
        self._has_waited = False
        self._last: dict[tuple[str, bytes], int] = {}
        self._new: list[Topic] = []
        """Topics that are not in the bag yet."""
        self._queue: deque[Record] = deque()
        self._kept = LatchedMessages(writer.repeats)
        """Messages that a snapshot begins with although the cache has them no more."""
        self._waiting = 0
        """Bytes in the queue."""
        self._work = threading.Condition()
        self._is_ending = self._is_writing_snapshot = False
        self._split_after: int | None = None
        """How many of those in the queue are to be in the old file, where a new one is asked for."""
        self._tasks: set[asyncio.Task[None]] = set()
        self._thread = threading.Thread(target=self._write, name="graphflow-recorder", daemon=True)

    @property
    def topics(self) -> int:
        """How many topics are recorded."""
        return len(self._subscriptions)

    @property
    def missing(self) -> list[str]:
        """Topics that were named and have not appeared."""
        events = {f"{service}{EVENTS}" for service in self._choice.services}
        return sorted((self._choice.topics | events) - self._subscriptions.keys())

    @property
    def size(self) -> int:
        """Bytes of the bag so far."""
        return self._writer.size

    async def run(self) -> None:
        """Record until cancelled, or until nothing can be written; then finish the bag.

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
                await asyncio.wait([self.failed], timeout=LOOK_EVERY)
        finally:
            stop()
            await self._end()
            await asyncio.sleep(0)  # the thread's last word is on its way
            if self.failed.done():
                raise self.failed.result()

    async def _end(self) -> None:
        for subscription in self._subscriptions.values():
            self.dropped += subscription.dropped
            subscription.close()
        for task in self._tasks:
            task.cancel()
        try:
            for name in list(self._held):
                self._release(name, self._topic(name, ""))
        finally:
            with self._work:
                self._is_ending = True
                self._work.notify()
            await asyncio.to_thread(self._thread.join)

    # commands

    def split(self) -> None:
        """Go on in a new file; what has come before is in the old one."""
        with self._work:
            self._split_after = len(self._queue)
            self._work.notify()

    def take_snapshot(self) -> bool:
        """Write what the cache holds; False where everything is written anyway."""
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
        if entity.zid == self._node.context.session.zid:  # what the recorder itself says
            return
        if not self._records_leaves and not self._is_heard(entity.name):
            return

        def arrived(payload: bytes, info: MessageInfo) -> None:
            self._arrived(entity.name, payload, info)

        try:
            self._subscriptions[entity.name] = raw.subscribe(
                self._node, entity.type, entity.name, arrived, self._qos.get(entity.name, HEARD), type_hash=entity.hash
            )
        except (GraphflowError, ValueError) as error:  # whoever announced it may call its type anything
            if (entity.name, entity.type) not in self._left_out:
                self._left_out.add((entity.name, entity.type))
                logger.warning("%s cannot be recorded: %s", printable(entity.name), printable(str(error)))
            return
        self._held[entity.name] = []
        self._tell(f"Subscribed to topic '{entity.name}'")
        task = asyncio.ensure_future(self._define(entity))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _is_heard(self, name: str) -> bool:
        own = self._node.context.session.zid
        return any(e.zid != own for e in self._node.context.cache.endpoints(Kind.SUBSCRIPTION, name))

    async def _define(self, entity: Entity) -> None:
        """Find the definition of a topic's type, and let its messages go on."""
        try:
            definition = await asked(self._node, entity)
        except Exception as error:  # whatever another process has answered
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
            self._last.clear()
            return
        now_ns = self._node.clock.time_ns()
        if now_ns <= 0:
            self._say_that_it_waits()
            return
        self._follow(name, info)
        gate = self._gates.get(name)
        if gate is not None and not gate.passes(now_ns):
            return
        held = self._held.get(name)
        if held is None:
            self._take(Record(self._topics[name], now_ns, _sent(info, now_ns), info.sequence, payload))
        elif self._held_bytes + len(payload) + OVERHEAD <= self._cache:
            self._held_bytes += len(payload) + OVERHEAD
            held.append((payload, now_ns, info))
        else:
            self.dropped += 1

    def _say_that_it_waits(self) -> None:
        """Tell once that nothing is recorded before simulated time has begun."""
        if not self._has_waited:
            self._has_waited = True
            self._tell("Waiting for the first message on /clock; nothing is recorded before it")

    def _follow(self, name: str, info: MessageInfo) -> None:
        """Count what the numbers of a publisher leave out."""
        key = (name, info.gid)
        last = self._last.get(key)
        if last is None and len(self._last) >= SENDERS_BOUND:
            return
        if last is not None and info.sequence > last + 1:
            self.lost += info.sequence - last - 1
        self._last[key] = info.sequence

    def _release(self, name: str, topic: Topic) -> None:
        """Let the messages of a topic go on that waited for its definition."""
        self._topics[name] = topic
        with self._work:
            self._new.append(topic)
        for payload, now_ns, info in self._held.pop(name, []):
            self._held_bytes -= len(payload) + OVERHEAD
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
            if was_low and self._waiting >= self._cache // 4:
                self._work.notify()

    # the thread

    def _write(self) -> None:
        try:
            while self._write_some():
                pass
            self._writer.close()
        except Exception as error:  # nobody else would hear of it
            told = error if isinstance(error, BagError) else BagError(f"{self._writer.folder}: {error!r}")
            try:
                self._writer.salvage()
            finally:
                self._loop.call_soon_threadsafe(self._fail, told)

    def _fail(self, error: BagError) -> None:
        if not self.failed.done():
            self.failed.set_result(error)

    def _write_some(self) -> bool:
        """Write what waits; False when that was the last."""
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
                batch, came = [*self._kept.before(batch[0].log_ns, batch), *batch], batch
                for record in came:
                    self._kept.put(record)
            self._split_after, self._is_writing_snapshot = None, False
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
    """When a message was sent; now, where its sender says nothing that can be."""
    return info.source_ns if 0 < info.source_ns < 1 << 63 else now_ns

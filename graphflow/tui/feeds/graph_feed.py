"""The running graph as one hidden client of it sees and hears it.

The console is a client of the rendezvous, not a peer of the nodes: a console that hangs is the rendezvous's
affair, and no node waits for it.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, TypeVar

from graphflow.errors import GraphflowError
from graphflow.introspect import concurrency
from graphflow.introspect.concurrency import ConcurrencyReport
from graphflow.introspect.drawing.picture import misfit
from graphflow.introspect.graph_view import View
from graphflow.introspect.numbers import Numbers
from graphflow.machines.cache import GraphCache
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, explained
from graphflow.msgs.rcl_interfaces.msg import Log
from graphflow.qos import BEST_AVAILABLE
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.wire import process
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.process import NUMBERS, WAITS, ProcessToken, answer_key

T = TypeVar("T")

LOOK_EVERY = 1.0
"""Seconds between two looks at what all processes report."""
ANSWER_LIMIT = 0.9
"""Seconds they have to answer."""
WANTED_FOR = 2.5
"""Seconds after which nobody asks any more for what nobody has looked at."""
REPLIES_BOUND = 1000
PROCESSES_BOUND = 10_000
ENDS_BOUND = 200
"""Endpoints of a topic up to which each publisher is held against each subscription."""
ROSOUT_KEPT = 2000
"""Log messages remembered for where they were written; they are decoded only when somebody asks."""
SAME_MOMENT = 1e-2
"""Seconds within which a line of a log and a message of /rosout are the same record."""


class Live:
    """The graph of one domain, once `open` has found it.

    Args:
        open_view: Opens a blocking view of the graph; another one than Zenoh's for tests.
    """

    def __init__(self, domain: int, open_view: Callable[[int], View] = View) -> None:
        self.domain = domain
        self._open_view = open_view
        self.context: Context | None = None
        self.trouble = ""
        """Why there is no graph to see."""
        self.numbers = Numbers()
        self.concurrency: ConcurrencyReport | None = None
        self.asked_at = 0.0
        """When the processes were asked for it, by the monotonic clock."""
        self.deadlocks: list[Deadlock] = []
        self.processes: dict[str, ProcessToken] = {}
        """The graphflow processes of the domain, by session."""
        self.changes = 0
        """How often a node or endpoint has come or gone."""
        self._looked_at = -1
        """The number of changes at which misfits were looked for."""
        self._ends: dict[str, list[Entity]] = {}
        self._misfits: dict[str, str] = {}
        self._nothing = GraphCache()
        self._node: Node | None = None
        self._rosout: TopicSubscription[Log] | None = None
        self._written: deque[tuple[float, str, str]] = deque(maxlen=ROSOUT_KEPT)
        self._made: dict[tuple[str, str], Any] = {}
        self._wanted: dict[str, float] = {}
        self._looking: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Join the graph; on failure `trouble` says why."""
        try:
            await self.join(await Context.open(self.domain, mode="client", deadlock="off"))
        except GraphflowError as error:
            self.trouble = str(error)

    async def join(self, context: Context) -> None:
        """Join the graph by a context that is open already."""
        self.context = context
        node = Node(
            f"_graphflow_console_{os.getpid()}",
            start_parameter_services=False,
            enable_rosout=False,
            enable_logger_service=False,
        )
        await core_of(node).start(context)
        self._node = node
        self._rosout = node.create_subscription(Log, "/rosout", None, replace(BEST_AVAILABLE, depth=ROSOUT_KEPT))
        context.on_change(lambda _: self._changed())
        context.session.watch(process.watch_key(self.domain), self._process)
        self._looking = asyncio.create_task(self._look())

    def _changed(self) -> None:
        self.changes += 1

    def _process(self, token: str, alive: bool) -> None:
        found = process.parse(token)
        if found is None:
            return
        if not alive:
            self.processes.pop(found.zid, None)
        elif len(self.processes) < PROCESSES_BOUND:
            self.processes[found.zid] = found

    @property
    def cache(self) -> GraphCache:
        """The nodes and endpoints known so far."""
        return self._nothing if self.context is None else self.context.cache

    @property
    def stuck_nodes(self) -> set[str]:
        """The nodes in the rings that were found."""
        if self.concurrency is None:
            return set()
        activities = self.concurrency.graph.activities
        return {activities[name].node for deadlock in self.deadlocks for name in deadlock.ring}

    @property
    def misfits(self) -> dict[str, str]:
        """Mismatches of publishers and subscriptions, by topic; looked for when the graph has changed."""
        if self._looked_at != self.changes:
            self._looked_at = self.changes
            self._ends = {}
            for entity in self.others():
                if entity.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
                    self._ends.setdefault(entity.name, []).append(entity)
            found = {topic: misfit(there) for topic, there in self._ends.items() if len(there) < ENDS_BOUND}
            self._misfits = {topic: why for topic, why in found.items() if why}
        return self._misfits

    def misfits_of(self, node: str) -> int:
        """Topics on which something of a node does not fit."""
        return sum(any(e.node_name == node for e in self._ends[topic]) for topic in self.misfits)

    def others(self) -> Iterator[Entity]:
        """Nodes and endpoints but for those of this console, which would count as a publisher of what it drives."""
        own = "" if self.context is None else self.context.session.zid
        return (entity for entity in self.cache if entity.zid != own)

    @property
    def node(self) -> Node | None:
        """The console's own hidden node, once it is in the graph."""
        return self._node

    def want(self, what: str) -> None:
        """Keep `numbers` or `concurrency` fresh; to be said again at every look."""
        self._wanted[what] = time.monotonic()

    async def _look(self) -> None:
        while True:
            now = time.monotonic()
            wanted = {what for what, at in self._wanted.items() if now - at < WANTED_FOR}
            if "numbers" in wanted:
                replies = await self._ask(NUMBERS)
                self.numbers.take(replies, time.monotonic())
            if "concurrency" in wanted:
                answers = await self._ask(WAITS)
                self.concurrency, self.asked_at = concurrency.read(answers), now
                found = self.concurrency
                self.deadlocks = explained(found.graph, deadlocked(found.graph)) if found.reports else []
            await asyncio.sleep(max(0.1, LOOK_EVERY - (time.monotonic() - now)) if wanted else 0.1)

    async def _ask(self, what: str) -> list[bytes]:
        assert self.context is not None
        done: asyncio.Future[list[bytes]] = self.context.loop.create_future()

        def told(replies: list[bytes], all_there: bool) -> None:
            if all_there and not done.done():
                done.set_result(replies[:REPLIES_BOUND])

        self.context.session.ask_reports(answer_key(self.domain, what), ANSWER_LIMIT, told)
        try:
            async with asyncio.timeout(ANSWER_LIMIT + 1.0):
                return await done
        except TimeoutError:
            return []

    async def ask(self, work: Callable[[View], T]) -> T:
        """Do something with a blocking view of the graph, in a thread.

        Raises:
            GraphflowError: Whatever `work` raises, or nothing is running.
        """
        if self.context is None:
            raise GraphflowError(self.trouble or "not connected to the graph yet")

        def with_view() -> T:
            with self._open_view(self.domain) as view:
                return work(view)

        return await self.context.in_thread(with_view)

    async def source_of(self, stamp: float, text: str) -> str | None:
        """The file and line that wrote a log record, as /rosout has told since we listen; None if it has not."""
        if self._rosout is None:
            return None
        while self._rosout.statistics()["waiting"]:
            log = await anext(self._rosout)
            self._written.append(
                (log.stamp.sec + log.stamp.nanosec * 1e-9, plain_text(log.msg), f"{log.file}:{log.line}")
            )
        near = (w for w in self._written if abs(w[0] - stamp) < SAME_MOMENT)
        return next((place for _, said, place in near if said.startswith(text[:100])), None)

    def publisher(self, type_: type[Any], topic: str) -> Any:
        """A publisher of the console's own on a topic; made once, and only in an open graph."""
        assert self._node is not None
        if ("topic", topic) not in self._made:
            self._made["topic", topic] = self._node.create_publisher(type_, topic)
        return self._made["topic", topic]

    def action_client(self, type_: type[Any], action: str) -> Any:
        """A client of an action; as `publisher`."""
        assert self._node is not None
        if ("action", action) not in self._made:
            self._made["action", action] = self._node.create_action_client(type_, action)
        return self._made["action", action]

    async def close(self) -> None:
        """Leave the graph."""
        if self._looking is not None:
            self._looking.cancel()
        if self._node is not None:
            await core_of(self._node).stop()
        if self.context is not None:
            await self.context.close()

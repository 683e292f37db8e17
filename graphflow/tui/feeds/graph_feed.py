"""The running graph as one hidden client observes it.

The console connects to the rendezvous as a client, not to the nodes as a peer: a console that hangs delays the
rendezvous only, and no node waits for it.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Literal, TypeVar, cast

from graphflow.errors import GraphflowError
from graphflow.introspect import concurrency
from graphflow.introspect.concurrency import ConcurrencyReport
from graphflow.introspect.drawing.picture import misfit
from graphflow.introspect.graph_view import View
from graphflow.introspect.numbers import Numbers
from graphflow.machines.cache import GraphCache
from graphflow.machines.waits.rings import Deadlock
from graphflow.msgs.base import Action, Feedback, Goal, Message, Result
from graphflow.msgs.rcl_interfaces.msg import Log
from graphflow.qos import BEST_AVAILABLE
from graphflow.runtime.actions.client import GoalClient
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.wire import process
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.process import NUMBERS, WAITS, ProcessToken, answer_key

T = TypeVar("T")
M = TypeVar("M", bound=Message)

POLL_INTERVAL = 1.0
"""Seconds between two requests for reports of all processes."""
REPLY_TIMEOUT = 0.9
"""Seconds that processes have to reply."""
WANTED_FOR = 2.5
"""Seconds after which reports that no view uses are no longer requested."""
REPLIES_BOUND = 1000
PROCESSES_BOUND = 10_000
ENDS_BOUND = 200
"""Maximum endpoints of a topic for which every publisher is compared with every subscription."""
ROSOUT_KEPT = 2000
"""Messages of /rosout remembered for their source locations; they are decoded only on demand."""
SAME_MOMENT = 1e-2
"""Seconds within which a log line and a message of /rosout count as the same record."""


class Live:
    """The graph of one domain, known from `open` on.

    Args:
        open_view: Opens a blocking view of the graph; replaced in tests.
    """

    def __init__(self, domain: int, open_view: Callable[[int], View] = View) -> None:
        self.domain = domain
        self._open_view = open_view
        self.context: Context | None = None
        self.trouble = ""
        """The reason why the graph cannot be joined; empty if there is none."""
        self.numbers = Numbers()
        self.concurrency: ConcurrencyReport | None = None
        self.requested_at = 0.0
        """The time of the request for `concurrency`, by the monotonic clock."""
        self.deadlocks: list[Deadlock] = []
        self.processes: dict[str, ProcessToken] = {}
        """The graphflow processes of the domain, by session."""
        self.changes = 0
        """Number of nodes and endpoints that have come or gone."""
        self._searched_at = -1
        """The value of `changes` at the last search for mismatches."""
        self._ends: dict[str, list[Entity]] = {}
        self._misfits: dict[str, str] = {}
        self._empty_cache = GraphCache()
        self._node: Node | None = None
        self._rosout: TopicSubscription[Log] | None = None
        self._rosout_records: deque[tuple[float, str, str]] = deque(maxlen=ROSOUT_KEPT)
        self._publishers: dict[str, object] = {}
        self._action_clients: dict[str, object] = {}
        self._wanted: dict[str, float] = {}
        self._polling: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Join the graph; on failure, `trouble` gives the reason."""
        try:
            await self.join(await Context.open(self.domain, mode="client", deadlock="off"))
        except GraphflowError as error:
            self.trouble = str(error)

    async def join(self, context: Context) -> None:
        """Join the graph with an open context."""
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
        self._polling = asyncio.create_task(self._poll())

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
        return self._empty_cache if self.context is None else self.context.cache

    @property
    def stuck_nodes(self) -> set[str]:
        """The nodes in the deadlocks that were found."""
        if self.concurrency is None:
            return set()
        activities = self.concurrency.graph.activities
        return {activities[name].node for deadlock in self.deadlocks for name in deadlock.ring}

    @property
    def misfits(self) -> dict[str, str]:
        """Mismatches of publishers and subscriptions by topic, updated when the graph has changed."""
        if self._searched_at != self.changes:
            self._searched_at = self.changes
            self._ends = {}
            for entity in self.others():
                if entity.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
                    self._ends.setdefault(entity.name, []).append(entity)
            found = {topic: misfit(ends) for topic, ends in self._ends.items() if len(ends) < ENDS_BOUND}
            self._misfits = {topic: why for topic, why in found.items() if why}
        return self._misfits

    def misfits_of(self, node: str) -> int:
        """Return the number of topics on which an endpoint of a node has a mismatch."""
        return sum(any(e.node_name == node for e in self._ends[topic]) for topic in self.misfits)

    def others(self) -> Iterator[Entity]:
        """Iterate over nodes and endpoints, except those of this console, which publishes to nodes that it drives."""
        own = "" if self.context is None else self.context.session.zid
        return (entity for entity in self.cache if entity.zid != own)

    @property
    def node(self) -> Node | None:
        """The console's own hidden node, once it has joined the graph."""
        return self._node

    def want(self, report: Literal["numbers", "concurrency"]) -> None:
        """Request that `numbers` or `concurrency` be kept fresh. Views repeat the request at every update."""
        self._wanted[report] = time.monotonic()

    async def _poll(self) -> None:
        while True:
            now = time.monotonic()
            wanted = {report for report, at in self._wanted.items() if now - at < WANTED_FOR}
            if "numbers" in wanted:
                replies = await self._request(NUMBERS)
                self.numbers.take(replies, time.monotonic())
            if "concurrency" in wanted:
                answers = await self._request(WAITS)
                # The time of the request, not of the reply: a change made in between is not in the report.
                self.concurrency, self.requested_at = concurrency.read(answers), now
                found = self.concurrency
                self.deadlocks = concurrency.deadlocks(found.graph) if found.reports else []
            await asyncio.sleep(max(0.1, POLL_INTERVAL - (time.monotonic() - now)) if wanted else 0.1)

    async def _request(self, report: str) -> list[bytes]:
        assert self.context is not None
        done: asyncio.Future[list[bytes]] = self.context.loop.create_future()

        def on_replies(replies: list[bytes], is_complete: bool) -> None:
            if is_complete and not done.done():
                done.set_result(replies[:REPLIES_BOUND])

        self.context.session.ask_reports(answer_key(self.domain, report), REPLY_TIMEOUT, on_replies)
        try:
            async with asyncio.timeout(REPLY_TIMEOUT + 1.0):
                return await done
        except TimeoutError:
            return []

    async def ask(self, work: Callable[[View], T]) -> T:
        """Run a function in a thread with a blocking view of the graph.

        Raises:
            GraphflowError: Raised by `work`, or the graph has not been joined.
        """
        if self.context is None:
            raise GraphflowError(self.trouble or "not connected to the graph yet")

        def with_view() -> T:
            with self._open_view(self.domain) as view:
                return work(view)

        return await self.context.in_thread(with_view)

    async def source_of(self, stamp: float, text: str) -> str | None:
        """Return the file and line that wrote a log record, according to /rosout; None if no message matches."""
        if self._rosout is None:
            return None
        while self._rosout.statistics()["waiting"]:
            log = await anext(self._rosout)
            self._rosout_records.append(
                (log.stamp.sec + log.stamp.nanosec * 1e-9, plain_text(log.msg), f"{log.file}:{log.line}")
            )
        near = (w for w in self._rosout_records if abs(w[0] - stamp) < SAME_MOMENT)
        return next((place for _, logged, place in near if logged.startswith(text[:100])), None)

    def publisher(self, type_: type[M], topic: str) -> TopicPublisher[M]:
        """Return the console's own publisher on a topic, created once. The graph must be open."""
        assert self._node is not None
        found = self._publishers.get(topic)
        if found is None:
            found = self._publishers[topic] = self._node.create_publisher(type_, topic)
        return cast("TopicPublisher[M]", found)

    def action_client(
        self, type_: type[Action[Goal, Result, Feedback]], action: str
    ) -> GoalClient[Goal, Result, Feedback]:
        """Return the console's own client of an action; see `publisher`."""
        assert self._node is not None
        found = self._action_clients.get(action)
        if found is None:
            found = self._action_clients[action] = self._node.create_action_client(type_, action)
        return cast("GoalClient[Goal, Result, Feedback]", found)

    async def close(self) -> None:
        """Leave the graph."""
        if self._polling is not None:
            self._polling.cancel()
        if self._node is not None:
            await core_of(self._node).stop()
        if self.context is not None:
            await self.context.close()

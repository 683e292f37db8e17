"""The state shared by all nodes of a process: session, clock, graph cache, ledger and ids."""

from __future__ import annotations

import asyncio
import itertools
import logging
import threading
from collections.abc import Callable
from contextlib import suppress
from contextvars import copy_context
from typing import TYPE_CHECKING, Any, TypeVar, TypeVarTuple

from graphflow.deadlock.inspection import Inspection
from graphflow.deadlock.protocols import Elsewhere, Subject
from graphflow.deadlock.search import Search
from graphflow.domain import domain_id
from graphflow.errors import WrongThread, printable
from graphflow.executor.clock import Clock, WallClock
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import Runner
from graphflow.interface import CALL_TIMEOUT, DeadlockPolicy
from graphflow.machines.cache import GraphCache, GraphChange
from graphflow.names import nearest
from graphflow.runtime.actions.goal_reasons import Reasons
from graphflow.runtime.callables import name_of
from graphflow.runtime.endpoints.direct_calls import Switchboard
from graphflow.runtime.endpoints.intra_process import IntraProcess
from graphflow.runtime.endpoints.shared_memory import Readers
from graphflow.runtime.mistakes.network.same_names import Twins
from graphflow.runtime.mistakes.network.unlatched import Unlatched
from graphflow.runtime.mistakes.network.unmatched import Unmatched
from graphflow.runtime.mistakes.rclpy_words import AttributeHints
from graphflow.transport.base import Closable, Session
from graphflow.transport.event_loop.daemon_threads import THREADS
from graphflow.transport.event_loop.loop import in_thread
from graphflow.wire import process
from graphflow.wire.liveliness import Entity, watch_key
from graphflow.wire.profile import advice, wire_profile

if TYPE_CHECKING:
    from graphflow.transport.link import Link
    from graphflow.transport.rendezvous import Router
    from graphflow.transport.takeover import Takeover

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

logger = logging.getLogger("graphflow")

OFFLOAD_LIMIT = 32
"""Functions that `offload` runs in threads at the same time; further calls wait."""
LINK_GRACE = 3.0
"""Seconds to wait for other machines to answer before continuing without them."""


class Context(AttributeHints):
    """One process's participation in a domain. Made by `open` or, over any session, by the constructor.

    Args:
        deadlock: The policy for deadlocks that involve this process.
        call_timeout: Default timeout of calls, in seconds; None for no limit.
    """

    def _hint(self, name: str) -> str:
        if nearest(name, [word for word in dir(self) if not word.startswith("_")], cutoff=0.75) is not None:
            return ""  # a misspelt attribute
        return "running(...) gives a context: make the node before, node = Talker(), and enter running(node)"

    def __init__(
        self,
        session: Session,
        *,
        domain: int = 0,
        clock: Clock | None = None,
        deadlock: DeadlockPolicy = "raise",
        call_timeout: float | None = CALL_TIMEOUT,
    ) -> None:
        self.session = session
        self.domain = domain
        self.clock = clock or WallClock()
        self.loop = asyncio.get_running_loop()
        self.profile = wire_profile()
        """The wire profile: the ROS 2 distribution whose definitions this process offers."""
        self.cache = GraphCache()
        """The nodes and endpoints of the domain whose tokens have arrived."""
        self.switchboard = Switchboard(session, domain, self.loop)
        """Direct calls to and from other graphflow processes."""
        self.intra_process = IntraProcess()
        """Delivery between nodes of this process."""
        self.readers = Readers(session, domain)
        """Subscriptions in other processes that read large messages from shared memory."""
        self.reasons = Reasons(session, domain)
        """Reasons for rejected and aborted goals."""
        self.call_timeout = call_timeout
        self.nodes: list[Subject] = []
        """The running nodes of this process."""
        self.elsewhere: list[Elsewhere] = []
        """Other sources of callbacks in this process, for the deadlock search."""
        self.ledger = Ledger(self.loop)
        """The waits of this process's handlers."""
        self.noticed: Callable[[BaseException], object] = id
        """Called with each error that a node reported and survived; tests replace it."""
        self._offloads, self._has_warned_full = asyncio.Semaphore(OFFLOAD_LIMIT), False
        self.search = Search(self, deadlock)
        self._inspection = Inspection(self, self.search)
        self._ids = itertools.count()
        self._takeover: Takeover | None = None
        self._link: Link | None = None
        self._listeners: list[Callable[[GraphChange], None]] = []
        self._by_name: dict[str, list[Callable[[GraphChange], None]]] = {}
        self._advised = False
        self.twins = Twins(self)
        self.on_name("", self.twins.changed)  # tokens of nodes have none of an endpoint
        self.unmatched = Unmatched(self)
        self.on_change(self.unmatched.changed)
        self.unlatched = Unlatched(self)
        self._declared: list[Closable] = [session.watch(watch_key(domain), self._token)]

    @classmethod
    async def open(
        cls,
        domain: int | None = None,
        *,
        mode: str = "peer",
        checked: bool = False,
        link: bool = True,
        router: Router | None = None,
        deadlock: DeadlockPolicy = "raise",
        call_timeout: float | None = CALL_TIMEOUT,
    ) -> Context:
        """Join the machine's graphs over Zenoh.

        Args:
            domain: The domain number; None for the environment's, as `domain_id` reads it.
            mode: The Zenoh session's mode: `peer` or `client`.
            checked: Whether a trusted process has just checked the rendezvous.
            link: Whether to link this machine to others if the environment configures it.
            router: The rendezvous, if it was checked and this process is it.
            deadlock, call_timeout: As for `Context`.

        Raises:
            TransportError: The rendezvous cannot be reached or hosted, or belongs to another user.
        """
        from graphflow.transport.rendezvous import establish
        from graphflow.transport.takeover import Takeover
        from graphflow.transport.zenoh import ZenohSession

        domain = domain_id(domain)
        loop = asyncio.get_running_loop()
        # The rendezvous first: through it, the session finds the others.
        takeover = Takeover(router if checked else establish())
        try:
            session = ZenohSession(loop, mode)
        except BaseException:  # cancellation included: nothing stays open
            await takeover.close()
            raise
        context = cls(session, domain=domain, deadlock=deadlock, call_timeout=call_timeout)
        context._takeover = takeover
        context.search.watchdog.start()
        takeover.guard(session)
        context._declared.append(session.announce(process.token(domain, session.zid)))
        if link and not checked:
            try:
                context.open_link()
                await context.wait_linked()
            except BaseException:  # cancellation included: nothing stays open
                await context.close()
                raise
        return context

    @property
    def is_rendezvous(self) -> bool:
        """Whether this process hosts the machine's rendezvous."""
        return self._takeover is not None and self._takeover.is_router

    @property
    def router_id(self) -> str:
        """The rendezvous's Zenoh id in hex; "" while there is none."""
        return "" if self._takeover is None else self._takeover.router_id

    def open_link(self) -> None:
        """Link this machine to others if the environment configures it.

        Raises:
            TransportError, GraphFileError: The environment's link settings are invalid.
        """
        from graphflow.transport.config import reaches_out

        if reaches_out():
            from graphflow.transport.link import Link

            self._link = Link(self.session.bell, self.domain)

    async def wait_linked(self) -> None:
        """Wait until the other machines have answered; on a timeout, log it and continue."""
        if self._link is not None:
            await self._link.wait_ready(LINK_GRACE)

    def arrived(self) -> list[tuple[Runner, bytes, int]]:
        """Return the requests that the loop has not processed yet: (runner, client GID, sequence number) each."""
        return self.switchboard.arrived()

    def next_id(self) -> int:
        """Return a number that no other node or endpoint of this process has."""
        return next(self._ids)

    async def in_thread(
        self, fn: Callable[[*Ts], T], *args: *Ts, stays: bool = False, ended: Callable[[], None] | None = None
    ) -> T:
        """Run `fn(*args)` in a thread, which cannot be cancelled.

        Args:
            stays: Whether to wait for the thread even when cancelled, and raise the cancellation afterwards.
            ended: Called on the loop when the thread ends, whether or not a caller still waits.

        The threads are daemons: unlike those of a pool, they do not delay the interpreter's exit.
        """
        future: asyncio.Future[T] = self.loop.create_future()
        context = copy_context()

        def done(result: T | None, error: BaseException | None) -> None:
            with suppress(RuntimeError):  # the loop has been closed meanwhile
                self.loop.call_soon_threadsafe(_settle, future, result, error)
                if ended is not None:
                    self.loop.call_soon_threadsafe(ended)

        name = f"graphflow-{name_of(fn, 'thread')}"
        try:
            thread = THREADS.run(lambda: context.run(fn, *args), done, name)
        except RuntimeError:  # no thread can be started
            if ended is not None:
                ended()
            raise
        with self.ledger.thread_work(future, thread):
            if stays:
                await _seen_through(future)
            return await future

    @property
    def is_here(self) -> bool:
        """Whether the current thread is the event loop's."""
        return threading.get_ident() == self.ledger.thread

    def refuse_other_threads(self, what: str, instead: str = "node.call_soon(fn, ...) calls fn there") -> None:
        """Raise WrongThread unless this is the thread of the event loop."""
        if not self.is_here:
            name = threading.current_thread().name
            raise WrongThread(f"{what} may not be used from the thread {name!r}, only on the event loop; {instead}")

    async def offload(self, fn: Callable[[*Ts], T], *args: *Ts) -> T:
        """Run `fn(*args)` in a thread, at most `OFFLOAD_LIMIT` at a time."""
        if self._offloads.locked() and not self._has_warned_full:
            self._has_warned_full = True
            logger.warning("offload: %s waits, since %d offloaded functions are running", name_of(fn), OFFLOAD_LIMIT)
        await self._offloads.acquire()
        return await self.in_thread(fn, *args, ended=self._offload_ended)

    def _offload_ended(self) -> None:
        self._offloads.release()
        self._has_warned_full = False

    def on_change(self, listener: Callable[[GraphChange], None]) -> Callable[[], None]:
        """Call `listener` for every node or endpoint that appears or leaves; returns a function that stops this."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def on_name(self, name: str, listener: Callable[[GraphChange], None]) -> Callable[[], None]:
        """Call `listener` for every endpoint called `name` that appears or leaves; returns a function to stop."""
        listeners = self._by_name.setdefault(name, [])
        listeners.append(listener)

        def stop() -> None:
            listeners.remove(listener)
            if not listeners and self._by_name.get(name) is listeners:
                del self._by_name[name]

        return stop

    async def wait_for(self, condition: Callable[[], bool]) -> None:
        """Wait until `condition` holds; it is evaluated whenever the graph changes."""
        if condition():
            return
        future = self.loop.create_future()

        def check(_: GraphChange) -> None:
            if future.done():
                return
            try:
                if condition():
                    future.set_result(None)
            except Exception as error:  # belongs to the waiting caller, not to other listeners of the graph
                future.set_exception(error)

        stop = self.on_change(check)
        try:
            await future
        finally:
            stop()

    def _token(self, token: str, alive: bool) -> None:
        refused = self.cache.refused
        for change in self.cache.apply(token, alive=alive):
            if alive and not self._advised:
                self._advise(change.entity)
            for listener in [*self._by_name.get(change.entity.name, ()), *self._listeners]:
                listener(change)
        if refused == 0 and self.cache.refused:
            text = printable(token[:200])
            logger.warning("a liveliness token is ignored, since it is malformed or exceeds the limit: %s", text)

    def _advise(self, entity: Entity) -> None:
        """Log once that a node on the network uses another wire profile."""
        text = advice(entity, self.profile)
        if text:
            self._advised = True
            logger.warning("%s has %s: %s", entity.node_name, entity.name, text)

    async def close(self) -> None:
        """Leave the network. All nodes must have stopped."""
        self.search.close()
        self.twins.close()
        self.unmatched.close()
        self.unlatched.close()
        self._inspection.close()
        self.reasons.close()
        if self._link is not None:
            await in_thread(self._link.close)
        if self._takeover is not None:
            await self._takeover.close()
        await self.session.close()


async def _seen_through(future: asyncio.Future[T]) -> None:
    """Wait for a thread to end even if the wait is cancelled; then raise the cancellation."""
    cancelled: asyncio.CancelledError | None = None
    while not future.done():
        try:
            await asyncio.shield(future)
        except asyncio.CancelledError as error:
            if future.cancelled():
                raise
            cancelled = error
        # The coroutine is being closed, and may not wait any more.
        except GeneratorExit:
            raise
        except BaseException:  # the thread's error, which the caller raises
            return
    if cancelled is not None and future.exception() is None:
        raise cancelled


def _settle(future: asyncio.Future[Any], result: Any, error: BaseException | None) -> None:
    if future.done():
        return
    if isinstance(error, StopIteration):  # a future cannot carry StopIteration
        error = RuntimeError(f"a thread raised {error!r}")
    if error is not None:
        future.set_exception(error)
    else:
        future.set_result(result)

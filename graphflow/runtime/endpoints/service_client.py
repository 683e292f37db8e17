"""Service clients: calls with a deadline and specific errors."""

from __future__ import annotations

import asyncio
import threading
from asyncio import CancelledError, Future
from collections import deque
from collections.abc import Callable
from contextlib import closing, nullcontext
from types import EllipsisType
from typing import Any, Generic, NamedTuple

from graphflow.errors import (
    CallError,
    CallTimeout,
    ClosedError,
    DeadlockError,
    DecodeError,
    EncodeError,
    LoopBlockedError,
    RemoteError,
    ServerBusy,
    ServerInactive,
    ServerLost,
    ServiceUnavailable,
)
from graphflow.executor.deadlines import Deadlines
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.machines.cache import GraphCache
from graphflow.machines.waits.wait_graph import call_id
from graphflow.msgs import registry
from graphflow.msgs.base import Request, Response, Service
from graphflow.names import is_hidden
from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.endpoints.direct_calls import ClientLine
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.service_events import Introspection, ServiceEvent, ServiceEvents
from graphflow.runtime.endpoints.services import STOPPING
from graphflow.runtime.mistakes.network.other_domains import alone_here
from graphflow.runtime.mistakes.network.unreachable import why_unreachable
from graphflow.runtime.mistakes.network.unserved import Unserved
from graphflow.runtime.part import Host
from graphflow.times import to_ns
from graphflow.transport.base import Answer, Caller
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind

DISCOVERY_GRACE = 1.0
"""Seconds that a call waits for a server to be announced."""
EXPLAINED = 1.0
"""Shortest time limit, in seconds, of a call whose CallTimeout says where the server is."""


def nobody_serves(cache: GraphCache, name: str, type_name: str, *, is_own: bool = False) -> str:
    """Return a sentence on a service that no node offers, with those of its type.

    Args:
        is_own: Whether the calling node itself declares the service but is not ready yet.
    """
    offered = [e.type for e in cache.endpoints(Kind.SERVICE, name)]
    if offered and type_name not in offered:
        return f"service {name} is of type {offered[0]}, not {type_name}"
    if is_own:
        return f"service {name} is this node's own, and opens when on_start has returned; call it in a @task"
    return f"no node offers the service {name} [{type_name}]{cache.service_of_type(name, type_name)}"


class _Reply(NamedTuple):
    """A response that waits for a slot."""

    call: str
    deliver: Callable[[], None]


class ServiceClient(Endpoint, Generic[Request, Response]):
    """A client of a service.

    Args:
        group: The group in which responses take a slot, as in ROS 2; None delivers them at once.
    """

    kind = Kind.CLIENT

    def __init__(
        self,
        host: Host,
        type_: type[Service[Request, Response]],
        name: str,
        qos: Qos,
        group: HandlerGroup | None = None,
    ) -> None:
        super().__init__(host, type_.NAME, name, qos)
        self.type = type_
        self._group = group
        self._replies: deque[_Reply] = deque()
        self.runner: Runner | None = None
        """Runs the deliveries of responses that wait for a slot of the client's group."""
        service = registry.service_schema(type_.NAME)
        self.request_class: type[Any] = registry.interface_class(service.request.name)
        """The class of the type's requests."""
        self._requests, self._responses = registry.codec(service.request.name), registry.codec(service.response.name)
        self._sequence = 0
        self._service_events = ServiceEvents(host, type_, name)
        self._caller: Caller | None = None
        self._line: ClientLine | None = None
        """The line to the server, while there is exactly one."""
        self._pending: set[Future[Answer]] = set()
        self._deadlines: Deadlines | None = None
        self._waiting: set[Future[None]] = set()
        self._unserved = Unserved(host, self._nobody_else)

    def _open(self, key: str) -> None:
        self._caller = self.host.context.session.open_caller(key, self._look_ready)
        self._declared.append(self._caller)
        if self._group is not None:
            label = self.name.rpartition("/")[2]
            spec = RunnerSpec(label, _deliver, _delivered, self.host.full_name, "reply")
            self.runner = self.host.runner(spec, self._replies, self._group)
        self._service_events.open()

    def configure_introspection(self, level: Introspection, qos: Qos | int = DEFAULT) -> None:
        """Publish service events as `ServiceServer.configure_introspection` does."""
        self._service_events.configure(level, Qos.of(qos), is_open=self.is_open)

    def service_is_ready(self) -> bool:
        """Whether a server of this name and type is in the graph and reachable."""
        self._announced()
        # A token may arrive before its endpoint is reachable; the first call is safe only with both.
        return bool(self.matched) and self._caller is not None and self._caller.has_server

    async def wait_ready(self, timeout: float | None = None) -> bool:
        """Wait for a server; returns whether one is ready.

        Args:
            timeout: Seconds; None for no limit.

        Raises:
            ClosedError: The node is not running, or stops during the wait.
        """
        return await self._wait_ready(timeout)

    async def _wait_ready(self, timeout: float | None, *, raises: bool = False) -> bool:
        if self.service_is_ready():
            return True
        future: Future[None] = self.host.context.loop.create_future()
        self._waiting.add(future)
        ledger, clock = self.host.context.ledger, self.host.clock
        try:
            async with clock.timeout(timeout) if timeout is not None else nullcontext():
                with ledger.opening(future, self.name, clock.monotonic_ns()), self._unserved.waiting(raises=raises):
                    await future
        except TimeoutError:
            return False
        finally:
            self._waiting.discard(future)
        return True

    async def expect_ready(self, timeout: float | None) -> None:
        """Wait for a server as `wait_ready`, but raise ServiceUnavailable if none is ready in time."""
        if not await self._wait_ready(timeout, raises=True):
            is_own = self.host.serves(self.name)
            alone = "" if is_own else await alone_here(self.host.context, self.host.full_name)
            raise ServiceUnavailable(f"{await self.nobody()}{alone}")

    def _look_ready(self) -> None:
        if self._waiting and self.entity is not None and self.service_is_ready():
            for future in self._waiting:
                if not future.done():
                    future.set_result(None)

    def _matched(self, other: Entity, alive: bool) -> None:
        if self._line is not None and not alive and other == self._line.server:
            self._line.close()
            self._line = None
        if self._line is None and len(self.matched) == 1:
            (server,) = self.matched.values()
            self._line = ClientLine(self.host.context.switchboard, self._announced(), server)
        self._look_ready()

    async def nobody(self) -> str:
        """Return the reason why no server is reachable."""
        cache = self.host.context.cache
        same = [e for e in cache.endpoints(Kind.SERVICE, self.name) if e.type == self.type_name]
        if same:
            return await why_unreachable(self.host, self.name, same, registry.hash_of(self.type_name))
        return nobody_serves(cache, self.name, self.type_name, is_own=self.host.serves(self.name))

    async def _nobody_else(self) -> str:
        """Return `nobody`'s reason; "" for an action's services, and for waits that the deadlock search reports."""
        return "" if is_hidden(self.name) or self.host.serves(self.name) else await self.nobody()

    async def call(self, request: Request, *, timeout: float | EllipsisType | None = ...) -> Response:
        """Send a request and wait for the response.

        Args:
            request: An instance of the service's `Request`.
            timeout: Seconds; None for no limit; by default the graph's `call_timeout` (10 s).

        Raises:
            ServiceUnavailable: No server appeared within `DISCOVERY_GRACE`.
            ServerLost: The server stopped or disappeared during the call.
            CallTimeout: The deadline passed.
            RemoteError: The handler raised.
            EncodeError: The request does not fit its type.
            DecodeError: The response is malformed.
            WrongThread: This is not the event loop's thread.
        """
        if request.__class__ is not self.request_class:
            wanted = self.request_class.__qualname__
            given = getattr(request, "SCHEMA", None)
            fields = [
                f.name for f in self.request_class.SCHEMA.fields if given is not None and str(f.type) == given.name
            ]
            way = f"{wanted.replace('_', '.')}({f'{fields[0]}=' if len(fields) == 1 else ''}...)"
            raise EncodeError(f"{self.name} takes {wanted}, not {request!r}; write {way}")
        self.host.context.refuse_other_threads(
            f"call of {self.name}", "in a thread, call_sync(request) waits for the response"
        )
        payload = self._requests.encode(request)
        if timeout is ...:
            timeout = self.host.context.call_timeout
        if timeout is not None and timeout < 0:
            raise ValueError(f"timeout= of a call is in seconds, and cannot be {timeout!r}; None waits for ever")
        started = self.host.clock.monotonic_ns()
        if not self._reaches_server():
            await self.expect_ready(DISCOVERY_GRACE if timeout is None else min(timeout, DISCOVERY_GRACE))
        self._sequence += 1
        sequence, gid = self._sequence, self._announced().gid
        self._service_events.tell(ServiceEvent.REQUEST_SENT, gid, sequence, request=request)
        beside = attachment.pack(sequence, self.host.context.clock.time_ns(), gid)
        answer = await self._ask(
            sequence, payload, beside, started, None if timeout is None else started + to_ns(timeout), timeout
        )
        message: Response = self._responses.decode(answer.payload)
        self._service_events.tell(ServiceEvent.RESPONSE_RECEIVED, gid, sequence, response=message)
        return message

    def _reaches_server(self) -> bool:
        self._announced()
        return self._caller is not None and self._caller.has_server

    async def _ask(
        self,
        sequence: int,
        payload: bytes,
        beside: bytes,
        started_ns: int,
        deadline_ns: int | None,
        timeout: float | None,
    ) -> Answer:
        future: Future[Answer] = self.host.context.loop.create_future()

        def answered(answer: Answer | None) -> None:
            if not future.done():
                self._answer(future, sequence, answer)

        def expired() -> CallTimeout:
            return CallTimeout(f"{self.name} did not answer within {timeout:g} s")

        context, gid = self.host.context, self._announced().gid
        deadlines = self._deadlines
        if deadlines is None or deadlines.clock is not self.host.clock:
            deadlines = self._deadlines = Deadlines(self.host.clock)
        if deadline_ns is not None:
            deadlines.add(future, deadline_ns, expired)
        self._pending.add(future)
        give_up = _nothing
        try:
            with context.ledger.call(future, gid, sequence, self.name, started_ns, deadline_ns) as call:
                arrived = answered if self.runner is None else self._queued(answered, call_id(gid, sequence))
                give_up = self._send(sequence, payload, beside, context.search.chain(call), arrived)
                return await future
        except CallTimeout as error:
            try:
                await self._explain(error, call_id(gid, sequence), timeout or 0.0)
            finally:
                give_up()
            raise
        except (ClosedError, CancelledError):
            give_up()
            raise
        finally:
            self._pending.discard(future)
            deadlines.discard(future)

    def _answer(self, future: Future[Answer], sequence: int, answer: Answer | None) -> None:
        """End a call with its answer; None if the server has gone away."""
        if answer is None:
            future.set_exception(ServerLost(f"the server of {self.name} went away before it answered"))
        elif answer.is_error:
            future.set_exception(error_of(answer.payload, self.name))
        elif sequence_of(answer) == sequence:
            future.set_result(answer)

    async def _explain(self, error: CallTimeout, call: str, timeout: float) -> None:
        """Add to the error where the server is, if it is graphflow's; not to errors of short calls, as of polls."""
        server = next(iter(self.matched.values()), None)
        is_heard = self._is_own() or (self._line is not None and self._line.is_heard)
        if timeout < EXPLAINED or server is None or len(self.matched) != 1 or not is_heard:
            return
        from graphflow.deadlock.unanswered import where_served  # most programs never need it

        context = self.host.context
        if text := await where_served(context, context.search.snapshot, call, server.zid):
            error.args = (f"{error}; {text}",)

    def _send(
        self, sequence: int, payload: bytes, beside: bytes, chain: bytes, arrived: Callable[[Answer | None], None]
    ) -> Callable[[], None]:
        """Send a request; returns a function that abandons the response."""
        line = self._line if len(self.matched) == 1 else None
        if line is not None and line.is_open:
            return line.call(sequence, payload, beside + chain, arrived)
        assert self._caller is not None
        # Other servers may not accept an attachment with a call chain at its end.
        is_understood = self._is_own() or (line is not None and line.is_heard)
        return self._caller.call(payload, beside + chain if is_understood else beside, arrived)

    def _queued(self, answered: Callable[[Answer | None], None], call: str) -> Callable[[Answer | None], None]:
        """Return a callback that queues responses for a slot of the client's group."""
        runner = self.runner
        assert runner is not None

        def queue(answer: Answer | None) -> None:
            if answer is not None and answer.is_error and isinstance(error_of(answer.payload, ""), DeadlockError):
                answered(answer)  # the deadlock's own error must not wait for a slot
            elif answer is not None:
                self._replies.append(_Reply(call, lambda: answered(answer)))
                runner.wake()
            # The end of the replies may overtake a response that still waits for its slot.
            elif not any(reply.call == call for reply in self._replies):
                answered(None)

        return queue

    def call_sync(self, request: Request, *, timeout: float | EllipsisType | None = ...) -> Response:
        """Call from a thread and block it until the response arrives. For `def` handlers with `thread=True`.

        Arguments and errors as for `call`.

        Raises:
            LoopBlockedError: This is the event loop's thread, which could not receive the response. With the deadlock
                policy `report`, which is for teaching, the call blocks anyway.
        """
        context = self.host.context
        if (thread := threading.get_ident()) != context.ledger.thread:
            asking = self._ask_for(thread, request, timeout)
            return asyncio.run_coroutine_threadsafe(asking, context.loop).result()
        if context.search.policy != "report":
            raise LoopBlockedError(
                f"{self.name}: call_sync would block the event loop, which must receive the response; "
                "await client.call(...) in an `async def`, or run the handler in a thread (thread=True)"
            )
        return self._block(request, context.call_timeout if timeout is ... else timeout)

    async def _ask_for(self, thread: int, request: Request, timeout: float | EllipsisType | None) -> Response:
        task = asyncio.current_task()
        assert task is not None
        with self.host.context.ledger.asked_from(thread, task):
            return await self.call(request, timeout=timeout)

    def _block(self, request: Request, timeout: float | None) -> Response:
        """Send a request and block the event loop, where no response can arrive."""
        asking = self.call(request, timeout=timeout)
        # The first step sends the request, if a server is known, and yields the future that the call waits for.
        with closing(asking), self.host.context.ledger.blocked_by(asking.send(None)):
            threading.Event().wait(timeout)
        raise CallTimeout(f"no response from {self.name} could arrive within {timeout:g} s: the event loop was blocked")

    def _is_own(self) -> bool:
        """Whether the only server of the service is in this process."""
        servers = self.matched.values()
        return len(servers) == 1 and all(server.zid == self.host.context.session.zid for server in servers)

    def begin_to_stop(self) -> Runner | None:
        return self.runner

    def close(self) -> None:
        """Close the client. Pending calls end with ClosedError."""
        self._service_events.close()
        waiting: list[Future[Any]] = [*self._pending, *self._waiting]
        for future in waiting:
            if not future.done():
                future.set_exception(ClosedError(f"the client of {self.name} was closed while a call waited"))
        if self._line is not None:
            self._line.close()
            self._line = None
        super().close()


def _deliver(reply: _Reply) -> None:
    reply.deliver()


def _delivered(*_: Any) -> None:
    """Do nothing: the call's future already has its outcome."""


def _nothing() -> None:
    """Do nothing: there is no response to abandon yet."""


def error_of(payload: bytes, service: str) -> CallError:
    """Convert an error response to the caller's exception."""
    error = RemoteError.from_payload(payload, service)
    if error.type == STOPPING.type:
        return ServerLost(f"the server of {service} stopped before it answered")
    named = {known.__name__: known for known in (DeadlockError, ServerBusy, ServerInactive)}
    return named[error.type](error.message) if error.type in named else error


def sequence_of(answer: Answer) -> int | None:
    """Return the sequence number of a response's call; None if it has none."""
    try:
        return attachment.unpack((answer.attachment or b"")[: attachment.SIZE]).sequence
    except DecodeError:
        return None

"""Services and their clients at work."""

from __future__ import annotations

import asyncio
import threading
from asyncio import CancelledError, Future
from collections import deque
from collections.abc import Callable
from contextlib import nullcontext
from types import EllipsisType
from typing import TYPE_CHECKING, Any, Generic, NamedTuple

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
    ServerLost,
    ServiceUnavailable,
)
from graphflow.machines.waits import call_id
from graphflow.msgs import registry
from graphflow.msgs.base import Request, Response, Service
from graphflow.names import did_you_mean
from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.direct import ClientLine, DirectRequest, ServerLines
from graphflow.runtime.endpoints import Endpoint
from graphflow.runtime.groups import HandlerGroup
from graphflow.runtime.scheduler import Runner
from graphflow.runtime.service_events import Introspection, ServiceEvent, ServiceEvents
from graphflow.times import to_ns
from graphflow.transport.base import Answer, Caller, Inbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

REQUEST_QUEUE = 64
"""Requests that may wait for a service; more are refused with ServerBusy."""
DISCOVERY_GRACE = 1.0
"""Seconds a call waits for a server that nobody has announced yet."""

_STOPPING = RemoteError("Cancelled", "the server is stopping")
"""What a server that stops answers; no exception class is called that."""


class ServiceServer(Endpoint, Generic[Request, Response]):
    """A service at work."""

    kind = Kind.SERVICE
    is_inner = False
    """Whether it is one that every node has, or a part of an action."""

    def __init__(
        self,
        node: Node,
        type_: type[Service[Request, Response]],
        name: str,
        qos: Qos,
        callback: Callable[[Request], Any],
        label: str = "",
        group: HandlerGroup | None = None,
    ) -> None:
        super().__init__(node, type_.NAME, name, qos)
        self.type = type_
        self._callback = callback
        self._label = label or f"service {name}"
        self._group = group
        service = registry.service_schema(type_.NAME)
        self._decode = registry.codec(service.request.name).decode
        self._encode = registry.codec(service.response.name).encode
        self._response: type[Any] = registry.interface_class(service.response.name)
        self.runner: Runner | None = None
        self.refused = 0
        """Requests answered with ServerBusy because too many were waiting."""
        self._inbox: Inbox | None = None
        self._lines: ServerLines | None = None
        self._service_events = ServiceEvents(node, type_, name)

    def configure_introspection(self, level: Introspection, qos: Qos | int = DEFAULT) -> None:
        """Publish what passes on `<service>/_service_event`: nothing, its metadata, or its contents too."""
        self._service_events.configure(level, Qos.of(qos), is_open=self.is_open)

    def _open(self, key: str) -> None:
        session = self.node.context.session
        self._inbox = Inbox(session.bell, None, self._arrived)
        queue = (self._inbox.items, self._invoke, self._finished, self._refuse)
        self.runner = self.node.runner(self._label, self._group, *queue, kind="service")
        self.runner.is_inner = self.is_inner
        self._declared.append(session.open_server(key, self._inbox))
        self._lines = ServerLines(self.node.context, self._announced(), self._asked)
        self._service_events.open()

    def _matched(self, other: Entity, alive: bool) -> None:
        assert self._lines is not None
        self._lines.client_came() if alive else self._lines.client_gone(other)

    def _asked(self, request: DirectRequest) -> None:
        assert self._inbox is not None
        self._inbox.items.append(request)
        self._arrived()

    def _arrived(self) -> None:
        assert self._inbox is not None
        assert self.runner is not None
        if not self.is_open:
            self._answer_no_more()
            return
        self.runner.wake()
        if self._inbox.items and self.node.context.detector.fails_hopeless:
            self._fail_hopeless()
        while len(self._inbox.items) > REQUEST_QUEUE:
            self._refuse(self._inbox.items.pop(), f"has {REQUEST_QUEUE} requests waiting")

    def _fail_hopeless(self) -> None:
        """End calls that wait, directly or through others, for runs that wait for them."""
        assert self._inbox is not None
        assert self.runner is not None
        waits = self.node.context.waits
        for request in list(self._inbox.items):
            asked = request.attachment or b""
            holders = waits.hopeless(self.runner, asked) if len(asked) > attachment.SIZE else []
            if holders:
                self._inbox.items.remove(request)
                text = self.node.context.detector.why_hopeless(self.name, self.runner, holders)
                request.reply_error(RemoteError(DeadlockError.__name__, text).to_payload())

    def _refuse(self, request: Any, why: str = "runs in a group that is full and drops requests") -> None:
        self.refused += 1
        request.reply_error(RemoteError(ServerBusy.__name__, f"{self.name} {why}").to_payload())

    def _invoke(self, request: Any) -> Any:
        asked = attachment.unpack((request.attachment or b"")[: attachment.SIZE])
        message = self._decode(request.payload)
        self._service_events.tell(ServiceEvent.REQUEST_RECEIVED, asked.gid, asked.sequence, request=message)
        return self._callback(message)

    def _finished(self, request: Any, result: Any, error: BaseException | None) -> None:
        if not self.node.is_running:  # it has not waited for this run, and its clients know that it has gone
            return
        if error is None:
            try:
                if result is None and not self._response.SCHEMA.fields:
                    result = self._response()
                if result.__class__ is not self._response:
                    raise TypeError(
                        f"the handler of {self.name} returned {result!r}, not {self._response.__qualname__}"
                    )
                payload = self._encode(result)
            except (TypeError, EncodeError) as wrong:
                error = wrong
        if error is not None:
            if isinstance(error, CancelledError) and self.runner is not None and self.runner.closed:
                request.reply_error(_STOPPING.to_payload())
                return
            if not isinstance(error, DecodeError):
                self.node.handler_failed(self._label, error)
            request.reply_error(RemoteError(type(error).__name__, str(error)).to_payload())
            return
        asked = attachment.unpack(request.attachment[: attachment.SIZE])
        now = self.node.context.clock.time_ns()
        request.reply(payload, attachment.pack(asked.sequence, now, asked.gid))
        self._service_events.tell(ServiceEvent.RESPONSE_SENT, asked.gid, asked.sequence, response=result)

    def statistics(self) -> dict[str, Any]:
        """Requests answered or under way, failed, waiting and refused."""
        runner, waiting = self.runner, 0 if self._inbox is None else len(self._inbox.items)
        runs, errors = (0, 0) if runner is None else (runner.runs, runner.errors)
        counts = {"runs": runs, "errors": errors, "waiting": waiting, "refused": self.refused}
        return {**counts, **super().statistics()}

    def close(self) -> None:
        self._service_events.close()
        if self.runner is not None:
            self.runner.cancel()
        self._answer_no_more()
        if self._lines is not None:
            self._lines.close()
        super().close()

    def _answer_no_more(self) -> None:
        while self._inbox is not None and self._inbox.items:
            self._inbox.items.popleft().reply_error(_STOPPING.to_payload())


class _Reply(NamedTuple):
    """An answer that waits for a slot."""

    call: str
    deliver: Callable[[], None]


class ServiceClient(Endpoint, Generic[Request, Response]):
    """A client at work.

    Args:
        group: Whose slots answers take, as in ROS 2; None delivers them at once.
    """

    kind = Kind.CLIENT

    def __init__(
        self,
        node: Node,
        type_: type[Service[Request, Response]],
        name: str,
        qos: Qos,
        group: HandlerGroup | None = None,
    ) -> None:
        super().__init__(node, type_.NAME, name, qos)
        self.type = type_
        self._group = group
        self._replies: deque[_Reply] = deque()
        self.runner: Runner | None = None
        """Delivers answers that wait for a slot of the client's group."""
        service = registry.service_schema(type_.NAME)
        self._request: type[Any] = registry.interface_class(service.request.name)
        self._encode = registry.codec(service.request.name).encode
        self._decode = registry.codec(service.response.name).decode
        self._sequence = 0
        self._service_events = ServiceEvents(node, type_, name)
        self._caller: Caller | None = None
        self._line: ClientLine | None = None
        """To the server, while there is only one."""
        self._pending: set[Future[Answer]] = set()
        self._waiting: set[Future[None]] = set()

    def _open(self, key: str) -> None:
        self._caller = self.node.context.session.open_caller(key, self._look_ready)
        self._declared.append(self._caller)
        if self._group is not None:
            queue = (self._replies, _deliver, _delivered)
            self.runner = self.node.runner(self.name.rpartition("/")[2], self._group, *queue, kind="reply")
        self._service_events.open()

    def configure_introspection(self, level: Introspection, qos: Qos | int = DEFAULT) -> None:
        """As `ServiceServer.configure_introspection`."""
        self._service_events.configure(level, Qos.of(qos), is_open=self.is_open)

    def service_is_ready(self) -> bool:
        """Whether a server of this name and type is in the graph and can be reached."""
        self._announced()
        # A token may come before what it announces: only both together make sure of the first call.
        return bool(self.matched) and self._caller is not None and self._caller.has_server

    async def wait_ready(self, timeout: float | None = None) -> None:
        """Wait until there is a server.

        Args:
            timeout: Seconds; None for as long as it takes.

        Raises:
            ServiceUnavailable: None came in time.
            ClosedError: The node is not running, or stopped meanwhile.
        """
        if self.service_is_ready():
            return
        future: Future[None] = self.node.context.loop.create_future()
        self._waiting.add(future)
        try:
            async with self.node.clock.timeout(timeout) if timeout is not None else nullcontext():
                await future
        except TimeoutError:
            raise ServiceUnavailable(self._nobody()) from None
        finally:
            self._waiting.discard(future)

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
            self._line = ClientLine(self.node.context, self._announced(), server)
        self._look_ready()

    def _nobody(self) -> str:
        services = self.node.context.cache.services()
        if self.name in services:
            offered = [e.type for e in self.node.context.cache.endpoints(Kind.SERVICE, self.name)]
            if offered and self.type_name not in offered:
                return f"service {self.name} is a {offered[0]}, not a {self.type_name}"
        if any(isinstance(mine, ServiceServer) and mine.name == self.name for mine in self.node.endpoints):
            return f"service {self.name} is this node's own, and opens when on_start has returned; call it in a @task"
        offers = {e.name for e in self.node.context.cache.endpoints(Kind.SERVICE)}
        return f"nobody offers the service {self.name} [{self.type_name}]{did_you_mean(self.name, offers)}"

    async def call(self, request: Request, *, timeout: float | EllipsisType | None = ...) -> Response:
        """Ask, and wait for the response.

        Args:
            request: An instance of the service's `Request`.
            timeout: Seconds until the call gives up; None waits for ever; left out, as long as the graph says (10 s).

        Raises:
            ServiceUnavailable: There is no server, and none came within `DISCOVERY_GRACE`.
            ServerLost: The server stopped or went away while the call waited.
            CallTimeout: The deadline passed.
            RemoteError: The handler raised.
            EncodeError: The request does not fit its type.
            DecodeError: The response is malformed.
        """
        if request.__class__ is not self._request:
            raise EncodeError(f"{self.name} takes {self._request.__qualname__}, not {request!r}")
        payload = self._encode(request)
        if timeout is ...:
            timeout = self.node.context.call_timeout
        started = self.node.clock.monotonic_ns()
        if not self._reaches_server():
            await self.wait_ready(DISCOVERY_GRACE if timeout is None else min(timeout, DISCOVERY_GRACE))
        self._sequence += 1
        sequence, gid = self._sequence, self._announced().gid
        self._service_events.tell(ServiceEvent.REQUEST_SENT, gid, sequence, request=request)
        beside = attachment.pack(sequence, self.node.context.clock.time_ns(), gid)
        answer = await self._ask(
            sequence, payload, beside, started, None if timeout is None else started + to_ns(timeout), timeout
        )
        message: Response = self._decode(answer.payload)
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
        future: Future[Answer] = self.node.context.loop.create_future()

        def answered(answer: Answer | None) -> None:
            if future.done():
                return
            if answer is None:
                future.set_exception(ServerLost(f"the server of {self.name} went away before it answered"))
            elif answer.is_error:
                future.set_exception(_error_of(answer.payload, self.name))
            elif _sequence_of(answer) == sequence:
                future.set_result(answer)

        def expired() -> None:
            if not future.done():
                future.set_exception(CallTimeout(f"{self.name} did not answer within {timeout:g} s"))

        context = self.node.context
        chain = b""
        if context.detector.is_on:
            chain = context.waits.begin(future, (self._announced().gid, sequence, self.name, started_ns, deadline_ns))
            context.detector.arm()
        self._pending.add(future)
        if self.runner is not None:
            arrived = self._queued(answered, call_id(self._announced().gid, sequence))
        else:
            arrived = answered
        if self._line is not None and self._line.is_open and len(self.matched) == 1:
            give_up = self._line.call(sequence, payload, beside + chain, arrived)
        else:
            assert self._caller is not None
            if self._is_own():  # whoever else answers may not know what stands behind the attachment
                beside += chain
            give_up = self._caller.call(payload, beside, arrived)
        alarm = None if deadline_ns is None else self.node.clock.call_at(deadline_ns, expired)
        try:
            return await future
        except (CallTimeout, ClosedError, CancelledError):
            give_up()
            raise
        finally:
            self._pending.discard(future)
            context.waits.calls.pop(future, None)
            if alarm is not None:
                alarm.cancel()

    def _queued(self, answered: Callable[[Answer | None], None], call: str) -> Callable[[Answer | None], None]:
        """Have answers wait for a slot of the client's group."""
        runner = self.runner
        assert runner is not None

        def queue(answer: Answer | None) -> None:
            if answer is not None and answer.is_error and isinstance(_error_of(answer.payload, ""), DeadlockError):
                answered(answer)  # it would wait for its own caller
            elif answer is not None:
                self._replies.append(_Reply(call, lambda: answered(answer)))
                runner.wake()
            elif not any(reply.call == call for reply in self._replies):
                answered(None)

        return queue

    def call_sync(self, request: Request, *, timeout: float | EllipsisType | None = ...) -> Response:
        """Ask from a thread, and block it until the response is there. For `def` handlers with `thread=True`.

        Arguments and errors as `call`.

        Raises:
            LoopBlockedError: This is the event loop's thread, where nothing could ever be received. With the deadlock
                policy `report`, which is for teaching, it blocks all the same.
        """
        context = self.node.context
        if (thread := threading.get_ident()) != context.waits.thread:
            asking = self._ask_for(thread, request, timeout)
            return asyncio.run_coroutine_threadsafe(asking, context.loop).result()
        if context.detector.policy != "report":
            raise LoopBlockedError(
                f"{self.name}: call_sync would block the event loop, which has to receive the answer; "
                "await client.call(...) in an `async def`, or run the handler in a thread (thread=True)"
            )
        return self._block(request, context.call_timeout if timeout is ... else timeout)

    async def _ask_for(self, thread: int, request: Request, timeout: float | EllipsisType | None) -> Response:
        asking, task = self.node.context.waits.asking, asyncio.current_task()
        assert task is not None
        asking[thread] = task
        try:
            return await self.call(request, timeout=timeout)
        finally:
            del asking[thread]

    def _block(self, request: Request, timeout: float | None) -> Response:
        """Send a request and wait for its answer where it cannot arrive."""
        waits, asking = self.node.context.waits, self.call(request, timeout=timeout)
        waits.blocking = asking.send(None)
        try:
            threading.Event().wait(timeout)
        finally:
            waits.blocking = None
            asking.close()
        raise CallTimeout(f"{self.name} could not answer within {timeout:g} s: the event loop was blocked")

    def _is_own(self) -> bool:
        """Whether its only server is in this process."""
        servers = self.matched.values()
        return len(servers) == 1 and all(server.zid == self.node.context.session.zid for server in servers)

    def close(self) -> None:
        """Withdraw it. Calls that are waiting end with ClosedError."""
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
    """The future of the call has what there is to be told."""


def _error_of(payload: bytes, service: str) -> CallError:
    """What an error reply means to the caller."""
    error = RemoteError.from_payload(payload, service)
    if error.type == _STOPPING.type:
        return ServerLost(f"the server of {service} stopped before it answered")
    if error.type == DeadlockError.__name__:
        return DeadlockError(error.message)
    return ServerBusy(error.message) if error.type == ServerBusy.__name__ else error


def _sequence_of(answer: Answer) -> int | None:
    try:
        return attachment.unpack(answer.attachment or b"").sequence
    except DecodeError:
        return None

"""Service servers: queue requests, run the handler and send the responses."""

from __future__ import annotations

from asyncio import CancelledError
from collections.abc import Callable
from typing import Any, Generic

from graphflow.errors import (
    DeadlockError,
    DecodeError,
    EncodeError,
    RemoteError,
    ServerBusy,
    ServerInactive,
)
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec, title_of
from graphflow.machines.cache import GraphChange
from graphflow.msgs import registry
from graphflow.msgs.base import Request, Response, Service
from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.endpoints.direct_calls import DirectRequest, ServerLines, unanswered, warn_of_refused
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.service_events import Introspection, ServiceEvent, ServiceEvents
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.part import Host
from graphflow.transport.base import request_size
from graphflow.transport.inbox import BYTES_BOUND, REQUESTS_BOUND, RequestInbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind

REQUEST_QUEUE = 64
"""Longest queue of requests; further ones are refused with ServerBusy."""

OFFERED_TWICE = "%s is offered twice by this node, by %s (%s) and %s (%s): each call reaches both; keep one"
STOPPING = RemoteError("Cancelled", "the server is stopping")
"""The response of a stopping server; no exception class has that name."""


class ServiceServer(Endpoint, Generic[Request, Response]):
    """A server of a service.

    Args:
        label: The handler's name in messages.
        is_inner: Whether the service is one that every node has, or part of an action.
        takes_response: Whether the handler also takes an empty response to fill in.
        place: The handler's place in the source.
    """

    kind = Kind.SERVICE

    def __init__(
        self,
        host: Host,
        type_: type[Service[Request, Response]],
        name: str,
        qos: Qos,
        callback: Callable[..., Any],
        label: str = "",
        group: HandlerGroup | None = None,
        *,
        is_inner: bool = False,
        takes_response: bool = False,
        place: str = "",
    ) -> None:
        super().__init__(host, type_.NAME, name, qos)
        self.type = type_
        self.is_inner = is_inner
        self._callback = callback
        self._takes_response, self.place = takes_response, place
        self._label = label or f"service {name}"
        self._group = group
        service = registry.service_schema(type_.NAME)
        self._requests, self._responses = registry.codec(service.request.name), registry.codec(service.response.name)
        self._response: type[Any] = registry.interface_class(service.response.name)
        self.runner: Runner | None = None
        self.refused = 0
        """Requests refused with ServerBusy by a full queue."""
        self._inbox: RequestInbox | None = None
        self._lines: ServerLines | None = None
        self._service_events = ServiceEvents(host, type_, name)

    @property
    def handler_title(self) -> str:
        return title_of("service", self._label)

    def configure_introspection(self, level: Introspection, qos: Qos | int = DEFAULT) -> None:
        """Publish events of calls on `<service>/_service_event`: none, metadata, or the messages as well."""
        self._service_events.configure(level, Qos.of(qos), is_open=self.is_open)

    def _open(self, key: str) -> None:
        session = self.host.context.session
        self._inbox = RequestInbox(session.bell, REQUESTS_BOUND, self._arrived, request_size, unanswered)
        self._inbox.tell_losses(self._warn_of_refused, 1)
        tell = (self._invoke, self._finished, self.host.full_name)
        spec = RunnerSpec(self._label, *tell, "service", self._refuse, is_inner=self.is_inner)
        self.runner = self.host.runner(spec, self._inbox.items, self._group)
        self._declared.append(session.open_server(key, self._inbox))
        self._lines = ServerLines(self.host.context.switchboard, self._announced(), self.runner, self._asked)
        self._service_events.open()

    def _counterpart(self, change: GraphChange) -> None:
        super()._counterpart(change)
        other = change.entity
        if change.alive and other.kind is Kind.SERVICE and other.node_name != self.host.full_name:
            self.host.context.twins.share(self.name)

    def _matched(self, other: Entity, alive: bool) -> None:
        assert self._lines is not None
        self._lines.client_came(other) if alive else self._lines.client_gone(other)

    def _asked(self, request: DirectRequest) -> None:
        assert self._inbox is not None
        # Past the inbox's own bounds: the line's inbox has enforced them already.
        self._inbox.items.append(request)
        self._arrived()

    def _arrived(self) -> None:
        assert self._inbox is not None
        assert self.runner is not None
        if not self.is_open or self.idle_because:
            self._answer_no_more()
            return
        self.runner.wake()
        if self._inbox.items:
            self._fail_hopeless()
        items = self._inbox.items
        while len(items) > REQUEST_QUEUE:
            self._refuse(items.pop(), f"has {REQUEST_QUEUE} requests waiting")
        # REQUEST_QUEUE requests exceed the byte limit only if one is larger than its share: sum up only then.
        while len(items) > 1 and request_size(items[-1]) > BYTES_BOUND // REQUEST_QUEUE:
            if sum(map(request_size, tuple(items))) <= BYTES_BOUND:
                break
            self._refuse(items.pop(), f"has {BYTES_BOUND >> 20} MB of requests waiting")

    def _warn_of_refused(self) -> None:
        assert self._inbox is not None
        warn_of_refused(self._inbox, f"{self.name} of {self.host.full_name}: requests")

    def _fail_hopeless(self) -> None:
        """End waiting calls that depend, directly or through others, on runs that wait for them."""
        assert self._inbox is not None
        assert self.runner is not None
        search = self.host.context.search
        for request in list(self._inbox.items):
            asked = request.attachment or b""
            text = search.hopeless(self.name, self.runner, asked) if len(asked) > attachment.SIZE else ""
            if text:
                self._inbox.items.remove(request)
                request.reply_error(RemoteError(DeadlockError.__name__, text).to_payload())

    def _refuse(self, request: Any, why: str = "runs in a group that is full and drops requests") -> None:
        self.refused += 1
        request.reply_error(RemoteError(ServerBusy.__name__, f"{self.name} {why}").to_payload())

    def _invoke(self, request: Any) -> Any:
        asked = attachment.unpack((request.attachment or b"")[: attachment.SIZE])
        message = self._requests.decode(request.payload)
        self._service_events.tell(ServiceEvent.REQUEST_RECEIVED, asked.gid, asked.sequence, request=message)
        return self._callback(message, self._response()) if self._takes_response else self._callback(message)

    def _finished(self, request: Any, result: Any, error: BaseException | None) -> None:
        if not self.host.is_running:  # the run outlived the stop, and its clients have seen the server go
            return
        if error is None:
            try:
                if result is None and not self._response.SCHEMA.fields:
                    result = self._response()
                if result.__class__ is not self._response:
                    from graphflow.runtime.mistakes.wrong_returns import wrong_return  # most programs never need it

                    raise wrong_return(result, self._response, self._callback, self.place)
                payload = self._responses.encode(result)
            except (TypeError, EncodeError) as wrong:
                error = wrong
        if error is not None:
            if isinstance(error, CancelledError) and self.runner is not None and self.runner.closed:
                request.reply_error(self._why_ended().to_payload())
                return
            if not isinstance(error, DecodeError):
                self.host.handler_failed(self._label, error)
            request.reply_error(RemoteError(type(error).__name__, self._error_text(error)).to_payload())
            return
        asked = attachment.unpack(request.attachment[: attachment.SIZE])
        now = self.host.context.clock.time_ns()
        request.reply(payload, attachment.pack(asked.sequence, now, asked.gid))
        self._service_events.tell(ServiceEvent.RESPONSE_SENT, asked.gid, asked.sequence, response=result)

    def _error_text(self, error: BaseException) -> str:
        """Return the error text for the client; a deadlock's full explanation is logged only here."""
        explain(error)
        head, _, rest = str(error).partition("\n")
        if not rest or not isinstance(error, DeadlockError):
            return str(error)
        return f"{head}; explained in the log of {self.host.full_name}"

    def statistics(self) -> dict[str, Any]:
        """Return counters: requests answered or under way, failed, waiting and refused."""
        runner, waiting = self.runner, 0 if self._inbox is None else len(self._inbox.items)
        runs, errors = (0, 0) if runner is None else (runner.runs, runner.errors)
        refused = self.refused + (0 if self._inbox is None else self._inbox.dropped)
        counts = {"runs": runs, "errors": errors, "waiting": waiting, "refused": refused}
        return {**counts, **super().statistics()}

    def begin_to_stop(self) -> Runner | None:
        return self.runner

    def pause(self, why: str) -> Runner | None:
        """Answer requests with an error that has the reason."""
        super().pause(why)
        self._answer_no_more()
        return self.runner

    def resume(self) -> Runner | None:
        super().resume()
        if self.runner is not None:
            self.runner.reopen()
        return self.runner

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
            self._inbox.items.popleft().reply_error(self._why_ended().to_payload())

    def _why_ended(self) -> RemoteError:
        return RemoteError(ServerInactive.__name__, self.idle_because) if self.idle_because else STOPPING

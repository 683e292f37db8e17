"""Service servers."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from graphflow.errors import DecodeError
from graphflow.rclpy.messages import classes
from graphflow.runtime.endpoints.service_events import ServiceEvent
from rclpy.handle import Handle
from rclpy.impl.mistakes.arguments import must_return
from rclpy.impl.reexports import passed_on
from rclpy.impl.service_end import ServiceEnd

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.endpoints.threaded import Asked, ThreadedService
    from rclpy.callback_groups import CallbackGroup
    from rclpy.qos import QoSProfile


class RequestHeader(NamedTuple):
    """The sender of a request, needed to answer it."""

    asked: Asked

    @property
    def request_id(self) -> tuple[bytes, int]:
        return self.asked.gid, self.asked.sequence

    @property
    def source_timestamp(self) -> int:
        return self.asked.source_ns


class Service(ServiceEnd):
    """A service server. Create it with `Node.create_service`."""

    turn = 4
    endpoint: ThreadedService

    def __init__(
        self,
        service_impl: ThreadedService,
        srv_type: Any,
        srv_name: str,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        *,
        life: ContextState,
        handle: Handle,
    ) -> None:
        self.srv_type, self.srv_name, self.callback = srv_type, srv_name, callback
        self.callback_group, self.qos_profile = callback_group, qos_profile
        self.endpoint, self._life, self._handle = service_impl, life, handle
        # As rclpy's handle has it: code without an executor takes requests by it.
        handle.__dict__["service_take_request"] = self._take_request

    def send_response(self, response: object, header: RequestHeader) -> None:
        """Answer a request. Raises TypeError if the response is not of the service's type."""
        if not isinstance(response, self.srv_type.Response):
            raise TypeError(f"Expected {self.srv_type.Response}, got {classes.what_came(response)}")
        with self._handle:
            payload = classes.encode(response)
            self.endpoint.answer(header.asked, payload)
            self.endpoint.tell(ServiceEvent.RESPONSE_SENT, header.asked, payload)

    def has_work(self) -> bool:
        return bool(self.endpoint.inbox.items)

    def take_work(self) -> Callable[[], object] | None:
        asked = self.endpoint.take()
        if asked is None:
            return None
        return partial(self._do_async if inspect.iscoroutinefunction(self.callback) else self._do, asked)

    def _request(self, asked: Asked) -> Any:
        try:
            request = classes.decode(self.srv_type.Request, asked.payload)
            self.endpoint.tell(ServiceEvent.REQUEST_RECEIVED, asked, asked.payload)
            return request
        except DecodeError as error:
            self.endpoint.host.log.warning("%s: a malformed request is not answered: %s", self.endpoint.name, error)
            return None

    def _do(self, asked: Asked) -> None:
        request = self._request(asked)
        if request is not None:
            self._answer(self.callback(request, self.srv_type.Response()), asked)

    async def _do_async(self, asked: Asked) -> None:
        request = self._request(asked)
        if request is not None:
            self._answer(await self.callback(request, self.srv_type.Response()), asked)

    def _answer(self, response: object, asked: Asked) -> None:
        if not isinstance(response, self.srv_type.Response):
            raise TypeError(must_return(self.callback, "its response", response))
        self.send_response(response, RequestHeader(asked))

    def _take_request(self, request_type: object) -> tuple[object, RequestHeader | None]:
        asked = self.endpoint.take()
        return (None, None) if asked is None else (classes.decode(request_type, asked.payload), RequestHeader(asked))


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

"""The services of an action, which need the client's identity and never wait for a user's group."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from graphflow.executor.groups import HandlerGroup
from graphflow.msgs.base import Service
from graphflow.qos import SERVICES
from graphflow.runtime.endpoints.services import ServiceServer
from graphflow.runtime.part import Host
from graphflow.transport.base import Request
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity

Answer = Callable[[Any, bytes], object]
"""Takes a request and the client's GID; returns the response, or a coroutine for it."""


class GoalService(ServiceServer[Any, Any]):
    """One of an action's services.

    Args:
        answer: Answers a request.
        client_gone: Called with the GID of a client whose token is gone.
    """

    def __init__(
        self,
        host: Host,
        type_: type[Service[Any, Any]],
        name: str,
        answer: Answer,
        label: str,
        client_gone: Callable[[bytes], None],
    ) -> None:
        # A group of its own without a limit: a goal can be cancelled while its handler's group is full.
        lane = HandlerGroup(None, name.rpartition("/")[2])
        super().__init__(host, type_, name, SERVICES, answer, label, lane, is_inner=True)
        self._client_gone = client_gone

    def _invoke(self, request: Request) -> object:
        asked = attachment.unpack((request.attachment or b"")[: attachment.SIZE])
        return self._callback(self._requests.decode(request.payload), asked.gid)

    def _matched(self, other: Entity, alive: bool) -> None:
        super()._matched(other, alive)
        if not alive:
            self._client_gone(other.gid)

"""Service introspection: events of calls, published for observers.

Source: service_msgs/msg/ServiceEventInfo; rcl service_introspection.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, Literal

from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.part import Host

if TYPE_CHECKING:
    from graphflow.msgs.base import Message, Service

    AnyService = type[Service[Any, Any]]

Introspection = Literal["off", "metadata", "contents"]
"""Content of the events of a call: nothing, metadata (the caller and the times), or the messages as well."""


class ServiceEvent(IntEnum):
    """The constants of ServiceEventInfo.event_type."""

    REQUEST_SENT = 0
    REQUEST_RECEIVED = 1
    RESPONSE_SENT = 2
    RESPONSE_RECEIVED = 3


def _event_class(type_: AnyService) -> Any:
    return type_.Event


class ServiceEvents:
    """The topic `<service>/_service_event` of one client or server."""

    def __init__(self, host: Host, type_: AnyService, name: str) -> None:
        self._host, self._event, self._name = host, _event_class(type_), name
        self._level: Introspection = "off"
        self._qos = DEFAULT
        self._publisher: TopicPublisher[Any] | None = None

    @property
    def is_on(self) -> bool:
        """Whether events are published."""
        return self._level != "off"

    def configure(self, level: Introspection, qos: Qos, *, is_open: bool) -> None:
        """Set the content of future events.

        Args:
            is_open: Whether the client or server is on the network.

        Raises:
            ValueError: The level is unknown.
        """
        if level not in ("off", "metadata", "contents"):
            raise ValueError(f"introspection must be off, metadata or contents, not {level!r}")
        self.close()
        self._level, self._qos = level, qos
        if is_open:
            self.open()

    def open(self) -> None:
        if self._level != "off":
            self._publisher = TopicPublisher(self._host, self._event, f"{self._name}/_service_event", self._qos)
            self._publisher.open()

    def close(self) -> None:
        if self._publisher is not None:
            self._publisher.close()
            self._publisher = None

    def tell(
        self,
        event: ServiceEvent,
        gid: bytes,
        sequence: int,
        request: Message | None = None,
        response: Message | None = None,
    ) -> None:
        """Publish an event.

        Args:
            gid: The client's GID.
            sequence: The call's sequence number at the client.
        """
        if self._publisher is None or not self._publisher.is_wanted:
            return
        info = {"event_type": event, "stamp": self._host.clock.now(), "client_gid": gid, "sequence_number": sequence}
        whole = self._level == "contents"
        self._publisher.publish(
            self._event(
                info=info,
                request=[request] if whole and request is not None else [],
                response=[response] if whole and response is not None else [],
            )
        )

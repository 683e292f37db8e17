"""QoS events of endpoints: matches, missed deadlines, lost messages, liveliness and incompatibilities."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

from graphflow.runtime.endpoints.events import QosEvent
from rclpy._rclpy_pybind11 import UnsupportedEventTypeError
from rclpy.impl.reexports import passed_on
from rclpy.qos import QoSPolicyKind
from rclpy.waitable import Waitable

if TYPE_CHECKING:
    from graphflow.rclpy.node_bridge import NodeBell
    from rclpy.callback_groups import CallbackGroup

__all__ = [
    "EventHandler",
    "IncompatibleTypeInfo",
    "PublisherEventCallbacks",
    "QoSEventHandler",
    "QoSLivelinessChangedInfo",
    "QoSLivelinessLostInfo",
    "QoSMessageLostInfo",
    "QoSOfferedDeadlineMissedInfo",
    "QoSOfferedIncompatibleQoSInfo",
    "QoSPublisherEventType",
    "QoSPublisherMatchedInfo",
    "QoSRequestedDeadlineMissedInfo",
    "QoSRequestedIncompatibleQoSInfo",
    "QoSSubscriptionEventType",
    "QoSSubscriptionMatchedInfo",
    "SubscriptionEventCallbacks",
    "UnsupportedEventTypeError",
]


class QoSPublisherEventType(IntEnum):
    """The events of a publisher."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """The events of a subscription."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class _Counts(NamedTuple):
    total_count: int = 0
    total_count_change: int = 0


class QoSRequestedDeadlineMissedInfo(_Counts):
    """A subscription received no message within its deadline."""


class QoSOfferedDeadlineMissedInfo(_Counts):
    """A publisher sent nothing within its deadline."""


class QoSLivelinessLostInfo(_Counts):
    """A publisher failed to assert its liveliness in time."""


class QoSMessageLostInfo(_Counts):
    """Messages were lost."""


class IncompatibleTypeInfo(_Counts):
    """Another endpoint of the topic has a different type."""


class QoSLivelinessChangedInfo(NamedTuple):
    """Publishers appeared, left, fell silent or came alive again."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


class QoSRequestedIncompatibleQoSInfo(NamedTuple):
    """Another endpoint of the topic offers less than the requested QoS."""

    total_count: int = 0
    total_count_change: int = 0
    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo


class QoSSubscriptionMatchedInfo(NamedTuple):
    """Endpoints of the other side appeared or left."""

    total_count: int = 0
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0


QoSPublisherMatchedInfo = QoSSubscriptionMatchedInfo

_KINDS: dict[IntEnum, str] = {
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: "deadline_missed",
    QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST: "liveliness_lost",
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: "incompatible_qos",
    QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: "incompatible_type",
    QoSPublisherEventType.RCL_PUBLISHER_MATCHED: "matched",
}
_SUBSCRIPTION_KINDS: dict[IntEnum, str] = {
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: "deadline_missed",
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: "liveliness_changed",
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: "incompatible_qos",
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST: "message_lost",
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: "incompatible_type",
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: "matched",
}
_POLICIES = {
    "reliability": QoSPolicyKind.RELIABILITY,
    "durability": QoSPolicyKind.DURABILITY,
    "deadline": QoSPolicyKind.DEADLINE,
    "liveliness": QoSPolicyKind.LIVELINESS,
    "liveliness lease": QoSPolicyKind.LIVELINESS,
}
"""The policies' names in graphflow and in ROS 2."""


class EventHandler(Waitable):
    """Has an executor call `callback` with an endpoint's events of one type."""

    def __init__(
        self,
        *,
        callback_group: CallbackGroup,
        callback: Callable[..., None],
        event_type: IntEnum,
        parent_impl: object = None,
        bell: NodeBell | None = None,
    ) -> None:
        super().__init__(callback_group)
        self.event_type, self.callback = event_type, callback
        is_publishers = isinstance(event_type, QoSPublisherEventType)
        self.kind = (_KINDS if is_publishers else _SUBSCRIPTION_KINDS)[event_type]
        self._bell, self._is_publishers = bell, is_publishers
        self._events: deque[QosEvent] = deque(maxlen=1000)
        self._told = 0
        self._is_destroyed = False

    def notice(self, event: QosEvent) -> None:
        """Record an event of the endpoint. Callable from any thread."""
        if not self._is_destroyed:
            self._events.append(event)
            if self._bell is not None:
                self._bell.mark(self)

    def is_ready(self, wait_set: object) -> bool:
        return bool(self._events) and not self._is_destroyed

    def take_data(self) -> Any:
        # Exchanged and not cleared: the event loop's thread appends meanwhile.
        events, self._events = self._events, deque(maxlen=1000)
        return self._info(list(events)) if events else None

    def _info(self, events: list[QosEvent]) -> object:
        """Merge several events into one, as rcl reports them."""
        last, more = events[-1], sum(event.change for event in events)
        match self.kind:
            case "liveliness_changed":
                came = sum(e.change for e in events if e.change > 0)
                gone = -sum(e.change for e in events if e.change < 0)
                return QoSLivelinessChangedInfo(last.current, 0 if last.current else gone, came - gone, gone - came)
            case "matched":
                return QoSSubscriptionMatchedInfo(last.total, sum(e.change > 0 for e in events), last.current, more)
            case "incompatible_qos":
                first = last.detail.partition(",")[0].strip()
                kind = _POLICIES.get(first, QoSPolicyKind.INVALID)
                return QoSRequestedIncompatibleQoSInfo(last.total, more, kind)
            case "deadline_missed":
                cls = QoSOfferedDeadlineMissedInfo if self._is_publishers else QoSRequestedDeadlineMissedInfo
                return cls(last.total, more)
            case "message_lost":
                return QoSMessageLostInfo(last.total, more)
            case "liveliness_lost":
                return QoSLivelinessLostInfo(last.total, more)
        return IncompatibleTypeInfo(last.total, more)

    async def execute(self, taken_data: object) -> None:
        if taken_data is not None:
            self.callback(taken_data)

    def destroy(self) -> None:
        """Stop recording events."""
        self._is_destroyed = True


QoSEventHandler = EventHandler


def dispatcher(handlers: list[EventHandler]) -> Callable[[QosEvent], None]:
    """Return the function that dispatches an endpoint's events to the handlers of their type."""

    def adapted(event: QosEvent) -> None:
        for handler in handlers:
            if handler.kind == event.kind:
                handler.notice(event)

    return adapted


class SubscriptionEventCallbacks:
    """The callbacks for a subscription's events.

    Args:
        use_default_callbacks: Whether to handle incompatibilities for which no callback is given.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[QoSRequestedDeadlineMissedInfo], None] | None = None,
        incompatible_qos: Callable[[QoSRequestedIncompatibleQoSInfo], None] | None = None,
        liveliness: Callable[[QoSLivelinessChangedInfo], None] | None = None,
        message_lost: Callable[[QoSMessageLostInfo], None] | None = None,
        incompatible_type: Callable[[IncompatibleTypeInfo], None] | None = None,
        matched: Callable[[QoSSubscriptionMatchedInfo], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.incompatible_qos, self.liveliness = deadline, incompatible_qos, liveliness
        self.message_lost, self.incompatible_type, self.matched = message_lost, incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self,
        callback_group: CallbackGroup,
        subscription: Any,
        topic_name: str,
        bell: NodeBell | None = None,
    ) -> list[EventHandler]:
        """Create the handlers of these callbacks."""
        kinds = QoSSubscriptionEventType
        incompatible_qos, incompatible_type = self.incompatible_qos, self.incompatible_type
        if self.use_default_callbacks:
            incompatible_qos, incompatible_type = incompatible_qos or _logged, incompatible_type or _logged
        wanted = {
            kinds.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: self.deadline,
            kinds.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: incompatible_qos,
            kinds.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: self.liveliness,
            kinds.RCL_SUBSCRIPTION_MESSAGE_LOST: self.message_lost,
            kinds.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: incompatible_type,
            kinds.RCL_SUBSCRIPTION_MATCHED: self.matched,
        }
        return _handlers(wanted, callback_group, bell)


class PublisherEventCallbacks:
    """The callbacks for a publisher's events. `use_default_callbacks` as for `SubscriptionEventCallbacks`."""

    def __init__(
        self,
        *,
        deadline: Callable[[QoSOfferedDeadlineMissedInfo], None] | None = None,
        liveliness: Callable[[QoSLivelinessLostInfo], None] | None = None,
        incompatible_qos: Callable[[QoSRequestedIncompatibleQoSInfo], None] | None = None,
        incompatible_type: Callable[[IncompatibleTypeInfo], None] | None = None,
        matched: Callable[[QoSPublisherMatchedInfo], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.liveliness, self.incompatible_qos = deadline, liveliness, incompatible_qos
        self.incompatible_type, self.matched = incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self,
        callback_group: CallbackGroup,
        publisher: Any,
        topic_name: str,
        bell: NodeBell | None = None,
    ) -> list[EventHandler]:
        """Create the handlers of these callbacks."""
        kinds = QoSPublisherEventType
        incompatible_qos, incompatible_type = self.incompatible_qos, self.incompatible_type
        if self.use_default_callbacks:
            incompatible_qos, incompatible_type = incompatible_qos or _logged, incompatible_type or _logged
        wanted = {
            kinds.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: self.deadline,
            kinds.RCL_PUBLISHER_LIVELINESS_LOST: self.liveliness,
            kinds.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: incompatible_qos,
            kinds.RCL_PUBLISHER_INCOMPATIBLE_TYPE: incompatible_type,
            kinds.RCL_PUBLISHER_MATCHED: self.matched,
        }
        return _handlers(wanted, callback_group, bell)


def _handlers(
    wanted: Mapping[Any, Callable[..., None] | None],
    group: CallbackGroup,
    bell: NodeBell | None,
) -> list[EventHandler]:
    return [
        EventHandler(callback_group=group, callback=callback, event_type=kind, bell=bell)
        for kind, callback in wanted.items()
        if callback is not None
    ]


def _logged(info: object) -> None:
    """Do nothing: the endpoint logs incompatibilities itself, with both nodes and the remedy."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

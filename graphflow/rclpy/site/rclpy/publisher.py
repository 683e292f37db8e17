"""Publishers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graphflow.rclpy.messages import classes
from graphflow.runtime.endpoints.publishers import WITH_CONTRADICTIONS
from rclpy._rclpy_pybind11 import RCLError
from rclpy.duration import Duration
from rclpy.handle import Handle
from rclpy.impl.mistakes.origins import Created
from rclpy.impl.reexports import passed_on

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.endpoints.threaded import ThreadedPublisher
    from rclpy.callback_groups import CallbackGroup
    from rclpy.event_handler import EventHandler, PublisherEventCallbacks
    from rclpy.qos import QoSProfile

_FOREVER = Duration(seconds=-1)


class Publisher(Created):
    """A publisher. Create it with `Node.create_publisher`."""

    def __init__(
        self,
        publisher_impl: ThreadedPublisher,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks,
        callback_group: CallbackGroup,
        *,
        life: ContextState,
        handle: Handle,
        event_handlers: list[EventHandler],
    ) -> None:
        self.endpoint, self._life, self._handle = publisher_impl, life, handle
        self.msg_type, self.topic, self.qos_profile = msg_type, topic, qos_profile
        self.event_handlers = event_handlers
        if publisher_impl.type_name in WITH_CONTRADICTIONS:
            self._graphflow_check_first()

    def _graphflow_check_first(self) -> None:
        """Check the first messages for contradictions, in a `publish` that gives way to the class's after them."""
        from graphflow.runtime.mistakes.contradictions import FirstMessages  # most programs never need it

        first = FirstMessages(self.endpoint.host, self.endpoint.type_name, self.endpoint.name)

        def publish(msg: Any) -> None:
            if isinstance(msg, self.msg_type):
                first.check(msg)
            if not first.is_open:
                self.__dict__.pop("publish", None)
            type(self).publish(self, msg)

        vars(self)["publish"] = publish

    def publish(self, msg: Any) -> None:
        """Publish a message, or the CDR bytes of one. Never waits.

        Raises:
            TypeError: Not a message of the publisher's type.
            RCLError: The context was shut down.
            InvalidHandle: The publisher was destroyed.
        """
        with self._handle:
            if isinstance(msg, self.msg_type):
                payload = classes.encode(msg)
            # Serialized messages go out as they are: rclpy does not check them either.
            elif isinstance(msg, bytes):
                payload = msg
            else:
                raise TypeError(f"Expected {self.msg_type}, got {classes.what_came(msg)}")
            # After the check of the type, whose error comes first in rclpy, too.
            if not self._life.is_ok:
                raise RCLError("Failed to publish: publisher's context is invalid")
            self.endpoint.put(payload)

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions."""
        with self._handle:
            return len(self.endpoint.matched)

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        with self._handle:
            return self.endpoint.name

    @property
    def handle(self) -> Handle:
        return self._handle

    def destroy(self) -> None:
        """Withdraw the publisher. Call `Node.destroy_publisher` instead."""
        for handler in self.event_handlers:
            handler.destroy()
        self._handle.destroy_when_not_in_use()

    def assert_liveliness(self) -> None:
        """Assert liveliness, for MANUAL_BY_TOPIC."""
        with self._handle:
            self._life.on_loop(self.endpoint.assert_liveliness)

    def wait_for_all_acked(self, timeout: Duration = _FOREVER) -> bool:
        """Return True: the wire has no acknowledgements to wait for."""
        with self._handle:
            return True

    def __enter__(self) -> Publisher:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

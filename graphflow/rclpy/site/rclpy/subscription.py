"""Subscriptions."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Any, TypedDict

from graphflow.errors import DecodeError
from graphflow.rclpy.messages import classes
from rclpy.handle import Handle
from rclpy.impl.mistakes.origins import Created
from rclpy.impl.reexports import passed_on

if TYPE_CHECKING:
    from graphflow.runtime.endpoints.threaded import Taken, ThreadedSubscription
    from rclpy.callback_groups import CallbackGroup
    from rclpy.event_handler import EventHandler, SubscriptionEventCallbacks
    from rclpy.qos import QoSProfile


class MessageInfo(TypedDict):
    """The metadata of a message: times in nanoseconds, and the publisher's sequence number."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None


class Subscription(Created):
    """A subscription. Create it with `Node.create_subscription`."""

    turn = 1

    class CallbackType(Enum):
        """The arguments that a callback takes."""

        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        subscription_impl: ThreadedSubscription,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        event_callbacks: SubscriptionEventCallbacks,
        *,
        handle: Handle,
        event_handlers: list[EventHandler],
    ) -> None:
        self.endpoint, self._handle = subscription_impl, handle
        self.msg_type, self.topic, self.qos_profile = msg_type, topic, qos_profile
        self.callback_group, self.raw, self.event_handlers = callback_group, raw, event_handlers
        self._callback: Callable[..., Any] = callback
        self._callback_type = self.CallbackType.MessageOnly
        self._run: Callable[[Taken], object] = self._do
        self.callback = callback
        handle.__dict__["take_message"] = self._take_message

    def get_publisher_count(self) -> int:
        """Return the number of matched publishers."""
        with self._handle:
            return len(self.endpoint.matched)

    @property
    def handle(self) -> Handle:
        return self._handle

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        with self._handle:
            return self.endpoint.name

    @property
    def callback(self) -> Callable[..., Any]:
        """The function that is called with each message, and optionally with its `MessageInfo`."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., Any]) -> None:
        self._callback = value
        self._callback_type = _type_of(value)
        self._run = self._do_async if inspect.iscoroutinefunction(value) else self._do

    def has_work(self) -> bool:
        return self.endpoint.waiting > 0

    def take_work(self) -> Callable[[], object] | None:
        taken = self.endpoint.take()
        return None if taken is None else partial(self._run, taken)

    def _arguments(self, taken: Taken) -> tuple[object, ...]:
        """Return the callback's arguments; empty if the arrival is not a message of the type."""
        if self.raw:
            message: Any = taken.payload
        else:
            try:
                message = classes.decode(self.msg_type, taken.payload)
            except DecodeError as error:
                self.endpoint.count_malformed(error)
                return ()
        if self._callback_type is self.CallbackType.MessageOnly:
            return (message,)
        return (message, info_of(taken))

    def _do(self, taken: Taken) -> None:
        arguments = self._arguments(taken)
        if arguments:
            self._callback(*arguments)

    async def _do_async(self, taken: Taken) -> None:
        arguments = self._arguments(taken)
        if arguments:
            await self._callback(*arguments)

    def _take_message(self, msg_type: Any, raw: bool) -> tuple[object, MessageInfo] | None:
        taken = self.endpoint.take()
        if taken is None:
            return None
        return (taken.payload if raw else classes.decode(msg_type, taken.payload)), info_of(taken)

    def destroy(self) -> None:
        """Withdraw the subscription. Call `Node.destroy_subscription` instead."""
        for handler in self.event_handlers:
            handler.destroy()
        self._handle.destroy_when_not_in_use()

    def __enter__(self) -> Subscription:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


def info_of(taken: Taken) -> MessageInfo:
    """Return the metadata of a message."""
    return MessageInfo(
        source_timestamp=taken.info.source_ns,
        received_timestamp=time.time_ns(),
        publication_sequence_number=taken.info.sequence,
        reception_sequence_number=None,
    )


def _type_of(callback: Callable[..., Any]) -> Subscription.CallbackType:
    try:
        # One argument has precedence: `def heard(msg, info=None)` gets the message only, as in rclpy.
        inspect.signature(callback).bind(object())
        return Subscription.CallbackType.MessageOnly
    except TypeError:
        pass
    except ValueError:  # no signature to be read
        return Subscription.CallbackType.MessageOnly
    try:
        inspect.signature(callback).bind(object(), object())
        return Subscription.CallbackType.WithMessageInfo
    except TypeError:
        raise RuntimeError(
            "Subscription.__init__(): callback should be either be callable with one argument"
            "(to get only the message) or two (to get message and message info)"
        ) from None


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

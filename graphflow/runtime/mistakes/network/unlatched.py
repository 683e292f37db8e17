"""Subscriptions that miss the one message of a publisher that keeps it for late ones, such as a map.

A volatile subscription that opens after the message never receives it. That may be intended; hence a warning requires
that nothing has arrived for a while, that the publisher has sent a single message, and that it did so before the
subscription opened. The message itself tells: a subscription for kept messages is opened for a moment.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Protocol

from graphflow.deadlock.protocols import ProcessContext
from graphflow.errors import DecodeError
from graphflow.executor.clock import Alarm
from graphflow.names import is_everybodys, is_hidden
from graphflow.qos import INFINITE_NS, Durability, Qos
from graphflow.times import to_ns
from graphflow.transport.base import Closable
from graphflow.transport.inbox import Inbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity

WARN_AFTER = 5.0
"""Seconds without a message before the publisher is asked for the one it keeps."""
ANSWER = 1.0
"""Seconds for its answer."""
ANSWERS_BOUND = 100
"""Kept messages that are looked at; a topic has few publishers, and what else arrives may be a flood."""
_KEPT = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)


class Volatile(Protocol):
    """A subscription, as the check sees it."""

    opened_ns: int
    """The wall-clock time of its opening."""
    latched_profile: str
    """The profile that receives kept messages, as the user's code writes it."""
    matched: dict[str, Entity]

    @property
    def entity(self) -> Entity | None: ...

    @property
    def received(self) -> int: ...

    @property
    def idle_because(self) -> str: ...


@dataclass
class _Asking:
    """A subscription that has received nothing yet."""

    log: logging.Logger
    alarm: Alarm
    kept: Closable | None = None
    """The momentary subscription for kept messages."""


class Unlatched:
    """The volatile subscriptions of a process to publishers that keep messages, each reported once."""

    def __init__(self, here: ProcessContext) -> None:
        self._here = here
        self._asking: dict[Volatile, _Asking] = {}
        self._is_closed = False

    def matched(self, subscription: Volatile, publisher: Entity, log: logging.Logger) -> None:
        """Note the appearance of a publisher."""
        own = subscription.entity
        if publisher.qos.durability is not Durability.TRANSIENT_LOCAL or own is None or self._is_closed:
            return
        is_users = not (is_everybodys(own.name) or is_hidden(own.node_name) or is_hidden(publisher.node_name))
        if own.qos.durability is Durability.VOLATILE and is_users and subscription not in self._asking:
            self._asking[subscription] = _Asking(log, self._at(WARN_AFTER, partial(self._ask, subscription)))

    def _at(self, seconds: float, due: Callable[[], None]) -> Alarm:
        clock = self._here.clock
        return clock.call_at(clock.monotonic_ns() + to_ns(seconds), due)

    def _ask(self, subscription: Volatile) -> None:
        own, session = subscription.entity, self._here.session
        if own is None or not _is_waiting(subscription):
            self._asking[subscription].alarm.cancel()
            return
        inbox = Inbox(session.bell, ANSWERS_BOUND, lambda: None)
        answered = self._at(ANSWER, partial(self._answered, subscription, inbox))
        kept = session.open_receiver(own.data_key, _KEPT, inbox)
        self._asking[subscription] = _Asking(self._asking[subscription].log, answered, kept)

    def _answered(self, subscription: Volatile, inbox: Inbox) -> None:
        asking, is_waiting = self._asking[subscription], _is_waiting(subscription)
        if asking.kept is not None:
            asking.kept.close()
            asking.kept = None  # the entry stays, so that a restarted publisher is not reported again
        publishers = {publisher.gid: publisher for publisher in subscription.matched.values()}
        for arrival in list(inbox.items) if is_waiting else ():
            publisher = self._only_before(arrival, subscription.opened_ns, publishers)
            if publisher is not None:
                asking.log.warning(
                    "%s: %s sent its only message before this subscription opened, and keeps it for late ones that "
                    "ask for it; give the subscription %s",
                    publisher.name,
                    publisher.node_name,
                    subscription.latched_profile,
                )
                return

    def _only_before(self, arrival: object, opened_ns: int, publishers: Mapping[bytes, Entity]) -> Entity | None:
        """Return the publisher of a message if it is its only one, and older than the subscription."""
        try:
            sequence, source_ns, gid = attachment.fields(self._here.session.read(arrival)[1] or b"")
        except DecodeError:
            return None
        publisher = publishers.get(gid)
        if sequence != 1 or source_ns >= opened_ns or publisher is None:
            return None
        lifespan_ns = publisher.qos.lifespan_ns
        is_over = lifespan_ns != INFINITE_NS and self._here.clock.time_ns() - source_ns > lifespan_ns
        return None if is_over else publisher

    def forget(self, subscription: Volatile) -> None:
        """Stop the check of a subscription."""
        asking = self._asking.pop(subscription, None)
        if asking is not None:
            asking.alarm.cancel()
            if asking.kept is not None:
                asking.kept.close()

    def close(self) -> None:
        """Stop reporting."""
        self._is_closed = True
        for subscription in list(self._asking):
            self.forget(subscription)


def _is_waiting(subscription: Volatile) -> bool:
    return subscription.entity is not None and not (subscription.received or subscription.idle_because)

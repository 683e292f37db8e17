"""Messages that a node publishes once, at its start, before their first subscription opens, such as a map.

A volatile publisher does not keep them for late subscriptions, so that they are lost. Nodes may publish before anybody
listens. Hence a warning requires that the node's source publishes nothing else to the topic, ever.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from functools import partial
from typing import Protocol

from graphflow.deadlock.protocols import ProcessContext
from graphflow.errors import Place
from graphflow.executor.clock import Alarm
from graphflow.machines.near_topics import is_everybodys
from graphflow.names import is_hidden
from graphflow.qos import Durability
from graphflow.times import to_ns
from graphflow.wire.liveliness import Entity

WARN_AFTER = 2.0
"""Seconds after the first subscription, in which the node may publish another message."""


class Unlatched(Protocol):
    """A publisher, as the check sees it."""

    matched: dict[str, Entity]
    unheard: int
    """Messages published while there was no subscription."""

    @property
    def entity(self) -> Entity | None: ...

    @property
    def published(self) -> int: ...

    def single_sends(self) -> Sequence[Place]:
        """Return the lines at which its node publishes; empty if one may run twice, or that is unknown."""


class Unkept:
    """The publishers of a process with a first subscription, each checked once."""

    def __init__(self, here: ProcessContext) -> None:
        self._here = here
        self._heard: dict[Unlatched, Alarm | None] = {}
        """The publishers that have had a subscription, with the check of those that had published before."""

    def matched(self, publisher: Unlatched, subscription: Entity, log: logging.Logger) -> None:
        """Note the appearance of a subscription."""
        own = publisher.entity
        if own is None or publisher in self._heard or is_everybodys(own.name) or is_hidden(own.node_name):
            return
        if is_hidden(subscription.node_name):
            return
        self._heard[publisher] = None
        volatile = own.qos.durability is subscription.qos.durability is Durability.VOLATILE  # others are told as such
        if publisher.unheard and volatile:
            clock = self._here.clock
            due = partial(self._check, publisher, publisher.published, subscription, log)
            self._heard[publisher] = clock.call_at(clock.monotonic_ns() + to_ns(WARN_AFTER), due)

    def _check(self, publisher: Unlatched, count: int, subscription: Entity, log: logging.Logger) -> None:
        own = publisher.entity
        if own is None or subscription.token not in publisher.matched:
            return
        if not publisher.unheard == publisher.published == count:
            return
        places = publisher.single_sends()
        if 0 < len(places) <= count:
            what, it = ("the only message was", "it is") if count == 1 else (f"all {count} messages were", "they are")
            log.warning(
                "%s: %s published before the subscription of %s opened (%s), and %s not kept for it; give both "
                "Qos(depth=%d, durability=Durability.TRANSIENT_LOCAL)",
                *(own.name, what, subscription.node_name, ", ".join(map(str, places)), it, count),
            )

    def forget(self, publisher: Unlatched) -> None:
        """Stop the check of a publisher."""
        alarm = self._heard.pop(publisher, None)
        if alarm is not None:
            alarm.cancel()

    def close(self) -> None:
        """Stop reporting."""
        for publisher in list(self._heard):
            self.forget(publisher)

"""Messages that a node publishes once, at its start, before their first subscription opens, such as a map.

A volatile publisher does not keep them for late subscriptions, so that they are lost. Nodes may publish before anybody
listens. Hence a warning requires that the node's source publishes nothing else to the topic, ever.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from functools import partial
from typing import Protocol

from graphflow.errors import Place
from graphflow.executor.clock import Clock
from graphflow.names import is_everybodys, is_hidden
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


def check_later(publisher: Unlatched, subscription: Entity, clock: Clock, log: logging.Logger) -> bool:
    """Check a publisher that nobody has heard, as its first subscription has just appeared.

    Returns:
        False if the subscription does not matter: it is a tool's, or asks for kept messages, and is told that there
        are none.
    """
    own = publisher.entity
    if own is None or is_everybodys(own.name) or is_hidden(own.node_name) or is_hidden(subscription.node_name):
        return False
    if not own.qos.durability is subscription.qos.durability is Durability.VOLATILE:
        return False
    due = partial(_check, publisher, publisher.published, subscription, log)
    clock.call_at(clock.monotonic_ns() + to_ns(WARN_AFTER), due)
    return True


def _check(publisher: Unlatched, count: int, subscription: Entity, log: logging.Logger) -> None:
    own = publisher.entity
    if own is None or subscription.token not in publisher.matched:
        return
    if not publisher.unheard == publisher.published == count:
        return
    places = publisher.single_sends()
    if 0 < len(places) <= count:
        what, it = ("the only message was", "it is") if count == 1 else (f"all {count} messages were", "they are")
        log.warning(
            "%s: %s published before the subscription of %s opened (%s), and %s not kept for it; await the "
            "publisher's wait_matched() first, publish in a @timer, or give both "
            "Qos(depth=%d, durability=Durability.TRANSIENT_LOCAL)",
            *(own.name, what, subscription.node_name, ", ".join(map(str, places)), it, count),
        )

"""Subscriptions whose publishers are here: feedback loops of one node, and `ignore_local` that ignores everything.

There is no cost per message: the subscription's counters are compared once a second, while its own node publishes its
topic.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from graphflow.executor.clock import Alarm, Clock
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS, to_ns
from graphflow.wire.liveliness import Entity

IGNORED_AFTER = 3.0
"""Seconds for a publisher of another process to appear."""
LOOP = 2000
"""Messages per second, in two successive seconds, before a warning; `doctor` reports slower loops."""


class Echo:
    """The check of one subscription, until it has warned.

    Args:
        received: Returns the number of messages received so far.
        warn: Called with the messages per second, once, and again at the end, since what they cause hides the first.
    """

    def __init__(self, clock: Clock, received: Callable[[], int], warn: Callable[[int], None]) -> None:
        self._clock, self._received, self._warn = clock, received, warn
        self._alarm: Alarm | None = None
        self._last = self._rate = 0
        self._has_warned = self._was_fast = False

    def follow(self, *, has_own: bool) -> None:
        """Start the check while the node has a publisher of the topic, or stop it."""
        if not has_own:
            self.stop()
        elif self._alarm is None:
            self._last, self._was_fast = self._received(), False
            self._arm()

    def stop(self) -> None:
        """Stop the check until the next `follow`."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
            if self._has_warned and self._was_fast:
                self._warn(self._rate)

    def _arm(self) -> None:
        self._alarm = self._clock.call_at(self._clock.monotonic_ns() + NANOSECONDS, self._check)

    def _check(self) -> None:
        self._alarm, received = None, self._received()
        self._rate, self._last = received - self._last, received
        is_fast = self._rate >= LOOP
        if is_fast and self._was_fast and not self._has_warned:
            self._has_warned = True
            self._warn(self._rate)
        self._was_fast = is_fast
        self._arm()


def echo_of(host: Host, topic: str, received: Callable[[], int]) -> Echo:
    """Return the check of a node's subscription, with its warning."""

    def warn(rate: int) -> None:
        host.log.warning(
            "this node hears what it publishes itself on %s, %d messages a second: if the handler publishes there, "
            "that never ends; give one of the two another topic",
            topic,
            rate,
        )

    return Echo(host.context.clock, received, warn)


class IgnoresLocal(Protocol):
    """A subscription, as the check sees it."""

    name: str
    matched: dict[str, Entity]

    @property
    def entity(self) -> Entity | None: ...


def check_ignored(subscription: IgnoresLocal, host: Host, *, is_ignoring: bool) -> None:
    """Warn, some seconds after the first publisher has appeared, if all are other nodes of this process.

    A node that ignores only its own messages waits for other processes on purpose.
    """
    if not is_ignoring or len(subscription.matched) != 1:
        return

    def check() -> None:
        own = subscription.entity
        others = [publisher for publisher in subscription.matched.values() if own is None or publisher.nid != own.nid]
        if own is None or not others or any(publisher.zid != own.zid for publisher in others):
            return
        names = " and ".join(sorted({publisher.node_name for publisher in others}))
        host.log.warning(
            "%s: nothing is received: %s is in this process, whose messages ignore_local=True skips; leave it out, or "
            "give one of the two nodes a process of its own",
            *(subscription.name, names),
        )

    clock = host.context.clock
    clock.call_at(clock.monotonic_ns() + to_ns(IGNORED_AFTER), check)

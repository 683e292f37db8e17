"""A node's clock: its context's, or the time on /clock while `use_sim_time` is true."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from graphflow.executor.clock import Alarm, Clock
from graphflow.executor.sim_time import SimClock
from graphflow.qos import CLOCK
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS, to_ns

TIMELESS = (
    "it uses simulated time (use_sim_time), but there is no message on /clock: its clock stands still. Start the "
    "simulator, or let it go on if it is paused, or play a bag with --clock, or set use_sim_time to false"
)
WARN_AFTER = 3.0
"""Seconds that simulated time has to start before a warning."""


class NodeClock:
    """The choice between a context's clock and simulated time.

    Args:
        resolve: Resolves the topic's name.
        add: Adds the subscription to the node's parts.
    """

    def __init__(
        self,
        host: Host,
        resolve: Callable[[str], str],
        add: Callable[[TopicSubscription[Any]], TopicSubscription[Any]],
    ) -> None:
        self._host, self._resolve, self._add = host, resolve, add
        self._simulated: tuple[SimClock, TopicSubscription[Any]] | None = None
        self._alarm: Alarm | None = None

    @property
    def current(self) -> Clock:
        """The clock in force. Raises ClosedError when the node does not run and does not follow /clock."""
        return self._host.context.clock if self._simulated is None else self._simulated[0]

    def complaints(self) -> list[str]:
        """Report that simulated time has not started, if so."""
        is_waiting = self._simulated is not None and self._simulated[0].time_ns() == 0
        return [TIMELESS] if is_waiting else []

    def follow(self, *, is_simulated: bool) -> None:
        """Switch to /clock or to the context's clock; pending waits continue on the new clock."""
        former = self._simulated
        if is_simulated and former is None:
            from graphflow.msgs.rosgraph_msgs.msg import Clock as ClockMessage

            clock = SimClock(self._host.context.loop)

            def advance(message: ClockMessage) -> None:
                clock.set_time(message.clock.sec * NANOSECONDS + message.clock.nanosec)

            subscription = TopicSubscription(self._host, ClockMessage, self._resolve("/clock"), CLOCK, advance)
            subscription.is_inner = True
            self._simulated = (clock, self._add(subscription))
            real = self._host.context.clock
            self._alarm = real.call_at(real.monotonic_ns() + to_ns(WARN_AFTER), self._warn)
        elif not is_simulated and former is not None:
            self._simulated = None
            if self._alarm is not None:
                self._alarm.cancel()
            former[1].close()
            # By now, `current` is the real clock.
            former[0].retire(self.current)

    def _warn(self) -> None:
        for text in self.complaints() if self._host.is_running else ():
            self._host.log.warning("%s", text)

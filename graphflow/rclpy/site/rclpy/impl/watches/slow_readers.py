"""Subscriptions that lose most of their messages while a callback runs for long, as with a `time.sleep` in it.

In ROS 2 the queue drops them silently. A queue of one message keeps the newest on purpose.
"""

from __future__ import annotations

import logging
import time

from rclpy.impl.deadlock.stacks import stacks
from rclpy.impl.entities import full_name, role_of
from rclpy.impl.spinning import Run
from rclpy.impl.watches.late_timers import SLOW
from rclpy.impl.watches.starvation import HeldUp, kept_by, label_of, node_of, own_group, place_of
from rclpy.subscription import Subscription

MANY = 100
"""Messages that a subscription must have lost."""
logger = logging.getLogger("graphflow")


class SlowReaders:
    """The callbacks of one context that let subscriptions lose messages, each reported once."""

    def __init__(self, held_up: HeldUp) -> None:
        self._held_up = held_up
        self._since: dict[object, float] = {}
        """The monotonic time at which each step of a run was first noticed."""

    def check(self) -> None:
        """Report what has become due."""
        now = time.monotonic()
        runs = {(run, run.stepped_ns): run for run in self._held_up.runs() if run.thread}
        self._since = {key: self._since.get(key, now) for key in runs}
        for key, run in runs.items():
            if now - self._since[key] >= SLOW:
                self._report(run, now - self._since[key])

    def _report(self, run: Run, seconds: float) -> None:
        affected = [one for one in (run.entity, *kept_by(run)) if isinstance(one, Subscription)]
        losing = [one for one in affected if _loses_most(one)]
        node, level = node_of(run), next((s.levels[-1] for s in stacks() if s.levels[-1].run is run), None)
        if not losing or node is None or level is None or level.waiting is not None:
            return
        title = f"{label_of(run)} of {full_name(node)}"
        if self._held_up.is_deadlocked(run, title) or self._held_up.was_reported(title):
            return
        who, way = "", "return from it soon (a timer does what a sleep does)"
        if losing[0] is not run.entity:
            who, way = f"{role_of(losing[0]).label} ", f"{way}, or {own_group(run)}"
        counts = losing[0].endpoint.dropped, losing[0].endpoint.received
        text = "%s takes %.1f s or more, as in %s, and %shas lost %d of %d messages: %s"
        logger.warning(text, title, seconds, place_of(level, node), who, *counts, way)


def _loses_most(subscription: Subscription) -> bool:
    endpoint = subscription.endpoint
    is_deep = endpoint.qos.depth > 1
    return is_deep and endpoint.dropped >= MANY and 2 * endpoint.dropped >= endpoint.received

"""Hooks of a node that take long: where they wait is told, and what waits for them."""

from __future__ import annotations

import asyncio

from graphflow.deadlock.openings import place_of
from graphflow.executor.clock import Alarm
from graphflow.runtime.host import Host
from graphflow.times import to_ns

SLOW = 5.0
"""Seconds that a hook may take before it is reported."""
_BEGINNINGS = ("on_start", "on_configure", "on_activate")
"""Hooks after which handlers run, sooner or later."""
_NO_HANDLERS = (
    "this node's handlers start when it has: what waits for them, or for nodes that wait for this one, belongs in a "
    "@task"
)
_NO_TRANSITION = "until it has, the node can make no other transition"


def when_slow(host: Host, hook: str) -> Alarm:
    """Say where a hook that this task runs waits if it has not returned in a while; the caller cancels that."""
    task, clock = asyncio.current_task(), host.context.clock
    then = _NO_HANDLERS if hook in _BEGINNINGS else _NO_TRANSITION

    def say() -> None:
        host.log.warning("%s has not returned for %.0f s %s; %s", hook, SLOW, place_of(task), then)

    return clock.call_at(clock.monotonic_ns() + to_ns(SLOW), say)

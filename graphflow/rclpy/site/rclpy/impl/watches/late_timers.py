"""Timers that cannot keep their period: a period of zero, repeated delays, or a clock that stands still.

In ROS 2 the first occupy a processor, the second skip calls, and the third never run, all silently.
"""

from __future__ import annotations

import logging
import time
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakSet

from graphflow.runtime.node_clock import TIMELESS
from rclpy.constants import S_TO_NS
from rclpy.impl.deadlock.stacks import stacks
from rclpy.impl.entities import full_name, role_of
from rclpy.impl.nodes import internals_of, nodes_of
from rclpy.impl.spinning import Run
from rclpy.impl.watches.starvation import (
    RETURN,
    HeldUp,
    empty_group,
    kept_by,
    label_of,
    label_with_line,
    node_of,
    own_group,
    place_of,
)
from rclpy.timer import Timer

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.node import Node

WARN_AFTER = 3.0
"""Seconds for which a period of zero, or a clock that stands still, is tolerated."""
SLOW = 0.5
"""Seconds that a callback may take before it is checked for timers that it delays."""
SLOW_ONCE = 1.5
"""Seconds from which a first delay is reported: shorter ones may be the cost of a first call."""
logger = logging.getLogger("graphflow")


class _Slow(NamedTuple):
    """A run that delays timers."""

    title: str
    place: str
    late: Timer
    is_own: bool
    """Whether the timer is delayed by its own callback."""
    own_group: str
    """The remedy of another callback group."""
    remark: str
    """A further remark on the node."""


class LateTimers:
    """The timers of one context's nodes, each reported once."""

    def __init__(self, life: ContextState, held_up: HeldUp) -> None:
        self._life, self._held_up = life, held_up
        self._since: dict[object, float] = {}
        """The monotonic time at which each step of a run, timer or node was first noticed."""
        self._slow: dict[object, _Slow] = {}
        """The steps that delay timers, while they run."""
        self._were_slow: set[str] = set()
        """The callbacks that have delayed timers once."""
        self._known: WeakSet[object] = WeakSet()
        """The timers and nodes that have been reported."""

    def check(self) -> None:
        """Report what has become due."""
        now = time.monotonic()
        runs: dict[object, Run] = {(run, run.stepped_ns): run for run in self._held_up.runs() if run.thread}
        nodes = nodes_of(self._life)
        restless: dict[object, Node] = {
            timer: node for node in nodes for timer in list(node.timers) if _is_restless(timer)
        }
        timeless: dict[object, Node] = {node: node for node in nodes if _is_timeless(node)}
        seen = {*runs, *restless, *timeless}
        for key in [key for key in self._since if key not in seen]:
            seconds, slow = now - self._since.pop(key), self._slow.pop(key, None)
            if slow is not None:
                self._report_slow(slow, seconds)
        for key in seen:
            seconds = now - self._since.setdefault(key, now)
            if key in runs:
                if seconds >= SLOW and (slow := self._slow_one(runs[key], seconds)) is not None:
                    self._slow[key] = slow
            elif seconds >= WARN_AFTER and key not in self._known:
                self._known.add(key)
                if key in timeless:
                    timeless[key].get_logger().warning(f"{full_name(timeless[key])}: {TIMELESS}")
                elif isinstance(key, Timer):
                    _report_restless(key, restless[key])

    def _slow_one(self, run: Run, seconds: float) -> _Slow | None:
        """Return a report on a run of that many seconds; None if it delays no timer."""
        node, level = node_of(run), next((s.levels[-1] for s in stacks() if s.levels[-1].run is run), None)
        if node is None or level is None or level.waiting is not None:
            return None
        # Two periods: one that is skipped now and then is nothing to report.
        late = [t for t in kept_by(run) if isinstance(t, Timer) and 0 < 2 * t.timer_period_ns <= seconds * S_TO_NS]
        if not late:
            return None
        own = next((timer for timer in late if timer is run.entity), None)
        title = f"{label_of(run)} of {full_name(node)}"
        if self._held_up.is_deadlocked(run, title):
            return None
        return _Slow(title, place_of(level, node), own or late[0], own is not None, own_group(run), empty_group(node))

    def _report_slow(self, slow: _Slow, seconds: float) -> None:
        if slow.title not in self._were_slow and seconds < SLOW_ONCE:
            self._were_slow.add(slow.title)
        elif not self._held_up.was_reported(slow.title):
            every = f"every {slow.late.timer_period_ns / S_TO_NS:g} s"
            if slow.is_own:
                late, way = f"is due {every}", f"{RETURN}, or give it a longer period"
            else:
                late, way = (
                    f"keeps {role_of(slow.late).label}, which is due {every}, waiting",
                    f"{RETURN}, or {slow.own_group}",
                )
            text = "%s takes %.1f s, as in %s, and %s: %s%s"
            logger.warning(text, slow.title, seconds, slow.place, late, way, slow.remark)


def _is_restless(timer: Timer) -> bool:
    is_inner = timer.timer_period_ns == 0 and role_of(timer).is_inner
    return timer.timer_period_ns == 0 and not is_inner and not timer.handle.is_destroyed and not timer.is_canceled()


def _report_restless(timer: Timer, node: Node) -> None:
    text = "%s of %s has a period of 0 s, and is called continuously: give it one, as in create_timer(0.1, ...)"
    logger.warning(text, label_with_line(timer), full_name(node))


def _is_timeless(node: Node) -> bool:
    source = internals_of(node).time_source
    return source is not None and source.ros_time_is_active and source.last_ns == 0

"""Goals that an action server has accepted and never executes, so that their clients wait for ever.

ROS 2 does not report them. A server with a `handle_accepted_callback` must call `goal_handle.execute()` itself.
"""

from __future__ import annotations

import gc
import logging
import time
from types import FrameType
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary, WeakSet

from graphflow.machines.goal import GoalStatus as Status
from rclpy.action.server import ActionServer, ServerGoalHandle
from rclpy.impl.entities import callbacks_of, full_name
from rclpy.impl.mistakes.arguments import described
from rclpy.impl.nodes import internals_of, nodes_of

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.node import Node

WARN_AFTER = 3.0
"""Seconds after which a goal is reported if nothing holds its handle to execute it later."""
KEPT = 15.0
"""The same in seconds if something does, and no other goal of the server is executed meanwhile."""
logger = logging.getLogger("graphflow")


class Unexecuted:
    """The goals of one context's action servers; one goal of each server is reported."""

    def __init__(self, life: ContextState) -> None:
        self._life = life
        self._since: WeakKeyDictionary[ServerGoalHandle, float] = WeakKeyDictionary()
        """The monotonic time since which each goal has waited while no other was executed."""
        self._kept: WeakSet[ServerGoalHandle] = WeakSet()
        """The goals whose handle something holds."""
        self._reported: WeakSet[ActionServer] = WeakSet()

    def check(self) -> None:
        """Report goals that have waited for long."""
        for node in nodes_of(self._life):
            for server in [w for w in list(node.waitables) if isinstance(w, ActionServer)]:
                if server not in self._reported:
                    self._check_server(node, server)

    def _check_server(self, node: Node, server: ActionServer) -> None:
        inner = internals_of(server)
        now, goals = time.monotonic(), list(inner.handles.values())
        is_busy = any(goal.state in (Status.EXECUTING, Status.CANCELING) for goal in goals)
        has_searched = False
        for goal in goals:
            if goal.state is not Status.ACCEPTED or is_busy:
                self._since.pop(goal, None)
                continue
            seconds = now - self._since.setdefault(goal, now)
            if seconds >= WARN_AFTER and goal not in self._kept:
                # The search goes through every object of the process, and clients may send thousands of goals.
                if has_searched:
                    continue
                has_searched = True
                if _is_kept(goal, inner.handles, goals):
                    self._kept.add(goal)
            if seconds >= (KEPT if goal in self._kept else WARN_AFTER):
                self._reported.add(server)
                text = "%s accepted a goal of %s %.1f s ago, and its execute() was not called: end %s with %s"
                callback = described(callbacks_of(server).handle_accepted)
                way = "goal_handle.execute()"
                logger.warning(text, full_name(node), inner.action_name, seconds, callback, way)
                return


def _is_kept(goal: ServerGoalHandle, *known: object) -> bool:
    """Whether user code could still execute a goal: something unknown refers to its handle."""
    others = [other for other in gc.get_referrers(goal) if all(other is not one for one in known)]
    return not all(isinstance(other, FrameType) for other in others)

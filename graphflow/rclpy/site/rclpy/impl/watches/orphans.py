"""Nodes that leave their executor, by another spin or by their own callback, so that nothing of theirs runs any more.

In ROS 2 they just fall silent.
"""

from __future__ import annotations

import logging
import sys
from types import FrameType
from typing import TYPE_CHECKING

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.rclpy.context_state import LOOP
from rclpy.impl.deadlock.stacks import is_in_run, stacks
from rclpy.impl.nodes import internals_of

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.executors import Executor
    from rclpy.node import Node

WARN_AFTER = 1.0
"""Seconds within which the node may be spun again, or the spin may end."""
_IN_A_CALLBACK = "do not spin in a callback: future.add_done_callback(...), or await it in an async def callback"
logger = logging.getLogger("graphflow")


def watch(node: Node, former: Executor, what: str) -> None:
    """Report a node that nothing spins again while its former executor continues without it.

    Args:
        node: The node that was spun by `what`, a function of rclpy's, and is in no executor now.
        former: The executor that the node was in before.
    """
    begin = sys._getframe()
    where = _users_place(begin)
    if not where:
        return
    remedy = (
        _IN_A_CALLBACK
        if is_in_run(begin)
        else f"spin the executor, with all its nodes: {what.replace('rclpy', 'executor')}(...)"
    )
    text = (
        f"{node.get_fully_qualified_name()} is no longer spun: {what}, called in {where}, removed it from its "
        f"{type(former).__name__}, as in ROS 2\nRemedy:\n  {remedy}"
    )
    times = internals_of(node).times_added

    def check() -> None:
        if internals_of(node).times_added == times and not node.handle.is_destroyed and _is_spun(former):
            logger.error("%s", text)

    internals_of(node).life.on_loop(lambda: LOOP.start().call_later(WARN_AFTER, check), wait=False)


def attend(life: ContextState) -> None:
    """Report a callback that destroys the last node of its executor while the spin continues."""
    life.on_leaving.append(_destroyed)


def _destroyed(node: Node) -> None:
    executor, begin = node.executor, sys._getframe()
    if executor is None or executor.spinning.nodes or not is_in_run(begin):
        return
    place, name = _users_place(begin), node.get_fully_qualified_name()

    def check() -> None:
        spinning = executor.spinning
        if not spinning.nodes and spinning.waits_forever and _is_spun(executor):
            text = "%s destroyed %s, and its spin goes on without a node: to end it as well, raise SystemExit there"
            logger.warning(text, place, name)

    if place:
        internals_of(node).life.on_loop(lambda: LOOP.start().call_later(WARN_AFTER, check), wait=False)


def _users_place(begin: FrameType) -> str:
    """Return the innermost line of user code that leads to a frame: `lamp.py:12 in tick`; empty for none."""
    frame = users_frame(begin)
    if frame is None:
        return ""
    return f"{short_place(frame.f_code.co_filename, frame.f_lineno)} in {frame.f_code.co_name}"


def _is_spun(executor: Executor) -> bool:
    return executor.context.ok() and any(executor in stack.spins for stack in stacks())

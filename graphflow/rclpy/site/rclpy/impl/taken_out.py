"""Nodes that a spin has taken out of the executor that spins them, and left in none: nothing of theirs runs any more.

In ROS 2 they fall silent without a word.
"""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from types import FrameType
from typing import Any

from graphflow.deadlock.user_code import is_users
from graphflow.errors import Place
from graphflow.rclpy.life import LOOP
from rclpy.impl.stacks import is_in_run, stacks

TELL_AFTER = 1.0
"""Seconds within which somebody may spin the node again."""
_IN_A_CALLBACK = "do not spin in a callback: future.add_done_callback(...), or await it in an async def callback"
logger = logging.getLogger("graphflow")


def watch(node: Any, former: Any, what: str) -> None:
    """Tell it if nobody spins a node again, and its former executor goes on without it.

    Args:
        node: The node that was spun by `what`, a function of rclpy's, and is in no executor now.
        former: The executor that it was in before.
    """
    begin = sys._getframe()
    frame: FrameType | None = begin
    while frame is not None and not is_users(frame.f_code.co_filename):
        frame = frame.f_back
    if frame is None:
        return
    where = f"{Place(Path(frame.f_code.co_filename).name, frame.f_lineno)} in {frame.f_code.co_name}"
    remedy = (
        _IN_A_CALLBACK
        if is_in_run(begin)
        else f"spin the executor, with all its nodes: {what.replace('rclpy', 'executor')}(...)"
    )
    text = (
        f"{node.get_fully_qualified_name()} is spun by nobody any more: {what}, called in {where}, took it out of its "
        f"{type(former).__name__} and left it in none, as in ROS 2\nThis ends it:\n  {remedy}"
    )
    times = node._graphflow.times_added

    def look() -> None:
        if node._graphflow.times_added == times and not node.handle.is_destroyed and _is_spun(former):
            logger.error("%s", text)

    node._graphflow.life.on_loop(lambda: LOOP.start().call_later(TELL_AFTER, look), wait=False)


def _is_spun(executor: Any) -> bool:
    return executor.context.ok() and any(executor in stack.spins for stack in stacks())

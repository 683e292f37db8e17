"""Goals that a callback sends again and again while the former ones still run, as in each run of a timer.

ROS 2 sends them all, and the server queues them or runs them side by side.
"""

from __future__ import annotations

import logging

from graphflow.errors import Place
from rclpy.impl.callers import caller
from rclpy.impl.deadlock.stacks import is_in_run

MANY = 10
"""The number of goals of one client before a warning."""
_reported: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


def warn_of_unended(action: str, count: int) -> None:
    """Warn of many goals, once at the line in a callback that sends another one.

    Args:
        count: The number of goals of the client that wait or run.
    """
    asked = caller(2) if count >= MANY else None
    if asked is None or asked.place in _reported or not is_in_run(asked.frame):
        return
    _reported.add(asked.place)
    text = "%s: this sends another goal to %s while %d wait or run: send the next one when the result of the former "
    text += "has come, or cancel the former with goal_handle.cancel_goal_async()"
    logger.warning(text, asked.place, action, count)

"""Goals that go on after their cancellation was accepted, since no code looks whether they are cancelled.

ROS 2 lets them run to their end.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.action.server import ActionServer

MANY = 2
"""The number of feedback messages after the cancellation; the first may have been under way."""


class Uncancelled:
    """Whether a goal's callback looks at a cancellation; the warning is given once."""

    def __init__(self, server: ActionServer) -> None:
        self._server = server
        self._is_due = False
        self._sent = 0

    def cancelled(self) -> None:
        """Note that the cancellation was accepted."""
        self._is_due = True

    def look(self) -> None:
        """Note that code has read the goal's status."""
        self._is_due = False

    def sent_feedback(self) -> None:
        """Warn if a cancelled goal goes on."""
        self._sent += self._is_due
        if self._sent >= MANY:
            self.succeeds()

    def succeeds(self) -> None:
        """Warn if a cancelled goal ends as if it were not cancelled."""
        if not self._is_due:
            return
        self._is_due = False
        result = f"{self._server.action_type.__name__}.Result()"
        way = f"if goal_handle.is_cancel_requested: goal_handle.canceled(); return {result}"
        self._server.warn(f"the goal is cancelled, and goes on: where it is executed, write in the loop {way}")

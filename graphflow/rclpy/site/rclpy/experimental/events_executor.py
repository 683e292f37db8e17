"""An executor of one thread that is told what has something to do; in ROS 2 others look for it, here none does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy.executors import SingleThreadedExecutor

if TYPE_CHECKING:
    from rclpy.context import Context


class EventsExecutor(SingleThreadedExecutor):
    """Runs callbacks one after the other, in the thread that spins."""

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)

"""ROS 2's event-driven executor; here every executor is driven by events."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy.executors import SingleThreadedExecutor

if TYPE_CHECKING:
    from rclpy.context import Context


class EventsExecutor(SingleThreadedExecutor):
    """An executor that runs callbacks one at a time in the spinning thread."""

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)

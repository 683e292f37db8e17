"""ROS 2's experimental features."""

from __future__ import annotations

from rclpy.experimental.events_executor import EventsExecutor

__all__ = ["EventsExecutor"]

"""What ROS 2 tries out."""

from __future__ import annotations

from rclpy.experimental.events_executor import EventsExecutor

__all__ = ["EventsExecutor"]

"""What is published of the calls of a service."""

from rclpy._rclpy_pybind11 import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]

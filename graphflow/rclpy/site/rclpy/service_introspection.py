"""Service introspection: the part of a service's calls that is published."""

from rclpy._rclpy_pybind11 import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]

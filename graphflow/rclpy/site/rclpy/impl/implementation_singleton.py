"""The access path to rclpy's extension module."""

import rclpy._rclpy_pybind11 as rclpy_implementation

__all__ = ["rclpy_implementation"]

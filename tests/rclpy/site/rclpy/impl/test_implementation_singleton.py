"""Where code finds the extension module."""

from rclpy import _rclpy_pybind11
from rclpy.impl.implementation_singleton import rclpy_implementation


def test_it_is_that_module() -> None:
    """Under the name that rclpy gives it."""
    assert rclpy_implementation is _rclpy_pybind11

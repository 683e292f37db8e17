"""Names of rclpy's extension module."""

from __future__ import annotations

import pytest

from rclpy import _rclpy_pybind11 as extension
from rclpy.qos import qos_profile_default


def test_its_errors_are_what_code_catches() -> None:
    """All that rcl reports is a RuntimeError."""
    for error in (extension.RCLError, extension.InvalidHandle, extension.UnknownROSArgsError):
        with pytest.raises(RuntimeError):
            raise error("said")


def test_profiles_are_found_by_name() -> None:
    """As some code asks for them."""
    assert extension.rmw_qos_profile_t.predefined("qos_profile_default") is qos_profile_default

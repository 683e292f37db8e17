"""Loggers by name."""

from __future__ import annotations

from pathlib import Path

import pytest

import rclpy.logging as loggers
from rclpy.logging import LoggingSeverity


def test_levels_are_set_by_name() -> None:
    """And gone when they are cleared."""
    loggers.set_logger_level("arm", LoggingSeverity.ERROR)
    assert loggers.get_logger_level("arm") is LoggingSeverity.ERROR
    assert loggers.get_logger_effective_level("arm.hand") is LoggingSeverity.ERROR
    loggers.clear_config()
    assert loggers.get_logger_level("arm") is LoggingSeverity.UNSET
    assert loggers.get_logger_effective_level("arm.hand") is LoggingSeverity.INFO
    loggers.initialize()
    loggers.shutdown()


def test_a_logger_has_a_name() -> None:
    """And a level one of the known ones."""
    assert loggers.get_logger("arm").name == "arm"
    with pytest.raises(ValueError, match="must not be empty"):
        loggers.get_logger("")
    assert loggers.get_logging_severity_from_string("warn") is LoggingSeverity.WARN
    with pytest.raises(RuntimeError, match="loud"):
        loggers.get_logging_severity_from_string("loud")


def test_log_files_are_where_ros_2_has_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """As the environment says."""
    monkeypatch.setenv("ROS_HOME", "/ros")
    assert loggers.get_logging_directory() == Path("/ros/log")
    monkeypatch.setenv("ROS_LOG_DIR", "/logs")
    assert loggers.get_logging_directory() == Path("/logs")

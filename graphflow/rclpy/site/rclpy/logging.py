"""Loggers by name, and their levels."""

from __future__ import annotations

import logging as python_logging
import os
from pathlib import Path

from graphflow.runtime.logs.logger import ROOT
from rclpy._rclpy_pybind11 import RCUtilsError
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.rcutils_logger import RcutilsLogger, python_logger

__all__ = [
    "LoggingSeverity",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]

_root_logger = RcutilsLogger()


def get_logger(name: str) -> RcutilsLogger:
    """Return the logger of a name. Raises ValueError for an empty one."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return _root_logger.get_child(name)


def initialize() -> None:
    """Do nothing: no setup is needed."""


def shutdown() -> None:
    """Do nothing: there is nothing to release."""


def clear_config() -> None:
    """Reset all loggers to the root's level."""
    for name, logger in list(python_logging.Logger.manager.loggerDict.items()):
        if name.startswith(f"{ROOT}.") and isinstance(logger, python_logging.Logger):
            logger.setLevel(python_logging.NOTSET)


def set_logger_level(name: str, level: int | LoggingSeverity, detailed_error: bool = False) -> None:
    """Make the logger of a name log only lines of at least this severity.

    Args:
        detailed_error: Ignored; rcutils' option for a longer text.

    Raises:
        ValueError: No such level.
    """
    RcutilsLogger(name).set_level(LoggingSeverity(level))


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return a logger's effective level: its own, or that of its nearest ancestor that has one."""
    return RcutilsLogger(name).get_effective_level()


def get_logger_level(name: str) -> LoggingSeverity:
    """Return a logger's own level."""
    return LoggingSeverity(python_logger(name).level)


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Convert a severity's name. Raises RCUtilsError if there is none of that name."""
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RCUtilsError(f"Failed to get log severity from name {log_severity!r}") from None


def get_logging_directory() -> Path:
    """Return the folder of log files, as ROS 2 chooses it."""
    given, home = os.environ.get("ROS_LOG_DIR"), os.environ.get("ROS_HOME")
    if given:
        return Path(given).expanduser()
    return Path(home or "~/.ros").expanduser() / "log"

"""Loggers by name, and their levels."""

from __future__ import annotations

import logging as python_logging
import os
from pathlib import Path

from graphflow.runtime.logs.logger import ROOT
from rclpy._rclpy_pybind11 import RCUtilsError
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.rcutils_logger import RcutilsLogger

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
    """The logger of a name. Raises ValueError for an empty one."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return _root_logger.get_child(name)


def initialize() -> None:
    """Nothing is needed before a line is logged."""


def shutdown() -> None:
    """Nothing is held."""


def clear_config() -> None:
    """Have all loggers go by the level of the root again."""
    for name, logger in list(python_logging.Logger.manager.loggerDict.items()):
        if name.startswith(f"{ROOT}.") and isinstance(logger, python_logging.Logger):
            logger.setLevel(python_logging.NOTSET)


def set_logger_level(name: str, level: int | LoggingSeverity, detailed_error: bool = False) -> None:
    """Have the logger of a name log only what matters this much.

    Args:
        detailed_error: rcutils' wish for a longer text.

    Raises:
        ValueError: There is no such level.
    """
    RcutilsLogger(name).set_level(LoggingSeverity(level))


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """What the lines of a logger must matter: its own level, or that of the nearest above it that has one."""
    return RcutilsLogger(name).get_effective_level()


def get_logger_level(name: str) -> LoggingSeverity:
    """The level of a logger itself."""
    return LoggingSeverity(RcutilsLogger(name)._logger.level)


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """The level of a word. Raises RCUtilsError if there is none."""
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RCUtilsError(f"Failed to get log severity from name {log_severity!r}") from None


def get_logging_directory() -> Path:
    """The folder for log files, as ROS 2 has it."""
    given, home = os.environ.get("ROS_LOG_DIR"), os.environ.get("ROS_HOME")
    if given:
        return Path(given).expanduser()
    return Path(home or "~/.ros").expanduser() / "log"

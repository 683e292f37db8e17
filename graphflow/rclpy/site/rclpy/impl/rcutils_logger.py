"""A node's logger: lines go to the terminal, the log files and /rosout, as for graphflow's own nodes."""

from __future__ import annotations

import logging as python_logging
import sys
import time
from types import CodeType, FrameType, SimpleNamespace
from typing import Any

from graphflow.runtime.logs.logger import ROOT, node_logger
from graphflow.runtime.logs.rosout import Console, setup_console
from rclpy.impl.logging_severity import SEVERITIES, LoggingSeverity


class _WallClock:
    """Wall time, for calls that name no clock."""

    @staticmethod
    def now() -> SimpleNamespace:
        return SimpleNamespace(nanoseconds=time.time_ns())


_WALL_CLOCK = _WallClock()
_FILTERS: dict[str, dict[str, object]] = {
    "throttle": {"throttle_duration_sec": None, "throttle_time_source_type": _WALL_CLOCK},
    "skip_first": {"skip_first": None},
    "once": {"once": None},
}
"""The options of a call that filter its lines, with their defaults: None if required. In order of evaluation."""


class LoggingFilter:
    """A filter that decides, by the options of a call, whether its line is logged."""

    params: dict[str, object] = {}  # noqa: RUF012 - as rclpy has it


class Once(LoggingFilter):
    """Logs the first line only."""

    params = _FILTERS["once"]


class Throttle(LoggingFilter):
    """Logs at most one line per duration."""

    params = _FILTERS["throttle"]


class SkipFirst(LoggingFilter):
    """Logs all lines but the first."""

    params = _FILTERS["skip_first"]


class _Site:
    """One logging call in the code."""

    def __init__(self, name: str, severity: int, options: dict[str, Any]) -> None:
        self.name, self.severity, self.options = name, severity, options
        self.is_first = True
        self.was_logged = False
        self.last_ns: int | None = None

    def compare(self, name: str, severity: int, options: dict[str, Any]) -> None:
        """Raise ValueError if the call's options have changed."""
        if name != self.name:
            raise ValueError("Logger name cannot be changed between calls.")
        if severity != self.severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        if options != self.options:
            raise ValueError(f"Logging parameters cannot be changed between calls. Was: {self.options}, is: {options}")

    def is_due(self) -> bool:
        """Whether the line is to be logged this time."""
        options = self.options
        if "throttle_duration_sec" in options and not self._has_passed(options["throttle_duration_sec"]):
            return False
        if "skip_first" in options and self.is_first:
            self.is_first = False
            return False
        if "once" in options:
            first, self.was_logged = not self.was_logged, True
            return first
        return True

    def _has_passed(self, seconds: float) -> bool:
        clock = self.options["throttle_time_source_type"]
        now_ns = clock.now().nanoseconds
        last_ns = self.last_ns if self.last_ns is not None else 0
        if now_ns >= last_ns + int(seconds * 1e9):
            self.last_ns = now_ns
            return True
        return False


def _options(given: dict[str, object]) -> dict[str, object]:
    """Return the options of a call that are not false. Raises TypeError for an unknown one, and for a wrong value."""
    found: dict[str, Any] = {}
    if isinstance(pause := given.get("throttle_duration_sec"), (str, bytes)):
        raise TypeError(f"throttle_duration_sec: expected a number of seconds, got {pause!r}")
    for name, words in _FILTERS.items():
        needed = [word for word, default in words.items() if default is None]
        is_half = any(given.get(word) is not None for word in words if word not in needed)
        if is_half and not all(given.get(word) is not None for word in needed):
            raise TypeError(f'required parameter "{needed[0]}" not specified but is required for the {name} filter')
        if all(given.get(word) for word in needed):
            found |= {word: given.get(word, default) for word, default in words.items()}
    for word in given:
        if not any(word in words for words in _FILTERS.values()):
            raise TypeError(f'parameter "{word}" is not one of the recognized logging options')
    return found


def python_logger(name: str) -> python_logging.Logger:
    """Return the logger of Python's that a logger's name stands for; the root for an empty one."""
    return node_logger(f"/{name.replace('.', '/')}") if name else python_logging.getLogger(ROOT)


class RcutilsLogger:
    """A logger. Loggers whose names continue its own after a dot are its children and inherit its level."""

    _has_root_level = False
    """Whether the root's level was set; until then it is INFO."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._sites: dict[tuple[CodeType, int], _Site] = {}

    @property
    def _logger(self) -> python_logging.Logger:
        return python_logger(self.name)

    def get_child(self, name: str) -> RcutilsLogger:
        """Return the logger `name` below this one. Raises ValueError for an empty name."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: LoggingSeverity | int) -> None:
        """Log only lines of at least this severity."""
        try:
            severity = LoggingSeverity(level)
        except ValueError as error:
            raise ValueError(str(error)) from None  # from this line, which users need not see, and not from enum's
        self._logger.setLevel(int(severity))
        if not self.name:
            RcutilsLogger._has_root_level = True

    def get_effective_level(self) -> LoggingSeverity:
        """Return the effective level: the logger's own, or that of its nearest ancestor that has one."""
        logger: python_logging.Logger | None = self._logger
        if not self.name:
            return _severity(self._logger.level) if self._has_root_level else LoggingSeverity.INFO
        while logger is not None and logger.name.startswith(ROOT):
            if logger.level:
                return _severity(logger.level)
            logger = logger.parent
        return LoggingSeverity.INFO

    def is_enabled_for(self, severity: LoggingSeverity | int) -> bool:
        """Whether a line of this severity is logged."""
        return (self.get_effective_level() or LoggingSeverity.INFO) <= LoggingSeverity(severity)

    def log(self, message: object, severity: LoggingSeverity | int, **kwargs: Any) -> bool:
        """Log a line; return whether it was logged.

        Args:
            kwargs: `throttle_duration_sec=1.0` for at most once in that time, with `throttle_time_source_type` by
                another clock; `once=True`; `skip_first=True`; `name` of another logger.

        Raises:
            TypeError: An option is unknown.
            ValueError: The options of a call in the code have changed since it first ran.
        """
        severity = LoggingSeverity(severity)
        name = kwargs.pop("name", None) or self.name
        frame = _caller()
        # By instruction, as rclpy's CallerId: two calls in one line have filters of their own.
        site_key = (frame.f_code, frame.f_lasti)
        site = self._sites.get(site_key)
        options = _options(kwargs) if kwargs else {}
        if site is None:
            site = self._sites[site_key] = _Site(name, severity, options)
        else:
            site.compare(name, severity, options)
        if not self.is_enabled_for(severity) or (options and not site.is_due()):
            return False
        if not Console.installed().is_wanted:
            setup_console()
        logger = self._logger if name == self.name else python_logger(name)
        code = frame.f_code
        # Not `logger.log`: it would look for the caller again, and find this file.
        record = logger.makeRecord(
            logger.name, int(severity), code.co_filename, frame.f_lineno, str(message), (), None, code.co_qualname
        )
        logger.handle(record)
        return True

    def debug(self, message: object, **kwargs: object) -> bool:
        """Log with severity DEBUG; see `log`."""
        return self.log(message, LoggingSeverity.DEBUG, **kwargs)

    def info(self, message: object, **kwargs: object) -> bool:
        """Log with severity INFO; see `log`."""
        return self.log(message, LoggingSeverity.INFO, **kwargs)

    def warning(self, message: object, **kwargs: object) -> bool:
        """Log with severity WARN; see `log`."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    warn = warning

    def error(self, message: object, **kwargs: object) -> bool:
        """Log with severity ERROR; see `log`."""
        return self.log(message, LoggingSeverity.ERROR, **kwargs)

    def fatal(self, message: object, **kwargs: object) -> bool:
        """Log with severity FATAL; see `log`."""
        return self.log(message, LoggingSeverity.FATAL, **kwargs)


def _severity(level: int) -> LoggingSeverity:
    return LoggingSeverity(level) if level in SEVERITIES else LoggingSeverity.INFO


def _caller() -> FrameType:
    """Return the frame of the code that logs: the first that is not rclpy's."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and frame.f_code.co_filename == __file__ and frame.f_back is not None:
        frame = frame.f_back
    assert frame is not None
    return frame

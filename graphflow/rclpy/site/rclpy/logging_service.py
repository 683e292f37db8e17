"""Services with which others get and set the levels of a process's loggers."""

from __future__ import annotations

from typing import Any

from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.reexports import passed_on
from rclpy.logging import get_logger_level, set_logger_level


class LoggingService:
    """The logger services of a node."""

    def __init__(self, node: Any) -> None:
        from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels

        name = node.get_name()
        self._get = node.create_service(GetLoggerLevels, f"{name}/get_logger_levels", self._asked)
        self._set = node.create_service(SetLoggerLevels, f"{name}/set_logger_levels", self._asked_to_set)

    @staticmethod
    def _asked(request: Any, response: Any) -> object:
        from rcl_interfaces.msg import LoggerLevel

        response.levels = [LoggerLevel(name=name, level=int(get_logger_level(name))) for name in request.names]
        return response

    @staticmethod
    def _asked_to_set(request: Any, response: Any) -> object:
        from rcl_interfaces.msg import SetLoggerLevelsResult

        for wanted in request.levels:
            is_level = wanted.level in LoggingSeverity._value2member_map_
            if is_level:
                set_logger_level(wanted.name, wanted.level)
            reason = "" if is_level else "Failed reason: Invalid logger level."
            response.results.append(SetLoggerLevelsResult(successful=is_level, reason=reason))
        return response


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

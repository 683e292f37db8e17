"""Services with which others get and set the levels of a process's loggers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.impl.logging_severity import SEVERITIES
from rclpy.impl.reexports import passed_on
from rclpy.logging import get_logger_level, set_logger_level

if TYPE_CHECKING:
    from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels

    from rclpy.node import Node


class LoggingService:
    """The logger services of a node."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces import srv

        name = node.get_name()
        self._get = node.create_service(srv.GetLoggerLevels, f"{name}/get_logger_levels", self._serve_levels)
        self._set = node.create_service(srv.SetLoggerLevels, f"{name}/set_logger_levels", self._serve_set_levels)

    @staticmethod
    def _serve_levels(request: GetLoggerLevels.Request, response: GetLoggerLevels.Response) -> object:
        from rcl_interfaces.msg import LoggerLevel

        response.levels = [LoggerLevel(name=name, level=int(get_logger_level(name))) for name in request.names]
        return response

    @staticmethod
    def _serve_set_levels(request: SetLoggerLevels.Request, response: SetLoggerLevels.Response) -> object:
        from rcl_interfaces.msg import SetLoggerLevelsResult

        for wanted in request.levels:
            is_level = wanted.level in SEVERITIES
            if is_level:
                set_logger_level(wanted.name, wanted.level)
            reason = "" if is_level else "Failed reason: Invalid logger level."
            response.results.append(SetLoggerLevelsResult(successful=is_level, reason=reason))
        return response


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

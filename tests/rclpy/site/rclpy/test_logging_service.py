"""The levels of loggers, from outside."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels

import rclpy.logging
from rclpy.node import Node
from tests.rclpy.conftest import Spinner


def test_levels_are_set_and_asked_for(node: Node, spin: Spinner) -> None:
    """Of any logger of the process; a level that there is not is refused."""
    other = Node("other", enable_logger_service=True)
    spin.executor.add_node(other)

    def call(type_: Any, name: str, request: Any) -> Any:
        client = node.create_client(type_, f"/other/{name}")
        assert client.wait_for_service(5)
        future = client.call_async(request)
        spin(future.done)
        return future.result()

    levels = [LoggerLevel(name="arm", level=40), LoggerLevel(name="arm", level=41)]
    results = call(SetLoggerLevels, "set_logger_levels", SetLoggerLevels.Request(levels=levels)).results
    assert [(r.successful, r.reason) for r in results] == [(True, ""), (False, "Failed reason: Invalid logger level.")]
    assert call(GetLoggerLevels, "get_logger_levels", GetLoggerLevels.Request(names=["arm"])).levels == levels[:1]
    rclpy.logging.clear_config()

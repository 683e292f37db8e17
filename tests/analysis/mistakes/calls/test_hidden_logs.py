"""Programs whose log shows nothing."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.hidden_logs import hidden_logs

TOLD = "debug() prints nothing at the usual level: write info(), or give --ros-args --log-level debug"


@pytest.mark.parametrize("logger", ["self.get_logger()", "node.get_logger()", "self.log", "self.logger", "logger"])
def test_a_file_that_logs_with_debug_alone(logger: str) -> None:
    """The first call is told of a program; a module may be one that others import."""
    line = f"{logger}.debug('on')\n"
    assert list(hidden_logs(ast.parse(f"self.pub.publish(1)\n{line}{line}rclpy.spin(node)"))) == [(2, TOLD)]
    assert list(hidden_logs(ast.parse(f"self.pub.publish(1)\n{line}{line}"))) == []


@pytest.mark.parametrize(
    "other",
    [
        "print('on')",
        "self.get_logger().info('on')",
        "self.log.warning('on')",
        "self.get_logger().set_level(LoggingSeverity.DEBUG)",
        "logging.basicConfig(level='DEBUG')",
    ],
)
def test_a_file_that_shows_something(other: str) -> None:
    """Nothing is told of it: what is logged with `debug` is meant for those who ask."""
    assert list(hidden_logs(ast.parse(f"self.get_logger().debug('on')\n{other}\ngraphflow.run(Lamp)"))) == []


def test_files_without_a_log() -> None:
    """Nothing is told: other objects have a `debug`, too."""
    assert list(hidden_logs(ast.parse("pdb.debug('x')\nself.pub.publish(1)\nrclpy.spin(node)"))) == []

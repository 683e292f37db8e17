"""Errors of callbacks that the program around the spin swallows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

PROGRAM = """\
import rclpy
from rclpy.executors import ExternalShutdownException


def main(node, executor, values):
    def tick():
        {tick}

    node.create_timer(0.001, tick)
    try:
        {spin}
    {handler}


def outer(*args):
    try:
        main(*args)
    except Exception:
        pass
"""
INDEX, SPIN, PASS = "values[3]", "rclpy.spin(node, executor)", "except:\n        pass"


def told(tmp_path: Path, caplog: pytest.LogCaptureFixture, node: Node, tick: str, spin: str, handler: str) -> list[str]:
    """Run the program, and return the warnings."""
    file = tmp_path / f"{tmp_path.name}.py"
    file.write_text(source := PROGRAM.format(tick=tick, spin=spin, handler=handler))
    space: dict[str, Any] = {"__name__": "lamp", "rclpy": rclpy}
    exec(compile(source, str(file), "exec"), space)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    space["outer"](node, executor, [])
    return [record.getMessage() for record in caplog.records]


@pytest.mark.parametrize("spin", [SPIN, "executor.spin()"])
@pytest.mark.parametrize(
    ("handler", "line"),
    [
        (PASS, 12),
        ("except Exception:\n        pass", 12),
        ("except KeyboardInterrupt:\n        pass\n    except Exception as e:\n        node.destroy_node()", 14),
    ],
)
def test_an_error_that_is_swallowed(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, node: Node, spin: str, handler: str, line: int
) -> None:
    """It is told once, with the callback, the error and both lines."""
    name = f"{tmp_path.name}.py"

    assert told(tmp_path, caplog, node, INDEX, spin, handler) == [
        f"tick ends the spin by IndexError: list index out of range ({name}:7), which {name}:{line} swallows: "
        "write except (KeyboardInterrupt, ExternalShutdownException), from rclpy.executors"
    ]


@pytest.mark.parametrize(
    ("tick", "spin", "handler"),
    [
        (INDEX, SPIN, "except Exception as e:\n        print(e)"),
        (INDEX, SPIN, "except IndexError:\n        pass"),
        (INDEX, SPIN, "except (KeyboardInterrupt, ExternalShutdownException):\n        pass"),
        (INDEX, SPIN, "except:\n        pass\n        raise"),
        (INDEX, SPIN, "finally:\n        pass"),
        (INDEX, "rclpy.spin_once(node, executor=executor)", PASS),
        ("raise SystemExit", SPIN, PASS),
        ("raise ValueError('done')", SPIN, PASS),
        ("raise KeyboardInterrupt", SPIN, PASS),
        ("rclpy.shutdown()", SPIN, PASS),
        ("rclpy.shutdown(); values[3]", SPIN, PASS),
    ],
)
def test_errors_that_are_handled(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, node: Node, tick: str, spin: str, handler: str
) -> None:
    """Nothing is told of errors that are reported, caught by name, or raised to end the spin."""
    assert told(tmp_path, caplog, node, tick, spin, handler) == []

"""Callbacks that spin their own node."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.nested_spins import nested_spins

SOURCE = """
class Talker(Node):
    def __init__(self):
        self.create_timer(0.5, self.tick)
        {init}

    def tick(self):
        {tick}
"""


def test_a_callback_that_spins() -> None:
    """The line is told, with the callback."""
    [(line, text)] = nested_spins(ast.parse(SOURCE.format(init="pass", tick="rclpy.spin_once(self)")))
    assert line == 8
    assert text.startswith("rclpy.spin_once(self) in the callback tick waits for callbacks of this node")


@pytest.mark.parametrize(
    ("init", "tick"),
    [
        ("rclpy.spin_once(self)", "pass"),
        ("pass", "rclpy.spin_once(self.other)"),
        ("pass", "executor.spin_once()"),
        ("pass", "rclpy.spin(self)"),
    ],
)
def test_other_spins(init: str, tick: str) -> None:
    """Spins outside of callbacks, and those of another node or executor, are left alone."""
    assert not list(nested_spins(ast.parse(SOURCE.format(init=init, tick=tick))))

"""Callbacks that spin their own node."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.nested_spins import nested_spins

SOURCE = """
class Talker(Node):
    def __init__(self):
        {made}
        {init}

    def tick(self):
        {tick}
"""
TIMER = "self.create_timer(0.5, self.tick)"


@pytest.mark.parametrize(
    "made",
    [
        TIMER,
        "self.create_subscription(String, 'word', self.tick, 10)",
        "self.create_service(Empty, 'go', self.tick)",
        "self.create_timer(timer_period_sec=0.5, callback=self.tick)",
    ],
)
def test_a_callback_that_spins(made: str) -> None:
    """The line is told, with the callback."""
    source = SOURCE.format(made=made, init="pass", tick="rclpy.spin_once(self)")
    [(line, text)] = nested_spins(ast.parse(source))
    assert line == 8
    assert text.startswith("rclpy.spin_once(self) in the callback tick waits for callbacks of this node")


@pytest.mark.parametrize(
    ("init", "tick"),
    [
        ("rclpy.spin_once(self)", "pass"),
        ("pass", "rclpy.spin_once(self.other)"),
        ("pass", "executor.spin_once()"),
        ("pass", "rclpy.spin(self)"),
        ("self.create_timer(callback=self.work, timer_period_sec=0.5)", "executor.spin_once()"),
    ],
)
def test_other_spins(init: str, tick: str) -> None:
    """Spins outside of callbacks, and those of another node or executor, are left alone."""
    assert not list(nested_spins(ast.parse(SOURCE.format(made=TIMER, init=init, tick=tick))))

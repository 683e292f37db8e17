"""A spin_once in place of a spin."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.single_spins import single_spins

_PROGRAM = """
class Talker(Node):
    def __init__(self):
        self.create_{made}

def main():
    {spin}

{more}
"""
_TIMER = "timer(0.5, self.tick)"


def _found(spin: str, made: str = _TIMER, more: str = "main()") -> list[tuple[int, str]]:
    return list(single_spins(ast.parse(_PROGRAM.format(spin=spin, made=made, more=more))))


def test_the_only_spin() -> None:
    """The sentence has the call that runs until the program is stopped."""
    [(line, text)] = _found("rclpy.spin_once(Talker())")
    assert line == 7
    assert text.startswith("rclpy.spin_once calls one callback and returns, and no timer runs after it")
    assert text.endswith("write rclpy.spin(Talker())")


def test_several_that_are_all_there_is() -> None:
    """The last one is told."""
    [(line, text)] = _found("rclpy.spin_once(talker)\n    rclpy.spin_once(listener)")
    assert line == 8
    assert text.endswith("write rclpy.spin(listener)")


@pytest.mark.parametrize("made", ["subscription(Int32, 'a', self.heard, 10)", "service(Trigger, 'go', self.go)"])
@pytest.mark.parametrize("after", ["", "node.destroy_node()\n    rclpy.shutdown()"])
def test_a_listener_that_ends(made: str, after: str) -> None:
    """One message, or one request, is seldom what is meant."""
    [(line, text)] = _found(f"rclpy.spin_once(node)\n    {after}", made)
    assert line == 7
    assert text.startswith(
        "rclpy.spin_once calls one callback and returns, and the program ends after it; to run until"
    )


def test_a_spin_outside_functions() -> None:
    """It is the program's, as one in `main` is."""
    [(line, _)] = _found("pass", more="rclpy.spin_once(node)")
    assert line == 9


@pytest.mark.parametrize(
    ("spin", "made", "more"),
    [
        ("while rclpy.ok(): rclpy.spin_once(node)", _TIMER, "main()"),
        ("for _ in range(9): rclpy.spin_once(node)", _TIMER, "main()"),
        ("[rclpy.spin_once(node) for _ in range(9)]", _TIMER, "main()"),
        ("rclpy.spin(node)", _TIMER, "main()"),
        ("rclpy.spin_until_future_complete(node, future)", _TIMER, "main()"),
        ("rclpy.spin_once(node)\n    print(node.heard)", "subscription(Int32, 'a', self.heard, 10)", "main()"),
        ("rclpy.spin_once(node)", "client(Trigger, 'go')", "main()"),
        ("rclpy.spin_once(node, timeout_sec=5.0)", "subscription(Int32, 'a', self.heard, 10)", "main()"),
        ("pass", "subscription(Int32, 'a', self.heard, 10)", "rclpy.spin_once(node)"),
        ("rclpy.spin_once(node)", _TIMER, "rclpy.spin(node)"),
        ("rclpy.spin_once(node)", _TIMER, "rclpy.spin_until_future_complete(node, future)"),
        ("pass", _TIMER, "def step(): rclpy.spin_once(node)"),
    ],
)
def test_spins_that_may_be_meant(spin: str, made: str, more: str) -> None:
    """Loops, other spins, a program that waits for one message, one that also spins, and a helper are left alone."""
    assert _found(spin, made, more) == []

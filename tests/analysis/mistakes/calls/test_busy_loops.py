"""Loops without a pause, and loops around spin_once with a long one."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.busy_loops import busy_loops


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (
            "while self.pose is None:\n    await asyncio.sleep(0)",
            "write await asyncio.sleep(0.05), or",
        ),
        ("while not done():\n    rclpy.spin_once(node, timeout_sec=0)", "leave out timeout_sec"),
        ("while rclpy.ok():\n    rclpy.spin_once(node, timeout_sec=0.0)", "takes a whole core"),
        ("while not self.is_done:\n    pass", "nothing else runs in its thread"),
        ("while node.pose is None:\n    pass", "; if a callback of a node ends it, call rclpy.spin_once"),
        (
            "def f(self):\n    while not self.is_done:\n        pass",
            "; if a callback ends it, go on there",
        ),
        (
            "async def f(self):\n    while not self.is_done:\n        pass",
            "; return from it, and go on in the",
        ),
        ("while rclpy.ok():\n    rclpy.spin_once(node)\n    time.sleep(1.0)", "keeps the next one waiting 1 s"),
    ],
)
def test_loops_that_cost_too_much(code: str, told: str) -> None:
    """The sentence says what the loop costs, and what to write."""
    [(_, text)] = busy_loops(ast.parse(code))
    assert told in text


@pytest.mark.parametrize(
    "code",
    [
        "while self.pose is None:\n    await asyncio.sleep(0.1)",
        "while queue:\n    handle(queue.pop())\n    await asyncio.sleep(0)",
        "while rclpy.ok():\n    rclpy.spin_once(node)",
        "while rclpy.ok():\n    rclpy.spin_once(node, timeout_sec=0.1)\n    time.sleep(0.05)",
        "while rclpy.ok():\n    step()\n    rclpy.spin_once(node, timeout_sec=0)",
        "while True:\n    node.step()\n    time.sleep(1.0)",
        "while read() != b'':\n    pass",
        "while True:\n    pass",
    ],
)
def test_loops_with_work(code: str) -> None:
    """A loop that waits, or does something in each turn, is left alone."""
    assert list(busy_loops(ast.parse(code))) == []

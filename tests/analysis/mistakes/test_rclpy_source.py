"""Mistakes in the source of programs for rclpy."""

from __future__ import annotations

import ast

from graphflow.analysis.mistakes.rclpy_source import foreseen, slips

SOURCE = """\
def tick(timer):
    timer.cancel
    timer.state == "on"

def main():
    node.create_timer(1.0, work())
    Thread(target=rclpy.spin(node))

def work():
    print("works")

if __name__ == "main":
    main()
"""


def test_both_lists() -> None:
    """Each mistake is in one of them, with its line."""
    module = ast.parse(SOURCE)
    assert [line for line, _ in slips(module)] == [2, 3]
    assert sorted(line for line, _ in foreseen(module)) == [6, 7, 12]
    assert "__name__ is never 'main', so nothing runs; write: if __name__ == '__main__':" in dict(foreseen(module))[12]


def test_a_correct_program() -> None:
    """Is in none."""
    right = SOURCE.replace("timer.cancel", "timer.cancel()").replace('== "on"', '= "on"')
    right = right.replace("work())", "work)").replace("rclpy.spin(node)", "rclpy.spin").replace('"main"', '"__main__"')
    module = ast.parse(right)
    assert (slips(module), foreseen(module)) == ([], [])

"""Statements after rclpy.spin that are meant to run beside it."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.after_spin import after_spin

_PROGRAM = """
class Mover(Node):
    def move(self):
        self.pub.publish(Twist())

    def stop_robot(self):
        self.pub.publish(Twist())

    def report(self):
        print(self.count)

def main():
    node = Mover()
    rclpy.spin(node)
    {}
"""


@pytest.mark.parametrize("statement", ["node.move()", "node.pub.publish(Twist())", "node.create_timer(1.0, f)"])
def test_statements_that_send(statement: str) -> None:
    """The sentence names both lines."""
    [(line, text)] = after_spin(ast.parse(_PROGRAM.format(statement)))
    assert line == 15
    assert text.startswith(f"{statement.partition('(')[0]} runs only after Ctrl-C, since spin (line 14) returns then")


def test_another_spin() -> None:
    """It begins when the first one ends."""
    [(line, text)] = after_spin(ast.parse(_PROGRAM.format("rclpy.spin(other)\n    other.move()")))
    assert line == 15
    assert text.startswith(
        "rclpy.spin(other) runs only after Ctrl-C, since spin (line 14) returns then; spin all nodes"
    )


def test_a_spin_that_a_callback_ends() -> None:
    """A part that is initialized anew comes after it on purpose."""
    more = "rclpy.init()\n    other = Other()\n    rclpy.spin(other)\n    other.move()"
    assert list(after_spin(ast.parse(_PROGRAM.format(more)))) == []


@pytest.mark.parametrize(
    "statement",
    ["node.destroy_node()", "node.stop_robot()", "node.report()", "rclpy.shutdown()", "print(node.count)", "move()"],
)
def test_statements_for_the_end(statement: str) -> None:
    """Calls that belong to the end of a program are left alone."""
    assert list(after_spin(ast.parse(_PROGRAM.format(statement)))) == []


@pytest.mark.parametrize(
    "use",
    [
        "response = future.result()",
        "print(future.result().sum)",
        "response = future.result()\n    print(future.result())\n    node.move()",
    ],
)
def test_the_result_of_a_future(use: str) -> None:
    """The sentence has the call that returns when the future is done; it is told of the first line only."""
    program = _PROGRAM.replace("    rclpy.spin", "    future = node.send()\n    rclpy.spin").format(use)
    [(line, text)] = after_spin(ast.parse(program))
    assert line == 16
    assert text.startswith("future.result() runs only after Ctrl-C, since spin (line 15) returns then")
    assert text.endswith("write rclpy.spin_until_future_complete(node, future) in line 15")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("pass", "future = node.end()\n    print(future.result())"),
        ("future = None", "future = node.end()\n    print(future.result())"),
        ("future = pool.submit(work)", "print(future.result())"),
        ("future = node.send()", "print(future.result(1.0))"),
    ],
)
def test_futures_of_the_end(before: str, after: str) -> None:
    """One that is made after spin is awaited there in another way, as is one of a thread, and one that has a limit."""
    program = _PROGRAM.replace("    rclpy.spin", f"    {before}\n    rclpy.spin").format(after)
    assert list(after_spin(ast.parse(program))) == []


def test_a_node_that_is_destroyed_before() -> None:
    """Its line is told; another node's end is not."""
    program = _PROGRAM.replace("    rclpy.spin", "    {}.destroy_node()\n    rclpy.spin").format("node", "pass")
    [(line, text)] = after_spin(ast.parse(program))
    assert line == 14
    assert text.startswith("node.destroy_node() ends the node before spin (line 15)")
    assert not list(after_spin(ast.parse(program.replace("node.destroy_node", "other.destroy_node"))))

"""Publishers that nothing uses."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.unused_publishers import unused_publishers

PROGRAM = """\
class Circle(Node):
    def __init__(self):
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(0.1, self.drive)
    def drive(self):
        {}
def main():
    rclpy.spin(Circle())
"""
TOLD = "self.publisher publishes nothing, since no other line uses it: "


@pytest.mark.parametrize(
    ("line", "way"),
    [
        ("print(Twist())", "call self.publisher.publish(...)"),
        ("self.pub.publish(Twist())", "line 6 has self.pub, which nothing sets: write self.publisher there"),
        ("other.pub.publish(Twist())", "call self.publisher.publish(...)"),
        ("self.pub = make(); self.pub.publish(Twist())", "call self.publisher.publish(...)"),
    ],
)
def test_a_publisher_that_nothing_uses(line: str, way: str) -> None:
    """It is told, with the name that is written in its place."""
    assert list(unused_publishers(ast.parse(PROGRAM.format(line)))) == [(3, TOLD + way)]


@pytest.mark.parametrize(
    "code",
    [
        PROGRAM.format("self.publisher.publish(Twist())"),
        PROGRAM.format("send(self.publisher)"),
        PROGRAM.format("node.publisher.publish(Twist())"),
        PROGRAM.format("getattr(self, name).publish(Twist())"),
        PROGRAM.format("send(self, 'publisher')"),
        PROGRAM.format("pass").replace("main", "helper"),
        PROGRAM.format("pass").replace("self.publisher =", "publisher ="),
    ],
)
def test_publishers_that_may_be_used(code: str) -> None:
    """They are left alone, and so are those of files without a program."""
    assert list(unused_publishers(ast.parse(code))) == []

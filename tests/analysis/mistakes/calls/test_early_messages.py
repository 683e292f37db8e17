"""Messages that a constructor publishes."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.early_messages import early_messages

PROGRAM = """\
class Start(Node):
    def __init__(self):
        super().__init__("start")
        self.pub = self.create_publisher(Bool, "start", {})
        {}
    def tick(self):
        self.pub.publish(Bool())
"""


def test_a_message_at_the_start() -> None:
    """It comes with both remedies."""
    [(line, text)] = early_messages(ast.parse(PROGRAM.format(10, "self.pub.publish(Bool(data=True))")))
    assert line == 5
    assert text == (
        "in __init__, before ROS 2 has found any listener, a message is usually lost; publish it in a timer, or give "
        "the publisher and its subscriptions durability TRANSIENT_LOCAL"
    )


@pytest.mark.parametrize(
    ("qos", "line"),
    [
        ("latched", "self.pub.publish(Bool())"),
        ("10", "self.other.publish(Bool())"),
        ("10", "pub.publish(Bool())"),
        ("10", "time.sleep(1.0); self.pub.publish(Bool())"),
        ("10", "while not self.pub.get_subscription_count(): pass\n        self.pub.publish(Bool())"),
        ("10", "self.create_timer(1.0, lambda: self.pub.publish(Bool()))"),
        ("10", "pass"),
    ],
)
def test_messages_that_may_arrive(qos: str, line: str) -> None:
    """They are kept for those who come later, or the constructor waits for them."""
    assert list(early_messages(ast.parse(PROGRAM.format(qos, line)))) == []

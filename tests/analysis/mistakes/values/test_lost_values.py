"""Values that nothing receives."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.lost_values import lost_values

NATIVE = """
from graphflow.msgs.geometry_msgs.msg import Twist

class Robot(Node):
    cmd_vel = Publisher(Twist, "cmd_vel")
    state = "FORWARD"

    @timer(0.1)
    async def drive(self):
        {}

    def say(self, given):
        return self.state
"""
RCLPY = """
from geometry_msgs.msg import Twist
from std_msgs.msg import String

class Robot(Node):
    def __init__(self):
        super().__init__("robot")
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.scan = None
        self.create_subscription(String, "word", self.drive, 10)

    def drive(self, message):
        {}

    def say(self):
        return self.scan
"""
LOCAL = "{0} sets a local variable, which nothing reads; write self.{0}"
DROPS = "drive is called by a {}, which drops the Twist that it returns; write self.{}.publish({})"


def _told(source: str, line: str) -> list[str]:
    return [text for _, text in lost_values(ast.parse(source.format(line)))]


@pytest.mark.parametrize(
    ("source", "line", "told"),
    [
        (NATIVE, "state = 'BACK'", LOCAL.format("state = 'BACK'")),
        (NATIVE, "if self.state: state = 'A' if x.y else 'B'", LOCAL.format("state = 'A' if x.y else 'B'")),
        (
            NATIVE,
            "state = 'BACK'\n        self.log.info(f'now {state}')",
            LOCAL.format("state = 'BACK'").replace("nothing reads", "only a log reads"),
        ),
        (
            NATIVE,
            "state = 'BACK'\n        print(state)",
            LOCAL.format("state = 'BACK'").replace("nothing reads", "only a log reads"),
        ),
        (RCLPY, "scan = message", LOCAL.format("scan = message")),
        (
            NATIVE,
            "msg = Twist()\n        msg.linear.x = 2.0\n        return msg",
            DROPS.format("timer", "cmd_vel", "msg"),
        ),
        (
            NATIVE,
            "msg = Twist()\n        msg.linear.x = 2.0",
            "msg is a message that nothing reads; publish it, as in .publish(msg)",
        ),
        (
            NATIVE,
            "msg = Twist()\n        msg.parts[0].x = 2.0",
            "msg is a message that nothing reads; publish it, as in .publish(msg)",
        ),
        (NATIVE, "Twist()", "Twist() makes a message that nothing uses; publish it"),
        (RCLPY, "return Twist()", DROPS.format("subscription", "pub", "Twist()")),
    ],
)
def test_lost_values(source: str, line: str, told: str) -> None:
    """Each is told with its correction."""
    assert _told(source, line) == [told]


@pytest.mark.parametrize(
    "line",
    [
        "self.state = 'BACK'",
        "state = 'BACK'\n        print(state, file=f)",
        "state = 'BACK'\n        return lambda: state",
        "state = self.call()",
        "global state\n        state = 'BACK'",
        "state = 'BACK'\n        print('{{state}}'.format(**locals()))",
        "for state in range(3): pass",
        "state = self.state",
        "state = 'BACK'\n        self.state = 'FORWARD'",
        "class Part:\n            state = 'BACK'",
    ],
)
def test_variables_that_are_read(line: str) -> None:
    """Variables may be read, hold the result of a call, or be told from the attribute by the method."""
    assert _told(NATIVE, line) == []


@pytest.mark.parametrize(
    ("source", "line"),
    [(NATIVE, "other = 'BACK'"), (NATIVE, "say = 'BACK'"), (RCLPY, "message = 1\n        return message")],
)
def test_variables_of_other_names(source: str, line: str) -> None:
    """The class sets no attribute of that name."""
    assert _told(source, line) == []


@pytest.mark.parametrize(
    ("source", "line"),
    [
        (NATIVE, "msg = Twist()\n        self.cmd_vel.publish(msg)\n        return msg"),
        (NATIVE, "self.cmd_vel.publish(Twist())\n        return Twist()"),
        (NATIVE, "msg = Twist()\n        self.last = msg\n        return msg"),
        (NATIVE, "return None"),
        (NATIVE, "return self.make()"),
        (NATIVE, "return Twist()\n\n    async def again(self):\n        self.cmd_vel.publish(await self.drive())"),
        (RCLPY, "return Twist()\n\n    def again(self):\n        self.pub.publish(self.drive(None))"),
        (RCLPY, "return 1"),
    ],
)
def test_messages_that_are_returned(source: str, line: str) -> None:
    """The handler may also publish or keep the message, or other lines may call the handler."""
    assert _told(source, line) == []


@pytest.mark.parametrize(
    "line",
    [
        "msg.linear.x = 2.0\n        self.cmd_vel.publish(msg)",
        "self.list[msg] = 1",
        "self.use(lambda: msg)",
        "self.use(**locals())",
        "del msg",
        "msg = self.latest\n        msg.linear.x = 2.0",
    ],
)
def test_messages_that_are_read(line: str) -> None:
    """They may be; or their name also stands for another one."""
    assert _told(NATIVE, f"msg = Twist()\n        {line}") == []


@pytest.mark.parametrize(
    "line",
    [
        "msg = Other()\n        msg.linear = 2.0",
        "count = 1",
        "global msg\n        msg = Twist()",
        "with raises(Error):\n            Twist(linear=1)",
        "async with raises(Error):\n            Twist(linear=1)",
        "try:\n            Twist(linear=1)\n        except TypeError: pass",
    ],
)
def test_messages_that_are_meant_otherwise(line: str) -> None:
    """Objects of other classes, globals, and messages that are made for their error."""
    assert _told(NATIVE, line) == []

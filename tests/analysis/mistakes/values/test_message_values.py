"""Messages taken for their values."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.message_values import message_values, subscribed

SOURCE = """
class Voice(Node):
    def __init__(self):
        self.create_subscription(String, "word", self.heard, 10)

    def heard(self, msg):
        {}

    def other(self, msg):
        return msg == "go"
"""


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("return msg == 'go'", "msg is a message, which never equals 'go'; write msg.data, or another field"),
        ("self.fast = msg > 0.5", "msg is a message, which never equals 0.5; "),
        ("if msg: pass", "msg is a message, and so always true; write msg.data, or another field"),
        ("if not msg: pass", "msg is a message, and so always true"),
        ("if msg.data == 5: pass", "msg.data is a text, which never equals 5; write '5', or convert it"),
        ("return msg.data != True", "msg.data is a text, which never equals True; write 'True', or convert it"),
    ],
)
def test_a_message_as_a_value(line: str, told: str) -> None:
    """It is told in the callback of a subscription only."""
    module = ast.parse(SOURCE.format(line))
    [(number, text)] = message_values(module, subscribed(module))
    assert number == 7
    assert text.startswith(told)


@pytest.mark.parametrize(
    ("kind", "value", "told"),
    [
        ("Bool", "'true'", "a bool, which never equals 'true'; write True or False, without quotes"),
        ("Int32", "'5'", "a number, which never equals '5'; write it without quotes"),
        ("Float64", "'5'", "a number, which never equals '5'; write it without quotes"),
        ("Bool", "1", ""),
        ("UInt8", "5", ""),
        ("Float32", "None", ""),
        ("Pair", "'5'", ""),
    ],
)
def test_a_value_of_another_type(kind: str, value: str, told: str) -> None:
    """Its type is known for messages of `std_msgs`."""
    module = ast.parse(SOURCE.replace("String", kind).format(f"return msg.data == {value}"))
    found = [text for _, text in message_values(module, subscribed(module))]
    assert found == ([f"msg.data is {told}"] if told else [])


@pytest.mark.parametrize(
    "line",
    [
        "return msg.data == 'go'",
        "return msg.text == 5",
        "return other.data == 5",
        "return msg is None",
        "return msg == self.last",
        "msg = msg.data; return msg == 'go'",
    ],
)
def test_fields_and_other_messages(line: str) -> None:
    """They are left alone, as is a name that gets another value."""
    module = ast.parse(SOURCE.format(line))
    assert not list(message_values(module, subscribed(module)))

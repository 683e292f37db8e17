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
    ],
)
def test_a_message_as_a_value(line: str, told: str) -> None:
    """It is told in the callback of a subscription only."""
    module = ast.parse(SOURCE.format(line))
    [(number, text)] = message_values(module, subscribed(module))
    assert number == 7
    assert text.startswith(told)


@pytest.mark.parametrize(
    "line",
    ["return msg.data == 'go'", "return msg is None", "return msg == self.last", "msg = msg.data; return msg == 'go'"],
)
def test_fields_and_other_messages(line: str) -> None:
    """They are left alone, as is a name that gets another value."""
    module = ast.parse(SOURCE.format(line))
    assert not list(message_values(module, subscribed(module)))

"""Methods that a class defines twice."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.defined_twice import defined_twice

BOTH = """\
class A(Node):
    def __init__(self):
        self.create_subscription(Pose, 'pose', self.heard, 10)
        self.create_subscription(Twist, 'twist', callback=self.heard, qos_profile=10)

    def heard(self, msg):
        print(msg.x)

    def heard(self, msg):
        print(msg.linear)
"""
LOOP = "        for name in names:\n            self.create_subscription(Pose, name, self.heard, 10)\n"


def test_a_callback_for_two_topics() -> None:
    """The line is that of the method that is lost."""
    assert list(defined_twice(ast.parse(BOTH))) == [
        (6, "A has another 'heard' in line 9, which replaces this one; rename one of the two")
    ]


@pytest.mark.parametrize(
    "text",
    [
        BOTH.replace("    def heard", "    @heard.register\n    def heard"),
        BOTH.replace("msg.linear", "msg.x"),
        BOTH.replace("callback=self.heard", "callback=self.other"),
        BOTH.replace("    def heard(self, msg):\n        print(msg.x)\n", ""),
        f"class A(Node):\n    def __init__(self):\n{LOOP}\n    def heard(self, msg): ...\n",
        BOTH + "\nclass B:\n    def heard(self): ...\n",
    ],
)
def test_names_that_are_shared_on_purpose(text: str) -> None:
    """Nothing is told of decorated methods, copies, leftovers and other classes."""
    assert len(list(defined_twice(ast.parse(text)))) == ("class B" in text)

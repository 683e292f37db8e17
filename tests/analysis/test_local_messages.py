"""Which local names stand for messages."""

from __future__ import annotations

import ast
import textwrap
from typing import Any

import pytest

from graphflow.analysis.local_messages import messages_of
from graphflow.msgs import geometry_msgs
from graphflow.msgs.geometry_msgs.msg import Twist


class Drive:
    """No message."""


NAMES: dict[str, Any] = {"Twist": Twist, "geometry_msgs": geometry_msgs, "Drive": Drive}


@pytest.mark.parametrize(
    ("code", "names"),
    [
        ("def f(self):\n    a = Twist()", {"a"}),
        ("def f(self):\n    a = Twist(linear=1)\n    a = Twist()", {"a"}),
        ("async def f(self, a: Twist): pass", {"a"}),
        ("def f(self, a: 'Twist'): pass", {"a"}),
        ("def f(self, a: geometry_msgs.msg.Twist): pass", {"a"}),
        ("def f(self, a): pass", set()),
        ("def f(self, a: Drive): pass", set()),
        ("def f(self):\n    a = Drive()", set()),
        ("def f(self):\n    a = Twist()\n    a = self", set()),
        ("def f(self, a: Twist):\n    a = self", set()),
        ("def f(self):\n    a = Twist()\n    for a in [self]: pass", set()),
        ("def f(self):\n    a = Unheard()", set()),
        ("def f(self):\n    a = b = Twist()", set()),
    ],
)
def test_names(code: str, names: set[str]) -> None:
    """Those to which nothing else is ever bound."""
    [function] = ast.parse(textwrap.dedent(code)).body
    assert isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef)
    assert messages_of(function, NAMES) == names

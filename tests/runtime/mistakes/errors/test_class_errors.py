"""Message classes that are used in place of messages."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.runtime.mistakes.errors.class_errors import class_in_place
from graphflow.runtime.mistakes.errors.python_errors import remark_on

TWIST = "{0} is the class Twist, not a message: write {0} = Twist()"


def _nested() -> None:
    twist: Any = Twist
    twist.linear.x = 2.0


def _attribute() -> None:
    self = SimpleNamespace(twist=Twist)
    self.twist.linear.x = 2.0


def _read() -> None:
    message: Any = Int32
    str(message.data + 1)


def _itself() -> None:
    str(Int32.data + 1)


def _other() -> None:
    class Lamp:
        @property
        def power(self) -> float:
            return 1.0

    lamp: Any = Lamp
    str(lamp.power.watts)


@pytest.mark.parametrize(
    ("use", "told"),
    [
        (_nested, TWIST.format("twist")),
        (_attribute, TWIST.format("self.twist")),
        (_read, "message is the class Int32, not a message: write message = Int32()"),
        (_itself, "Int32 is a class, not a message: write Int32(), or use a message"),
        (_other, ""),
    ],
)
def test_a_class_in_place_of_a_message(use: Any, told: str) -> None:
    """It is named with the way to make one; a class of the user's has no such words."""
    with pytest.raises((AttributeError, TypeError)) as caught:
        use()
    assert class_in_place(caught.value) == told
    assert remark_on(caught.value) == told


def test_other_errors() -> None:
    """They have other causes."""
    assert class_in_place(AttributeError("'Twist' object has no attribute 'x'")) == ""
    assert class_in_place(AttributeError("'member_descriptor' object has no attribute 'x'")) == ""
    assert class_in_place(ValueError("'property'")) == ""

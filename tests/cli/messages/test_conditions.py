"""Conditions that are typed on the command line."""

from __future__ import annotations

import pytest

from graphflow.cli.messages.conditions import compile_condition
from graphflow.errors import UsageFault
from graphflow.msgs.std_msgs.msg import Int32


def test_a_condition() -> None:
    """A condition is a Python expression on a message m."""
    holds = compile_condition("m.data % 3 == 1")
    assert [n for n in range(7) if holds(Int32(data=n))] == [1, 4]


@pytest.mark.parametrize("text", ["", "m.data =", "import os", "m.data; 1", "\0"])
def test_what_is_no_condition(text: str) -> None:
    """Says how one is written."""
    with pytest.raises(UsageFault, match=r"is not an expression: .*; example: 'm\.data > 3'"):
        compile_condition(text)


def test_a_condition_that_fails() -> None:
    """Says why."""
    with pytest.raises(UsageFault, match=r"'m\.dat': AttributeError: .*dat"):
        compile_condition("m.dat")(Int32())


def test_a_field_without_its_message() -> None:
    """The error for a field's bare name has `m.` before it; for another name, it says what m is."""
    with pytest.raises(UsageFault, match=r"name 'data' is not defined; write m\.data$"):
        compile_condition("data > 3")(Int32())
    with pytest.raises(UsageFault, match=r"name 'msg' is not defined; the message is m, as in m\.data > 3$"):
        compile_condition("msg.data > 3")(Int32())

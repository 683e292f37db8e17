"""Handlers of errors that hide the mistakes of callbacks."""

from __future__ import annotations

import ast
from textwrap import indent

import pytest

from graphflow.analysis.mistakes.calls.silent_excepts import silent_excepts

TOLD = "this hides every error, misspelt names included: write the exception that you expect, or log it"
METHOD = "class Talker(Node):\n    @subscription(String, 'chat')\n    def heard(self, message):\n"


def found(body: str) -> list[tuple[int, str]]:
    return list(silent_excepts(ast.parse(METHOD + indent(body, " " * 8))))


@pytest.mark.parametrize("caught", ["except:", "except Exception:", "except BaseException as error:"])
@pytest.mark.parametrize("work", ["self.out.publish(3)", "self.near = message.rages[0]", "print(message.dat)"])
def test_errors_of_callbacks_that_nobody_sees(caught: str, work: str) -> None:
    """They are told at the line of the `except`."""
    assert found(f"try:\n    {work}\n{caught}\n    pass\n") == [(6, TOLD)]
    assert found(f"for n in range(3):\n    try:\n        {work}\n    {caught}\n        continue\n") == [(7, TOLD)]


@pytest.mark.parametrize(
    "body",
    [
        "try:\n    self.out.publish(3)\nexcept TypeError:\n    pass",
        "try:\n    self.out.publish(3)\nexcept Exception as error:\n    self.log.error(error)",
        "try:\n    self.port.write(b'x')\nexcept Exception:\n    pass",
        "try:\n    self.out.publish(3)\nfinally:\n    pass",
    ],
)
def test_errors_that_are_expected_or_seen(body: str) -> None:
    """Nothing is told of them."""
    assert found(body) == []


def test_callbacks_without_a_decorator() -> None:
    """They are known by the call that takes them; other methods may be for a device, or for the end."""
    source = (METHOD + "        try:\n            message.dat\n        except:\n            pass\n").replace(
        "    @", "    # @"
    )
    assert list(silent_excepts(ast.parse(source))) == []
    source += "    def start(self):\n        self.create_subscription(String, 'chat', self.heard, 10)\n"
    assert list(silent_excepts(ast.parse(source))) == [(6, TOLD)]


def test_functions_outside_of_classes() -> None:
    """They may end a program."""
    source = "def main(node):\n    try:\n        node.publish()\n    except Exception:\n        pass\n"
    assert list(silent_excepts(ast.parse(source))) == []

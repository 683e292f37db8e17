"""The futures of clients in a method."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.rclpy_futures import dotted, futures_of, polled_futures

CALL = "future = self.client.call_async(request)\n"


@pytest.mark.parametrize(
    "use",
    [
        "",
        "rclpy.spin_until_future_complete(self, future)",
        "print(future)",
        "while not future.done(): pass",
        "future.result()",
        "self.executor.spin_until_future_complete(future)",
    ],
)
def test_a_future_that_only_its_client_ends(use: str) -> None:
    """It may be read, awaited and spun for."""
    assert futures_of(ast.parse(CALL + use), {"client"}) == {"future": "client"}


@pytest.mark.parametrize(
    "use",
    [
        "Timer(3.0, future.cancel).start()",
        "future.set_result(None)",
        "self.pending[future] = 1",
        "watch(future)",
        "def later(): print(future)",
    ],
)
def test_a_future_that_other_code_may_end(use: str) -> None:
    """It is left out, as is one of an unknown client."""
    assert futures_of(ast.parse(CALL + use), {"client"}) == {}
    assert futures_of(ast.parse(CALL), {"other"}) == {}


def test_loops_that_ask_for_an_end() -> None:
    """Each future with `not ... .done()` is found, by a dotted name."""
    test = ast.parse("rclpy.ok() and not self.future.done() and other.done()", mode="eval").body
    assert [dotted(owner) for owner in polled_futures(test)] == ["self.future"]
    assert dotted(ast.parse("f()", mode="eval").body) == ""

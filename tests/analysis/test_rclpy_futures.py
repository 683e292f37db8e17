"""The futures of clients in a method."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.rclpy_futures import dotted, early_results, futures_of, polled_futures

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


SENDS = """\
def send(self, request):
    future = self.client.call_async(request)
    {}
    return future.result()
"""


def test_a_result_that_is_returned_at_once() -> None:
    """It is None; the line is told with what to write before it."""
    text = "future.result() is None there, since nothing spins after line 2"
    way = "write before it: rclpy.spin_until_future_complete(self, future)"
    assert list(early_results(ast.parse(SENDS.format("print('sent')")))) == [(4, f"{text}; {way}")]


@pytest.mark.parametrize(
    "line",
    [
        "rclpy.spin_until_future_complete(self, future)",
        "while not future.done(): self.executor.spin_once()",
        "self.came.wait()",
        "time.sleep(1.0)",
        "future = self.other()",
    ],
)
def test_a_result_that_may_be_there(line: str) -> None:
    """Something spins, or other code may do so meanwhile."""
    text = SENDS.format(line).replace("client.call_async", "client.call_async" if "other" not in line else "call")
    assert list(early_results(ast.parse(text))) == []

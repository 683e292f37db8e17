"""Futures that are cancelled in place of their goals."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.cancelled_futures import cancelled_futures

SOURCE = """
class Asker(Node):
    def __init__(self):
        self.future = None

    def accepted(self, future):
        self.future = future.result().get_result_async()
        self.timer = self.create_timer(2.0, self.stop)

    def stop(self):
        {}
"""


def test_a_cancelled_future() -> None:
    """The sentence has the call that cancels the goal."""
    [(line, text)] = cancelled_futures(ast.parse(SOURCE.format("self.future.cancel()")))
    assert line == 11
    assert text.startswith("self.future.cancel() ends only the wait, and the goal goes on")
    assert text.endswith("goal_handle.cancel_goal_async()")


@pytest.mark.parametrize(
    "line",
    ["self.timer.cancel()", "self.handle.cancel_goal_async(); self.future.cancel()", "self.other.cancel()"],
)
def test_other_cancellations(line: str) -> None:
    """Those of timers, of unknown futures, and beside a cancelled goal are left alone."""
    assert not list(cancelled_futures(ast.parse(SOURCE.format(line))))

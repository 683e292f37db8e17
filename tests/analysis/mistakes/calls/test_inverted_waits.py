"""Loops that wait while a service is there."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.inverted_waits import inverted_waits


@pytest.mark.parametrize("wait", ["wait_for_service", "wait_for_server"])
@pytest.mark.parametrize("body", ["log.info('waits')", "print('waits'); time.sleep(1.0)", "pass"])
def test_a_loop_without_not(wait: str, body: str) -> None:
    """The sentence has the loop that was meant."""
    [(line, text)] = inverted_waits(ast.parse(f"while self.cli.{wait}(timeout_sec=1.0): {body}"))
    assert line == 1
    assert text.endswith(f"write while not self.cli.{wait}(timeout_sec=1.0):")


@pytest.mark.parametrize(
    "code",
    [
        "while not self.cli.wait_for_service(): log.info('waits')",
        "while self.cli.wait_for_service(): self.work()",
        "while self.cli.wait_for_service(): log.info('there'); self.work()",
        "while self.cli.wait_for_service(): self.count += 1",
        "while self.is_there(): log.info('there')",
    ],
)
def test_other_loops(code: str) -> None:
    """The right loop, one that works, and one with another condition are left alone."""
    assert not list(inverted_waits(ast.parse(code)))

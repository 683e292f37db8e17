"""Loops that wait while a service is there."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.inverted_waits import inverted_waits


def test_a_loop_without_not() -> None:
    """The sentence has the loop that was meant."""
    [(line, text)] = inverted_waits(
        ast.parse("while self.cli.wait_for_service(timeout_sec=1.0):\n    log.info('waits')")
    )
    assert line == 1
    assert text.endswith("write while not self.cli.wait_for_service(timeout_sec=1.0):")


@pytest.mark.parametrize(
    "code",
    [
        "while not self.cli.wait_for_service(): log.info('waits')",
        "while self.cli.wait_for_service(): self.work()",
        "while self.is_there(): log.info('there')",
    ],
)
def test_other_loops(code: str) -> None:
    """The right loop, one that works, and one with another condition are left alone."""
    assert not list(inverted_waits(ast.parse(code)))

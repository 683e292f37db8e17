"""The values of a loop: spans, lists, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from graphflow.graph.checks.validation import Problems
from graphflow.graph.expansion.loops import values_of
from graphflow.markup import source
from graphflow.markup.tree import tree


@pytest.mark.parametrize(
    ("text", "values", "said"),
    [
        ("1..3", range(1, 4), ""),
        ("2..2", range(2, 3), ""),
        ("[]", [], ""),
        ("[1, '1', true]", [1, "1", True], ""),
        ("3..1", range(0), "in: 3..1 is empty, as a span counts up; write 1..3"),
        ("[a, b, a]", (), "in: 'a' is in the list twice; remove one"),
        ("3", (), "in: expected a list or a span such as 1..10, got 3"),
    ],
)
def test_the_values_of_a_loop(text: str, values: Sequence[Any], said: str) -> None:
    """A span counts up, and a list has each value once; anything else is told."""
    problems = Problems()

    found = values_of(tree(source.read(text, "f.yaml")), problems, is_written_out=True)

    assert list(found) == list(values)
    assert [problem.message for problem in problems] == ([said] if said else [])

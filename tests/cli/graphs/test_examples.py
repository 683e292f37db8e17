"""The examples of `graphflow demo`."""

from __future__ import annotations

import pytest

from graphflow.cli.graphs.examples import DEADLOCKS, graph_file, heading


@pytest.mark.parametrize("kind", ["broken", "fixed"])
@pytest.mark.parametrize("name", [step.name for step in DEADLOCKS])
def test_each_is_a_pair_of_files_that_say_what_they_show(name: str, kind: str) -> None:
    """In their first line."""
    assert len(heading(graph_file(name, kind)).split()) > 3

"""Words that are no verbs."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from graphflow.cli.main import cli
from graphflow.cli.verbs import NOT_YET


@pytest.mark.parametrize("words", NOT_YET)
def test_what_ros2_has_and_graphflow_not_yet(words: str) -> None:
    """A line says so, and what to use meanwhile; the table has nothing that is there by now."""
    done = CliRunner().invoke(cli, [*words.split(), "/x"])
    assert done.exit_code == 2
    assert f"graphflow has no '{words}' yet; meanwhile: " in " ".join(done.output.split())


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("topic ech", "no such command 'ech'; did you mean 'echo'?"),
        ("topi", "no such command 'topi'; did you mean 'topic'?"),
        ("kill", "no such command 'kill'; did you mean 'down'?"),
        ("frobnicate", "no such command 'frobnicate'; graphflow --help lists them"),
        ("service x", "no such command 'x'; there is call, echo, find, info, list, type"),
    ],
)
def test_a_word_that_is_misspelt(words: str, told: str) -> None:
    """The nearest is named, or where they are listed."""
    done = CliRunner().invoke(cli, words.split(), prog_name="graphflow")
    assert done.exit_code == 2
    assert told in done.output

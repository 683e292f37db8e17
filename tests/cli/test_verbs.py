"""Words that are no verbs."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from graphflow.cli.main import cli
from graphflow.cli.verbs import NOT_NEEDED, OF_ONE
from tests.conftest import Machine


@pytest.mark.parametrize("words", NOT_NEEDED)
def test_what_ros2_has_and_graphflow_does_without(words: str) -> None:
    """The error has the reason or the alternative; no entry of the table is an existing verb."""
    done = CliRunner().invoke(cli, [*words.split(), "/x"])
    assert done.exit_code == 2
    assert f"graphflow has no '{words}': " in " ".join(done.output.split())


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("topic ech", "no such command 'ech'; did you mean 'echo'?"),
        ("topi", "no such command 'topi'; did you mean 'topic'?"),
        ("kill", "no such command 'kill'; did you mean 'stop'?"),
        ("frobnicate", "no such command 'frobnicate'; graphflow --help lists all"),
        ("rostopic list", "no such command 'rostopic'; did you mean: graphflow topic list"),
        ("topic list --json true", "--json takes no value; leave out true"),
        ("topic list | grep pose", "| is for a shell, and no shell reads this line: run it in a terminal"),
        ("topic echo /pose --once > out.txt", "> is for a shell, and no shell reads this line: run it in a terminal"),
        ("service x", "no such command 'x'; there is call, echo, find, info, list, type"),
    ],
)
def test_a_word_that_is_misspelt(words: str, told: str) -> None:
    """The nearest is named, or where they are listed."""
    done = CliRunner().invoke(cli, words.split(), prog_name="graphflow")
    assert done.exit_code == 2
    assert told in done.output


@pytest.mark.parametrize(("words", "one"), [*OF_ONE.items(), ("interface list", "interface show")])
def test_a_name_behind_a_verb_that_tells_of_all(words: str, one: str) -> None:
    """The verb that takes it is named, and is one that does."""
    name = "std_msgs/msg/String" if one == "interface show" else "talker"
    done = CliRunner().invoke(cli, [*words.split(), name], prog_name="graphflow")
    assert done.exit_code == 2
    assert f"{words} takes no name; for one: graphflow {one} {name}" in " ".join(done.output.split())
    if words.startswith("interface"):
        told = CliRunner().invoke(cli, [*words.split(), "Pose"], prog_name="graphflow").output
        assert "for one: graphflow interface show PACKAGE/msg/Pose" in " ".join(told.split())
    described = CliRunner().invoke(cli, [*one.split(), "--help"], prog_name="graphflow")
    assert described.exit_code == 0
    assert f"Usage: graphflow {one} [" in described.output


@pytest.mark.parametrize(
    "words", ["node list", "topic list", "service list", "action list", "param list", "topic info /x"]
)
def test_words_about_the_daemon(standing: Machine, words: str) -> None:
    """Options about the daemon are accepted and have no effect."""
    plain = standing.look_and_end(*words.split())
    assert standing.look_and_end(*words.split(), "--no-daemon", "--spin-time", "5", "--use-sim-time") == plain


def test_an_option_that_means_something_else_here() -> None:
    """An option with another meaning keeps it; long-running verbs do not accept `--use-sim-time`."""
    for words in ("topic plot", "topic pub", "topic delay"):
        done = CliRunner().invoke(cli, [*words.split(), "--use-sim-time", "/x"])
        assert "No such option '--use-sim-time'" in done.output

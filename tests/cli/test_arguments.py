"""Arguments of graphs on the command line."""

from __future__ import annotations

import pytest

from graphflow.cli.arguments import as_argument
from tests.conftest import Machine


@pytest.mark.parametrize(
    ("option", "words", "argument"),
    [
        ("--rate", ["g.yaml", "--rate", "2.0"], "rate:=2.0"),
        ("--rate", ["g.yaml", "--rate=2.0"], "rate:=2.0"),
        ("--max-rate", ["--max-rate", "--no-console"], "max_rate:=VALUE"),
        ("--no-tui", ["--no-tui", "g.yaml"], "no_tui:=VALUE"),
        ("-r", ["g.yaml", "-r2"], "r:=VALUE"),
        ("-p", ["g.yaml", "-p", "rate:=2.0"], "rate:=2.0"),
        ("--2", ["--2"], None),
    ],
)
def test_options_as_arguments(option: str, words: list[str], argument: str | None) -> None:
    """With the value that was given."""
    assert as_argument(option, words) == argument


@pytest.mark.parametrize("verb", ["up", "launch", "check", "plan", "explain"])
def test_an_argument_as_an_option(machine: Machine, verb: str) -> None:
    """An argument written as an option is corrected."""
    text = machine.look(verb, "talker_listener", "--rate", "2.0", code=2)
    assert "No such option '--rate'. An argument of the graph is written as rate:=2.0; up GRAPH --show-args" in text


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--params-file", "p.yaml"], "A parameter file belongs to a node of the graph file: params_file: FILE.yaml"),
        (["-p", "rate:=2.0"], "An argument of the graph is written as rate:=2.0. A parameter of a node goes below"),
        (["-p", "rate=2.0"], "Error: A parameter of a node goes below its params:, or is set by graphflow param set"),
        (["--ros-args", "-p", "rate:=2.0"], "A graph file has params: and remap: for each node"),
    ],
)
def test_options_of_nodes(machine: Machine, words: list[str], told: str) -> None:
    """The error for a node's option has the entry of the graph file that replaces it."""
    assert told in machine.look("check", "talker_listener", *words, code=2)


def test_a_misspelt_option(machine: Machine) -> None:
    """A misspelt option is not mistaken for an argument."""
    assert "Did you mean '--json'?" in machine.look("up", "talker_listener", "--jso", code=2)


def test_an_argument_behind_a_dash() -> None:
    """An argument behind one dash is corrected as a whole, although click reads only one letter."""
    assert as_argument("-r", ["a.launch.py", "-rate:=3"]) == "rate:=3"
    assert as_argument("-r", ["a.launch.py", "-r", "3"]) == "r:=3"

"""Commands of ROS 1, and half-remembered ones."""

from __future__ import annotations

import click
import pytest
from click.testing import CliRunner

from graphflow.cli.main import cli
from graphflow.cli.other_words import _LINES, _OPTIONS, _SENTENCES, answer, option_answer


@pytest.mark.parametrize(
    ("path", "words", "line"),
    [
        ("", "msg show geometry_msgs/Twist", "interface show geometry_msgs/msg/Twist"),
        ("", "srv show turtlesim/Spawn", "interface show turtlesim/srv/Spawn"),
        ("", "rosmsg info std_msgs/msg/String", "interface show std_msgs/msg/String"),
        ("", "srv list", "interface list -s"),
        ("", "rostopic echo /a", "topic echo /a"),
        ("", "rosnode kill /a", "stop /a"),
        (
            "",
            "rosrun turtlesim turtlesim_node _a:=1 __name:=b c:=d",
            "run turtlesim turtlesim_node -p a:=1 -r __node:=b c:=d",
        ),
        ("", "plot /turtle1/pose.x", "topic plot /turtle1/pose.x"),
        ("", "call /a std_srvs/srv/Empty '{}'", "service call /a std_srvs/srv/Empty ''\"'\"'{}'\"'\"''"),
        ("", "create lab", "init lab"),
        ("node", "ping turtlesim", "node info turtlesim"),
        ("action", "status /a", "topic echo /a/_action/status"),
        ("lifecycle", "configure /a", "lifecycle set /a configure"),
        ("", "help topic", "topic --help"),
        ("topic", "help", "topic --help"),
        ("action", "status", "topic echo NAME/_action/status"),
        ("interface", "std_msgs/msg/String", "interface show std_msgs/msg/String"),
    ],
)
def test_lines(path: str, words: str, line: str) -> None:
    """The error has the whole command, with types in ROS 2's notation."""
    assert answer(path, words.split()) == f"no such command {words.split()[0]!r}; did you mean: graphflow {line}"


@pytest.mark.parametrize(
    ("path", "words", "text"),
    [
        ("", "roscore", "none is needed: nodes find each other"),
        ("", "core", "none is needed: nodes find each other"),
        ("", "test tests", "tests are run by pytest"),
        ("", "new", "graphflow init NAME creates a project, and graphflow pkg create NAME a package"),
        ("topic", "create /a", "a topic exists as soon as a node publishes or subscribes to it"),
        ("action", "cancel /a", "graphflow service call /a/_action/cancel_goal action_msgs/srv/CancelGoal"),
        ("bag", "stop", "Ctrl-C in its terminal ends a recording"),
    ],
)
def test_sentences(path: str, words: str, text: str) -> None:
    """If there is no command, the error has the reason."""
    told = answer(path, words.split())
    assert told.startswith(f"no such command {words.split()[0]!r}: ")
    assert text in told


@pytest.mark.parametrize("line", _OPTIONS)
def test_options(line: str) -> None:
    """Each option of another tool has an answer, and is not one of the verb's own."""
    path, _, option = line.rpartition(" ")
    done = CliRunner().invoke(cli, [*path.split(), option])
    assert isinstance(done.exception, SystemExit)
    assert f"No such option: {option}" in done.output or f"No such option '{option}'" in done.output
    assert option_answer(path, option)
    assert option_answer(path, "--zzz") == ""


def test_words_that_are_not_known() -> None:
    """Unknown words have no answer."""
    assert answer("", ["frobnicate"]) == answer("topic", ["core"]) == answer("topic", ["ech"]) == ""


def found(words: list[str]) -> list[str]:
    """Return the words of a line that are neither verbs nor options; none if the line is a command."""
    command: click.Command = cli
    context = click.Context(cli)
    while words and isinstance(command, click.Group) and not words[0].startswith("-"):
        inner = command.get_command(context, words[0])
        if inner is None:
            return words
        command, context, words = inner, click.Context(inner, parent=context), words[1:]
    return []


@pytest.mark.parametrize("key", [*_LINES, *_SENTENCES])
def test_no_word_is_a_command(key: str) -> None:
    """A word that is a command would never get its answer."""
    assert found(key.split()) != []


@pytest.mark.parametrize("line", _LINES.values())
def test_each_line_is_a_command(line: str) -> None:
    """With options that it has."""
    words = line.split()
    assert found(words) == []
    options = [word for word in words if word.startswith("-")]
    command: click.Command | None = cli
    for word in words[: len(words) - len(options)]:
        command = command.get_command(click.Context(cli), word) if isinstance(command, click.Group) else command
    known = {name for param in (command or cli).params for name in param.opts} | {"--version"}
    assert known.issuperset(options)

"""Command lines of ROS as steps."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.launchfiles.commands import one_word_fault, plain_words, step_of, typed
from graphflow.markup.tree import Item

CALL = {"call": "/a", "type": "b/srv/C"}
HERE = Place("f.xml", 3, 1)


@pytest.mark.parametrize(
    ("line", "step"),
    [
        ("ros2 service call /a b/srv/C", CALL),
        (
            "ros2 service call /a b/srv/C '{x: 1, y: $(var y)}'",
            {"call": "/a", "type": "b/srv/C", "request": {"x": 1, "y": "$(var y)"}},
        ),
        ("ros2 service call /a b/srv/C \"'{x: 1}'\"", {**CALL, "request": {"x": 1}}),
        (
            "ros2 action send_goal /a b/action/C '{x: 1}' --feedback",
            {"goal": "/a", "type": "b/action/C", "request": {"x": 1}},
        ),
        (
            "ros2 param set /n rate 2.5",
            {"set": "/n", "params": {"rate": 2.5}, "type": "rcl_interfaces/srv/SetParametersAtomically"},
        ),
        ("ros2 topic list", None),
        ("echo hello", None),
    ],
)
def test_lines(line: str, step: dict[str, Any] | None) -> None:
    """A service call, a goal, a parameter; anything else is a program."""
    complaints: list[str] = []
    found = step_of(shlex.split(line), Item(line, HERE), lambda _, said: complaints.append(said))
    assert complaints == []
    assert (None if found is None else {key: item.plain() for key, item in found.items()}) == step


def test_a_request_that_is_no_yaml() -> None:
    """It is told, at the command's place."""
    complaints: list[str] = []
    step_of(
        ["ros2", "service", "call", "/a", "b/srv/C", "{x"],
        Item("", HERE),
        lambda at, said: complaints.append(f"{at} {said}"),
    )
    (complaint,) = complaints
    assert complaint.startswith("f.xml:3:1 the request '{x': not valid YAML")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("2.5", 2.5),
        ("true", True),
        ("[1, 2]", [1, 2]),
        ("a b", "a b"),
        ("$(var x)", "$(var x)"),
        ("{a: 1}", "{a: 1}"),
    ],
)
def test_texts_as_values(text: str, value: object) -> None:
    """Numbers, truth values and lists; a mapping, a substitution, or what is no YAML stays a text."""
    assert typed(Item(text, HERE)).plain() == value
    assert typed(Item("", HERE)).plain() == ""
    assert typed(Item("[", HERE)).plain() == "["
    assert typed(Item(7, HERE)).plain() == 7


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("ros2 topic list", ["ros2", "topic", "list"]),
        ("ros2 call /a \"{x: '1', y: $(var y)}\"", ["ros2", "call", "/a", "{x: '1', y: $(var y)}"]),
        ("ros2 topic list | cat", []),
        ("sleep 1 && ros2 topic list", []),
        ("ros2 topic list > file", []),
        ("ros2 'open", []),
    ],
)
def test_lines_that_need_no_shell(line: str, words: list[str]) -> None:
    """Those without pipes and the like."""
    assert plain_words(line) == words


WAY = "cmd is one word with spaces: add shell=True"


@pytest.mark.parametrize(
    ("texts", "fault"),
    [
        (["ros2 topic list"], f"{WAY}, or give a list of words, cmd=['ros2', 'topic', 'list']"),
        (["$(find-exec ros2) topic list"], f"{WAY}, or give a list of words"),
        (["echo a | cat"], WAY),
        (["ros2", "topic list"], ""),
        (["rviz2"], ""),
        (["$(find-exec rviz 2)"], ""),
        (["'a b'"], ""),
        ([""], ""),
        ([], ""),
    ],
)
def test_a_line_that_is_given_as_one_word(texts: list[str], fault: str) -> None:
    """Is told with the words, where no shell is needed for it."""
    assert one_word_fault(texts) == fault


def test_a_program_whose_name_has_a_space(tmp_path: Path) -> None:
    """Is a program."""
    (tmp_path / "my prog").touch()
    assert one_word_fault([str(tmp_path / "my prog")]) == ""

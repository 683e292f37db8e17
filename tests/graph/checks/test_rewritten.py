"""Values of a graph file in the shape of other tools."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.graph.checks.rewritten import command_of, in_shell, line_for, shell_word


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("params", [{"rate": 2.0}, {"on": True}], "params: {rate: 2.0, 'on': true}"),
        ("params", [{"name": "rate", "value": 2}], "params: {rate: 2}"),
        ("env", ["A=1", "B=x=y"], "env: {A: 1, B: x=y}"),
        ("env", "LANG=C", "env: {LANG: C}"),
        ("remap", [["a", "b"]], "remap: {a: b}"),
        ("remap", [{"from": "a", "to": "/b"}], "remap: {a: /b}"),
        ("remap", ["a:=b"], "remap: {a: b}"),
        ("remap", "chatter -> news", "remap: {chatter: news}"),
        ("nodes", [{"/a": {"class": "b"}}, {"/c": {"class": "d"}}], "nodes: {/a: {class: b}, /c: {class: d}}"),
        ("nodes", [{f"/{n * 60}": {"class": "b"}} for n in "ab"], f"nodes: {{/{'a' * 60}: {{class: b}}, ...}}"),
        ("nodes", [{"name": "a", "pkg": "p", "exec": "e"}], "nodes: {/a: {pkg: p, exec: e}}"),
        ("command", "rviz2 -d 'my robot.rviz'", "command: [rviz2, -d, my robot.rviz]"),
        ("wait", 2.0, "delay: 2.0"),
        ("goal", {"theta": 1.0}, "request: {theta: 1.0}"),
        ("request", "{x: 1.0, y: 2.0}", "request: {x: 1.0, y: 2.0}, without quotes"),
        ("params", "{a: 3}", "params: {a: 3}, without quotes"),
        ("params", "[{a: 3}]", "params: {a: 3}, without quotes"),
        ("nodes", "{/t: {class: 'a:B'}}", "nodes: {/t: {class: 'a:B'}}, without quotes"),
        ("command", "[rviz2, -d, a.rviz]", "command: [rviz2, -d, a.rviz], without quotes"),
        ("command", "[ -f a ] && ls", "command: [sh, -c, '[ -f a ] && ls']"),
    ],
)
def test_lines(key: str, value: Any, line: str) -> None:
    """Each is the line to write in its place."""
    assert line_for(key, value) == line


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("params", 3),
        ("params", "rate"),
        ("params", "{rate"),
        ("params", "[1]"),
        ("remap", [1]),
        ("nodes", [{"class": "a:B"}]),
        ("env", [f"A={'x' * 200}"]),
    ],
)
def test_values_that_mean_nothing(key: str, value: Any) -> None:
    """They have none, nor have long ones."""
    assert line_for(key, value) == ""


def test_lines_of_a_shell() -> None:
    """What only a shell understands is given to one."""
    assert command_of("cd /tmp && ls") == "[sh, -c, cd /tmp && ls]"
    assert command_of("python3 a.py > out") == "[sh, -c, python3 a.py > out]"
    assert command_of("ls 'a") == "[ls, '''a']"
    assert in_shell(["echo", "a b", ">", "out"]) == "[sh, -c, echo 'a b' > out]"


def test_words_of_a_shell() -> None:
    """Programs that take such words themselves, and shells, are left alone."""
    assert shell_word(["cd", "/tmp"]) == "cd"
    assert shell_word(["echo", 1, ">", "out"]) == ">"
    assert shell_word(["sh", "-c", "cd /tmp && ls"]) == shell_word(["expr", 1, ">", 2]) == shell_word([]) == ""
    assert shell_word(["/usr/bin/find", ".", ";"]) == shell_word(["echo", "a>b"]) == ""

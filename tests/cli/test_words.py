"""Words of a command line as options and values: what the shell leaves of an unquoted message is a message."""

from __future__ import annotations

import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import click
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.cli import words
from graphflow.cli.ros.param import set_
from graphflow.cli.ros.topic import pub
from graphflow.cli.words import message_values, messages_in, repair, split_values
from graphflow.errors import UsageFault
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.values import from_plain
from tests.cases import count

CIRCLE = "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"
FLAGS, VALUED = frozenset({"-1", "--once"}), frozenset({"-r", "--rate", "-t"})


def parsed(command: click.Command, words: list[str]) -> dict[str, Any]:
    """Parse the words after a command with click, without running it."""
    return command.make_context(command.name or "", list(words)).params


def published(line: str) -> tuple[dict[str, Any], Any]:
    """The options of a `topic pub` line, and the values of its message."""
    found = parsed(pub, shlex.split(line))
    return found, message_values(found["values"])


def test_the_unquoted_command_of_the_slides() -> None:
    """The course's line has no quotes; the turtle still drives in a circle."""
    options, values = published(f"-r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist {CIRCLE}")
    assert len(options["values"]) > 10
    assert (options["name"], options["type_name"], options["rate"]) == (
        "/turtle1/cmd_vel",
        "geometry_msgs/msg/Twist",
        10.0,
    )
    assert from_plain(Twist, values) == Twist(linear=Vector3(x=2.0), angular=Vector3(z=1.8))


@pytest.mark.skipif(shutil.which("bash") is None, reason="asks bash itself")
def test_bash_splits_it_so() -> None:
    """bash really splits the lines into the words of these tests."""
    done = subprocess.run(
        ["bash", "-c", f"printf '%s\\n' {CIRCLE} -1"], capture_output=True, text=True, check=True, timeout=20
    )
    assert done.stdout.splitlines() == [*CIRCLE.split(), "-1"]


@pytest.mark.parametrize(
    "line",
    [
        "-1 -r 5 /t T {a}",
        "/t -1 T -r 5 {a}",
        "/t T {a} -1 -r 5",
        "/t T {a} --once --rate 5",
        "/t T {a} --once --rate=5",
        "/t T {a} -1 -r5",
        "-r5.0 /t T {a} -1",
        "/t T -1 -r 5 -- {a}",
    ],
)
def test_options_may_stand_anywhere(line: str) -> None:
    """Before, between and after the values, in each way an option is written."""
    options, _ = published(line)
    assert (options["once"], options["rate"]) == (True, 5.0)
    assert (options["name"], options["type_name"], options["values"]) == ("/t", "T", ("{a}",))


@pytest.mark.parametrize(
    ("line", "values"),
    [
        ("{linear: {x: -1}}", {"linear": {"x": -1}}),
        ("{linear: {x: -1.0}} -1", {"linear": {"x": -1.0}}),
        ("{x: -1, y: -2} -1", {"x": -1, "y": -2}),
        ("data: -1", {"data": -1}),
        ("data: -1 -1", {"data": -1}),
        ("[-1, -2]", [-1, -2]),
        ("-1.5", -1.5),
        ("-2", -2),
        ("data: hello", {"data": "hello"}),
        ("'data: hello world'", {"data": "hello world"}),
        ("data: hello   world", {"data": "hello world"}),
        ("""'{data: "a { b"}' -1""", {"data": "a { b"}),
        ("""'{data: "a } b"}' -1""", {"data": "a } b"}),
        ("""'{data: "it\\"s {"}' -1""", {"data": 'it"s {'}),
        ("{data: don\\'t} -1", {"data": "don't"}),
        ("{data: -- }", {"data": "--"}),
        ("{data: --once}", {"data": "--once"}),
        ("{data: 12:30}", {"data": "12:30"}),
        ("", None),
        ("''", None),
        ("{}", {}),
    ],
)
def test_values_that_look_like_options(line: str, values: Any) -> None:
    """Within brackets, behind a colon, or as a number, a minus sign begins a value; quotes hide brackets."""
    options, found = published(f"/t T {line}")
    assert found == values
    assert options["once"] == line.endswith(" -1") or line == "data: -1"


def test_a_negative_number_in_a_message() -> None:
    """A message's only field may be negative, without any bracket or quote."""
    assert from_plain(Int32, published("/t std_msgs/msg/Int32 data: -1")[1]) == Int32(data=-1)
    assert from_plain(String, published("/t std_msgs/msg/String data: -r")[1]) == String(data="-r")


@pytest.mark.parametrize(
    ("line", "value"),
    [
        ("/n gain -1.0", ("-1.0",)),
        ("/n gain -1", ("-1",)),
        ("--timeout 3 /n gain -1.0", ("-1.0",)),
        ("/n gain -1.0 --timeout 3", ("-1.0",)),
        ("/n gain --timeout=3 -1.0", ("-1.0",)),
        ("/n points [-1, 2]", ("[-1,", "2]")),
        ("/n name two words", ("two", "words")),
        ("/n name -x", ("-x",)),
    ],
)
def test_the_value_of_a_parameter(line: str, value: tuple[str, ...]) -> None:
    """`param set` takes a negative number as the number it is."""
    found = parsed(set_, line.split())
    assert (found["name"], found["value"]) == ("/n", value)
    assert found["timeout"] == (3.0 if "timeout" in line else 2.0)


def test_an_unknown_option_is_left_to_click() -> None:
    """An unknown long option is left to click, which suggests the nearest."""
    with pytest.raises(click.NoSuchOption, match="--rat") as caught:
        parsed(pub, ["/t", "T", "--rat", "5"])
    assert caught.value.possibilities
    assert "--rate" in caught.value.possibilities


def test_what_is_missing_is_left_to_click() -> None:
    """Missing arguments are click's usage error."""
    with pytest.raises(click.MissingParameter):
        parsed(pub, [])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["{}", "extra"], "'extra' is one word too many: '{}' is complete"),
        (["{x:", "1}", "{y:", "2}"], "'{y:' is one word too many: '{x: 1}' is complete"),
        (["{x:", "[1"], "'{x: [1', character 7: not valid YAML"),
        (["{x:2.0}"], "'{x:2.0}': write a space after each colon and quotes around it all, for example '{x: 2.0}'"),
        (["x:2.0", "y:1"], "'x:2.0 y:1': write a space after each colon"),
        (["{a: *b}"], "*b: aliases are not used here"),
    ],
)
def test_values_that_are_no_message(words: list[str], message: str) -> None:
    """Invalid YAML or missing spaces are wrong usage, with a correction."""
    with pytest.raises(UsageFault) as caught:
        message_values(words)
    assert message in str(caught.value)


@settings(derandomize=True, max_examples=count(few=75, full=300), deadline=None)
@given(st.lists(st.sampled_from(["-1", "-r", "5", "{a:", "-2}", "[", "]", "x", "--", "--no", "--rate=3", "'", "-r5"])))
def test_no_word_is_lost(words: list[str]) -> None:
    """Splitting only reorders words; it adds only separators."""
    found = split_values(words, FLAGS, VALUED)
    assert sorted(w for w in found if w != "--") == sorted(w for w in words if w != "--")


def test_values_from_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    """Standard input replaces the words; both are an error."""
    monkeypatch.setattr(sys, "stdin", io.StringIO("a: 2\nb: 3\n"))
    assert message_values([], from_stdin=True) == {"a": 2, "b": 3}
    with pytest.raises(UsageFault, match=r"--stdin reads the values from standard input; leave out '\{a:'"):
        message_values(["{a:", "2}"], from_stdin=True)


def test_messages_in_a_file(tmp_path: Path) -> None:
    """Messages are read as printed by `topic echo`, with their lines; empty documents are skipped."""
    file = tmp_path / "said.yaml"
    file.write_text("---\ndata: a\n---\n---\n\n# a remark\ndata: |\n  one\n  --- two\n--- {data: c}\n---\n")
    found = [(2, "a"), (6, "one\n--- two\n"), (10, "c")]
    assert messages_in(file) == [(f"{file}:{line}", {"data": data}) for line, data in found]


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (None, "No such file or directory"),
        (b"\xff", "is not UTF-8 text"),
        (b"---\n# nothing\n---\n", "has no message; graphflow topic echo TOPIC > "),
        (b"data: a\n---\ndata: {\n", ":3:8: not valid YAML"),
    ],
)
def test_files_without_messages(tmp_path: Path, data: bytes | None, told: str) -> None:
    """The file is named, and the line."""
    file = tmp_path / "said.yaml"
    if data is not None:
        file.write_bytes(data)
    with pytest.raises(UsageFault) as caught:
        messages_in(file)
    assert str(caught.value).startswith(str(file))
    assert told in str(caught.value)


def test_messages_in_a_file_of_another_kind(tmp_path: Path) -> None:
    """A FIFO without a writer does not block the command."""
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(UsageFault, match="fifo: it is not a regular file"):
        messages_in(tmp_path / "fifo")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("{linear: {x:2.0}}", "{linear: {x: 2.0}}"),
        ("{linear={x: 2.0}}", "{linear: {x: 2.0}}"),
        ("{linear: {x: 2,0}}", "{linear: {x: 2.0}}"),
        ("a: 2 b: 5", "{a: 2, b: 5}"),
        ("a: 2, b: 5", "{a: 2, b: 5}"),
        ("{a: 2; b: 5}", "{a: 2, b: 5}"),
        ('"{a: 2, b: 5}"', "{a: 2, b: 5}"),
        ("linear: {x: 1.0}, angular: {z: 2.0}", "{linear: {x: 1.0}, angular: {z: 2.0}}"),
        ("linear: x: 2.0", "linear: {x: 2.0}"),
        ("{linear: {x: 2.0}", "{linear: {x: 2.0}}"),
        ("{data: 'it's me'}", "{data: 'it''s me'}"),
        ("data: 'it's me'", "data: 'it''s me'"),
        ("{p: {x: 1.0} q: {y: 2}}", "{p: {x: 1.0}, q: {y: 2}}"),
        ("{p: {x: 1.0}, {q: {y: 2}}", "{p: {x: 1.0}, q: {y: 2}}"),
        ("{p: {x: 1.0}}, q: {y: 2}", "{p: {x: 1.0}, q: {y: 2}}"),
        ("{p: {x: 1.0}}, {q: {y: 2}}", "{p: {x: 1.0}, q: {y: 2}}"),
        ("“data: hi”", "data: hi"),
        ("\u2018{data: hi}\u2019", "{data: hi}"),
        ("“data”: hi", '"data": hi'),
        ("{“data”: “hi”}", '{"data": "hi"}'),
        ("“{linear: {x: 1.0}}”", "{linear: {x: 1.0}}"),
    ],
)
def test_values_with_a_slip(text: str, meant: str) -> None:
    """Common mistakes in values are corrected."""
    with pytest.raises(UsageFault, match=re.escape(f"did you mean {meant!r}?")):
        message_values([text])


@pytest.mark.parametrize(
    "text",
    [
        "{data: a=b}",
        "{data: 'x:y'}",
        "[1,2]",
        "{at: 12:30}",
        "{data: it's me}",
        "data: 'a; b: c'",
        "{a: {b: [{c: 1}]}}",
        "1,5",
    ],
)
def test_values_without_one(text: str) -> None:
    """Correct values are not changed."""
    message_values([text])
    assert repair("{x: [}") is None


def test_an_option_with_too_few_dashes_or_words() -> None:
    """An option with a missing dash or value is an error, not a value of the message."""
    with pytest.raises(click.NoSuchOption) as caught:
        parsed(pub, ["/t", "T", "-rate", "5"])
    assert caught.value.possibilities == ["--rate"]
    with pytest.raises(click.BadOptionUsage, match="Option '-r' requires an argument"):
        parsed(pub, ["/t", "T", "--once", "-r"])


def test_quotes_that_are_sent(capsys: pytest.CaptureFixture[str]) -> None:
    """Typographic quotes around a text get a note, since they may be intended; within a text they do not."""
    assert message_values(["{p: [{data: “hi”}]}"]) == {"p": [{"data": "“hi”"}]}
    assert (
        capsys.readouterr().err == "note: the quotes around “hi” become part of the text; YAML's quotes are ' and \"\n"
    )
    message_values(["data: he said “hi” \u2013 twice"])
    assert capsys.readouterr().err == ""


def test_a_list_for_each_field() -> None:
    """One list per field, as in ROS 1, is accepted as such; the error shows ROS 2's form."""
    assert message_values(["[1.0, 2]", "[3]"]) == [[1.0, 2], [3]]


@pytest.mark.parametrize(
    ("text", "name"),
    [("{x: 2, name: }", "name"), ("name:", "name"), ("{p: {name: , x: 1}}", "name"), ("{l: [{name: }]}", "name")],
)
def test_quotes_that_the_shell_takes_away(text: str, name: str) -> None:
    """`{name: ""}` within double quotes loses its value; the error has the correction."""
    message = f"{name} has no value, since the shell removes double quotes within double quotes; write {name}: ''"
    with pytest.raises(UsageFault, match=re.escape(message)):
        message_values([text])


@pytest.mark.parametrize("text", ["{name: ''}", "{name: null}", "{x: 1}", "", "[]"])
def test_values_that_are_there(text: str) -> None:
    """An empty text is a value, and an explicit null is not reported as a lost one."""
    message_values([text])


def test_a_file_of_messages_that_is_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused before it fills the memory."""
    file = tmp_path / "said.yaml"
    file.write_text("data: a\n")
    monkeypatch.setattr(words, "_MESSAGES_BOUND", 7)
    with pytest.raises(UsageFault, match="it has more than 7 bytes"):
        messages_in(file)

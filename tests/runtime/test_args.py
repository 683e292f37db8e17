"""ROS 2's arguments of a node."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import GraphflowError, Node, Param
from graphflow.names import Remap
from graphflow.runtime.args import meant, missed, parse_ros_args


class TurtleSim(Node):
    """Something with parameters."""

    rate = Param(1.0)
    title = Param("")


def test_no_arguments() -> None:
    """Without arguments, all settings have their defaults."""
    parsed = parse_ros_args([])

    assert (parsed.remaps, parsed.params, parsed.log_level, parsed.rest) == ([], [], "info", [])


def test_everything_together() -> None:
    """Rules, parameters and the level between --ros-args and --, and the rest left for the program."""
    parsed = parse_ros_args(
        [
            *["one", "--ros-args", "-r", "a:=b", "--remap", "__ns:=/robot", "-p", "rate:=2.0"],
            *["--param", "n:title:=x", "--log-level", "debug", "--", "two", "--x"],
        ]
    )

    assert [str(r) for r in parsed.remaps] == ["a:=b", "__ns:=/robot"]
    assert parsed.params == [(None, "rate", 2.0, "command line"), ("n", "title", "x", "command line")]
    assert parsed.log_level == "debug"
    assert parsed.rest == ["one", "two", "--x"]


def test_ros_args_may_come_twice() -> None:
    """As in ROS 2, each `--ros-args` runs to its `--` or to the end."""
    parsed = parse_ros_args(["--ros-args", "-r", "a:=b", "--", "x", "--ros-args", "-r", "c:=d"])

    assert [str(r) for r in parsed.remaps] == ["a:=b", "c:=d"]
    assert parsed.rest == ["x"]


def test_a_bare_rule_is_a_remap() -> None:
    """ROS 2 would silently ignore it."""
    assert parse_ros_args(["chatter:=news"]).remaps == [Remap.parse("chatter:=news", "command line")]
    assert parse_ros_args(["-r", "chatter:=news"]).remaps == parse_ros_args(["chatter:=news"]).remaps


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2", 2),
        ("2.5", 2.5),
        ("true", True),
        ("text", "text"),
        ("'2'", "2"),
        ("[1, 2]", [1, 2]),
        ("[a, b]", ["a", "b"]),
    ],
)
def test_parameter_values_are_yaml(text: str, value: Any) -> None:
    """A value is read as in a graph file."""
    [(_, _, parsed, _)] = parse_ros_args(["-p", f"x:={text}"]).params

    assert parsed == value
    assert type(parsed) is type(value)


def test_values_for_one_node() -> None:
    """A parameter may name its node, by the class's name or the remapped one; the last value counts."""
    parsed = parse_ros_args(
        [
            *["-p", "rate:=1.0", "-p", "turtle_sim:rate:=2.0", "-p", "other:rate:=3.0"],
            *["-p", "sim2:title:=two", "-r", "__node:=sim2"],
        ]
    )

    assert parsed.params_for(TurtleSim.interface()) == {"rate": (2.0, "command line"), "title": ("two", "command line")}
    assert TurtleSim(remap=parsed.remaps, overrides=parsed.params_for(TurtleSim.interface())).full_name == "/sim2"


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["-p"], "-p needs a value after it"),
        (["-r"], "-r needs a value after it"),
        (["--log-level"], "--log-level needs a value after it"),
        (["-p", "rate=2"], "-p 'rate=2': write rate:=2"),
        (["-p", "rate: 2.5"], "-p 'rate: 2.5': write rate:=2.5"),
        (["-p", "rate"], "-p 'rate': write name:=value, for example rate:=2.0"),
        (["-p", ":=2"], "-p ':=2': write name:=value"),
        (["--params-file", "-r", "a:=b"], "--params-file needs a value after it, such as params.yaml"),
        (["-p", "x:=", "100"], "-p 'x:=': the value is missing; write it after :=, without a space"),
        (["-p", "a:=[1,", "2]"], "-p 'a:=[1,': the bracket is not closed; put quotes around a rule with blanks in it"),
        (["-p", "a:={b: [1]"], "-p 'a:={b: [1]': the bracket is not closed; put quotes around a rule"),
        (["-p", "a:=*b"], "aliases are not used here"),
        (["-p", "a:=1 b:=2"], "-p 'a:=1 b:=2': write one -p each: -p a:=1 -p b:=2"),
        (["-r", "nothing"], "'nothing' is not a remap rule; write it as from:=to"),
        (["-r", "__nod:=x"], "'__nod' is not a remap key; did you mean '__node:=x'?"),
        (["-r", "__node=x"], "'__node=x' is not a remap rule; write it as from:=to: __node:=x"),
        (
            ["--ros-args", "-r", "__node:=my", "turtle"],
            "'turtle' is not a ROS argument; quote a value that contains a space",
        ),
        (["--ros-args", "-p", "a:=b", "c"], "contains a space: -p 'a:=b c'"),
        (["--ros-args", "-p", "a:=b", "-1"], "contains a space: -p 'a:=b -1'"),
        (["--ros-args", "-r", "__node:=bob", "--params", "a:=2"], "'--params' is not a ROS argument; write -p a:=2"),
        (["--ros-args", "--parameters", "a.yaml"], "'--parameters' is not a ROS argument; write --params-file a.yaml"),
        (["--ros-args", "-r", "a:=b", "--params", "-r"], "not a ROS argument; did you mean '--param'?"),
        (["--ros-args", "—p", "a:=1"], "'—p' is not a ROS argument; write -p"),
        (["\u2013r", "a:=b"], "'\u2013r' is not a ROS argument; write -r"),
        (["--ros-args", "--remp", "a:=b"], "'--remp' is not a ROS argument; did you mean '--remap'?"),
    ],
)
def test_what_is_wrong_is_said(words: list[str], text: str) -> None:
    """A mistake is an error that shows how it is written."""
    with pytest.raises(GraphflowError) as caught:
        parse_ros_args(words)
    assert text in str(caught.value)


@pytest.mark.parametrize("word", ["-params-file", "-ros-args", "\N{EN DASH}ros-args"])
def test_a_dash_too_few(word: str) -> None:
    """An option of ROS's with other dashes, as slides have it, is refused as ROS 2 refuses it, wherever it stands."""
    for words in ([word, "a.yaml"], ["--ros-args", word, "a.yaml"]):
        with pytest.raises(GraphflowError, match=f"is not a ROS argument; write --{word[1:]}$"):
            parse_ros_args(words)
    assert meant("--rosargs") == meant("--ros_args") == "; write --ros-args"
    assert parse_ros_args(["ros-args", "--rate"]).rest == ["ros-args", "--rate"]


def test_a_bare_rule_where_ros_knows_none() -> None:
    """It is unknown, as in ROS 2, if unknown arguments are allowed."""
    parsed = parse_ros_args(["--ros-args", "a:=b", "-r", "c:=d"], refuses_unknown=False)
    assert (parsed.unknown, [str(rule) for rule in parsed.remaps]) == (["a:=b"], ["c:=d"])


@pytest.mark.parametrize(
    ("line", "text"),
    [
        (
            "- -ros-args -p a:=1",
            "'-ros-args' means nothing to ROS, nor does the rest (-p a:=1); write --ros-args",
        ),
        ("___ns:=/a", "'___ns:=/a' means nothing to ROS before --ros-args; write --ros-args -r __ns:=/a"),
        ("-p a:=1", "'a:=1' means nothing to ROS before --ros-args; write --ros-args -p a:=1"),
        ("a:=b --ros-args", "'a:=b' means nothing to ROS before --ros-args; write --ros-args -r a:=b"),
        ("--ros-args -p a:=1 -- b:=c", "'b:=c' means nothing to ROS before --ros-args; write --ros-args -r b:=c"),
        (
            "-params-file x.yaml",
            "'-params-file' means nothing to ROS, nor does the rest (x.yaml); write --ros-args --params-file",
        ),
        ("--ros-args -p a:=1 -r b:=c", ""),
        (
            "--params-file x.yaml",
            "'--params-file' means nothing to ROS before --ros-args; write --ros-args --params-file x.yaml",
        ),
        ("-r a=/b", "if 'a=/b' is for ROS, write --ros-args -r a:=/b"),
        ("--param rate=2 -- -r", "if 'rate=2' is for ROS, write --ros-args --param rate:=2"),
        ("-p 8080 -r --params-file x.json --log-level debug", ""),
    ],
)
def test_words_that_miss_ros(line: str, text: str) -> None:
    """Arguments that are unlikely to be a program's own get a hint."""
    assert missed(line.split()) == text


def test_how_an_unknown_word_is_written() -> None:
    """A rule with its option, an option with its dashes, and the nearest of all."""
    assert meant("___node:=a") == "; write --ros-args -r __node:=a"
    assert meant("--log-level=DEBUG") == "; write --log-level DEBUG, without ="
    assert meant("-params-file") == "; write --params-file"
    assert meant("--remp") == "; did you mean '--remap'?"
    assert meant("what") == ""
    assert meant("gain:=2.0") == "; write --ros-args -p gain:=2.0"
    assert meant("a:=b") == "; write --ros-args -r a:=b"
    assert meant("_frame:=map") == "; write --ros-args -p frame:=map"
    assert meant("_rate:=2.0") == "; write --ros-args -p rate:=2.0"
    apart = "['--ros-args', '-p', 'speed:=1.0']"
    assert missed(["--ros-args -p speed:=1.0"]).endswith(f"is one word to ROS; write each apart: {apart}")
    assert missed(["-r", "___ns:=/a"]).endswith("; write --ros-args -r __ns:=/a")


def test_logs() -> None:
    """Levels of single loggers, and destinations of logs; options without meaning are reported."""
    words = ["--ros-args", "--log-level", "talker:=warn", "--log-level", "debug", "--disable-rosout-logs"]
    parsed = parse_ros_args([*words, "--disable-stdout-logs", "--enable-stdout-logs", "--disable-external-lib-logs"])
    assert (parsed.log_level, parsed.log_levels) == ("debug", {"talker": "warn"})
    assert (parsed.has_rosout, parsed.has_stdout) == (False, True)
    assert parse_ros_args(["--disable-stdout-logs"]).rest == ["--disable-stdout-logs"]


@pytest.mark.parametrize("option", ["--log-config-file", "--log-file-name", "-e", "--enclave"])
def test_what_means_nothing_here(option: str, caplog: pytest.LogCaptureFixture) -> None:
    """It is consumed with its value, and reported."""
    parsed = parse_ros_args(["--ros-args", option, "x", "-r", "a:=b"])
    assert [str(r) for r in parsed.remaps] == ["a:=b"]
    assert f"{option} means nothing to graphflow" in caplog.text
    with pytest.raises(GraphflowError, match="needs a value"):
        parse_ros_args(["--ros-args", option])

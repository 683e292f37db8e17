"""The command as a whole: its verbs, its help, its exit codes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import click
import pytest

import graphflow
from graphflow import errors
from graphflow.cli import exits, main
from graphflow.cli.main import cli
from graphflow.supervisor.starts import Announcement
from graphflow.transport.rendezvous import free_endpoint
from tests.cases import slow

VERBS: tuple[str, ...] = ("init", "up", "down", "attach", "ls", "ps", "start", "restart", "stop", "status", "wait")
VERBS += ("logs", "plan", "check", "explain", "schema", "launch", "run", "rclpy", "ws")
VERBS += (
    "demo",
    "graph",
    "snapshot",
    "view",
    "top",
    "router",
    "node",
    "topic",
    "service",
    "action",
    "param",
    "bag",
    "pkg",
    "component",
    "lifecycle",
    "tf",
    "map",
    "waits",
    "groups",
    "doctor",
    "console",
)
VERBS += ("completion", "interface")


@pytest.fixture(autouse=True)
def no_graph_anywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An environment in which nothing runs, and that is as it was afterwards."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "run"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.delenv("ROS_LOG_DIR", raising=False)
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "77")


def ends(*words: str) -> int:
    with pytest.raises(SystemExit) as end:
        main.main(words)
    assert isinstance(end.value.code, int)
    return end.value.code


def test_help_lists_every_verb(capsys: pytest.CaptureFixture[str]) -> None:
    """All verbs with a line each, the first steps on lines of their own, and no control characters."""
    assert ends("--help") == exits.OK
    text = capsys.readouterr().out
    listed = [line.split()[0] for line in text.partition("Commands:\n")[2].splitlines()]
    assert tuple(listed) == VERBS
    assert "\n  Start with:   graphflow up turtlesim\n" in text
    assert "\\b" not in text
    assert "\b" not in text


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_is_there(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A verb's module has it, its help works with -h, too, and begins with the line of the overview."""
    command = cli.get_command(click.Context(cli), verb)
    assert command is not None
    assert command.name == verb
    assert ends(verb, "-h") == exits.OK
    assert main._VERBS[verb][1].rstrip(".") in " ".join(capsys.readouterr().out.split())


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    """`--version` prints the package's version."""
    assert ends("--version") == exits.OK
    assert capsys.readouterr().out == f"graphflow, version {graphflow.__version__}\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["topik"], "no such command 'topik'; did you mean 'topic'?"),
        (["launch", "x.xml"], "error: x.xml: there is no such file"),
        (["lanch"], "no such command 'lanch'; did you mean 'launch'?"),
        (["kill"], "no such command 'kill'; did you mean 'stop'?"),
        (["zzz"], "no such command 'zzz'; graphflow --help lists all"),
        (["list", "node", "-a"], "no such command 'list'; did you mean: graphflow node list -a"),
        (["node", "kill", "/talker"], "to control nodes: graphflow stop /talker"),
        (["param", "dump", "/talker", "out.yaml"], "to write a file: graphflow param dump /talker > out.yaml"),
        (["topic", "echo", "-n", "1", "/chatter", "std_msgs/String"], "to end after the first message: --once"),
        (["rostopic", "echo", "/chatter"], "no such command 'rostopic'; did you mean: graphflow topic echo /chatter"),
        (["msg", "show", "std_msgs/String"], "did you mean: graphflow interface show std_msgs/msg/String"),
        (["roscore"], "no such command 'roscore': none is needed: nodes find each other"),
        (["ros2", "topic", "list"], "leave out ros2: graphflow topic list"),
        (["turtlesim", "turtlesim_node"], "did you mean: graphflow run turtlesim turtlesim_node"),
        (["tf2_echo", "base", "laser"], "did you mean: graphflow run tf2_ros tf2_echo base laser"),
        (["topic", "list", "--domain", "7"], "--domain goes before the verb: graphflow --domain 7 topic list"),
        (["topic", "lst"], "no such command 'lst'; did you mean 'list'?"),
        (["topic", "list", "--type"], "--show-types"),
        (["service", "call", "/x", "--once"], "No such option '--once'.\n"),
        (["--domain", "abc", "ps"], "Invalid value for '--domain': 'abc' is not a whole number.\n"),
        (["bag", "play", "x", "-r", "fast"], "Invalid value for '-r' / '--rate': 'fast' is not a number.\n"),
        (["topic", "pub"], "Missing argument 'TOPIC'"),
        (["topic", "pub", "/x"], "the topic's type comes before the values: graphflow topic pub /x TYPE ..."),
        (["topic", "pub", "-r", "0", "/x", "std_msgs/msg/String"], "Invalid value for '-r' / '--rate'"),
        (
            ["topic", "pub", "-r", "10hz", "/x", "std_msgs/msg/String"],
            "'-r' / '--rate': '10hz' is not a number; write 10",
        ),
        (["service", "call", "-r", "1,5", "/x", "std_srvs/srv/Empty"], "'1,5' is not a number; write 1.5"),
        (["bag", "record", "/x", "--duration", "500ms"], "500ms' is not a number; write 0.5, as it is in seconds"),
        (["topic", "hz", "-w", "many", "/x"], "'many' is not a whole number"),
        (["node", "-list"], "no such option '-list'; did you mean 'list'?"),
        (["topic", "--lst"], "no such option '--lst'; did you mean 'list'?"),
        (["node", "-x"], "No such option"),
        (["--domain", "-1", "ps"], "Invalid value for '--domain'"),
        (["check"], "Missing argument 'GRAPH.yaml|FILE.py|FOLDER'"),
        (["check", "nothing.yaml"], "error: nothing.yaml: there is no such file"),
        (["check", "turtlesm"], "error: turtlesm: there is no such file; did you mean 'turtlesim'?"),
        (["run", "nodes.talker.Talker"], "error: 'nodes.talker.Talker': write MODULE:CLASS, nodes.talker:Talker"),
        (
            ["topic", "list", "—verbose"],
            "error: '—verbose' begins with a typographic dash, not a hyphen; write --verbose",
        ),
        (
            ["topic", "pub", "/x", "std_msgs/String", "data: a", "\u2013-once"],
            "'\u2013-once' begins with a typographic dash, not a hyphen; write --once",
        ),
        (["—help"], "write --help"),
        (["topic", "info", "a b"], "error: 'a b' is not a topic or service name"),
    ],
)
def test_wrong_usage(words: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    """For misspelt words the nearest is suggested on stderr, with exit code 2."""
    assert ends(*words) == exits.USAGE
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err


def test_a_package_without_its_verb(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The forgotten `run` is told where the workspace has the executable."""
    folder = tmp_path / "src" / "lamp"
    (folder / "lamp").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>lamp</name></package>")
    (folder / "setup.py").write_text("setup(name='lamp', entry_points={'console_scripts': ['on = lamp.node:main']})")
    monkeypatch.chdir(tmp_path)
    assert ends("lamp", "on") == exits.USAGE
    assert "did you mean: graphflow run lamp on" in capsys.readouterr().err
    assert ends("lamp", "off") == exits.USAGE
    assert "graphflow run" not in capsys.readouterr().err


def test_no_verb_is_help_and_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    """`graphflow` alone shows what there is, and is not a success."""
    assert ends() == exits.USAGE
    assert "Commands:" in capsys.readouterr().err


def test_the_domain_goes_to_every_verb(monkeypatch: pytest.MonkeyPatch) -> None:
    """`--domain` comes before the environment's."""
    monkeypatch.setattr(cli, "get_command", lambda *_: click.Command("ps", callback=lambda: None))
    assert ends("--domain", "12", "ps") == exits.OK
    assert os.environ["GRAPHFLOW_DOMAIN"] == "12"


@pytest.mark.parametrize(
    ("outcome", "code", "text"),
    [
        (None, exits.OK, ""),
        (4, exits.TIMEOUT, ""),
        (errors.SupervisorError("nobody is there", 3), exits.NOT_RUNNING, "error: nobody is there\n"),
        (errors.CallTimeout("too late"), exits.TIMEOUT, "error: too late\n"),
        (errors.ServerLost("gone"), exits.FAILED, "error: gone\n"),
        (errors.UnknownInterface("no such type"), exits.USAGE, "error: no such type\n"),
        (click.UsageError("wrong"), exits.USAGE, "Error: wrong\n"),
        (click.ClickException("failed"), exits.FAILED, "Error: failed\n"),
        (KeyboardInterrupt(), exits.OK, ""),
        (click.Abort(), exits.OK, ""),
    ],
)
def test_how_a_command_ends(
    outcome: int | BaseException | None,
    code: int,
    text: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A verb's result is the exit code; an error of ours is one line on stderr; Ctrl-C is not a failure."""

    def run() -> int | None:
        if isinstance(outcome, BaseException):
            raise outcome
        return outcome

    monkeypatch.setattr(cli, "get_command", lambda *_: click.Command("ps", callback=run))
    assert ends("ps") == code
    err = capsys.readouterr().err
    assert err.endswith(text)
    assert "Traceback" not in err


def test_a_graph_that_is_being_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every verb that finds no graph mentions one that is being started, once."""
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", free_endpoint())
    announced = Announcement()
    announced.begin(tmp_path / "chase.yaml")
    about = f"being started: {tmp_path}/chase.yaml (process {os.getpid()}); wait for it with: graphflow wait\n"
    for words in (["ps"], ["ls"], ["logs"], ["topic", "list"]):
        assert ends(*words) == exits.NOT_RUNNING
        assert capsys.readouterr().err.count(about) == 1
    assert ends("wait", "--timeout", "0") == exits.TIMEOUT
    assert about in capsys.readouterr().err
    announced.end()
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/proc")
    assert ends("topic", "list") == exits.NOT_RUNNING
    assert "being started" not in capsys.readouterr().err


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("streams", "code", "told"),
    [
        (">&-", 1, "error: standard output is closed; to discard the output: > /dev/null\n"),
        ("2>&-", 0, ""),
        ("<&-", 0, ""),
    ],
)
def test_a_standard_stream_that_is_closed(streams: str, code: int, told: str) -> None:
    """A command's result must be readable; other streams may be closed."""
    command = f"{sys.executable} -m graphflow schema {streams}"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=30)
    assert (done.returncode, done.stderr) == (code, told)


def test_an_error_that_is_not_ours_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bug shows as the traceback it is."""

    def run() -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(cli, "get_command", lambda *_: click.Command("ps", callback=run))
    with pytest.raises(ZeroDivisionError):
        main.main(["ps"])

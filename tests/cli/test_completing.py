"""TAB completion of verbs, live names, types and messages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

from graphflow.cli.completing import choices
from tests.conftest import Machine

TWIST = "{linear: {x: 0.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 0.0}}"


@pytest.mark.parametrize(
    ("words", "partial", "found"),
    [
        ("", "top", ["top", "topic"]),
        ("topic", "e", ["echo"]),
        ("topic", "x", []),
        ("nothing", "", []),
        ("--domain 5 topic", "ec", ["echo"]),
        ("completion", "", ["install", "show"]),
        ("topic echo", "--on", ["--once"]),
        ("topic pub /a", "geometry_msgs/msg/TwistS", []),
        ("interface show", "geometry_msgs/msg/TwistS", ["geometry_msgs/msg/TwistStamped"]),
        ("topic pub /a geometry_msgs/msg/Twist", "'", [f"'{TWIST}'"]),
        ("topic pub -r 10 /a geometry_msgs/msg/Twist", '"', [f'"{TWIST}"']),
        ("service call /s turtlesim/srv/SetPen", "", ["'{r: 0, g: 0, b: 0, width: 0, off: 0}'"]),
        ("topic pub /a no_such/msg/Type", "'", []),
        ("topic pub /a no_such", "", []),
        ("topic echo --timeout", "", []),
        ("bag info", "", []),
        ("run", "turtles", ["turtlesim"]),
        ("run", "talk", ["talker"]),
        ("pkg executables", "talk", []),
        ("up", "turtlesi", ["turtlesim"]),
        ("up -d", "graphs/turtles", ["graphs/turtlesim.yaml"]),
        ("check", "graphs/deadl", ["graphs/deadlock/"]),
        ("up turtlesim", "turtlesi", []),
        ("launch", "con", ["convert"]),
        ("launch", "turtle_", ["turtle_tf2_py"]),
        ("launch turtle_tf2_py", "turtle_tf2_demo", ["turtle_tf2_demo.launch.py"]),
        ("launch turtle_tf2_py turtle_tf2_demo.launch.py", "turtle", []),
        ("launch no_such_package", "", []),
        ("run turtlesim", "turtle_", ["turtle_teleop_key"]),
        ("pkg executables", "demo_nodes_p", ["demo_nodes_py"]),
    ],
)
def test_without_a_graph(machine: Machine, words: str, partial: str, found: list[str]) -> None:
    """Verbs, options, types that are installed and messages; nothing that needs a graph, and no error."""
    with patch.dict(os.environ, machine.env):
        assert choices(words.split(), partial) == found


def test_files_that_a_shell_might_obey(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Are not offered; others are, and folders that may have some."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "zoo").mkdir()
    for name in ("zebra.yaml", "zebra.txt", "z$(id).yaml"):
        (tmp_path / name).touch()
    assert choices(["up"], "z") == ["zebra.yaml", "zoo/"]
    assert choices(["up", "zebra.yaml"], "z") == []


@pytest.fixture
def there(standing: Machine) -> Iterator[None]:
    """Completions come from the standing graph."""
    with patch.dict(os.environ, standing.env):
        yield


@pytest.mark.real
@pytest.mark.usefixtures("there")
@pytest.mark.parametrize(
    ("words", "partial", "found"),
    [
        ("topic echo", "/ch", ["/chatter"]),
        ("topic hz /chatter", "/off", ["/office/minutes"]),
        ("topic echo", "/office/_", []),
        ("topic pub /chatter", "", ["std_msgs/msg/String"]),
        ("node info", "/office/c", ["/office/clerk"]),
        ("service call", "/office/clerk/a", ["/office/clerk/add"]),
        ("service call /office/clerk/add", "", ["example_interfaces/srv/AddTwoInts"]),
        ("action send_goal", "/fib", ["/fibonacci"]),
        ("param get /office/clerk", "use_sim", ["use_sim_time"]),
        ("param get /nobody", "", []),
        ("bag record --topics", "/ch", ["/chatter"]),
    ],
)
def test_live_names(words: str, partial: str, found: list[str]) -> None:
    """Of what runs, each where it belongs; hidden ones are not offered."""
    assert choices(words.split(), partial) == found


def test_types_of_a_project(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A project's types are among the completions."""
    folder = tmp_path / "interfaces" / "completed_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Thing.msg").write_text("int32 x\n")
    (tmp_path / "pyproject.toml").touch()
    monkeypatch.chdir(tmp_path)
    with patch.dict(os.environ, machine.env):
        assert choices(["interface", "show"], "completed") == ["completed_msgs/msg/Thing"]


def test_what_a_shell_might_obey_is_not_offered(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names come from other processes."""
    names = ["/fine", "$(touch x)", "a;b", "a b", "`x`", "'q", "line\nline", "/~/x-1.y_2"]
    monkeypatch.setattr("graphflow.introspect.graph_view.View.__init__", lambda self, domain: None)
    monkeypatch.setattr("graphflow.introspect.graph_view.View.__exit__", lambda *_: None)
    monkeypatch.setattr("graphflow.introspect.graph_view.View.cache", None, raising=False)
    monkeypatch.setattr("graphflow.introspect.completions.names_for", lambda *_: names)
    with patch.dict(os.environ, machine.env):
        assert choices(["topic", "echo"], "") == ["/fine", "/~/x-1.y_2"]
        assert choices(["topic", "echo"], "'") == []

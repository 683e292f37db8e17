"""`graphflow plan` and `graphflow check`."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from graphflow.cli.graphs.files import find_graph
from graphflow.errors import UsageFault
from tests.cases import slow
from tests.conftest import PROJECT, Machine

GRAPH = "nodes:\n  /talker: {class: nodes.talker:Talker, params: {rate: 5.0}, remap: {chatter: said}}\n"


def test_a_path_is_a_graph(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A path is used without a note."""
    file = tmp_path / "g.yaml"
    file.write_text(GRAPH)
    assert find_graph(str(file)) == file
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["turtlesim", "turtlesim.yaml", "deadlock/crossing_broken"])
def test_a_name_is_a_bundled_graph(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A bundled graph is found from anywhere, with or without its suffix, and its origin is printed."""
    monkeypatch.chdir(tmp_path)
    found = find_graph(name)
    assert found == PROJECT / "graphs" / f"{name.removesuffix('.yaml')}.yaml"
    assert capsys.readouterr().err == f"{name}: using the one that comes with graphflow, {found}\n"


def test_a_file_comes_before_a_bundled_graph(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file takes precedence over a bundled graph of the same name."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "turtlesim").write_text(GRAPH)
    assert find_graph("turtlesim") == Path("turtlesim")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("labb.yaml", "labb.yaml: there is no such file; did you mean 'lab.yaml'"),
        ("lba", "lba: there is no such file; did you mean 'lab.yaml'"),
        ("ohter", "ohter: there is no such file; did you mean 'graphs/other.yaml'"),
        ("graphs/ohter.yaml", "graphs/ohter.yaml: there is no such file; did you mean 'graphs/other.yaml'"),
        ("graphs", "graphs: is a folder; name one of its files: graphs/other.yaml"),
        ("talker", "'talker' is a node, not a graph: graphflow run talker"),
        ("lamp.launch.py", "lamp.launch.py: there is no such file; to start it: graphflow launch lamp lamp.launch.py"),
        ("lamp", "lamp is a package, not a graph file; to start it: graphflow launch lamp lamp.launch.py"),
        (
            "nodes.lamp:Lamp",
            "nodes.lamp:Lamp is a node's class, not a graph file; run it with: graphflow run nodes.lamp:La",
        ),
        ("src/lmp.py", "src/lmp.py: there is no such file; did you mean 'src/lamp.py'?"),
        ("pipe.yaml", "pipe.yaml: it is not a regular file"),
        ("turtlesm", "turtlesm: there is no such file; did you mean 'turtlesim'"),
    ],
)
def test_neither(text: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error suggests the nearest graph: in the same folder, in `graphs/`, or bundled."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "graphs").mkdir()
    (tmp_path / "src" / "lamp" / "launch").mkdir(parents=True)
    (tmp_path / "src" / "lamp" / "package.xml").write_text("<package><name>lamp</name></package>")
    (tmp_path / "src" / "lamp" / "launch" / "lamp.launch.py").touch()
    (tmp_path / "src" / "lamp.py").touch()
    os.mkfifo(tmp_path / "pipe.yaml")
    for name in ("lab.yaml", "graphs/other.yaml"):
        (tmp_path / name).write_text(GRAPH)
    with pytest.raises(UsageFault) as caught:
        find_graph(text)
    assert str(caught.value).startswith(told)


@pytest.fixture
def here(machine: Machine, tmp_path: Path) -> Machine:
    """A machine with a graph file in `tmp_path`."""
    (tmp_path / "g.yaml").write_text(GRAPH)
    return machine


def test_plan(here: Machine, tmp_path: Path) -> None:
    """`plan` prints what would run, with the place of each setting, as text and as JSON."""
    lines = here.look("plan", "g.yaml", cwd=tmp_path).splitlines()
    assert lines[0].startswith("graph g  (g.yaml; classes from ")
    assert [line for line in lines if line.startswith("/")] == ["/talker"]
    assert "  param    rate = 5.0  # g.yaml:2:56" in lines
    assert "  remap    chatter -> said  # g.yaml:2:70" in lines
    found = json.loads(here.look("plan", "g.yaml", "--json", cwd=tmp_path))
    assert [node["class_path"] for node in found["nodes"]] == ["nodes.talker:Talker"]


def test_plan_of_a_wrong_file(here: Machine, tmp_path: Path) -> None:
    """The mistake has its place, and the exit code is 2."""
    (tmp_path / "g.yaml").write_text("nods: {}\n")
    assert "g.yaml:1:1: " in here.look("plan", "g.yaml", cwd=tmp_path, code=2)


@pytest.mark.real
@pytest.mark.parametrize(
    ("text", "code", "told"),
    [
        (GRAPH, 0, ["g.yaml: 1 node, 0 steps, no problems"]),
        (GRAPH.replace("rate", "rtae"), 2, ["g.yaml:2:56: ", "did you mean 'rate'", "1 problem"]),
        (GRAPH.replace("rate", "rtae").replace("chatter", "chater"), 2, ["'rate'", "'chatter'", "2 problems"]),
        ("nodes: {/a: {class: }}\n", 2, ["g.yaml:1:", "1 problem"]),
    ],
)
def test_check(here: Machine, tmp_path: Path, text: str, code: int, told: list[str]) -> None:
    """`check` reports all mistakes with places and suggestions, their number, and exit code 2."""
    (tmp_path / "g.yaml").write_text(text)
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "talker.py").write_text((PROJECT / "nodes" / "talker.py").read_text())
    found = here.look("check", "g.yaml", cwd=tmp_path, code=code)
    for words in told:
        assert words in found


@pytest.mark.real
def test_check_of_a_certain_deadlock(machine: Machine) -> None:
    """There is no problem with the file, and the exit code is 1; its fixed twin has neither."""
    text = machine.look("check", "deadlock/self_call_broken", code=1)
    assert "self_call.py:18: CERTAIN: timer tick of /narcissus awaits /narcissus/add" in text
    assert "1 node, 0 steps, 1 deadlock" in text
    assert "CERTAIN" not in machine.look("check", "deadlock/self_call_fixed")


GRAPHS = "graphs/draw_circle.yaml", "graphs/turtlesim.yaml"


def test_two_plans(machine: Machine) -> None:
    """`--diff` shows differences between two files, or between arguments of one file."""
    text = machine.look("plan", GRAPHS[0], "--diff", GRAPHS[1])
    assert text.startswith(f"--- {GRAPHS[0]}\n+++ {GRAPHS[1]}\n")
    assert "-/draw_circle" in text
    assert "# graphs" not in text
    assert machine.look("plan", GRAPHS[0], "--diff", GRAPHS[0]) == ""


@slow
def test_checks_for_programs(machine: Machine, tmp_path: Path) -> None:
    """Problems and deadlocks with their places; the exit code is the same."""
    nothing: dict[str, list[str]] = {"problems": [], "remarks": [], "deadlocks": [], "unread": []}
    assert json.loads(machine.look("check", "--json", GRAPHS[0])) == nothing
    wrong = tmp_path / "g.yaml"
    wrong.write_text("nodes: {a: {clas: x:Y}}\n")
    (problem,) = json.loads(machine.look("check", "--json", str(wrong), code=2))["problems"]
    assert problem["message"] == "unknown key 'clas'; did you mean 'class'?"
    assert (problem["line"], problem["column"]) == (1, 13)


@slow
def test_names_explained(machine: Machine) -> None:
    """`explain` takes one name or none, for all; an unknown name is an error with the nearest."""
    text = machine.look("explain", GRAPHS[0], "turtle1/cmd_vel")
    assert text.startswith("/turtle1/cmd_vel\n")
    assert "/draw_circle publishes it as 'turtle1/cmd_vel'" in text
    everything = json.loads(machine.look("explain", GRAPHS[0], "--json", "linear:=1.0"))
    assert {"/turtlesim", "/draw_circle", "/turtle1/cmd_vel", "/spawn"} <= everything.keys()
    assert "did you mean '/spawn'?" in machine.look("explain", GRAPHS[0], "/spwan", code=2)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("/chatter", "GRAPH.yaml /chatter; for a running graph: graphflow node info /chatter or topic info /chatter"),
        ("/chatter lab.yaml", "lab.yaml /chatter"),
        ("chatter lab.yaml", "lab.yaml chatter"),
    ],
)
def test_a_name_without_its_graph(here: Machine, tmp_path: Path, words: str, told: str) -> None:
    """The error has the right order, and the verbs for a running graph."""
    (tmp_path / "lab.yaml").write_text(GRAPH)
    said = here.look("explain", *words.split(), cwd=tmp_path, code=2)
    assert said == f"error: the graph file comes first: graphflow explain {told}\n"


def test_the_schema(machine: Machine) -> None:
    """`schema` prints one JSON document."""
    assert json.loads(machine.look("schema"))["title"] == "A graph file of graphflow"


@slow
def test_a_remap_the_wrong_way_round(machine: Machine, tmp_path: Path) -> None:
    """The suggestion has both names in their order."""
    file = tmp_path / "g.yaml"
    file.write_text("nodes: {/talker: {class: nodes.talker:Talker, remap: {/words: chatter}}}\n")
    text = machine.look("check", str(file), code=2)
    assert "no topic or service '/words'; it is the other way round, from the node's name: chatter: /words" in text


@slow
def test_a_wildcard_that_matches_nothing(machine: Machine, tmp_path: Path) -> None:
    """A wildcard rule that matches nothing is a mistake, as any remap rule; one that matches is not."""
    file = tmp_path / "g.yaml"
    text = "nodes: {/a: {class: nodes.listener:Listener, remap: {'/WHERE/*': '/b/\\1'}}}\n"
    file.write_text(text.replace("WHERE", "elsewhere"))
    assert "has no topic or service '/elsewhere/*'" in machine.look("check", str(file), code=2)
    file.write_text(text.replace("/WHERE", ""))
    machine.look("check", str(file))


def test_the_source_of_rclpy_nodes_is_checked(machine: Machine, tmp_path: Path) -> None:
    """A file, or all files below a folder, are read without being imported."""
    text = (
        "from rclpy.node import Node\nclass A(Node):\n    def __init__(self):\n"
        "        self.c = self.create_client(T, 'x')\n        self.c.call(1)\n"
    )
    (tmp_path / "own").mkdir()
    (tmp_path / "own/a.py").write_text(text)
    said = machine.look("check", "own/a.py", cwd=tmp_path, code=1)
    assert "own/a.py:5: CERTAIN: __init__ waits in self.c.call, and nobody spins" in said
    assert said.endswith("own/a.py: 1 deadlock in the source\n")
    [way] = json.loads(machine.look("check", "own", "--json", cwd=tmp_path, code=1))["deadlocks"]
    assert way["line"] == 5
    (tmp_path / "fine.py").write_text("import rclpy\n")
    both = machine.look("check", "fine.py", "own/a.py", cwd=tmp_path, code=1)
    assert both.endswith("2 paths: 1 deadlock in the source\n")
    (tmp_path / "own/a.py").write_text("import rclpy\n")
    assert "no deadlocks visible" in machine.look("check", "own", cwd=tmp_path)
    polls = "    def tick(self):\n        while not self.there: time.sleep(0.1)\n"
    timer = "        self.t = self.create_timer(1.0, self.tick)\n"
    (tmp_path / "own/a.py").write_text(text.replace("        self.c.call(1)\n", timer + polls))
    said = machine.look("check", "own", cwd=tmp_path)
    assert "own/a.py:7: not analysed: the source does not show what ends this loop" in said
    assert said.endswith("own: no deadlocks visible in the source, 1 loop not analysed\n")
    [place] = json.loads(machine.look("check", "own", "--json", cwd=tmp_path))["unfollowed"]
    assert place["line"] == 7
    assert "there is no file none.py" in machine.look("check", "none.py", cwd=tmp_path, code=2)


@slow
def test_a_folder_of_a_graphs_name(machine: Machine, tmp_path: Path) -> None:
    """The graph is checked, and the folder with a slash."""
    for folder in ("graphs", "own"):
        (tmp_path / folder).mkdir()
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "graphs/own.yaml").write_text("nodes: {/a: {pkg: turtlesim, exec: turtlesim_node}}\n")
    (tmp_path / "own/a.py").write_text("import rclpy\n")
    said = machine.look("check", "own", cwd=tmp_path)
    assert "to check the nodes of the folder: graphflow check ./own\n" in said
    assert "graphs/own.yaml: 1 node, 0 steps, no problems" in said
    for path in ("./own", "own/"):
        assert "no deadlocks visible" in machine.look("check", path, cwd=tmp_path)


@pytest.mark.parametrize("text", ["own.robot", "own.robot:Robot", "own/robot.py:Robot"])
def test_source_is_checked_by_its_file(machine: Machine, tmp_path: Path, text: str) -> None:
    """A module or a class is answered with the file that it is in."""
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "robot.py").touch()
    told = machine.look("check", text, cwd=tmp_path, code=2)
    assert told == f"error: {text}: to check source, name its file: graphflow check own/robot.py\n"

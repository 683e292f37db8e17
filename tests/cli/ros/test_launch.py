"""`graphflow launch convert`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from graphflow.cli.ros import launch
from graphflow.cli.ros.launch import _files_below
from graphflow.graph.resolve import load
from tests.cases import slow
from tests.conftest import PROGRAMS, Machine

pytestmark = pytest.mark.real
ROBOT = PROGRAMS / "launch" / "robot.launch.py"
XML = """<launch>
  <arg name="rate" default="1e3"/> <arg name="on" default="12:30"/>
  <node pkg="demo_nodes_py" exec="talker"><param name="greeting" value="1e3" type="str"/></node>
</launch>
"""


def test_python(machine: Machine, tmp_path: Path) -> None:
    """A Python launch file becomes a graph file; what is left out is listed with its line, with exit code 1."""
    target = tmp_path / "robot.yaml"
    told = machine.look("launch", "convert", str(ROBOT), "-o", str(target), code=1)
    assert f"{target}: written; try it with: graphflow check {target}" in told
    assert "rviz2 rviz2: no node of that name is here; ros2 runs it, which must be installed" in told
    assert "SetROSLogDir has no equivalent in a graph file" in told
    text = target.read_text()
    assert text.startswith("# From robot.launch.py, by graphflow launch convert.\n")
    text = text.replace("quiet", "speed").replace("unless: $(var speed)", "unless: false")
    target.write_text(text.replace("$(find-pkg-share robot)/config/params.yaml", "p.yaml"))
    (tmp_path / "p.yaml").write_text("/**: {ros__parameters: {background_g: 1}}\n")
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "robot"\n')
    plan = load(target, [], {})
    assert {node.name for node in plan.nodes} == {
        "/sim",
        "/t",
        "/echo_1",
        "/robot1/talker",
        "/rviz2",
        "/listener",
        "/leo",
    }
    assert plan.nodes[0].env == {"A": "c"}
    spawn = next(step for step in plan.steps if step.do == "call")
    assert (spawn.target, spawn.request, spawn.after) == ("/spawn", {"x": 2, "y": 2, "name": "t2"}, {"/sim": "ready"})


def test_xml(machine: Machine, tmp_path: Path) -> None:
    """Without -o it goes to stdout; texts that YAML would read as numbers stay texts."""
    file = tmp_path / "a.launch.xml"
    file.write_text(XML)
    target = tmp_path / "a.yaml"
    target.write_text(machine.look("launch", "convert", str(file)))
    plan = load(target, [], {})
    assert plan.args == {"rate": 1000.0, "on": "12:30"}
    assert plan.nodes[0].params["greeting"].value == "1e3"
    assert "already exists" in machine.look("launch", "convert", str(file), "-o", str(target), code=2)


@slow
def test_what_is_no_launch_file(machine: Machine, tmp_path: Path) -> None:
    """The error has the reason, or the right command."""
    (tmp_path / "a.py").write_text("import os\nos._exit(3)\n")
    assert "it ended without a launch description" in machine.look("launch", "convert", str(tmp_path / "a.py"), code=2)
    assert "does not exist" in machine.look("launch", "convert", "gone.xml", code=2)
    told = machine.look("launch", "demo_nodes_py", "talker.launch.py", code=2)
    assert "comes with graphflow has no launch files; graphflow launch FILE starts a file" in told
    assert "Package 'nav2' not found; go to" in machine.look("launch", "nav2", "a.launch.xml", code=2)
    assert "did you mean 'turtlesim'?" in machine.look("launch", "turtlesmi", "a.launch.xml", code=2)


LAUNCH = "launch:\n- arg: {name: rate, default: '2'}\n- node: {pkg: demo_nodes_py, exec: talker}\n"


PYTHON = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import ThisLaunchFileDir
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("loud", default_value="1"),
        Node(package="demo_nodes_py", executable="listener"),
        IncludeLaunchDescription([ThisLaunchFileDir(), "/talk.launch.yaml"]),
    ])
"""


@slow
def test_launch_is_up(machine: Machine, tmp_path: Path) -> None:
    """`launch` starts a file, or a file of a package, with ROS 2's options."""
    folder = tmp_path / "my_robot"
    (folder / "launch").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>my_robot</name></package>")
    (folder / "launch" / "talk.launch.yaml").write_text(LAUNCH)
    (tmp_path / "pyproject.toml").touch()
    for words in (["my_robot/launch/talk.launch.yaml"], ["my_robot", "talk.launch.yaml"]):
        told = machine.look("launch", *words, "-s", cwd=tmp_path)
        assert "'rate':" in told
        assert "/talker" in machine.look("launch", "-p", *words, "rate:=3", cwd=tmp_path)
    told = machine.look("launch", "my_robot", "talk.launch.yml", cwd=tmp_path, code=2)
    assert "my_robot has no file 'talk.launch.yml'; did you mean 'talk.launch.yaml'?" in told
    (folder / "resource").mkdir()
    (folder / "resource" / "my_robot").touch()  # the mark of a package, which is no launch file
    told = machine.look("launch", "my_robot", "my_robot", cwd=tmp_path, code=2)
    assert "my_robot has no file 'my_robot'" in told
    (folder / "scripts").mkdir()
    (folder / "scripts" / "drive.py").touch()
    told = machine.look("launch", "my_robot", "drive", cwd=tmp_path, code=2)
    assert told == "error: my_robot has no file 'drive'; that is an executable: graphflow run my_robot drive\n"
    (folder / "package.xml").write_text("<package><name>my-robot</name></package>")
    told = machine.look("launch", "my_robot", "talk.launch.yaml", cwd=tmp_path, code=2)
    assert told.startswith("error: Package 'my_robot' not found: my_robot is the package 'my-robot'")
    (folder / "package.xml").write_text("<package><name>my_robot</name></package>")
    (folder / "launch" / "all.launch.py").write_text(PYTHON)
    (folder / "launch" / "round").symlink_to(folder)
    told = machine.look("launch", "-p", "my_robot", "all.launch.py", "loud:=2", cwd=tmp_path)
    assert "/listener" in told
    assert "/talker" in told  # of the file that it includes
    assert "'loud':" in machine.look("launch", "-s", "my_robot", "all.launch.py", cwd=tmp_path)
    assert "2 nodes" in machine.look("check", "my_robot/launch/all.launch.py", cwd=tmp_path)
    assert "[PACKAGE] FILE" in machine.look("launch", "--help")


def test_a_folder_with_a_link_to_itself_is_searched_once(tmp_path: Path) -> None:
    """A folder that links to itself is searched once, and so are linked folders."""
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "a" / "b" / "f.launch.py").touch()
    (tmp_path / "a" / "round").symlink_to(tmp_path)
    (tmp_path / "elsewhere").symlink_to(tmp_path / "a" / "b")
    assert [file.name for file in _files_below(tmp_path)] == ["f.launch.py"]


def test_debug_is_not_detach(machine: Machine, tmp_path: Path) -> None:
    """`-d` is ROS's --debug, not that of `up -d`; a note says that it has no effect."""
    file = tmp_path / "a.launch.xml"
    file.write_text(XML)
    told = machine.look("launch", "-d", "-p", str(file))
    assert "note: -d is ROS's --debug, which has no effect here; --detach leaves the graph in the background" in told


@slow
def test_in_the_background(machine: Machine, tmp_path: Path) -> None:
    """`--detach` works as with `up`."""
    file = tmp_path / "a.launch.xml"
    file.write_text(XML)
    assert "Stop with: graphflow down" in machine.run("launch", "--detach", str(file), cwd=tmp_path)
    machine.run("down")


@slow
def test_json(machine: Machine, tmp_path: Path) -> None:
    """Events are lines of JSON, as by `up --json`; with -p, the plan is."""
    file = tmp_path / "a.launch.xml"
    file.write_text(XML)
    shown = json.loads(machine.look("launch", "--json", "-p", str(file)))
    assert [node["name"] for node in shown["nodes"]] == ["/talker"]
    graph = machine.start("launch", "--json", str(file), cwd=tmp_path)
    graph.wait_for('{"event": "up"')
    assert graph.end() == 0
    assert '{"event": "end"' in graph.text


def test_a_package_without_a_file(machine: Machine, tmp_path: Path) -> None:
    """The error lists the package's launch files."""
    folder = tmp_path / "src" / "lamp"
    (folder / "launch").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>lamp</name></package>")
    (folder / "setup.py").write_text("from setuptools import setup\nsetup()\n")
    for file in ("b.launch.py", "a_launch.xml"):
        (folder / "launch" / file).touch()
    told = machine.look("launch", "lamp", cwd=tmp_path, code=2)
    assert told == "error: 'lamp' is a package; write graphflow launch lamp FILE; it has a_launch.xml, b.launch.py\n"
    told = machine.look("launch", "b.launch.py", "lamp", "a:=1", cwd=tmp_path, code=2)
    assert told == "error: the package comes first: graphflow launch lamp b.launch.py a:=1\n"
    assert "lamb: there is no such file" in machine.look("launch", "lamb", cwd=tmp_path, code=2)


def test_a_folder_with_too_many_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only so many are searched."""
    monkeypatch.setattr(launch, "FOLDERS_BOUND", 2)
    for name in ("a", "a/b", "a/b/c"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").touch()
    assert [*_files_below(tmp_path)] == [tmp_path / "a" / "file"]

"""`graphflow ws`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.conftest import Machine

SETUP = "from setuptools import setup\nsetup(entry_points={'console_scripts': ['lamp = lamp.node:main']})\n"


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """One package with a node, and one with a message."""
    for name in ("lamp", "lamp_interfaces"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (tmp_path / "src/lamp/setup.py").write_text(SETUP)
    (tmp_path / "src/lamp/lamp").mkdir()
    (tmp_path / "src/lamp/lamp/node.py").write_text("import rclpy\ndef main(): ...\n")
    (tmp_path / "src/lamp_interfaces/msg").mkdir()
    (tmp_path / "src/lamp_interfaces/msg/LampLight.msg").write_text("int32 level\n")
    return tmp_path


def test_what_there_is(machine: Machine, workspace: Path) -> None:
    """From any folder in it; out of habit, people build it."""
    shown = machine.look("ws", cwd=workspace / "src" / "lamp")
    assert [line.split() for line in shown.splitlines()[:3]] == [
        ["PACKAGE", "EXECUTABLES", "INTERFACES", "FOLDER"],
        ["lamp", "lamp", "-", "src/lamp"],
        ["lamp_interfaces", "-", "msg/LampLight", "src/lamp_interfaces"],
    ]
    assert "Start one with: graphflow run PACKAGE EXECUTABLE" in shown
    assert "Nothing has to be built" in machine.look("ws", "build", "--symlink-install", cwd=workspace)
    found = json.loads(machine.look("ws", "--json", cwd=workspace))
    assert found["faults"] == []
    assert found["packages"][0]["executables"] == ["lamp"]


def test_a_source_tree_of_rclpy(machine: Machine, workspace: Path) -> None:
    """A source tree of rclpy is not a fault; a note says that it is not imported."""
    (workspace / "src/rclpy/rclpy").mkdir(parents=True)
    (workspace / "src/rclpy/package.xml").write_text("<package><name>rclpy</name></package>")
    (workspace / "src/rclpy/rclpy/__init__.py").touch()
    assert "src/rclpy/rclpy is not imported: graphflow has rclpy itself" in machine.look("ws", cwd=workspace)


def test_many_interfaces(machine: Machine, workspace: Path) -> None:
    """The table has the first of them, so that it can be read."""
    for i in range(6):
        (workspace / f"src/lamp_interfaces/msg/A{i}.msg").write_text("int32 x\n")
    assert "msg/A0, msg/A1, msg/A2, msg/A3 and 3 more" in machine.look("ws", cwd=workspace)
    assert len(json.loads(machine.look("ws", "--json", cwd=workspace))["packages"][1]["interfaces"]) == 7


def test_what_is_wrong(machine: Machine, workspace: Path) -> None:
    """An executable without its module and an invalid definition are faults."""
    (workspace / "src/lamp/lamp/node.py").unlink()
    (workspace / "src/lamp_interfaces/msg/Broken.msg").write_text("int32\n")
    shown = machine.look("ws", cwd=workspace, code=1)
    assert "lamp is lamp.node:main, and there is no" in shown
    assert "Broken.msg" in shown
    (workspace / "src/lamp/lamp/node.py").write_text("import rclpy\ndef mian(): ...\n")
    shown = machine.look("ws", cwd=workspace, code=1)
    assert "lamp/node.py has no function 'main'; did you mean 'mian'?" in shown
    (workspace / "src/lamp_interfaces/msg/Broken.msg").write_text("lamp_interfaces/LampLigt light\n")
    shown = machine.look("ws", cwd=workspace, code=1)
    assert "Broken.msg: " in shown
    assert "did you mean 'LampLight'?" in shown


def test_words_out_of_habit(machine: Machine, workspace: Path) -> None:
    """Each habitual verb has its answer; another word is a mistake."""
    assert "needs no initialization" in machine.look("ws", "init", cwd=workspace)
    assert "python -m pytest src/PACKAGE" in machine.look("ws", "test", cwd=workspace)
    assert "did you mean 'build'?" in machine.look("ws", "biuld", cwd=workspace, code=2)
    for word in ("build", "colcon", "source"):
        assert "nothing has to be built or sourced" in machine.look(word, "x", cwd=workspace, code=2)


def test_a_workspace_in_a_workspace(machine: Machine, workspace: Path) -> None:
    """A note says that the outer workspace's packages are not visible."""
    inner = workspace / "src/inner"
    (inner / "src/deep").mkdir(parents=True)
    (inner / "src/deep/package.xml").write_text("<package><name>deep</name></package>")
    assert f"whose packages are not visible from here: {workspace}\n" in machine.look("ws", cwd=inner)


def test_no_workspace(machine: Machine, tmp_path: Path) -> None:
    """The error says where a workspace would be, or what a folder lacks to be a package."""
    assert "go to a folder that has packages in src/" in machine.look("ws", cwd=tmp_path, code=1)
    (tmp_path / "src/dark").mkdir(parents=True)
    (tmp_path / "src/dark/setup.py").touch()
    assert "error: src/dark has setup.py but no package.xml" in machine.look("ws", cwd=tmp_path, code=1)


def test_two_packages_of_one_name(machine: Machine, workspace: Path) -> None:
    """The fault says which one takes precedence."""
    (workspace / "src/more/lamp").mkdir(parents=True)
    (workspace / "src/more/lamp/package.xml").write_text("<package><name>lamp</name></package>")
    said = machine.look("ws", cwd=workspace, code=1)
    assert f"src/more/lamp: another package is called 'lamp', too, and takes precedence: {workspace}" in said
    (workspace / "src/more/lamp/setup.py").write_text("from setuptools import setup\nsetup(name='lump')\n")
    named = "the package is called 'lump' here, and 'lamp' in package.xml"
    assert f"src/more/lamp/setup.py:2: {named}" in machine.look("ws", cwd=workspace, code=1)
    assert named in machine.look("check", "src/more/lamp/setup.py", cwd=workspace, code=2)


def test_executables_of_a_package_with_faults(machine: Machine, workspace: Path) -> None:
    """They are listed, and the exit code tells of the faults."""
    assert machine.look("pkg", "executables", "lamp", cwd=workspace, code=0)
    setup = workspace / "src/lamp/setup.py"
    setup.write_text("from setuptools import setup\nsetup(entry_points={'console_scripts': ['a = lamp.a']})\n")
    assert "error: " in machine.look("pkg", "executables", "lamp", cwd=workspace, code=1)


def test_a_package_without_executables(machine: Machine, workspace: Path) -> None:
    """The package is listed without executables."""
    cmake = "add_executable(one a.cpp)\nadd_executable(two b.cpp)"
    (workspace / "src/lamp_interfaces/CMakeLists.txt").write_text(cmake)
    said = machine.look("run", "lamp_interfaces", "shine", cwd=workspace, code=2)
    assert "the package 'lamp_interfaces' has no executable that graphflow can run; one, two are C++" in said
    said = machine.look("pkg", "executables", "lamp_interfaces", cwd=workspace)
    assert "has no executable that graphflow can run" in said


def test_what_is_no_package(machine: Machine, workspace: Path) -> None:
    """Every verb that takes a package explains a folder's state; a bare executable's name is attributed."""
    (workspace / "src/dark").mkdir()
    (workspace / "src/dark/setup.py").write_text(SETUP)
    (workspace / "g.yaml").write_text("nodes:\n  /a: {pkg: dark, exec: lamp}\n")
    told = "src/dark has setup.py but no package.xml"
    for words in (["run", "dark", "x"], ["launch", "dark", "x.launch.py"], ["check", "g.yaml"]):
        assert told in machine.look(*words, cwd=workspace, code=2)
    for verb in ("executables", "prefix", "xml"):
        assert told in machine.look("pkg", verb, "dark", cwd=workspace, code=1)
    (workspace / "src/lamp/setup.py").write_text(SETUP.replace("'lamp =", "'shine ="))
    assert "graphflow run lamp shine" in machine.look("run", "shine", cwd=workspace, code=2)
    said = machine.look("run", "position_contoler", "shine", cwd=workspace, code=2)
    assert said.endswith(
        "or with graphflow; /WORKSPACE has lamp, lamp_interfaces\n".replace("/WORKSPACE", str(workspace))
    )


def test_what_ros_2_would_not_build(machine: Machine, workspace: Path) -> None:
    """A broken package.xml, and a name of ROS 2's."""
    (workspace / "src/lamp/package.xml").write_text("<package><name>lamp</name>")
    (workspace / "src/lamp/setup.py").write_text(SETUP.replace("setup(", "setup(name='lump', "))
    (workspace / "src/std_msgs/std_msgs").mkdir(parents=True)
    (workspace / "src/std_msgs/package.xml").write_text("<package><name>std_msgs</name></package>")
    (workspace / "src/std_msgs/std_msgs/__init__.py").touch()
    told = machine.look("ws", cwd=workspace, code=1)
    assert f"{workspace}/src/lamp/package.xml:1: no element found" in told
    assert f"{workspace}/src/lamp/setup.py:2: the package is called 'lump' here, and 'lamp' in package.xml" in told
    assert f"{workspace}/src/std_msgs hides ROS 2's std_msgs" in told


def test_what_ros_2_would_not_find(machine: Machine, workspace: Path) -> None:
    """A name that is left of the package that was copied is a fault, and a folder that is not installed a note."""
    (workspace / "src/lamp/launch").mkdir()
    (workspace / "src/lamp/launch/lamp.launch.py").touch()
    assert "note: src/lamp/setup.py does not install launch/" in machine.look("ws", cwd=workspace)
    (workspace / "src/lamp/setup.cfg").write_text("[develop]\nscript_dir=$base/lib/lump\n")
    told = machine.look("ws", cwd=workspace, code=1)
    assert f"error: {workspace}/src/lamp/setup.cfg:2: ROS 2 looks for the executables in lib/lamp" in told


def test_interfaces_that_cmake_does_not_name(machine: Machine, workspace: Path) -> None:
    """ROS 2 would not build them; a pattern may name any."""
    folder = workspace / "src" / "dim_interfaces"
    (folder / "msg").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>dim_interfaces</name></package>")
    for name in ("Light", "Dark"):
        (folder / "msg" / f"{name}.msg").write_text("bool on\n")
    cmake = folder / "CMakeLists.txt"
    cmake.write_text('rosidl_generate_interfaces(${PROJECT_NAME}\n  "msg/Light.msg"\n)\n')
    told = machine.look("ws", cwd=workspace, code=None)
    assert f"{cmake}: some interfaces are missing, so that ROS 2 would not build them; add to rosidl" in told
    assert '"msg/Dark.msg"' in told
    cmake.write_text('rosidl_generate_interfaces(${PROJECT_NAME}\n  "msg/Light.msg"\n  "msg/Drak.msg"\n)\n')
    told = machine.look("ws", cwd=workspace, code=None)
    assert f"{cmake}: msg/Drak.msg is listed and does not exist; did you mean 'msg/Dark.msg'?" in told
    cmake.write_text("file(GLOB messages msg/*.msg)\n")
    assert "would not build" not in machine.look("ws", cwd=workspace, code=None)


def test_a_definition_that_is_not_in_camel_case(machine: Machine, workspace: Path) -> None:
    """The fault has the required name of the file."""
    folder = workspace / "src/lamp_interfaces/srv"
    folder.mkdir()
    (folder / "set_goal.srv").write_text("---\n")
    shown = machine.look("ws", cwd=workspace, code=1)
    right = f"{folder}/SetGoal.srv: names of interfaces are in camel case"
    assert f"error: {folder}/set_goal.srv must be {right}\n" in shown

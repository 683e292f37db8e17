"""`graphflow pkg`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import PROJECT, Machine


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """A package as ROS 2 creates it, with a node of graphflow's."""
    root = tmp_path / "my_robot"
    (root / "nodes").mkdir(parents=True)
    (root / "pyproject.toml").write_text('[project]\nname = "my_robot"\n')
    depends = "<depend>a</depend><depend> b </depend>"
    (root / "package.xml").write_text(f"<package>\n  <name>my_robot</name>\n  {depends}\n</package>\n")
    (root / "nodes" / "arm.py").write_text("from graphflow import Node\nclass Arm(Node): ...\n")
    return root


def test_list(machine: Machine, robot: Path) -> None:
    """Packages with nodes, the project's own, and those with types are listed."""
    names = machine.look("pkg", "list", cwd=robot).split()
    assert names == sorted(names)
    assert {"my_robot", "turtlesim", "demo_nodes_cpp", "std_msgs"} <= {*names}


@slow
def test_executables(machine: Machine, robot: Path) -> None:
    """Executables of all packages or of one are listed, as in ROS 2, or their paths."""
    names = ("draw_square", "mimic", "turtle_teleop_key", "turtlesim_node")
    assert machine.look("pkg", "executables", "turtlesim").splitlines() == [f"turtlesim {name}" for name in names]
    rows = machine.look("pkg", "executables", cwd=robot).splitlines()
    assert {"my_robot arm", "demo_nodes_cpp add_two_ints_server"} <= {*rows}
    assert machine.look("pkg", "executables", "my_robot", "--full-path", cwd=robot) == "nodes/arm.py\n"
    told = "Package 'turtlesin' not found; did you mean 'turtlesim'?"
    assert told in machine.look("pkg", "executables", "turtlesin", code=1)


@slow
def test_prefix(machine: Machine, robot: Path) -> None:
    """The prefix of the project's packages, and of those that come with graphflow, is printed."""
    assert machine.look("pkg", "prefix", "my_robot", cwd=robot) == f"{robot}\n"
    assert machine.look("pkg", "prefix", "demo_nodes_py", "--share") == f"{PROJECT}\n"
    assert "Package not found" in machine.look("pkg", "prefix", "nav2", code=1)


def test_xml(machine: Machine, robot: Path) -> None:
    """The whole manifest, or one tag, is printed."""
    assert machine.look("pkg", "xml", "my_robot", cwd=robot) == (robot / "package.xml").read_text()
    assert machine.look("pkg", "xml", "my_robot", "-t", "depend", cwd=robot) == "a\nb\n"
    assert "has no tag 'x'" in machine.look("pkg", "xml", "my_robot", "-t", "x", cwd=robot, code=2)
    assert "demo_nodes_py: no package.xml was found" in machine.look("pkg", "xml", "demo_nodes_py", code=1)


@slow
@pytest.mark.real
def test_the_executables_run(machine: Machine) -> None:
    """`run PKG EXE` starts an executable, with or without `.py`."""
    node = machine.start("run", "demo_nodes_cpp", "add_two_ints_server.py")
    words = ("service", "call", "/add_two_ints", "example_interfaces/srv/AddTwoInts", "{a: 2, b: 5}")
    machine.until(lambda: machine.look_and_end("service", "type", "/add_two_ints")[0] == 0, "the service is there")
    assert "sum=7" in machine.look(*words)
    node.wait_for("Incoming request\na: 2 b: 5")

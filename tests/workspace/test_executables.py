"""What ROS's pairs of package and executable are here."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from graphflow.system import ROS2
from graphflow.workspace.executables import (
    Executable,
    find,
    is_ros_sourced,
    package_folder,
    package_prefix,
    package_program,
    package_share,
)

SETUP = (
    "from setuptools import setup\nsetup(entry_points={'console_scripts': ['go = my_robot.driver:main', 'x=a:b']})\n"
)


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A package as `ros2 pkg create` makes it, which is also a project of ours."""
    folder = tmp_path / "my_robot"
    (folder / "my_robot").mkdir(parents=True)
    (folder / "nodes").mkdir()
    (folder / "package.xml").write_text('<package format="3">\n  <name> my_robot </name>\n</package>\n')
    (folder / "setup.py").write_text(SETUP)
    (folder / "my_robot" / "driver.py").write_text("class Driver(rclpy.node.Node): ...\nclass Helper: ...\n")
    (folder / "nodes" / "arm.py").write_text("class Arm(Node): ...\n")
    (folder / "nodes" / "two.py").write_text("class A(Node): ...\nclass B(LifecycleNode): ...\n")
    (folder / "nodes" / "broken.py").write_text("class A(Node)")
    return folder


@pytest.mark.parametrize(
    ("package", "executable", "found"),
    [
        ("turtlesim", "turtlesim_node", Executable("nodes.turtlesim:TurtleSim", "turtlesim")),
        ("demo_nodes_cpp", "talker", Executable("nodes.talker:Talker", "talker")),
        ("my_robot", "go", Executable("my_robot.driver:Driver", "go")),
        ("my_robot", "arm", Executable("nodes.arm:Arm", "arm")),
        ("my_robot", "two", None),
        ("my_robot", "broken", None),
        ("my_robot", "gone", None),
        ("turtlesim", "mimic", Executable("nodes.mimic:Mimic", "turtle_mimic")),
        ("turtlesim", "circle", None),
        ("nav2", "planner", None),
    ],
)
def test_find(root: Path, package: str, executable: str, found: Executable | None) -> None:
    """Nodes that come with graphflow, scripts of a `setup.py`, and modules in `nodes/` with one node class."""
    assert find(package, executable, root) == found


def test_folders_of_packages(root: Path) -> None:
    """By `package.xml`, some folders down; by the name in `pyproject.toml`, or that of the folder."""
    assert package_folder("my_robot", root.parent) == root
    assert package_folder("nav2", root.parent) is None
    (root.parent / "pyproject.toml").write_text('[project]\nname = "lab"\n')
    assert package_folder("lab", root.parent) == root.parent
    (root.parent / "pyproject.toml").write_text("[project")
    assert package_folder("lab", root.parent) is None
    assert package_folder(root.parent.name, root.parent) == root.parent


def test_where_packages_are(root: Path, tmp_path: Path) -> None:
    """The project's own come first, then those of a ROS 2 that is sourced, then Python's."""
    ros = tmp_path / "opt"
    for package in ("my_robot", "nav2", "numpy"):
        (ros / "share/ament_index/resource_index/packages").mkdir(parents=True, exist_ok=True)
        (ros / "share/ament_index/resource_index/packages" / package).touch()
    (ros / "lib/nav2").mkdir(parents=True)
    for program in (ros / "lib/nav2/planner", root / "scripts/calibrate"):
        program.parent.mkdir(exist_ok=True)
        program.touch(mode=0o755)
    sourced = {"AMENT_PREFIX_PATH": f"/nowhere:{ros}"}

    assert package_share("my_robot", root, sourced) == root
    assert package_share("nav2", root, sourced) == ros / "share/nav2"
    assert package_prefix("nav2", root, sourced) == ros
    assert package_share("numpy", root, sourced) == ros / "share/numpy"
    assert package_share("numpy", root, {}) == Path(np.__path__[0])
    assert package_prefix("numpy", root, {}) == Path(sys.prefix)
    assert package_prefix("nav2", root, {}) is None

    assert package_program("planner", "nav2", root, sourced) == ros / "lib/nav2/planner"
    assert package_program("planner", "nav2", root, {}) is None
    assert package_program("calibrate", "my_robot", root, {}) == root / "scripts/calibrate"
    assert package_program("calibrate", "nav2", root, sourced) is None


def test_hidden_folders_are_passed_over(root: Path) -> None:
    """They are caches and environments, and may go while they are looked at."""
    (root / ".venv" / "pkg").mkdir(parents=True)
    (root / ".venv" / "pkg" / "package.xml").write_text("<package><name>theirs</name></package>")
    assert package_folder("theirs", root) is None
    (root / "pkg").mkdir()
    (root / "pkg" / "package.xml").write_text("<package><name>mine</name></package>")
    assert package_folder("mine", root) == root / "pkg"


def test_a_ros_that_is_sourced(tmp_path: Path) -> None:
    """Has a program `ros2` on the path; graphflow's own of that name is none."""
    assert not is_ros_sourced({"PATH": ROS2})
    (tmp_path / "ros2").touch(mode=0o755)
    assert not is_ros_sourced({"PATH": f"{ROS2}:{tmp_path}"})
    assert is_ros_sourced({"PATH": f"{tmp_path}:{ROS2}"})
    assert Path(ROS2, "ros2").exists()

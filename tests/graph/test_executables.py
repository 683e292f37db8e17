"""What ROS's pairs of package and executable are here."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.graph.executables import Executable, find, package_folder

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
        ("turtlesim", "mimic", None),
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

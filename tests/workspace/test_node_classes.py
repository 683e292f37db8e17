"""Node classes by their source: bases of the same file and of the project's own modules are followed."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.workspace.executables import Executable, find
from graphflow.workspace.node_classes import node_classes_in, sole_class_in

BASE = "from graphflow import Node\n\nclass Controller(Node): ...\nclass Plain: ...\nclass TreeNode: ...\n"
ROS = "from rclpy.node import Node\n\nclass RosController(Node): ...\n"


@pytest.fixture
def nodes(tmp_path: Path) -> Path:
    """The folder `nodes` of a project."""
    folder = tmp_path / "nodes"
    folder.mkdir()
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "mine"\n')
    (folder / "base.py").write_text(BASE)
    (folder / "ros_base.py").write_text(ROS)
    (folder / "parts").mkdir()
    (folder / "parts" / "__init__.py").write_text("from ..base import Controller as Moved\n")
    return folder


@pytest.mark.parametrize(
    "source",
    [
        "from nodes.base import Controller\nclass A(Controller): ...",
        "from .base import Controller\nclass A(Controller): ...",
        "from nodes import base\nclass A(base.Controller): ...",
        "from . import base\nclass A(base.Controller): ...",
        "import nodes.base\nclass A(nodes.base.Controller): ...",
        "import nodes.base as b\nclass A(b.Controller): ...",
        "from nodes.parts import Moved\nclass A(Moved): ...",
        "from nodes.base import Controller as C, Plain\nclass A(Plain, C): ...",
        "import graphflow\nclass A(graphflow.LifecycleNode): ...",
        "from elsewhere import OurNode\nclass A(OurNode): ...",
        "from graphflow import Node\nclass A(Node[int]): ...",
    ],
)
def test_classes_through_the_projects_own_modules(nodes: Path, source: str) -> None:
    """However the base is imported."""
    file = nodes / "a.py"
    file.write_text(source + "\n")
    assert node_classes_in(file) == {"A": source.count("\n") + 1}


@pytest.mark.parametrize(
    "source",
    [
        "from nodes.base import Plain\nclass A(Plain): ...",
        "from nodes.base import TreeNode\nclass A(TreeNode): ...",
        "from nodes.ros_base import RosController\nclass A(RosController): ...",
        "from elsewhere import Thing\nclass A(Thing): ...",
        "from nodes.gone import Thing\nclass A(Thing): ...",
        "class A(B): ...\nclass B(A): ...",
        "class A(Exception): ...",
        "class A(make()): ...",
    ],
)
def test_what_is_no_node(nodes: Path, source: str) -> None:
    """Other classes, those of rclpy's, and those of which nothing is known."""
    file = nodes / "a.py"
    file.write_text(source + "\n")
    assert node_classes_in(file) == {}


def test_bases_of_the_same_file(nodes: Path) -> None:
    """Both are nodes, and the last of the line is the file's executable."""
    file = nodes / "a.py"
    file.write_text("from graphflow import Node\nclass B(Node): ...\nclass A(B): ...\n")
    assert node_classes_in(file) == {"B": 2, "A": 3}
    assert sole_class_in(file) == "A"
    assert find("mine", "a", nodes.parent) == Executable("nodes.a:A", "a")


def test_the_repositorys_own_nodes() -> None:
    """A node that inherits the project's own controller is found."""
    file = Path(__file__).parents[2] / "nodes" / "turtle_follower.py"
    assert node_classes_in(file).keys() == {"TurtleFollower"}

"""Node classes by their paths."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

from graphflow.errors import GraphflowError, Problem
from graphflow.interface import Interface
from graphflow.msgs import registry
from graphflow.supervisor.launching import classes
from graphflow.supervisor.launching.classes import _no_module, add_root, import_class, interfaces
from graphflow.supervisor.launching.probed import read_interfaces
from tests.conftest import PROGRAMS

SIMULATOR = "did you mean 'nodes.robot_simulator:RobotSimulator', which comes with graphflow?"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A project whose classes can be imported while the test runs, most of them by a mistake each only in theory."""
    folder = tmp_path / "project" / "machines"
    folder.mkdir(parents=True)
    shutil.copy(PROGRAMS / "supervisor" / "robot.py", folder)
    for name, text in {
        "raises": "def deep():\n    raise RuntimeError('no wheels')\n\n\ndeep()\n",
        "needs": "\nimport no_such_module_anywhere\n",
        "ros": "import geometry_msgs.msg\n",
        "elderly": "import rospy\n",
        "from_robot": "from machines.robot import Robto\n",
        "slide": "if True:\n    print(“hi”)\n",
        "syntax": "class Robot(:\n    pass\n",
        "declares": "from graphflow import Node, Param\n\n\nclass Robot(Node):\n    rate = Param(1, ge=3)\n",
        "ends": "raise SystemExit(3)\n",
        "parses": "import json\n\njson.loads('nonsense')\n",
        "runs": "import graphflow\n\n\ndef main():\n    graphflow.run()\n\n\nmain()\n",
        "asks": "from graphflow import Qos\n\nQos(\n    depth='10')\n",
    }.items():
        (folder / f"{name}.py").write_text(text)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(classes, "_roots", [])
    monkeypatch.setattr(registry, "_roots", [])
    import numpy  # noqa: F401 - it cannot be imported again, once it is forgotten with the others

    import graphflow.runtime.run  # noqa: F401 - nor may this be, of which graphflow keeps a function

    with patch.dict(sys.modules):
        add_root(str(folder.parent))
        yield folder.parent


def test_a_class_by_its_path(project: Path) -> None:
    """It is imported, and is the one that is meant."""
    assert import_class("machines.robot:Robot") is sys.modules["machines.robot"].Robot


def test_a_class_of_rclpy(project: Path) -> None:
    """Its file is run as it is."""
    file = project / "machines" / "old.py"
    file.write_text("class Base: ...\n\nBase.__module__ = 'rclpy.node'\n\nclass Lamp(Base): ...\n")
    with pytest.raises(GraphflowError, match=f"; it is one of rclpy, run by graphflow run {file}$"):
        import_class("machines.old:Lamp")


def test_a_file_with_the_name_of_a_package(project: Path) -> None:
    """It is hidden by the package, and is the one that is meant."""
    (project / "graphflow.py").write_text("class Robot: ...\n")
    text = r"module graphflow has no class 'Robot'; graphflow.py here is hidden by .*: rename it, as in my_graphflow.py"
    with pytest.raises(GraphflowError, match=text):
        import_class("graphflow:Robot")


def test_a_folder_of_a_project_with_modules_of_its_own(project: Path) -> None:
    """It lacks the file that makes it a project."""
    (project / "lab" / "machines").mkdir(parents=True)
    (project / "lab" / "machines" / "lamp.py").touch()
    with pytest.raises(GraphflowError) as caught:
        import_class("machines.lamp:Lamp")
    lab = project / "lab"
    assert str(caught.value) == (
        "cannot import machines.lamp: there is no module 'machines.lamp'; modules are looked for in "
        f"{project}, and machines/lamp.py is in {lab}: make {lab} a project of its own: touch {lab}/pyproject.toml"
    )


@pytest.mark.parametrize(
    ("class_path", "problem"),
    [
        ("machines.robot:Robto", "module machines.robot has no class 'Robto'; did you mean 'Robot'?"),
        ("machines.robot:Submarine", "module machines.robot has no class 'Submarine'; there is Robot"),
        ("machines.robot:Wheel", "machines.robot:Wheel is not a node class: it does not derive from graphflow.Node"),
        (
            "machines.nowhere:Robot",
            "cannot import machines.nowhere: there is no module 'machines.nowhere'; "
            "modules are looked for in {project}",
        ),
        (
            "nowhere.robot:Robot",
            "cannot import nowhere.robot: there is no module 'nowhere'; did you mean 'machines.robot:Robot'?",
        ),
        (
            "nowhere.nothing:Robot",
            "cannot import nowhere.nothing: there is no module 'nowhere'; modules are looked for in {project}",
        ),
        (
            "turtlebot3_gazebo:Bot",
            "cannot import turtlebot3_gazebo: there is no module 'turtlebot3_gazebo'; " + SIMULATOR,
        ),
        ("sim.simulator:Simulator", "cannot import sim.simulator: there is no module 'sim'; " + SIMULATOR),
        ("robot:Robot", "cannot import robot: there is no module 'robot'; did you mean 'machines.robot:Robot'?"),
        (
            "machines.robt:Robot",
            "cannot import machines.robt: there is no module 'machines.robt'; did you mean 'machines.robot:Robot'?",
        ),
        ("machines.raises:Robot", "cannot import machines.raises: {machines}/raises.py:2: RuntimeError: no wheels"),
        (
            "machines.needs:Robot",
            "cannot import machines.needs: {machines}/needs.py:2: ModuleNotFoundError: "
            "No module named 'no_such_module_anywhere'",
        ),
        (
            "machines.from_robot:Robot",
            "cannot import machines.from_robot: {machines}/from_robot.py:1: ImportError: "
            "cannot import name 'Robto' from 'machines.robot' ({machines}/robot.py)",
        ),
        (
            "machines.runs:Robot",
            "cannot import machines.runs: {machines}/runs.py:8: this calls graphflow.run when it is imported; write it "
            "below if __name__ == '__main__':",
        ),
        ("machines.ends:Robot", "cannot import machines.ends: {machines}/ends.py:1: SystemExit: 3"),
        (
            "machines.ros:Robot",
            "cannot import machines.ros: {machines}/ros.py:1: ModuleNotFoundError: No module named 'geometry_msgs'; "
            "write graphflow.msgs.geometry_msgs",
        ),
        (
            "machines.elderly:Robot",
            "cannot import machines.elderly: {machines}/elderly.py:1: ModuleNotFoundError: No module named 'rospy'; "
            "rospy is ROS 1's: write `from graphflow import Node`, or ROS 2's import rclpy",
        ),
        (
            "machines.parses:Robot",
            "cannot import machines.parses: {machines}/parses.py:3: JSONDecodeError: "
            "Expecting value: line 1 column 1 (char 0)",
        ),
        (
            "machines.asks:Robot",
            "cannot import machines.asks: {machines}/asks.py:3: ValueError: depth of a Qos is a whole number, not '10'",
        ),
        ("machines.syntax:Robot", "cannot import machines.syntax: {machines}/syntax.py:1: invalid syntax"),
        (
            "machines.slide:Robot",
            "cannot import machines.slide: {machines}/slide.py:2: invalid character '“' (U+201C); write print(\"hi\")",
        ),
    ],
)
def test_why_a_class_cannot_be_had(class_path: str, problem: str, project: Path) -> None:
    """Each failure names the place in the user's own code, or the nearest name."""
    with pytest.raises(GraphflowError) as caught:
        import_class(class_path)
    assert str(caught.value) == problem.replace("{machines}", f"{project}/machines").replace("{project}", str(project))


@pytest.mark.parametrize(
    ("line", "way"),
    [
        ("import robot", "No module named 'robot'; write from machines import robot"),
        (
            "from robot import Robot, Wheel  # both",
            "No module named 'robot'; write from machines.robot import Robot, Wheel",
        ),
        ("import parts.wheel", "No module named 'parts'; write from machines.parts import wheel"),
        ("from parts.wheel import turn", "No module named 'parts'; write from machines.parts.wheel import turn"),
        ("import elsewhere", "No module named 'elsewhere'"),
    ],
)
def test_a_module_beside_the_file(project: Path, line: str, way: str) -> None:
    """It is imported from the package; one that is nowhere has no advice."""
    (project / "machines" / "parts").mkdir()
    (project / "machines" / "uses.py").write_text(f"{line}\n")
    with pytest.raises(GraphflowError) as caught:
        import_class("machines.uses:Robot")
    assert str(caught.value).endswith(f"/uses.py:1: ModuleNotFoundError: {way}")


def test_a_file_that_is_run_apart_from_its_package(project: Path) -> None:
    """Its imports are found from the folder above, where it is run as a module."""
    sys.path.remove(str(project))
    add_root(str(project / "machines"))
    for module, line in {"relative": "from .robot import Robot", "whole": "from machines.robot import Robot"}.items():
        (project / "machines" / f"{module}.py").write_text(f"{line}\n")
        with pytest.raises(GraphflowError) as caught:
            import_class(f"{module}:Robot")
        way = f"; run it as a module of machines: graphflow run machines.{module}, in {project}"
        assert str(caught.value).endswith(way)


def test_a_project_without_its_file(tmp_path: Path) -> None:
    """The folder with the module is named, and the file that makes it the project's root."""
    for name in ("course", "graphs", "config"):
        (tmp_path / name).mkdir()
    text = _no_module("course.circle", "course.circle", "Circle", str(tmp_path / "graphs"))
    assert text.endswith(f"that of {tmp_path} is found once there is a file {tmp_path / 'pyproject.toml'}")
    (tmp_path / "pyproject.toml").touch()
    text = _no_module("course.circle", "course.circle", "Circle", str(tmp_path / "config"))
    assert text.endswith(f"that of {tmp_path} is found once the graph file is in {tmp_path / 'graphs'}")


@pytest.mark.parametrize("root", ["", "launch"])
def test_a_module_in_a_source_folder(tmp_path: Path, root: str) -> None:
    """It is to be moved beside the folder of the graph files, and is not taken for a node of graphflow."""
    (tmp_path / "src" / "course").mkdir(parents=True)
    (tmp_path / "src" / "course" / "talker.py").touch()
    (tmp_path / "launch").mkdir()
    text = _no_module("course.talker", "course.talker", "Talker", str(tmp_path / root))
    way = f"move it to {tmp_path}, and the graph file to {tmp_path / 'graphs'}"
    assert text.endswith(f"; {tmp_path / 'src' / 'course'} is not found there: {way}")
    assert "src" not in _no_module("course", "course.other", "Talker", str(tmp_path / root)).replace(str(tmp_path), "")
    below = tmp_path / "other" / "project"
    below.mkdir(parents=True)
    assert str(tmp_path / "src") not in _no_module("course", "course.talker", "Talker", str(below))


@pytest.mark.parametrize("root", ["", "other"])
def test_a_module_of_another_project(tmp_path: Path, root: str) -> None:
    """It is found once its project is installed, from the folder beside it and from the one above."""
    (tmp_path / "mylab" / "mylab").mkdir(parents=True)
    (tmp_path / "other").mkdir()
    (tmp_path / "mylab" / "pyproject.toml").touch()
    text = _no_module("mylab.greeter", "mylab.greeter", "Greeter", str(tmp_path / root))
    assert text.endswith(f"others find its modules once it is installed: pip install -e {tmp_path / 'mylab'}")
    (tmp_path / "mylab" / "mylab").rmdir()
    text = _no_module("mylab.greeter", "mylab.greeter", "Greeter", str(tmp_path / root))
    assert "is a project of its own" not in text


def test_a_package_that_another_hides(project: Path) -> None:
    """A name that an installed module has too is told as such, and not offered again."""
    (project / "json").mkdir()
    (project / "json" / "robot.py").touch()
    with pytest.raises(GraphflowError) as caught:
        import_class("json.robot:Robot")
    text = f"'json' is {json.__file__}; give the package in {project} another name"
    assert str(caught.value) == f"cannot import json.robot: {text}"


def test_a_wrong_declaration_names_its_line(project: Path) -> None:
    """A class that refuses to be made says where, and why."""
    with pytest.raises(GraphflowError) as caught:
        import_class("machines.declares:Robot")
    assert f"{project}/machines/declares.py:5: " in str(caught.value)
    assert "out of range: at least 3" in str(caught.value)


def test_interfaces_travel_as_json(project: Path) -> None:
    """Each class has its interface or its problem; one that fails leaves the others."""
    paths = ["machines.raises:Robot", "machines.robot:Robot"]
    problem, interface = read_interfaces(interfaces(paths)).values()
    assert isinstance(problem, Problem)
    assert "no wheels" in problem.message
    assert isinstance(interface, Interface)
    assert interface == import_class("machines.robot:Robot").interface()


def test_where_a_project_is_looked_for(project: Path) -> None:
    """Before what is installed, behind the standard library, once; its interfaces are known."""
    (project / "interfaces").mkdir()
    before = list(sys.path)
    add_root(str(project))
    assert sys.path == before
    assert registry._roots == [project / "interfaces"]
    at = sys.path.index(str(project))
    installed = [i for i, entry in enumerate(sys.path) if entry.endswith("-packages")]
    standard = sys.path.index(str(Path(shutil.__file__).parent))
    assert standard < at < min(installed)


def test_a_project_behind_another_that_is_installed(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As projects are that are installed to be edited: the one whose graph it is comes first."""
    monkeypatch.setattr(sys, "path", [*(p for p in sys.path if p != str(project)), "/another", str(project)])
    add_root(str(project))
    assert sys.path.index(str(project)) < sys.path.index("/another")


def test_classes_whose_nodes_cannot_be_made(project: Path) -> None:
    """Are told with the place of the class."""
    (project / "machines" / "needy.py").write_text(
        "from graphflow import Node\nclass Needy(Node):\n    def __init__(self, port):\n        super().__init__()\n"
    )
    [problem] = read_interfaces(interfaces(["machines.needy:Needy"])).values()
    assert isinstance(problem, Problem)
    assert problem.message.startswith(f"{project}/machines/needy.py:2: Needy.__init__ needs port, and nodes are made")


def test_a_module_of_that_very_name(project: Path) -> None:
    """In a subfolder, it is meant rather than a similar one of the project's own folder."""
    (project / "robot1.py").touch()
    (project / "machines" / "robot2.py").touch()
    assert classes.nearest_module("robot2", str(project)) == "machines.robot2"


def test_a_file_of_the_working_directory_that_is_hidden(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It may lie in a folder of the project."""
    (project / "machines" / "graphflow.py").write_text("class Robot: ...\n")
    monkeypatch.chdir(project / "machines")
    with pytest.raises(GraphflowError, match=r"graphflow.py here is hidden by .*: rename it, as in my_graphflow.py"):
        import_class("graphflow:Robot")


@pytest.mark.parametrize("module", ["rlcpy", "rcpy", "graphfow"])
def test_an_import_that_is_misspelt(project: Path, module: str) -> None:
    """The nearest of the two packages is named."""
    (project / "machines" / "slip.py").write_text(f"import {module}\n")
    meant = "graphflow" if module.startswith("g") else "rclpy"
    with pytest.raises(GraphflowError, match=rf"did you mean '{meant}'\?$"):
        import_class("machines.slip:Slip")


def test_a_root_with_too_many_folders(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the first are searched for a module of a similar name."""
    assert classes.nearest_module("robto", str(project)) == "machines.robot"
    monkeypatch.setattr(classes, "_FOLDERS_BOUND", 1)
    (project / "a").mkdir()
    assert classes.nearest_module("robto", str(project)) is None

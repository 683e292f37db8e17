"""Nodes and graph files of installed distributions."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.errors import UsageFault
from graphflow.workspace import installed
from graphflow.workspace.executables import all_executables, command_of, find
from graphflow.workspace.packages import Workspace
from graphflow.workspace.project import project_root
from graphflow.workspace.setup_file import EntryPoint
from tests.conftest import Machine

BLINKER = "from graphflow import Node\nclass Blinker(Node): ...\n"
BEEPER = """\
import rclpy


def main():
    rclpy.init()
    rclpy.create_node("beeper").get_logger().info("it beeps")
    rclpy.shutdown()
"""
ENTRIES = """\
[graphflow.nodes]
blinker = {name}.blinker:Blinker

[console_scripts]
beeper = {name}.beeper:main
tool = {name}.tool:main
"""


def install(site: Path, name: str) -> None:
    """What pip leaves of a wheel."""
    files = {
        f"{name}-1.0.dist-info/METADATA": f"Metadata-Version: 2.1\nName: {name.replace('_', '-')}\nVersion: 1.0\n",
        f"{name}-1.0.dist-info/entry_points.txt": ENTRIES.format(name=name),
        f"{name}/__init__.py": "",
        f"{name}/blinker.py": BLINKER,
        f"{name}/beeper.py": BEEPER,
        f"{name}/tool.py": "def main(): ...\n",
        f"{name}/graphs/robot.yaml": f"nodes:\n  /a: {{pkg: {name}, exec: blinker}}\n",
        f"{name}/interfaces/{name}_interfaces/msg/Light.msg": "int32 level\n",
    }
    for path, text in files.items():
        (site / path).parent.mkdir(parents=True, exist_ok=True)
        (site / path).write_text(text)


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of installed distributions, in a virtual environment inside a project."""
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "nodes").mkdir()
    folder = tmp_path / ".venv/lib/python3/site-packages"
    install(folder, "my_robot")
    monkeypatch.syspath_prepend(str(folder))
    installed.installed.cache_clear()
    yield folder
    installed.installed.cache_clear()
    for name in [name for name in sys.modules if name.partition(".")[0] == "my_robot"]:
        del sys.modules[name]


def test_what_a_distribution_has(site: Path) -> None:
    """Node classes, programs for rclpy and no others, graph files and interfaces."""
    own = installed.package_of("my_robot")
    assert own is not None
    assert own.nodes == {"blinker": "my_robot.blinker:Blinker"}
    assert own.programs == {"beeper": (site / "my_robot/beeper.py", EntryPoint("my_robot.beeper", "main"))}
    assert own.graphs == {"robot": site / "my_robot/graphs/robot.yaml"}
    assert installed.interfaces() == {"my_robot_interfaces": site / "my_robot/interfaces/my_robot_interfaces"}


def test_executables(site: Path, tmp_path: Path) -> None:
    """They are found as those of a project and of a workspace are."""
    found = find("my_robot", "blinker", tmp_path)
    assert found is not None
    assert found.class_path == "my_robot.blinker:Blinker"
    command = command_of("my_robot", "beeper", Workspace(tmp_path), {})
    assert command == ("graphflow", "run", "my_robot", "beeper")
    rows = [row.name for row in all_executables(tmp_path) if row.package == "my_robot"]
    assert rows == ["beeper", "blinker"]


def test_a_virtual_environment_is_not_its_projects(site: Path) -> None:
    """The classes of an installed graph are not looked for in a project that the environment lies in."""
    assert project_root(site / "my_robot/graphs/robot.yaml") == site / "my_robot/graphs"


def test_installed_to_be_edited(site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The files are the project's, though a copy of its graphs was installed, too."""
    (site / "my_robot").rename(tmp_path / "my_robot")
    (site / "my_robot/graphs").mkdir(parents=True)
    (tmp_path / "my_robot/graphs").rename(tmp_path / "graphs")
    (site / "my_robot/graphs/robot.yaml").touch()
    monkeypatch.syspath_prepend(str(tmp_path))
    installed.installed.cache_clear()
    own = installed.package_of("my_robot")
    assert own is not None
    assert own.graphs == {"robot": tmp_path / "graphs/robot.yaml"}
    assert own.programs["beeper"][0] == tmp_path / "my_robot/beeper.py"


def test_graphs_by_name(site: Path) -> None:
    """With their package or without; a name that several have has several files."""
    install(site, "other_robot")
    installed.installed.cache_clear()
    found = installed.graphs()
    assert found["my_robot/robot"] == [site / "my_robot/graphs/robot.yaml"]
    assert len(found["robot"]) == 2


def test_the_command_line(site: Path, machine: Machine, tmp_path: Path) -> None:
    """`pkg executables`, `plan` and `run` know them."""
    said = machine.look("pkg", "executables", "my_robot", cwd=tmp_path)
    assert said == "my_robot beeper\nmy_robot blinker\n"
    assert "my_robot.blinker:Blinker" in machine.look("plan", "robot", cwd=tmp_path)
    assert "my_robot.blinker:Blinker" in machine.look("plan", "my_robot/robot.yaml", cwd=tmp_path)
    assert "did you mean 'beeper'?" in machine.look("run", "my_robot", "beper", cwd=tmp_path, code=2)
    assert "did you mean 'robot'?" in machine.look("plan", "robt", cwd=tmp_path, code=2)
    install(site, "other_robot")
    installed.installed.cache_clear()
    assert "several packages have a graph 'robot'" in machine.look("plan", "robot", cwd=tmp_path, code=2)


def test_a_node_by_its_name(site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the one that is installed; two of one name are told apart by their packages."""
    from graphflow.cli.projects.node_lookup import find_class

    monkeypatch.chdir(tmp_path)
    assert find_class("blinker", [])[0].__module__ == "my_robot.blinker"
    assert find_class("my_robot", ["blinker"])[0].__module__ == "my_robot.blinker"
    install(site, "other_robot")
    installed.installed.cache_clear()
    with pytest.raises(UsageFault, match="run one of my_robot blinker, other_robot blinker"):
        find_class("blinker", [])


def test_of_two_installations_the_first_counts(site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As it does for Python."""
    other = tmp_path / "other/site-packages"
    install(other, "my_robot")
    (other / "my_robot-1.0.dist-info/entry_points.txt").write_text("[graphflow.nodes]\nold = my_robot.old:Old\n")
    monkeypatch.syspath_prepend(str(other))
    installed.installed.cache_clear()
    assert installed.installed()["my_robot"].executables == ["old"]
    monkeypatch.setattr(sys, "path", [*sys.path[1:], str(other)])
    installed.installed.cache_clear()
    assert "blinker" in installed.installed()["my_robot"].executables
    installed.installed.cache_clear()

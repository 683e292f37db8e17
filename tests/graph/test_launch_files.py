"""Launch files of packages: the paths of their files of parameters, and names that ROS 2 does not know."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.graph.resolve import load
from graphflow.workspace.package_share import in_launch_file

SETUP = "from setuptools import setup\nsetup(entry_points={'console_scripts': ['blink = lamp.blink:main']})\n"
VALUES = "/**:\n  ros__parameters:\n    rate: 5.0\n"
XML = '<launch>\n  <node pkg="lamp" exec="{name}"><param from="{path}"/></node>\n</launch>\n'


@pytest.fixture
def lamp(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a package with a node and a file of parameters, in a workspace that is the working directory."""
    lamp = tmp_path / "ws" / "src" / "lamp"
    for folder in ("lamp", "config", "launch"):
        (lamp / folder).mkdir(parents=True)
    (lamp / "package.xml").write_text("<package><name>lamp</name></package>")
    (lamp / "setup.py").write_text(SETUP)
    (lamp / "lamp" / "__init__.py").touch()
    (lamp / "lamp" / "blink.py").write_text("def main():\n    pass\n")
    (lamp / "config" / "lamp.yaml").write_text(VALUES)
    monkeypatch.chdir(tmp_path / "ws")
    return lamp


def test_a_path_begins_at_the_working_directory(lamp: Path) -> None:
    """As in ROS 2; beside the launch file, too, if nothing is there."""
    file = lamp / "launch" / "lamp.launch.xml"
    for path in ("src/lamp/config/lamp.yaml", "../config/lamp.yaml"):
        file.write_text(XML.format(name="blink", path=path))
        plan = load(file, [], {})
        (written,) = plan.nodes[0].params_files
        assert Path(written).resolve() == lamp / "config" / "lamp.yaml"
        assert plan.remarks == ()


@pytest.mark.parametrize("path", ["config/lamp.yaml", "lamp.yaml"])
def test_a_path_that_begins_at_the_package(lamp: Path, path: str) -> None:
    """How the launch file has to write it is told."""
    file = lamp / "launch" / "a.launch.xml"
    file.write_text(XML.format(name="blink", path=path))
    (told,) = load(file, [], {}).remarks
    place = path if path == "lamp.yaml" else f"src/lamp/launch/{path}"  # a folder that is there is a better one
    assert told.endswith(f"there is no file {place}; write $(find-pkg-share lamp)/config/lamp.yaml")
    right = "get_package_share_directory('lamp') + '/config/lamp.yaml'"
    assert in_launch_file(file.parent / path, file.with_suffix(".py")) == right


def test_a_file_that_the_package_does_not_have(lamp: Path) -> None:
    """Is named alone."""
    (lamp / "launch" / "a.launch.xml").write_text(XML.format(name="blink", path="other.yaml"))
    (told,) = load(lamp / "launch" / "a.launch.xml", [], {}).remarks
    assert told.endswith("there is no file other.yaml")
    (lamp / "launch" / "a.launch.xml").write_text(XML.format(name="blink", path="src/lamp/config/lmp.yaml"))
    (told,) = load(lamp / "launch" / "a.launch.xml", [], {}).remarks
    assert told.endswith("there is no file src/lamp/config/lmp.yaml; did you mean 'lamp.yaml'?")


def test_a_file_for_other_nodes(lamp: Path) -> None:
    """Is told where the launch file gives the node a name; another name may be that of the program."""
    (lamp / "config" / "lamp.yaml").write_text(VALUES.replace("/**", "/lamp"))
    text = XML.format(name="blink", path="src/lamp/config/lamp.yaml")
    (lamp / "launch" / "a.launch.xml").write_text(text)
    assert load(lamp / "launch" / "a.launch.xml", [], {}).remarks == ()
    (lamp / "launch" / "a.launch.xml").write_text(text.replace("exec=", 'name="lamp" namespace="left" exec='))
    (told,) = load(lamp / "launch" / "a.launch.xml", [], {}).remarks
    assert "lamp.yaml has nothing for /left/lamp; did you mean /left/lamp in place of /lamp at " in told


def test_an_executable_that_is_called_as_its_file(lamp: Path) -> None:
    """It starts here; that it does not in ROS 2 is told."""
    (lamp / "launch" / "a.launch.xml").write_text(XML.format(name="blink.py", path="src/lamp/config/lamp.yaml"))
    plan = load(lamp / "launch" / "a.launch.xml", [], {})
    assert plan.nodes[0].command[-1] == "blink"
    (told,) = plan.remarks
    assert told.endswith(": the executable is called blink; ROS 2 finds no blink.py")


def test_a_name_with_a_slash(lamp: Path) -> None:
    """It is a namespace and a name here; that ROS 2 refuses it is told."""
    text = XML.format(name="blink", path="src/lamp/config/lamp.yaml").replace("exec=", 'name="left/lamp" exec=')
    (lamp / "launch" / "a.launch.xml").write_text(text)
    plan = load(lamp / "launch" / "a.launch.xml", [], {})
    assert plan.nodes[0].name == "/left/lamp"
    (told,) = plan.remarks
    assert told.endswith(": ROS 2 takes no / in a node's name: write name 'lamp', and namespace 'left'")

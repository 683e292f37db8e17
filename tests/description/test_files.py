"""Files of robot descriptions, xacro and meshes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from graphflow.description import mesh_file, read_robot
from graphflow.errors import GraphFileError, GraphflowError

XACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:arg name="reach" default="0.5"/>
  <xacro:property name="r" value="$(arg reach)"/>
  <link name="base"/><link name="tip"/>
  <joint name="j" type="fixed"><parent link="base"/><child link="tip"/><origin xyz="${2 * r} 0 0"/></joint>
</robot>"""


def test_urdf(tmp_path: Path) -> None:
    """The text comes with the robot; a missing file is told."""
    file = tmp_path / "r.urdf"
    file.write_text('<robot name="r"><link name="a"/></robot>')
    robot, text = read_robot(file)
    assert (robot.name, list(robot.links), text) == ("r", ["a"], file.read_text())
    with pytest.raises(GraphFileError, match="cannot be read: No such file or directory"):
        read_robot(tmp_path / "no.urdf")
    file.write_bytes(b"\xff")
    with pytest.raises(GraphFileError, match="cannot be read: it is not UTF-8"):
        read_robot(file)


def test_xacro(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Arguments, properties and packages of the workspace are known to it."""
    file = tmp_path / "src" / "parts" / "urdf" / "r.urdf.xacro"
    file.parent.mkdir(parents=True)
    (tmp_path / "src" / "parts" / "package.xml").write_text("<package><name>parts</name></package>")
    file.write_text(XACRO)
    robot, text = read_robot(file)
    assert robot.joints["j"].origin.translation == (1.0, 0.0, 0.0)
    assert "xacro:property" not in text
    assert read_robot(file, {"reach": "1.5"})[0].joints["j"].origin.translation == (3.0, 0.0, 0.0)
    outer = tmp_path / "outer.xacro"
    monkeypatch.chdir(tmp_path)
    outer.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="two">'
        '<xacro:include filename="$(find parts)/urdf/r.urdf.xacro"/></robot>'
    )
    path = list(sys.path)
    assert list(read_robot(outer)[0].links) == ["base", "tip"]
    assert sys.path == path


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (XACRO.replace("2 * r", "2 * s"), "r.xacro:5:85: there is no property .s.; there is r"),
        (XACRO.replace("</robot>", ""), "not valid XML: no element found"),
        (XACRO.replace('type="fixed"', 'type="fix"'), "r.xacro .as xacro expands it.:.*is of no known type: 'fix'"),
    ],
)
def test_mistakes(tmp_path: Path, text: str, said: str) -> None:
    """The error has xacro's reason, or the mistake in what it makes."""
    file = tmp_path / "r.xacro"
    file.write_text(text)
    with pytest.raises(GraphFileError, match=said):
        read_robot(file)
    with pytest.raises(GraphFileError, match="cannot be read: No such file or directory"):
        read_robot(tmp_path / "no.xacro")


def test_without_xacro(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error says what to install."""
    monkeypatch.setitem(sys.modules, "xacro", None)
    (tmp_path / "r.xacro").write_text(XACRO)
    (tmp_path / "r.urdf").write_text(XACRO)  # as TurtleBot3's own description, which has the other ending
    with pytest.raises(GraphflowError, match=r"r.urdf needs"):
        read_robot(tmp_path / "r.urdf")
    with pytest.raises(GraphflowError, match=r"r.xacro needs xacro: pip install .*\[urdf\]"):
        read_robot(tmp_path / "r.xacro")


def test_meshes(tmp_path: Path) -> None:
    """They are found in packages, beside the description, and by their whole path."""
    (tmp_path / "src/p/meshes").mkdir(parents=True)
    (tmp_path / "src/p/package.xml").write_text("<package><name>p</name></package>")
    mesh = tmp_path / "src/p/meshes/m.stl"
    mesh.touch()
    for uri in ("package://p/meshes/m.stl", f"file://{mesh}", "src/p/meshes/m.stl"):
        found = mesh_file(uri, tmp_path)
        assert found is not None
        assert found.resolve() == mesh.resolve()
    assert mesh_file("package://p/meshes/no.stl", tmp_path) is None
    assert mesh_file("package://q/m.stl", tmp_path) is None

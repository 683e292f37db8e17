"""Which file is read how."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.launchfiles.reading import read

NODE = "{pkg: turtlesim, exec: turtlesim_node}"


@pytest.mark.parametrize(
    ("name", "text", "nodes"),
    [
        ("a.yaml", "nodes: {a: {class: x:Y}}", ["a"]),
        ("a.yaml", f"launch: [{{node: {NODE}}}]", ["turtlesim"]),
        ("a.launch", '<launch><node pkg="turtlesim" exec="turtlesim_node" name="s"/></launch>', ["s"]),
        ("a.launch.xml", '<launch><node pkg="turtlesim" exec="turtlesim_node" name="s"/></launch>', ["s"]),
    ],
)
def test_by_name_and_content(tmp_path: Path, name: str, text: str, nodes: list[str]) -> None:
    """XML by its name, ROS's dialect by its key; in the end all are graph files."""
    (tmp_path / name).write_text(text)
    complaints: list[str] = []
    top = read(tmp_path / name, name, lambda _, said: complaints.append(said))
    assert (list(top.entries["nodes"].entries), complaints) == (nodes, [])


def test_python(tmp_path: Path) -> None:
    """It is not run just because somebody looks at it."""
    with pytest.raises(GraphFileError, match="a launch file in Python is converted first"):
        read(tmp_path / "a.launch.py", "a.launch.py", lambda *_: None)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("launch:\n  node: {pkg: a, exec: b}\n", "f.yaml:2:3: launch: expected a list of actions; write - before each"),
        (
            "- node: {pkg: a, exec: b}\n",
            "f.yaml:1:1: a launch file begins with launch:, and its actions are listed below",
        ),
    ],
)
def test_launch_files_that_are_not_recognized(tmp_path: Path, text: str, said: str) -> None:
    """They are no graph files, whose keys would mean nothing to their authors."""
    file = tmp_path / "f.yaml"
    file.write_text(text)
    with pytest.raises(GraphFileError) as caught:
        read(file, "f.yaml", lambda *_: None)
    assert str(caught.value).startswith(said)

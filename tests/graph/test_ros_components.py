"""ROS's component containers; what becomes of whole files is tested with `ros_launch`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.graph import source
from graphflow.graph.ros_components import components
from graphflow.graph.tree import tree

TALKER = "{pkg: composition, plugin: 'composition::Talker'}"


def made(text: str) -> tuple[list[Any], list[str]]:
    complaints: list[str] = []
    item = tree(source.read(text, "f.yaml"))
    found = components(item, Path("/nowhere"), lambda at, said: complaints.append(f"{at}: {said}"))
    return [one.plain() for one in found], complaints


@pytest.mark.parametrize("name", ["name: c", "target: /room/c", "target: c"])
def test_a_component_is_a_node_of_the_process(name: str) -> None:
    """Which is called as the container, without its namespace."""
    found, complaints = made(f"{{{name}, composable_node: [{TALKER}]}}\n")
    assert found == [{"pkg": "composition", "exec": "talker", "process": "c"}]
    assert complaints == []


def test_a_condition_holds_for_all() -> None:
    """Each node has it."""
    found, _ = made(f"{{name: c, if: $(var x), composable_node: [{TALKER}, {TALKER}]}}\n")
    assert [one["if"] for one in found] == ["$(var x)", "$(var x)"]


def test_an_empty_container() -> None:
    """Is nothing."""
    assert made("{name: c}\n") == ([], [])

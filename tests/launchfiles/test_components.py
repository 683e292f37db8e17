"""ROS's component containers; what becomes of whole files is tested with `ros_launch`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.launchfiles.components import components
from graphflow.markup import source
from graphflow.markup.tree import tree

TALKER = "{pkg: composition, plugin: 'composition::Talker'}"


def made(text: str) -> tuple[list[Any], list[str]]:
    complaints: list[str] = []
    item = tree(source.read(text, "f.yaml"))

    def told(at: Place, said: str) -> None:
        complaints.append(f"{at}: {said}")

    found = components(item, Path("/nowhere"), told, lambda at, said: told(at, f"remark: {said}"))
    return [one.plain() for one in found], complaints


@pytest.mark.parametrize("name", ["name: c", "target: /room/c", "target: c"])
def test_a_component_is_a_node_of_the_process(name: str) -> None:
    """Which is called as the container, without its namespace."""
    found, complaints = made(f"{{{name}, composable_node: [{TALKER}]}}\n")
    assert found == [{"pkg": "composition", "exec": "talker", "process": "c"}]
    assert complaints == []


def test_a_component_that_nobody_here_has() -> None:
    """Is left out with a remark, unless one of its package has nearly that name; the others stay."""
    rectify = "{pkg: image_proc, plugin: 'image_proc::RectifyNode'}"
    found, said = made(f"{{name: c, composable_node: [{rectify}, {TALKER}]}}\n")
    assert [one["exec"] for one in found] == ["talker"]
    text = "no node here is the component image_proc::RectifyNode of the package image_proc"
    assert said == [f"f.yaml:1:55: remark: image_proc::RectifyNode is left out: {text}"]
    _, said = made(f"{{name: c, composable_node: [{TALKER.replace('Talker', 'Takler')}]}}\n")
    assert said[0].endswith("the component composition::Takler of the package composition; did you mean 'talker'?")


def test_what_a_container_has_of_its_own() -> None:
    """Is left out, and said so; its nodes stay."""
    found, said = made(f"{{name: c, param: [{{name: a, value: 1}}], composable_node: [{TALKER}]}}\n")
    assert len(found) == 1
    text = "param: left out, since a container is a process that nodes share; write it at the nodes"
    assert said == [f"f.yaml:1:11: remark: {text}"]


def test_a_condition_holds_for_all() -> None:
    """Each node has it."""
    found, _ = made(f"{{name: c, if: $(var x), composable_node: [{TALKER}, {TALKER}]}}\n")
    assert [one["if"] for one in found] == ["$(var x)", "$(var x)"]


def test_a_condition_of_its_own() -> None:
    """A node has it as well as that of the container."""
    own = f"{TALKER[:-1]}, unless: $(var y)}}"
    found, _ = made(f"{{name: c, if: $(var x), composable_node: [{own}]}}\n")
    assert found[0]["if"] == "$(all $(var x) $(not $(var y)))"
    found, _ = made(f"{{name: c, composable_node: [{own}]}}\n")
    assert found[0]["unless"] == "$(var y)"


def test_an_empty_container() -> None:
    """Is nothing."""
    assert made("{name: c}\n") == ([], [])

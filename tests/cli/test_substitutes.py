"""Nodes that replace programs of ROS that graphflow does not have."""

from __future__ import annotations

import pytest

from graphflow.cli.substitutes import PACKAGES, no_package
from tests.cases import slow
from tests.conftest import Machine


@pytest.mark.parametrize(
    ("package", "text"),
    [
        ("rviz2", "there is no package 'rviz2'; in its place: graphflow attach, then :map, :tf"),
        ("turtlebot3_navigation2", "in its place: graphflow up tb_map drive:=false"),
        ("xacro", "there is no package 'xacro'; write it without its package: xacro FILE.urdf.xacro"),
        ("my_robot", ""),
    ],
)
def test_packages(package: str, text: str) -> None:
    """The sentence says what to type."""
    found = no_package(package)
    assert text in found
    assert bool(found) is bool(text)


@slow
@pytest.mark.parametrize(
    "words", [("launch", "turtlebot3_navigation2", "navigation2.launch.py"), ("run", "xacro", "x")]
)
def test_commands(standing: Machine, words: tuple[str, ...]) -> None:
    """Both verbs that take a package give it."""
    assert PACKAGES[words[1]] in standing.look(*words, code=2)

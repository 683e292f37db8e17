"""Simulations by name; what is missing is tested with the node."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from graphflow import GraphFileError, GraphflowError
from graphflow.simulator import SimulatedRobot, simulate


def test_a_bundled_world() -> None:
    """It has its robot."""
    [robot] = simulate("hexagon").robots.values()
    assert isinstance(robot, SimulatedRobot)


def test_no_world() -> None:
    """The error lists those there are."""
    with pytest.raises(GraphflowError, match=r"no world 'moon'; bundled are empty, hexagon, house, maze, two$"):
        simulate("moon")


@pytest.mark.parametrize(
    ("world", "line", "fault"),
    [
        ("boxes: [{at: [0, 0], size: [1, 1, 1], yaw: 0.5}]\nrobots: [{at: [0.1, 0]}]", 2, "(0.1, 0), inside a box"),
        ("cylinders: [{at: [1, 1], radius: 0.5}]\nrobots:\n- {at: [1, 1.4]}", 3, "(1, 1.4), inside a cylinder"),
        ("walls: [{points: [[0, -2], [0, 2]]}]\nrobots: [{at: [0, 0]}]", 2, "(0, 0), inside a wall"),
        ("moving: [{path: [[1, 0], [2, 0]], speed: 0.1}]\nrobots: [{at: [1, 0]}]", 2, "(1, 0), inside an obstacle"),
        ("robots:\n- {name: a}\n- {name: b, at: [0.05, 0]}", 2, "(0, 0), inside the robot 'b'"),
    ],
)
def test_a_robot_inside_something(tmp_path: Path, world: str, line: int, fault: str) -> None:
    """The error is at the line with the robot's place, and names what is there."""
    file = tmp_path / "wrong.yaml"
    file.write_text(world)
    with pytest.raises(GraphFileError) as caught:
        simulate(str(file))
    problem = caught.value.problems[0]
    assert (problem.place.line, problem.message) == (line, f"the robot starts at {fault}")


def test_robots_that_stand_free(tmp_path: Path) -> None:
    """Beside a turned box, and beside each other."""
    file = tmp_path / "free.yaml"
    boxes = "boxes: [{at: [0, 0], size: [4, 0.2, 1], yaw: 1.5708}]\n"
    file.write_text(f"{boxes}robots: [{{name: a, at: [0.4, 0]}}, {{name: b, at: [0.7, 0]}}]")
    assert list(simulate(str(file)).robots) == ["a", "b"]


@pytest.mark.parametrize(
    ("origin", "cells", "fault"),
    [
        ("[50, 50, 0]", "254 " * 16, "(0, 0), outside the map, which reaches from (50, 50) to (52, 52)"),
        ("[-1, -1, 0]", "0 " * 16, "(0, 0), inside a wall of the map"),
    ],
)
def test_a_robot_off_the_map(tmp_path: Path, origin: str, cells: str, fault: str) -> None:
    """A map has its walls, and its end."""
    (tmp_path / "plan.pgm").write_text(f"P2\n4 4\n255\n{cells}\n")
    file = tmp_path / "plan.yaml"
    ways = "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    file.write_text(f"image: plan.pgm\nresolution: 0.5\norigin: {origin}\n{ways}")
    with pytest.raises(GraphFileError, match=re.escape(f"the robot starts at {fault}")):
        simulate(str(file))

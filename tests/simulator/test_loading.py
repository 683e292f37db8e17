"""Simulations by name; what is missing is tested with the node."""

from __future__ import annotations

import pytest

from graphflow import GraphflowError
from graphflow.simulator import SimulatedRobot, simulate


def test_a_bundled_world() -> None:
    """It has its robot."""
    [robot] = simulate("hexagon").robots.values()
    assert isinstance(robot, SimulatedRobot)


def test_no_world() -> None:
    """The error lists those there are."""
    with pytest.raises(GraphflowError, match=r"no world 'moon'; bundled are empty, hexagon, house, maze, two$"):
        simulate("moon")

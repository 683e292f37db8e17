"""Occupancy grids: conversion to ROS's message and back, and the place of cells."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow.maps import GridMap
from graphflow.maps.grid import UNKNOWN
from graphflow.msgs.nav_msgs.msg import OccupancyGrid


def test_round_trip() -> None:
    """A message gives back cells, resolution and origin, the first row with the smallest y."""
    grid = GridMap(np.array([[0, 100, -1], [50, 0, 0]], np.int8), 0.5, (1.0, -2.0, 0.3))
    message = grid.to_msg("map")
    assert (message.info.width, message.info.height, message.header.frame_id) == (3, 2, "map")
    assert list(message.data) == [0, 100, -1, 50, 0, 0]
    back = GridMap.from_msg(message)
    assert np.array_equal(back.cells, grid.cells)
    assert back.resolution == pytest.approx(0.5)
    assert back.origin == pytest.approx(grid.origin)


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.0])
def test_places(yaw: float) -> None:
    """The centre of each cell is in that cell; places outside are unknown."""
    grid = GridMap(np.arange(12, dtype=np.int8).reshape(3, 4), 0.25, (3.0, -1.0, yaw))
    rows, columns = np.arange(3).repeat(4), np.tile(np.arange(4), 3)
    centres = grid.centres(rows, columns)
    assert np.array_equal(grid.indices(centres), np.stack([rows, columns], axis=-1))
    assert [grid.at(x, y) for x, y in centres] == list(range(12))
    assert grid.at(3.0 - math.cos(yaw) * 0.1, -1.0 - math.sin(yaw) * 0.1) == UNKNOWN
    assert grid.size == (1.0, 0.75)


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("width", 7, "7 x 2 cells has data for 6"),
        ("resolution", 0.0, "cells of a map are 0.0 m wide"),
        ("resolution", math.nan, "cells of a map are nan m wide"),
        ("origin", math.inf, "origin of a map is inf"),
    ],
)
def test_malformed_messages(field: str, value: float, said: str) -> None:
    """The error has the numbers."""
    message: OccupancyGrid = GridMap(np.zeros((2, 3), np.int8), 0.5).to_msg()
    if field == "origin":
        message.info.origin.position.x = value
    else:
        setattr(message.info, field, value)
    with pytest.raises(ValueError, match=said):
        GridMap.from_msg(message)

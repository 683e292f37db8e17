"""Walls from the cells of a map."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow.maps import GridMap
from graphflow.maps.rectangles import rectangles


def test_they_cover_what_is_occupied() -> None:
    """Every occupied cell once, and no other."""
    dice = np.random.default_rng(1)
    cells = np.where(dice.random((30, 40)) < 0.4, 100, 0).astype(np.int8)
    grid = GridMap(cells, 0.1, (-2.0, 1.0, 0.0))
    covered = np.zeros(cells.shape, int)
    for x, y, width, height in rectangles(grid):
        left, low = round((x - width / 2 + 2.0) / 0.1), round((y - height / 2 - 1.0) / 0.1)
        covered[low : low + round(height / 0.1), left : left + round(width / 0.1)] += 1
    assert np.array_equal(covered, (cells == 100).astype(int))


def test_a_wall_is_one() -> None:
    """A straight wall of any thickness is a single rectangle, turned with the map; probable cells count from a half."""
    cells = np.zeros((10, 10), np.int8)
    cells[2:4, 1:9] = 60
    [wall] = rectangles(GridMap(cells, 0.5, (0.0, 0.0, math.pi / 2)))
    assert wall == pytest.approx((-1.5, 2.5, 4.0, 1.0))
    assert rectangles(GridMap(cells, 0.5), 70) == []

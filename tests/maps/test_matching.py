"""Scans in maps: the pose at which a scan's points lie on obstacles is found again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from graphflow.maps.matching import Field, Placement, Window, refine, rotated, search, smoothed

CELL = 0.05
WINDOW = Window(0.2, 0.05, 0.16, 0.02)


def room() -> tuple[Field, NDArray[np.float64]]:
    """A room of 4 m by 3 m around the origin, of which no two walls look alike, and the points that a scan sees."""
    walls = [
        *((x, -1.5) for x in np.arange(-2.0, 2.0, 0.02)),
        *((x, 1.5) for x in np.arange(-2.0, 1.0, 0.02)),
        *((-2.0, y) for y in np.arange(-1.5, 1.5, 0.02)),
        *((1.0, y) for y in np.arange(0.5, 1.5, 0.02)),
    ]
    points = np.array(walls) + 0.025  # the middle of cells
    cells = np.zeros((120, 120))
    places = np.floor((points + 3.0) / CELL).astype(int)
    cells[places[:, 1], places[:, 0]] = 1.0
    return Field(smoothed(cells, 1.0), CELL, -3.0, -3.0), points


@pytest.mark.parametrize("truth", [(0.0, 0.0, 0.0), (0.13, -0.08, 0.1), (-0.2, 0.17, -0.14)])
def test_a_pose_is_found(truth: tuple[float, float, float]) -> None:
    """From a guess that is wrong by up to 20 cm and 9 degrees, to 2 cm and half a degree."""
    field, walls = room()
    seen = rotated(walls - truth[:2], -truth[2])
    found = refine(field, seen, search(field, seen[::3], (0.0, 0.0, 0.0), WINDOW))
    assert (found.x, found.y) == pytest.approx(truth[:2], abs=0.02)
    assert found.yaw == pytest.approx(truth[2], abs=math.radians(0.5))
    assert found.score > 0.9


def test_a_corridor_says_nothing_of_the_way_along_it() -> None:
    """There the guess counts."""
    cells = np.zeros((120, 120))
    cells[[30, 90], :] = 1.0
    field = Field(smoothed(cells, 1.0), CELL, -3.0, -3.0)
    xs = np.arange(-1.0, 1.0, 0.05)
    seen = np.concatenate([np.stack([xs, np.full(len(xs), y)], axis=1) for y in (-1.475, 1.525)])
    found = refine(field, seen, search(field, seen, (0.1, 0.1, 0.0), WINDOW))
    assert found.x == pytest.approx(0.1, abs=0.01)
    assert found.y == pytest.approx(0.0, abs=0.01)


def test_refining_never_makes_it_worse() -> None:
    """From a place without any obstacle nearby it stays there."""
    field, _ = room()
    start = Placement(0.0, 0.0, 0.0, 0.0)
    found = refine(field, np.array([[0.0, 0.1], [0.1, 0.0]]), start)
    assert found[:3] == start[:3]


def test_smoothing() -> None:
    """The highest value stays, falls off evenly, and a thick wall is as high as a thin one."""
    cells = np.zeros((9, 9))
    cells[4, 4] = cells[4, 5] = 1.0
    out = smoothed(cells, 1.0)
    assert out[4, 4] == out[4, 5] == out.max() == 1.0
    assert out[4, 3] == out[3, 4] == pytest.approx(math.exp(-0.5))
    assert out[0, 0] == 0.0

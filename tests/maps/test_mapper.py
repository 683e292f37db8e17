"""Maps from scans: what is free and occupied, where the robot is, and how large a map becomes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from graphflow.maps import Mapper, mapper
from graphflow.maps.grid import UNKNOWN
from graphflow.tf import Pose2D
from tests.cases import slow

HOME = Pose2D(0.0, 0.0, 0.0)
NOTHING = np.zeros((0, 2))


def square(side: float, at: Pose2D) -> NDArray[np.float64]:
    """What a scanner at a pose sees of a square room, less one corner, around the origin."""
    line = np.arange(-side / 2, side / 2, 0.02)
    walls = [(np.full_like(line, -side / 2), line), (line, np.full_like(line, -side / 2))]
    walls += [(np.full_like(line, side / 2), line), (line[: len(line) // 2], np.full(len(line) // 2, side / 2))]
    points = np.concatenate([np.stack(wall, axis=1) for wall in walls]) + 0.02
    back = at.inverse()
    return np.array([(p.x, p.y) for p in (back.of(Pose2D(x, y, 0.0)) for x, y in points)])


def test_one_scan() -> None:
    """Beams clear their way, mark their ends, and tell nothing of what is behind."""
    made = Mapper(0.1)
    made.add(np.array([[1.05, 0.05]] * 3), np.array([[0.05, -2.0]]), HOME, HOME)
    grid = made.map()
    assert grid.at(0.55, 0.05) < 50 < grid.at(1.05, 0.05)
    assert grid.at(1.35, 0.05) == UNKNOWN
    assert grid.at(0.05, -1.75) < 50
    assert made.drawn == 1


def test_a_standing_robot_draws_once() -> None:
    """Scans of the same place would only harden the map."""
    made = Mapper()
    for _ in range(3):
        made.add(square(4.0, HOME), NOTHING, HOME, HOME)
    assert made.drawn == 1
    assert made.score > 0.9


@slow
def test_the_odometry_is_corrected() -> None:
    """An odometry that turns too far and drives too short is found out, scan by scan."""
    made = Mapper()
    for step in range(20):
        truth = Pose2D(0.03 * step, 0.01 * step, 0.02 * step)
        wrong = Pose2D(0.025 * step, 0.01 * step, 0.026 * step)
        found = made.add(square(4.0, truth), NOTHING, wrong, HOME)
        assert math.hypot(found.x - truth.x, found.y - truth.y) < 0.05
        assert abs(found.yaw - truth.yaw) < math.radians(2)
    assert abs(made.correction.yaw) > 0.08


def test_a_scanner_that_is_mounted_aside() -> None:
    """Its pose on the robot counts."""
    scanner = Pose2D(-0.1, 0.05, math.pi / 2)
    made = Mapper()
    found = made.add(square(4.0, scanner), NOTHING, HOME, scanner)
    assert found == HOME
    assert made.map().at(2.02, 0.5) > 50


def test_a_scan_that_fits_nowhere_is_not_believed() -> None:
    """The odometry then counts."""
    made = Mapper()
    made.add(square(4.0, HOME), NOTHING, HOME, HOME)
    far = np.stack([np.linspace(-1, 1, 50), np.full(50, 0.4)], axis=1)
    assert made.add(far, NOTHING, Pose2D(0.1, 0.0, 0.0), HOME) == Pose2D(0.1, 0.0, 0.0)
    assert made.score < mapper.ENOUGH


def test_a_map_grows_and_is_cut() -> None:
    """It keeps what it has, and shows its known part only."""
    made = Mapper(0.1)
    made.add(np.array([[1.05, 0.05]]), NOTHING, HOME, HOME)
    made.add(np.array([[1.05, 0.05]]), NOTHING, Pose2D(30.0, -20.0, 0.0), HOME)
    grid = made.map()
    assert grid.at(1.05, 0.05) > 50
    assert grid.at(31.05, -19.95) > 50
    assert grid.size == pytest.approx((31.1, 20.1), abs=0.2)


def test_the_size_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """A scan from too far away is left out."""
    monkeypatch.setattr(mapper, "CELLS_BOUND", 200 * 200)
    made = Mapper(0.1)
    made.add(np.array([[1.0, 0.0]]), NOTHING, HOME, HOME)
    assert not made.is_full
    made.add(np.array([[1.0, 0.0]]), NOTHING, Pose2D(1e6, 0.0, 0.0), HOME)
    assert made.is_full
    assert made.drawn == 1


def test_an_empty_map() -> None:
    """It is one unknown cell; so it is after `clear`."""
    made = Mapper()
    assert made.map().cells.tolist() == [[UNKNOWN]]
    made.add(square(4.0, HOME), NOTHING, Pose2D(1.0, 1.0, 1.0), HOME)
    made.clear()
    assert made.map().cells.tolist() == [[UNKNOWN]]
    assert made.correction == HOME

"""A map from scans: each cell's log-odds of being occupied, and the correction of the odometry by the map.

Source: S. Thrun, W. Burgard and D. Fox, Probabilistic Robotics, MIT Press 2005, chapters 6 and 9.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from graphflow.maps.grid import CELLS_BOUND, UNKNOWN, GridMap
from graphflow.maps.matching import Field, Placement, Window, refine, rotated, search, smoothed
from graphflow.tf.planar import Pose2D

HIT, MISS = 0.85, -0.2
"""Log-odds that a beam which ends in a cell, or passes it, adds."""
MOST = 8.0
"""Log-odds of a cell, at most in both directions, so that a map can still be changed."""
GROWTH = 5.0
"""Metres by which a map grows beyond a scan that leaves it."""
SMEAR = 0.035
"""Standard deviation in metres by which obstacles are smeared for the matching."""
WINDOW = Window(0.20, 0.05, 0.16, 0.02)
"""The error that the odometry may have between two scans."""
ENOUGH = 0.3
"""The score from which a placement counts as found."""
FEWEST = 20
"""Points of a scan below which it says too little."""
SETTLING = 0.6
"""Metres at the beginning in which the map is aligned to the odometry, which is exact to millimetres over so short a
way. The matching alone would place the map up to half a cell beside, since obstacles are drawn as whole cells."""
SHARE = 0.8
"""Share of a cell by which the map may lie beside, at most."""
MOVED, TURNED = 0.05, 0.05
"""Metres and radians after which a scan is drawn into the map; those of a standing robot would only harden it."""


class Mapper:
    """Builds a map from scans, and finds the robot's place in it.

    Args:
        resolution: The size of a cell in metres.

    Attributes:
        score: That of the latest matching, from 0 to 1; 0 if there was none.
        drawn: The number of scans in the map.
    """

    def __init__(self, resolution: float = 0.05) -> None:
        self.resolution = resolution
        self.clear()

    def clear(self) -> None:
        """Forget the map and the correction."""
        self._correction = Pose2D(0.0, 0.0, 0.0)
        """The pose of the odometry's frame among the cells."""
        self._beside = np.zeros(2)
        """The place of the map's frame among the cells."""
        self._settled: list[tuple[float, float]] = []
        """Differences between the matching and the odometry at the beginning."""
        self._way, self._before = 0.0, Pose2D(0.0, 0.0, 0.0)
        self.score, self.drawn = 0.0, 0
        self._odds = np.zeros((0, 0), np.float32)
        self._corner = 0, 0
        """The column and row of the first cell, counted from the map's origin."""
        self._latest: Pose2D | None = None
        self._is_full = False

    def add(self, points: NDArray[np.float64], free: NDArray[np.float64], odometry: Pose2D, scanner: Pose2D) -> Pose2D:
        """Take a scan; returns the robot's pose in the map.

        Args:
            points: The places where beams ended, of shape (n, 2), in metres in the scanner's frame.
            free: The farthest known free points of the other beams, of shape (m, 2).
            odometry: The robot's pose by its odometry at the scan's time.
            scanner: The scanner's pose on the robot.
        """
        robot = self._correction.of(odometry)
        on_robot = rotated(points, scanner.yaw) + np.array([scanner.x, scanner.y])
        if self.drawn and len(points) >= FEWEST:
            found = self._match(on_robot, robot)
            self.score = found.score
            if found.score >= ENOUGH:
                robot = Pose2D(found.x, found.y, math.remainder(found.yaw, math.tau))
                self._correction = robot.of(odometry.inverse())
                self._settle(robot, odometry)
        if self._has_moved(robot):
            self._latest = robot
            self._draw(on_robot, rotated(free, scanner.yaw) + np.array([scanner.x, scanner.y]), robot, scanner)
        return self._in_map(robot)

    @property
    def correction(self) -> Pose2D:
        """The pose of the odometry's frame in the map's."""
        return self._in_map(self._correction)

    def _in_map(self, pose: Pose2D) -> Pose2D:
        return Pose2D(pose.x - float(self._beside[0]), pose.y - float(self._beside[1]), pose.yaw)

    def _settle(self, robot: Pose2D, odometry: Pose2D) -> None:
        """Align the map's frame to the odometry while the robot is near its start."""
        if self._settled:
            self._way += math.hypot(odometry.x - self._before.x, odometry.y - self._before.y)
        self._before = odometry
        beside = robot.x - odometry.x, robot.y - odometry.y
        # A greater difference is an error of the odometry.
        if self._way < SETTLING and max(map(abs, beside)) < SHARE * self.resolution:
            self._settled.append(beside)
            # The first matches still move the cells.
            self._beside = np.mean(self._settled[len(self._settled) // 2 :], axis=0)

    def _has_moved(self, robot: Pose2D) -> bool:
        last = self._latest
        if last is None:
            return True
        turned = abs(math.remainder(robot.yaw - last.yaw, math.tau))
        return math.hypot(robot.x - last.x, robot.y - last.y) >= MOVED or turned >= TURNED

    def _match(self, points: NDArray[np.float64], guess: Pose2D) -> Placement:
        reach = float(np.abs(points).max()) * math.sqrt(2) + WINDOW.reach
        field = self._field(guess, reach)
        # The search needs few points only.
        some = points[:: max(1, len(points) // 120)]
        return refine(field, points, search(field, some, (guess.x, guess.y, guess.yaw), WINDOW))

    def _field(self, middle: Pose2D, reach: float) -> Field:
        """Return the smeared obstacles around a place, in a window that reaches so far to each side."""
        column, row = self._corner
        left, low = (math.floor((at - reach) / self.resolution) for at in (middle.x, middle.y))
        size = math.ceil(2 * reach / self.resolution) + 1
        window = np.zeros((size, size))
        # The part of the window that is in the map
        height, width = self._odds.shape
        west, south = max(left, column), max(low, row)
        east, north = min(left + size, column + width), min(low + size, row + height)
        if west < east and south < north:
            part = self._odds[south - row : north - row, west - column : east - column]
            window[south - low : north - low, west - left : east - left] = (part / HIT).clip(0.0, 1.0)
        return Field(
            smoothed(window, SMEAR / self.resolution), self.resolution, left * self.resolution, low * self.resolution
        )

    def _draw(self, points: NDArray[np.float64], free: NDArray[np.float64], robot: Pose2D, scanner: Pose2D) -> None:
        """Add a scan to the map, with points in the robot's frame."""
        eye = robot.of(scanner)
        ends = rotated(points, robot.yaw) + np.array([robot.x, robot.y])
        passed = rotated(free, robot.yaw) + np.array([robot.x, robot.y])
        if not self._grow(np.concatenate([ends, passed, [[eye.x, eye.y]]])):
            return
        column, row = self._corner
        crossed = self._crossed(np.array([eye.x, eye.y]), np.concatenate([ends, passed]))
        width = self._odds.shape[1]
        hit = np.unique(self._flat(ends, column, row, width))
        missed = np.setdiff1d(np.unique(self._flat(crossed, column, row, width)), hit, assume_unique=True)
        odds = self._odds.ravel()
        odds[hit] = np.minimum(odds[hit] + HIT, MOST)
        odds[missed] = np.maximum(odds[missed] + MISS, -MOST)
        self.drawn += 1

    def _crossed(self, eye: NDArray[np.float64], ends: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points along the beams, half a cell apart, up to a cell before their ends."""
        way = ends - eye
        lengths = np.hypot(way[:, 0], way[:, 1])
        longest = float(lengths.max(initial=0.0))
        steps = np.arange(0.0, longest, self.resolution / 2)
        share = steps[None, :] / np.maximum(lengths, 1e-9)[:, None]
        inside = steps[None, :] < (lengths - self.resolution)[:, None]
        return (eye + way[:, None, :] * share[:, :, None])[inside]

    def _flat(self, points: NDArray[np.float64], column: int, row: int, width: int) -> NDArray[np.int64]:
        """Return the indices of the cells of points in the flat map."""
        columns = np.floor(points[:, 0] / self.resolution).astype(np.int64) - column
        rows = np.floor(points[:, 1] / self.resolution).astype(np.int64) - row
        return rows * width + columns

    def _grow(self, points: NDArray[np.float64]) -> bool:
        """Make the map large enough for points; False if it would become too large."""
        low = np.floor(points.min(axis=0) / self.resolution).astype(int)
        high = np.floor(points.max(axis=0) / self.resolution).astype(int) + 1
        height, width = self._odds.shape
        column, row = self._corner
        if width and low[0] >= column and low[1] >= row and high[0] <= column + width and high[1] <= row + height:
            return True
        margin = math.ceil(GROWTH / self.resolution)
        left, bottom = (int(low[0]) - margin, int(low[1]) - margin)
        right, top = (int(high[0]) + margin, int(high[1]) + margin)
        if width:
            left, bottom = min(left, column), min(bottom, row)
            right, top = max(right, column + width), max(top, row + height)
        if (right - left) * (top - bottom) > CELLS_BOUND:
            self._is_full = True
            return False
        grown = np.zeros((top - bottom, right - left), np.float32)
        if width:
            grown[row - bottom : row - bottom + height, column - left : column - left + width] = self._odds
        self._odds, self._corner = grown, (left, bottom)
        return True

    @property
    def is_full(self) -> bool:
        """Whether a scan was left out because the map would have become too large."""
        return self._is_full

    def map(self) -> GridMap:
        """Return the map, cut to its known part."""
        known = self._odds != 0.0
        rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
        if not len(rows):
            return GridMap(np.full((1, 1), UNKNOWN, np.int8), self.resolution)
        part = self._odds[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        share = 1.0 / (1.0 + np.exp(-part))
        cells = np.where(part == 0.0, UNKNOWN, np.round(100.0 * share)).astype(np.int8)
        column, row = self._corner
        x, y = (column + int(columns[0])) * self.resolution, (row + int(rows[0])) * self.resolution
        return GridMap(cells, self.resolution, (x - float(self._beside[0]), y - float(self._beside[1]), 0.0))

"""The place of a scan in a map: the pose near a guess at which its points lie best on obstacles.

A correlative search tries every pose around the guess, so that it cannot end on a wrong hill of the score. A few
Gauss-Newton steps then find the place within a cell.

Source: E. Olson, Real-Time Correlative Scan Matching, ICRA 2009; S. Kohlbrecher et al., A Flexible and Scalable SLAM
System with Full 3D Motion Estimation, SSRR 2011.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

REFINEMENTS = 8
"""Gauss-Newton steps, at most."""


class Placement(NamedTuple):
    """A pose in the map: x, y in metres, yaw in radians.

    Attributes:
        score: The share of the scan's points that lie on obstacles, from 0 to 1, soft.
    """

    x: float
    y: float
    yaw: float
    score: float


@dataclass(frozen=True, slots=True)
class Window:
    """A search around a guess.

    Attributes:
        reach, turn: Metres to each side along x and y, and radians to each side.
        step, turn_step: Between two tries.
    """

    reach: float
    step: float
    turn: float
    turn_step: float


@dataclass(frozen=True, slots=True)
class Field:
    """The likelihood of obstacles, smoothed: of shape (height, width), with the place of the first cell's corner.

    It has a margin around all places that are looked at.
    """

    values: NDArray[np.float64]
    resolution: float
    x: float
    y: float

    def look(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the values at points of shape (..., 2), each that of its cell."""
        columns = ((points[..., 0] - self.x) / self.resolution).astype(np.int64)
        rows = ((points[..., 1] - self.y) / self.resolution).astype(np.int64)
        # `take` on the flat array is several times as fast as indexing by rows and columns.
        return np.asarray(self.values.ravel().take(rows * self.values.shape[1] + columns, mode="clip"))

    def slopes(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return values and gradients at points of shape (n, 2), interpolated between cells; gradients per metre."""
        height, width = self.values.shape
        u = ((points[:, 0] - self.x) / self.resolution - 0.5).clip(0, width - 1.001)
        v = ((points[:, 1] - self.y) / self.resolution - 0.5).clip(0, height - 1.001)
        i, j = u.astype(np.int64), v.astype(np.int64)
        a, b = u - i, v - j
        low, right = self.values[j, i], self.values[j, i + 1]
        up, both = self.values[j + 1, i], self.values[j + 1, i + 1]
        value = (1 - b) * ((1 - a) * low + a * right) + b * ((1 - a) * up + a * both)
        along_x = ((1 - b) * (right - low) + b * (both - up)) / self.resolution
        along_y = ((1 - a) * (up - low) + a * (both - right)) / self.resolution
        return value, np.stack([along_x, along_y], axis=1)


def search(field: Field, points: NDArray[np.float64], guess: tuple[float, float, float], window: Window) -> Placement:
    """Try all poses of a window around a guess; returns the best one.

    Args:
        points: The scan's points in the robot's frame, of shape (n, 2), in metres.
    """
    x, y, yaw = guess
    offsets = np.arange(-round(window.reach / window.step), round(window.reach / window.step) + 1) * window.step
    grid = np.stack(np.meshgrid(offsets, offsets, indexing="ij"), axis=-1).reshape(-1, 1, 2)
    far = np.hypot(grid[:, 0, 0], grid[:, 0, 1])
    best = Placement(x, y, yaw, -1.0)
    most = round(window.turn / window.turn_step)
    for index in sorted(range(-most, most + 1), key=abs):
        turn = index * window.turn_step
        placed = rotated(points, yaw + turn) + np.array([x, y])
        # Of poses with nearly the same score, that which is nearest to the guess: a bare corridor says nothing of
        # the way along it, and the odometry is then the better witness.
        scores = (
            field.look(placed + grid).mean(axis=1) - 0.02 * far / (window.reach or 1) - 0.02 * abs(index) / max(most, 1)
        )
        at = int(scores.argmax())
        if scores[at] > best.score:
            dx, dy = grid[at, 0]
            best = Placement(x + float(dx), y + float(dy), yaw + turn, float(scores[at]))
    return best


def refine(field: Field, points: NDArray[np.float64], start: Placement) -> Placement:
    """Climb from a pose to the nearby one with the best score."""
    x, y, yaw, _ = start
    best = start._replace(score=-1.0)
    for _ in range(REFINEMENTS):
        placed = rotated(points, yaw) + np.array([x, y])
        value, slope = field.slopes(placed)
        score = float(value.mean())
        if score <= best.score:
            break
        best = Placement(x, y, yaw, score)
        # The derivative of a placed point with respect to the yaw is the point, turned by 90 degrees.
        arm = placed - (x, y)
        around = slope[:, 1] * arm[:, 0] - slope[:, 0] * arm[:, 1]
        jacobian = np.column_stack([slope, around])
        # Damped, since directions that the scan says nothing of would otherwise be free.
        normal = jacobian.T @ jacobian + np.diag([1.0, 1.0, 0.1])
        step = np.linalg.solve(normal, jacobian.T @ (1.0 - value))
        x, y, yaw = x + float(step[0]), y + float(step[1]), yaw + float(step[2])
    return best


def rotated(points: NDArray[np.float64], yaw: float) -> NDArray[np.float64]:
    """Rotate points of shape (n, 2)."""
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return np.asarray(points @ np.array([[cosine, sine], [-sine, cosine]]))


def smoothed(occupied: NDArray[np.float64], sigma: float) -> NDArray[np.float64]:
    """Smooth values by a Gaussian of `sigma` cells, of which the highest stays 1: (height, width) to the same."""
    reach = max(1, math.ceil(2.5 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    out = occupied
    for axis in (0, 1):
        # The maximum of neighbours, not their sum: a thick wall then counts no more than a thin one.
        padded = np.pad(out, [(reach, reach) if a == axis else (0, 0) for a in (0, 1)])
        out = np.zeros_like(occupied)
        size = occupied.shape[axis]
        for shift, weight in enumerate(kernel):
            part = padded[shift : shift + size] if axis == 0 else padded[:, shift : shift + size]
            np.maximum(out, weight * part, out=out)
    return out

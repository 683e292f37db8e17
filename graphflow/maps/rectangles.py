"""Occupied cells of a map as rectangles, of which a simulator builds walls."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from graphflow.maps.grid import GridMap


class Rectangle(NamedTuple):
    """A rectangle of occupied cells: its centre in metres in the map's frame, and its size before rotation."""

    x: float
    y: float
    width: float
    height: float


def rectangles(grid: GridMap, occupied: int = 50) -> list[Rectangle]:
    """Cover the occupied cells with rectangles, each as long and then as high as it can be; none overlaps another.

    Args:
        occupied: The value from which a cell counts as occupied, in percent.
    """
    left = grid.cells >= occupied
    rows, columns = left.shape
    found = []
    for row in range(rows):
        column = 0
        while column < columns:
            if not left[row, column]:
                column += 1
                continue
            free = np.flatnonzero(~left[row, column:])
            end = column + (int(free[0]) if len(free) else columns - column)
            top = row + 1
            while top < rows and left[top, column:end].all():
                top += 1
            left[row:top, column:end] = False
            middle = grid.centres(np.array([(row + top - 1) / 2]), np.array([(column + end - 1) / 2]))[0]
            size = (end - column) * grid.resolution, (top - row) * grid.resolution
            found.append(Rectangle(float(middle[0]), float(middle[1]), *size))
            column = end
    return found

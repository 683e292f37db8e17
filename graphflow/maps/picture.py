"""Pictures of maps: as characters for a terminal, and as PNG files."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from graphflow.errors import MapFileError
from graphflow.maps.grid import UNKNOWN, GridMap

WALL, OPEN = 50, 25
"""Values above which a cell is drawn as occupied, and up to which as free."""
_BLOCKS = {(True, True): "█", (True, False): "▀", (False, True): "▄"}


def text(grid: GridMap, width: int, height: int) -> list[str]:
    """Draw a map in lines of characters: obstacles as blocks, free cells as dots, unknown ones as spaces.

    Args:
        width, height: The most columns and lines; a character is twice as high as wide.
    """
    rows, columns = grid.cells.shape
    step = max(1, math.ceil(columns / max(1, width)), math.ceil(rows / max(1, 2 * height)))
    walls, free = _reduced(grid.cells > WALL, step), _reduced((grid.cells >= 0) & (grid.cells <= OPEN), step)
    lines = []
    for row in range(len(walls) - 1, -1, -2):
        below = row - 1 if row else None
        line = ""
        for column in range(walls.shape[1]):
            pair = bool(walls[row, column]), below is not None and bool(walls[below, column])
            is_free = free[row, column] or (below is not None and free[below, column])
            line += _BLOCKS.get(pair, "·" if is_free else " ")
        lines.append(line.rstrip())
    return lines


def _reduced(cells: NDArray[np.bool_], step: int) -> NDArray[np.bool_]:
    """Join squares of cells: one is true if any of its cells is."""
    rows, columns = (-(-size // step) * step for size in cells.shape)
    padded = np.zeros((rows, columns), np.bool_)
    padded[: cells.shape[0], : cells.shape[1]] = cells
    squares = padded.reshape(rows // step, step, columns // step, step)
    return np.asarray(squares.any(axis=(1, 3)))


def described(grid: GridMap) -> str:
    """Say how large a map is, and how much of it is known."""
    height, width = grid.cells.shape
    across, along = grid.size
    known = float((grid.cells != UNKNOWN).mean())
    x, y, _ = grid.origin
    return (
        f"{width} x {height} cells of {grid.resolution:g} m: {across:.1f} m x {along:.1f} m from ({x:.2f}, {y:.2f}), "
        f"{known:.0%} known"
    )


def write_picture(grid: GridMap, file: Path) -> None:
    """Write a map as a picture: dark obstacles, white free space, grey where nothing is known.

    Raises:
        MapFileError: It cannot be written, or the name has no ending of a picture.
    """
    from PIL import Image

    values = grid.cells[::-1].astype(np.float64)
    grey = np.where(values < 0, 205.0, 254.0 * (1.0 - values.clip(0, 100) / 100.0)).astype(np.uint8)
    try:
        Image.fromarray(grey).save(file)
    except OSError as error:
        raise MapFileError(f"cannot write {file}: {error.strerror or error}") from None
    except ValueError as error:  # the name has no ending of a picture
        raise MapFileError(f"cannot write {file}: {error}") from None

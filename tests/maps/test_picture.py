"""Pictures of maps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from graphflow.errors import MapFileError
from graphflow.maps import GridMap
from graphflow.maps.picture import described, text, write_picture

GRID = GridMap(np.array([[100, 100, 100], [100, 0, -1], [100, 0, -1]], np.int8), 0.5, (1.0, 2.0, 0.0))


def test_as_characters() -> None:
    """Two rows of cells are a line, the largest y first; obstacles are blocks, free cells dots."""
    assert text(GRID, 80, 24) == ["█·", "▀▀▀"]


def test_a_small_terminal() -> None:
    """Cells are joined until the map fits; an obstacle stays one."""
    assert text(GridMap(np.zeros((40, 100), np.int8), 0.05), 50, 24) == ["·" * 50] * 10
    walls = np.zeros((64, 64), np.int8)
    walls[5, 5] = 100
    assert (
        "".join(text(GridMap(walls, 0.05), 16, 8)).count("▄") + "".join(text(GridMap(walls, 0.05), 16, 8)).count("▀")
        == 1
    )


def test_in_words() -> None:
    """Its size, its place and how much is known."""
    assert described(GRID) == "3 x 3 cells of 0.5 m: 1.5 m x 1.5 m from (1.00, 2.00), 78% known"


def test_as_a_file(tmp_path: Path) -> None:
    """Dark obstacles, light free cells, grey for the unknown."""
    write_picture(GRID, tmp_path / "m.png")
    with Image.open(tmp_path / "m.png") as image:
        assert np.asarray(image).tolist() == [[0, 254, 205], [0, 254, 205], [0, 0, 0]]
    for name, said in (("m.nothing", "unknown file extension"), ("no/m.png", "No such file")):
        with pytest.raises(MapFileError, match=said):
            write_picture(GRID, tmp_path / name)

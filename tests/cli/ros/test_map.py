"""`graphflow map`, and ROS's words for it, between processes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from graphflow.maps import GridMap, read_map, write_map
from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


def written(file: Path) -> Path:
    cells = np.zeros((4, 6), np.int8)
    cells[0] = 100
    return write_map(GridMap(cells, 0.5, (-1.0, 0.0, 0.0)), file)[0]


@slow
def test_shown_and_saved(machine: Machine, tmp_path: Path) -> None:
    """A map that is served is drawn, and saved again as it was."""
    file = written(tmp_path / "house")
    server = machine.start("run", "nav2_map_server", "map_server", "--ros-args", "-p", f"yaml_filename:={file}")
    server.wait_for("house.yaml: 6 x 4 cells of 0.5 m")
    shown = machine.look("map", "show")
    assert "······\n▄▄▄▄▄▄\n" in shown
    assert "6 x 4 cells of 0.5 m: 3.0 m x 2.0 m from (-1.00, 0.00), 100% known" in shown
    assert "wrote " in machine.look("map", "save", str(tmp_path / "copy"), "--fmt", "png")
    assert np.array_equal(read_map(tmp_path / "copy.yaml").cells, read_map(file).cells)
    assert server.end() == 0


def test_files_and_mistakes(machine: Machine, tmp_path: Path) -> None:
    """A file needs no graph; each mistake is answered with what to write."""
    file = written(tmp_path / "house")
    assert "▄▄▄▄▄▄" in machine.look("map", "show", str(file))
    assert "wrote " in machine.look("map", "show", str(file), "-o", str(tmp_path / "m.png"))
    assert "give the map's YAML file, such as house.yaml" in machine.look(
        "map", "show", str(tmp_path / "house.pgm"), code=2
    )
    assert "cannot write" in machine.look("map", "show", str(file), "-o", str(tmp_path / "m.x"), code=1)
    assert "--free 0.9 is not below --occ 0.65" in machine.look("map", "save", "x", "--free", "0.9", code=2)
    (tmp_path / "house.pgm").unlink()
    assert "house.yaml:1:8: there is no picture" in machine.look("map", "show", str(file), code=2)


@slow
def test_without_a_map(machine: Machine) -> None:
    """The verb says where it looked, and ends with the code for a timeout."""
    machine.start("run", "nodes.talker:Talker").wait_for("Publishing")
    assert "no map on /map in 5 s" in machine.look("map", "save", "x", code=4)

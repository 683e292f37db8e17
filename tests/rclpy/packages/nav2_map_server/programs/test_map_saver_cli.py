"""The map saver, between processes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from graphflow.maps import GridMap, read_map, write_map
from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_a_map_is_saved(machine: Machine, tmp_path: Path) -> None:
    """It is written as it was served; a wrong threshold is refused."""
    file = write_map(GridMap(np.zeros((4, 6), np.int8), 0.5), tmp_path / "house")[0]
    server = machine.start("run", "nav2_map_server", "map_server", "--ros-args", "-p", f"yaml_filename:={file}")
    server.wait_for("6 x 4 cells")
    saver = ("run", "nav2_map_server", "map_saver_cli", "-f", str(tmp_path / "copy"))
    machine.start(*saver).wait_for("Map saved: ")
    assert np.array_equal(read_map(tmp_path / "copy.yaml").cells, read_map(file).cells)
    assert "--free 0.9 is not below --occ 0.65" in machine.run(*saver, "--free", "0.9", code=2)
    assert server.end() == 0

"""The map server: its map, other maps, and files that cannot be read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from graphflow import RemoteError
from graphflow.maps import GridMap, write_map
from graphflow.msgs.nav2_msgs.srv import LoadMap
from graphflow.msgs.nav_msgs.msg import OccupancyGrid
from graphflow.msgs.nav_msgs.srv import GetMap
from graphflow.qos import LATCHED
from graphflow.testing import Graph
from nodes.map_server import MapServer


def written(file: Path, width: int) -> Path:
    return write_map(GridMap(np.zeros((2, width), np.int8), 0.1), file)[0]


async def test_maps(graph: Graph, tmp_path: Path) -> None:
    """The first is there at once, another replaces it, and a file that is missing or wrong changes nothing."""
    first, second = written(tmp_path / "a", 3), written(tmp_path / "b", 5)
    server = MapServer(yaml_filename=str(first))
    await graph.start(server)
    maps = graph.tap(OccupancyGrid, "/map", LATCHED)
    await graph.settle()
    assert (maps.latest.info.width, maps.latest.header.frame_id) == (3, "map")
    result = await graph.call(LoadMap, "/map_server/load_map", LoadMap.Request(map_url=f"file://{second}"))
    assert (result.result, result.map.info.width) == (LoadMap.Response.RESULT_SUCCESS, 5)
    missing = await graph.call(LoadMap, "/map_server/load_map", LoadMap.Request(map_url=str(tmp_path / "c.yaml")))
    assert missing.result == LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST
    second.write_text("image: [\n")
    wrong = await graph.call(LoadMap, "/map_server/load_map", LoadMap.Request(map_url=str(second)))
    assert wrong.result == LoadMap.Response.RESULT_INVALID_MAP_DATA
    kept = await graph.call(GetMap, "/map_server/map", GetMap.Request())
    assert kept.map.info.width == 5
    assert len(maps) == 2


async def test_without_a_map(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The service says how to load one; topic and frame are parameters."""
    server = MapServer(topic_name="plan_of_house", frame_id="world")
    await graph.start(server)
    assert server.maps.name == "/plan_of_house"
    assert "there is no map yet: start with -p yaml_filename:=house.yaml, or call load_map" in caplog.text
    with pytest.raises(RemoteError, match="no map has been loaded yet: call load_map"):
        await graph.call(GetMap, "/map_server/map", GetMap.Request())

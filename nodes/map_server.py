"""A map from a file, on the topic `map`, as Navigation2's map_server publishes it.

graphflow run nav2_map_server map_server --ros-args -p yaml_filename:=house.yaml
"""

from __future__ import annotations

from pathlib import Path

import graphflow
from graphflow import GraphFileError, Node, Param, service
from graphflow.maps import GridMap, read_map
from graphflow.msgs.nav2_msgs.srv import LoadMap
from graphflow.msgs.nav_msgs.msg import OccupancyGrid
from graphflow.msgs.nav_msgs.srv import GetMap
from graphflow.qos import LATCHED


class MapServer(Node):
    """Publish a map once; late subscribers get it, too."""

    dynamic_names = True

    yaml_filename = Param("", read_only=True, doc="The path of the map's YAML file; none to wait for load_map.")
    topic_name = Param("map", read_only=True, doc="The topic of the map.")
    frame_id = Param("map", read_only=True, doc="The frame of the map.")
    grid: GridMap | None = None

    async def on_start(self) -> None:
        self.maps = self.create_publisher(OccupancyGrid, self.topic_name, LATCHED)
        if self.yaml_filename:
            self.show(self.yaml_filename)
        else:
            self.log.warning("there is no map yet: start with -p yaml_filename:=house.yaml, or call load_map")

    def show(self, file: str) -> OccupancyGrid:
        """Read a map, and publish it. Raises GraphFileError."""
        self.grid = read_map(Path(file).expanduser())
        height, width = self.grid.cells.shape
        self.log.info("%s: %d x %d cells of %g m", file, width, height, self.grid.resolution)
        if remark := self.grid.remark:
            self.log.warning("%s: %s", file, remark)
        message = self.grid.to_msg(self.frame_id, self.clock.now())
        self.maps.publish(message)
        return message

    @service(GetMap, "~/map")
    async def get_map(self, request: GetMap.Request) -> GetMap.Response:
        if self.grid is None:
            raise ValueError("no map has been loaded yet: call load_map, or set yaml_filename")
        return GetMap.Response(map=self.grid.to_msg(self.frame_id, self.clock.now()))

    @service(LoadMap, "~/load_map")
    async def load_map(self, request: LoadMap.Request) -> LoadMap.Response:
        """Take another map; the node keeps its own if that cannot be read."""
        file = request.map_url.removeprefix("file://")
        if not Path(file).expanduser().is_file():
            self.log.error("there is no file %s", file)
            return LoadMap.Response(result=LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST)
        try:
            return LoadMap.Response(map=self.show(file), result=LoadMap.Response.RESULT_SUCCESS)
        except GraphFileError as error:
            self.log.error("%s", error)
            return LoadMap.Response(result=LoadMap.Response.RESULT_INVALID_MAP_DATA)


if __name__ == "__main__":
    graphflow.run(MapServer)

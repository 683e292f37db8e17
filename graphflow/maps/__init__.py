"""Occupancy grids: ROS's map files, mapping with a laser scanner, and pictures.

Read `grid` first: the cells of a map and their place. `files` reads and writes the map files of ROS's map_server,
`mapper` builds a map from scans and corrects the odometry by it, `matching` finds the place of a scan in a map, and
`picture` draws maps. Knows no node; the nodes are `nodes/mapper.py` and `nodes/map_server.py`. May import `tf` and
everything below the runtime.
"""

from graphflow.maps.files import read_map, write_map
from graphflow.maps.grid import GridMap
from graphflow.maps.mapper import Mapper

__all__ = ["GridMap", "Mapper", "read_map", "write_map"]

"""An occupancy grid: cells of the floor that are free, occupied or unknown."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from graphflow.msgs.geometry_msgs.msg import Point, Pose, Quaternion
from graphflow.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid
from graphflow.msgs.std_msgs.msg import Header
from graphflow.times import Time

COARSE = 1.0
"""Metres of a cell from which a map's resolution is doubted."""

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""The values of cells; those between are probabilities of being occupied, in percent."""
CELLS_BOUND = 64_000_000
"""The number of cells of a map, at most: 400 m by 400 m at 5 cm."""


@dataclass(frozen=True, slots=True)
class GridMap:
    """An occupancy grid.

    Attributes:
        cells: Values of shape (height, width), row by row from the smallest y; see `FREE`, `OCCUPIED`, `UNKNOWN`.
        resolution: The size of a cell in metres.
        origin: The place of the outer corner of the first cell: x, y in metres, yaw in radians.

    Source: nav_msgs/msg/OccupancyGrid.
    """

    cells: NDArray[np.int8]
    resolution: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @classmethod
    def from_msg(cls, message: OccupancyGrid) -> GridMap:
        """Convert a `nav_msgs/OccupancyGrid`.

        Raises:
            ValueError: Its cells are not `width` times `height`, or its cells have no size.
        """
        info = message.info
        data = np.asarray(message.data, dtype=np.int8)
        if data.size != info.width * info.height:
            raise ValueError(f"a map of {info.width} x {info.height} cells has data for {data.size:,}")
        if not (math.isfinite(info.resolution) and info.resolution > 0):
            raise ValueError(f"the cells of a map are {info.resolution} m wide")
        turn, at = info.origin.orientation, info.origin.position
        yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
        if not math.isfinite(at.x + at.y + yaw):
            raise ValueError(f"the origin of a map is {at.x}, {at.y}, {yaw}")
        return cls(data.reshape(info.height, info.width), info.resolution, (at.x, at.y, yaw))

    def to_msg(self, frame: str = "map", stamp: Time = Time(0)) -> OccupancyGrid:  # noqa: B008 - frozen
        """Convert to a `nav_msgs/OccupancyGrid`."""
        (x, y, yaw), (height, width) = self.origin, self.cells.shape
        turn = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
        origin = Pose(position=Point(x=x, y=y), orientation=turn)
        info = MapMetaData(map_load_time=stamp, resolution=self.resolution, width=width, height=height, origin=origin)
        return OccupancyGrid(header=Header(stamp=stamp, frame_id=frame), info=info, data=self.cells.ravel())

    @property
    def remark(self) -> str:
        """A sentence if its cells are so large that the resolution is probably in centimetres; else ""."""
        if self.resolution < COARSE:
            return ""
        centimetres = f"{self.resolution / 100:g} for {self.resolution:g} cm"
        return f"cells of {self.resolution:g} m are large: resolution: is in metres, {centimetres}"

    @property
    def size(self) -> tuple[float, float]:
        """Width and height in metres."""
        height, width = self.cells.shape
        return width * self.resolution, height * self.resolution

    def indices(self, points: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return the row and column of points, each of shape (..., 2); outside the map they are out of range."""
        x, y, yaw = self.origin
        moved = points - (x, y)
        cosine, sine = math.cos(yaw), math.sin(yaw)
        turned = moved @ np.array([[cosine, -sine], [sine, cosine]])
        found: NDArray[np.int64] = np.floor(turned / self.resolution).astype(np.int64)[..., ::-1]
        return found

    def centres(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the centres of cells in metres, of shape (..., 2)."""
        x, y, yaw = self.origin
        cosine, sine = math.cos(yaw), math.sin(yaw)
        inside = np.stack([(columns + 0.5) * self.resolution, (rows + 0.5) * self.resolution], axis=-1)
        found: NDArray[np.float64] = inside @ np.array([[cosine, sine], [-sine, cosine]]) + np.array([x, y])
        return found

    def covers(self, x: float, y: float) -> bool:
        """Whether a place is on the map."""
        [[row, column]] = self.indices(np.array([[x, y]]))
        height, width = self.cells.shape
        return bool(0 <= row < height and 0 <= column < width)

    def at(self, x: float, y: float) -> int:
        """Return the value of the cell at a place in metres; `UNKNOWN` outside the map."""
        row, column = self.indices(np.array([x, y], dtype=np.float64))
        height, width = self.cells.shape
        return int(self.cells[row, column]) if 0 <= row < height and 0 <= column < width else UNKNOWN

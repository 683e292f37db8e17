# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.nav_msgs import msg as nav_msgs
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class OccupancyGridUpdate(base.Message):
    header: std_msgs.Header
    x: int
    y: int
    width: int
    height: int
    data: npt.NDArray[np.int8]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        x: int = ...,
        y: int = ...,
        width: int = ...,
        height: int = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class PointCloud2Update(base.Message):
    ADD: ClassVar[Literal[0]]
    DELETE: ClassVar[Literal[1]]
    header: std_msgs.Header
    type: int
    points: sensor_msgs.PointCloud2
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        type: int = ...,
        points: sensor_msgs.PointCloud2 | Mapping[str, object] = ...,
    ) -> None: ...

class ProjectedMap(base.Message):
    map: nav_msgs.OccupancyGrid
    min_z: float
    max_z: float
    def __init__(
        self,
        *,
        map: nav_msgs.OccupancyGrid | Mapping[str, object] = ...,
        min_z: float = ...,
        max_z: float = ...,
    ) -> None: ...

class ProjectedMapInfo(base.Message):
    frame_id: str
    x: float
    y: float
    width: float
    height: float
    min_z: float
    max_z: float
    def __init__(
        self,
        *,
        frame_id: str = ...,
        x: float = ...,
        y: float = ...,
        width: float = ...,
        height: float = ...,
        min_z: float = ...,
        max_z: float = ...,
    ) -> None: ...

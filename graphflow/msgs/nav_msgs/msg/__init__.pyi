# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class Goals(base.Message):
    header: std_msgs.Header
    goals: list[geometry_msgs.PoseStamped]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        goals: Sequence[geometry_msgs.PoseStamped | Mapping[str, object]] = ...,
    ) -> None: ...

class GridCells(base.Message):
    header: std_msgs.Header
    cell_width: float
    cell_height: float
    cells: list[geometry_msgs.Point]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        cell_width: float = ...,
        cell_height: float = ...,
        cells: Sequence[geometry_msgs.Point | Mapping[str, object]] = ...,
    ) -> None: ...

class MapMetaData(base.Message):
    map_load_time: builtin_interfaces.Time
    resolution: float
    width: int
    height: int
    origin: geometry_msgs.Pose
    def __init__(
        self,
        *,
        map_load_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        resolution: float = ...,
        width: int = ...,
        height: int = ...,
        origin: geometry_msgs.Pose | Mapping[str, object] = ...,
    ) -> None: ...

class OccupancyGrid(base.Message):
    header: std_msgs.Header
    info: MapMetaData
    data: npt.NDArray[np.int8]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        info: MapMetaData | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...
    def to_numpy(self) -> npt.NDArray[Any]: ...

class Odometry(base.Message):
    header: std_msgs.Header
    child_frame_id: str
    pose: geometry_msgs.PoseWithCovariance
    twist: geometry_msgs.TwistWithCovariance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        child_frame_id: str = ...,
        pose: geometry_msgs.PoseWithCovariance | Mapping[str, object] = ...,
        twist: geometry_msgs.TwistWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class Path(base.Message):
    header: std_msgs.Header
    poses: list[geometry_msgs.PoseStamped]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        poses: Sequence[geometry_msgs.PoseStamped | Mapping[str, object]] = ...,
    ) -> None: ...

class Trajectory(base.Message):
    header: std_msgs.Header
    points: list[TrajectoryPoint]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        points: Sequence[TrajectoryPoint | Mapping[str, object]] = ...,
    ) -> None: ...

class TrajectoryPoint(base.Message):
    header: std_msgs.Header
    pose: geometry_msgs.Pose
    velocity: geometry_msgs.Twist
    acceleration: geometry_msgs.Accel
    effort: geometry_msgs.Wrench
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        velocity: geometry_msgs.Twist | Mapping[str, object] = ...,
        acceleration: geometry_msgs.Accel | Mapping[str, object] = ...,
        effort: geometry_msgs.Wrench | Mapping[str, object] = ...,
    ) -> None: ...

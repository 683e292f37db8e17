# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class BehaviorTreeLog(base.Message):
    timestamp: builtin_interfaces.Time
    event_log: list[BehaviorTreeStatusChange]
    def __init__(
        self,
        *,
        timestamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        event_log: Sequence[BehaviorTreeStatusChange | Mapping[str, object]] = ...,
    ) -> None: ...

class BehaviorTreeStatusChange(base.Message):
    timestamp: builtin_interfaces.Time
    node_name: str
    uid: int
    previous_status: str
    current_status: str
    def __init__(
        self,
        *,
        timestamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        node_name: str = ...,
        uid: int = ...,
        previous_status: str = ...,
        current_status: str = ...,
    ) -> None: ...

class CollisionDetectorState(base.Message):
    polygons: list[str]
    detections: npt.NDArray[np.bool_]
    def __init__(
        self,
        *,
        polygons: Sequence[str] = ...,
        detections: Sequence[bool] | npt.NDArray[np.bool_] = ...,
    ) -> None: ...

class CollisionMonitorState(base.Message):
    DO_NOTHING: ClassVar[Literal[0]]
    STOP: ClassVar[Literal[1]]
    SLOWDOWN: ClassVar[Literal[2]]
    APPROACH: ClassVar[Literal[3]]
    LIMIT: ClassVar[Literal[4]]
    action_type: int
    polygon_name: str
    def __init__(self, *, action_type: int = ..., polygon_name: str = ...) -> None: ...

class Costmap(base.Message):
    header: std_msgs.Header
    metadata: CostmapMetaData
    data: npt.NDArray[np.uint8]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        metadata: CostmapMetaData | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class CostmapFilterInfo(base.Message):
    header: std_msgs.Header
    type: int
    filter_mask_topic: str
    base: float
    multiplier: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        type: int = ...,
        filter_mask_topic: str = ...,
        base: float = ...,
        multiplier: float = ...,
    ) -> None: ...

class CostmapMetaData(base.Message):
    map_load_time: builtin_interfaces.Time
    update_time: builtin_interfaces.Time
    layer: str
    resolution: float
    size_x: int
    size_y: int
    origin: geometry_msgs.Pose
    def __init__(
        self,
        *,
        map_load_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        update_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        layer: str = ...,
        resolution: float = ...,
        size_x: int = ...,
        size_y: int = ...,
        origin: geometry_msgs.Pose | Mapping[str, object] = ...,
    ) -> None: ...

class CostmapUpdate(base.Message):
    header: std_msgs.Header
    x: int
    y: int
    size_x: int
    size_y: int
    data: npt.NDArray[np.uint8]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        x: int = ...,
        y: int = ...,
        size_x: int = ...,
        size_y: int = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class EdgeCost(base.Message):
    edgeid: int
    cost: float
    def __init__(self, *, edgeid: int = ..., cost: float = ...) -> None: ...

class MissedWaypoint(base.Message):
    index: int
    goal: geometry_msgs.PoseStamped
    error_code: int
    def __init__(
        self,
        *,
        index: int = ...,
        goal: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        error_code: int = ...,
    ) -> None: ...

class Particle(base.Message):
    pose: geometry_msgs.Pose
    weight: float
    def __init__(self, *, pose: geometry_msgs.Pose | Mapping[str, object] = ..., weight: float = ...) -> None: ...

class ParticleCloud(base.Message):
    header: std_msgs.Header
    particles: list[Particle]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        particles: Sequence[Particle | Mapping[str, object]] = ...,
    ) -> None: ...

class Route(base.Message):
    header: std_msgs.Header
    route_cost: float
    nodes: list[RouteNode]
    edges: list[RouteEdge]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        route_cost: float = ...,
        nodes: Sequence[RouteNode | Mapping[str, object]] = ...,
        edges: Sequence[RouteEdge | Mapping[str, object]] = ...,
    ) -> None: ...

class RouteEdge(base.Message):
    edgeid: int
    start: geometry_msgs.Point
    end: geometry_msgs.Point
    def __init__(
        self,
        *,
        edgeid: int = ...,
        start: geometry_msgs.Point | Mapping[str, object] = ...,
        end: geometry_msgs.Point | Mapping[str, object] = ...,
    ) -> None: ...

class RouteNode(base.Message):
    nodeid: int
    position: geometry_msgs.Point
    def __init__(self, *, nodeid: int = ..., position: geometry_msgs.Point | Mapping[str, object] = ...) -> None: ...

class SpeedLimit(base.Message):
    header: std_msgs.Header
    percentage: bool
    speed_limit: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        percentage: bool = ...,
        speed_limit: float = ...,
    ) -> None: ...

class VoxelGrid(base.Message):
    header: std_msgs.Header
    data: npt.NDArray[np.uint32]
    origin: geometry_msgs.Point32
    resolutions: geometry_msgs.Vector3
    size_x: int
    size_y: int
    size_z: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
        origin: geometry_msgs.Point32 | Mapping[str, object] = ...,
        resolutions: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        size_x: int = ...,
        size_y: int = ...,
        size_z: int = ...,
    ) -> None: ...

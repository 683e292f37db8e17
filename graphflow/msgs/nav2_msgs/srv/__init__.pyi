# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.nav2_msgs import msg as nav2_msgs
from graphflow.msgs.nav_msgs import msg as nav_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class ClearCostmapAroundPose_Request(base.Message):
    pose: geometry_msgs.PoseStamped
    reset_distance: float
    def __init__(
        self,
        *,
        pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        reset_distance: float = ...,
    ) -> None: ...

class ClearCostmapAroundPose_Response(base.Message):
    response: std_msgs.Empty
    def __init__(self, *, response: std_msgs.Empty | Mapping[str, object] = ...) -> None: ...

class ClearCostmapAroundPose_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ClearCostmapAroundPose_Request]
    response: list[ClearCostmapAroundPose_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ClearCostmapAroundPose_Request | Mapping[str, object]] = ...,
        response: Sequence[ClearCostmapAroundPose_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ClearCostmapAroundPose(base.Service[ClearCostmapAroundPose_Request, ClearCostmapAroundPose_Response]):
    Request: TypeAlias = ClearCostmapAroundPose_Request
    Response: TypeAlias = ClearCostmapAroundPose_Response
    Event: TypeAlias = ClearCostmapAroundPose_Event

class ClearCostmapAroundRobot_Request(base.Message):
    reset_distance: float
    def __init__(self, *, reset_distance: float = ...) -> None: ...

class ClearCostmapAroundRobot_Response(base.Message):
    response: std_msgs.Empty
    def __init__(self, *, response: std_msgs.Empty | Mapping[str, object] = ...) -> None: ...

class ClearCostmapAroundRobot_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ClearCostmapAroundRobot_Request]
    response: list[ClearCostmapAroundRobot_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ClearCostmapAroundRobot_Request | Mapping[str, object]] = ...,
        response: Sequence[ClearCostmapAroundRobot_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ClearCostmapAroundRobot(base.Service[ClearCostmapAroundRobot_Request, ClearCostmapAroundRobot_Response]):
    Request: TypeAlias = ClearCostmapAroundRobot_Request
    Response: TypeAlias = ClearCostmapAroundRobot_Response
    Event: TypeAlias = ClearCostmapAroundRobot_Event

class ClearCostmapExceptRegion_Request(base.Message):
    reset_distance: float
    def __init__(self, *, reset_distance: float = ...) -> None: ...

class ClearCostmapExceptRegion_Response(base.Message):
    response: std_msgs.Empty
    def __init__(self, *, response: std_msgs.Empty | Mapping[str, object] = ...) -> None: ...

class ClearCostmapExceptRegion_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ClearCostmapExceptRegion_Request]
    response: list[ClearCostmapExceptRegion_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ClearCostmapExceptRegion_Request | Mapping[str, object]] = ...,
        response: Sequence[ClearCostmapExceptRegion_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ClearCostmapExceptRegion(base.Service[ClearCostmapExceptRegion_Request, ClearCostmapExceptRegion_Response]):
    Request: TypeAlias = ClearCostmapExceptRegion_Request
    Response: TypeAlias = ClearCostmapExceptRegion_Response
    Event: TypeAlias = ClearCostmapExceptRegion_Event

class ClearEntireCostmap_Request(base.Message):
    request: std_msgs.Empty
    def __init__(self, *, request: std_msgs.Empty | Mapping[str, object] = ...) -> None: ...

class ClearEntireCostmap_Response(base.Message):
    response: std_msgs.Empty
    def __init__(self, *, response: std_msgs.Empty | Mapping[str, object] = ...) -> None: ...

class ClearEntireCostmap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ClearEntireCostmap_Request]
    response: list[ClearEntireCostmap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ClearEntireCostmap_Request | Mapping[str, object]] = ...,
        response: Sequence[ClearEntireCostmap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ClearEntireCostmap(base.Service[ClearEntireCostmap_Request, ClearEntireCostmap_Response]):
    Request: TypeAlias = ClearEntireCostmap_Request
    Response: TypeAlias = ClearEntireCostmap_Response
    Event: TypeAlias = ClearEntireCostmap_Event

class DynamicEdges_Request(base.Message):
    closed_edges: npt.NDArray[np.uint16]
    opened_edges: npt.NDArray[np.uint16]
    adjust_edges: list[nav2_msgs.EdgeCost]
    def __init__(
        self,
        *,
        closed_edges: Sequence[int] | npt.NDArray[np.integer] = ...,
        opened_edges: Sequence[int] | npt.NDArray[np.integer] = ...,
        adjust_edges: Sequence[nav2_msgs.EdgeCost | Mapping[str, object]] = ...,
    ) -> None: ...

class DynamicEdges_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class DynamicEdges_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DynamicEdges_Request]
    response: list[DynamicEdges_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DynamicEdges_Request | Mapping[str, object]] = ...,
        response: Sequence[DynamicEdges_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DynamicEdges(base.Service[DynamicEdges_Request, DynamicEdges_Response]):
    Request: TypeAlias = DynamicEdges_Request
    Response: TypeAlias = DynamicEdges_Response
    Event: TypeAlias = DynamicEdges_Event

class GetCost_Request(base.Message):
    use_footprint: bool
    x: float
    y: float
    theta: float
    def __init__(self, *, use_footprint: bool = ..., x: float = ..., y: float = ..., theta: float = ...) -> None: ...

class GetCost_Response(base.Message):
    cost: float
    def __init__(self, *, cost: float = ...) -> None: ...

class GetCost_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetCost_Request]
    response: list[GetCost_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetCost_Request | Mapping[str, object]] = ...,
        response: Sequence[GetCost_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetCost(base.Service[GetCost_Request, GetCost_Response]):
    Request: TypeAlias = GetCost_Request
    Response: TypeAlias = GetCost_Response
    Event: TypeAlias = GetCost_Event

class GetCostmap_Request(base.Message):
    specs: nav2_msgs.CostmapMetaData
    def __init__(self, *, specs: nav2_msgs.CostmapMetaData | Mapping[str, object] = ...) -> None: ...

class GetCostmap_Response(base.Message):
    map: nav2_msgs.Costmap
    def __init__(self, *, map: nav2_msgs.Costmap | Mapping[str, object] = ...) -> None: ...

class GetCostmap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetCostmap_Request]
    response: list[GetCostmap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetCostmap_Request | Mapping[str, object]] = ...,
        response: Sequence[GetCostmap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetCostmap(base.Service[GetCostmap_Request, GetCostmap_Response]):
    Request: TypeAlias = GetCostmap_Request
    Response: TypeAlias = GetCostmap_Response
    Event: TypeAlias = GetCostmap_Event

class IsPathValid_Request(base.Message):
    path: nav_msgs.Path
    def __init__(self, *, path: nav_msgs.Path | Mapping[str, object] = ...) -> None: ...

class IsPathValid_Response(base.Message):
    is_valid: bool
    invalid_pose_indices: npt.NDArray[np.int32]
    def __init__(
        self,
        *,
        is_valid: bool = ...,
        invalid_pose_indices: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class IsPathValid_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[IsPathValid_Request]
    response: list[IsPathValid_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[IsPathValid_Request | Mapping[str, object]] = ...,
        response: Sequence[IsPathValid_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class IsPathValid(base.Service[IsPathValid_Request, IsPathValid_Response]):
    Request: TypeAlias = IsPathValid_Request
    Response: TypeAlias = IsPathValid_Response
    Event: TypeAlias = IsPathValid_Event

class LoadMap_Request(base.Message):
    map_url: str
    def __init__(self, *, map_url: str = ...) -> None: ...

class LoadMap_Response(base.Message):
    RESULT_SUCCESS: ClassVar[Literal[0]]
    RESULT_MAP_DOES_NOT_EXIST: ClassVar[Literal[1]]
    RESULT_INVALID_MAP_DATA: ClassVar[Literal[2]]
    RESULT_INVALID_MAP_METADATA: ClassVar[Literal[3]]
    RESULT_UNDEFINED_FAILURE: ClassVar[Literal[255]]
    map: nav_msgs.OccupancyGrid
    result: int
    def __init__(self, *, map: nav_msgs.OccupancyGrid | Mapping[str, object] = ..., result: int = ...) -> None: ...

class LoadMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LoadMap_Request]
    response: list[LoadMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LoadMap_Request | Mapping[str, object]] = ...,
        response: Sequence[LoadMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LoadMap(base.Service[LoadMap_Request, LoadMap_Response]):
    Request: TypeAlias = LoadMap_Request
    Response: TypeAlias = LoadMap_Response
    Event: TypeAlias = LoadMap_Event

class ManageLifecycleNodes_Request(base.Message):
    STARTUP: ClassVar[Literal[0]]
    PAUSE: ClassVar[Literal[1]]
    RESUME: ClassVar[Literal[2]]
    RESET: ClassVar[Literal[3]]
    SHUTDOWN: ClassVar[Literal[4]]
    CONFIGURE: ClassVar[Literal[5]]
    CLEANUP: ClassVar[Literal[6]]
    command: int
    def __init__(self, *, command: int = ...) -> None: ...

class ManageLifecycleNodes_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class ManageLifecycleNodes_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ManageLifecycleNodes_Request]
    response: list[ManageLifecycleNodes_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ManageLifecycleNodes_Request | Mapping[str, object]] = ...,
        response: Sequence[ManageLifecycleNodes_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ManageLifecycleNodes(base.Service[ManageLifecycleNodes_Request, ManageLifecycleNodes_Response]):
    Request: TypeAlias = ManageLifecycleNodes_Request
    Response: TypeAlias = ManageLifecycleNodes_Response
    Event: TypeAlias = ManageLifecycleNodes_Event

class ReloadDockDatabase_Request(base.Message):
    filepath: str
    def __init__(self, *, filepath: str = ...) -> None: ...

class ReloadDockDatabase_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class ReloadDockDatabase_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ReloadDockDatabase_Request]
    response: list[ReloadDockDatabase_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ReloadDockDatabase_Request | Mapping[str, object]] = ...,
        response: Sequence[ReloadDockDatabase_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ReloadDockDatabase(base.Service[ReloadDockDatabase_Request, ReloadDockDatabase_Response]):
    Request: TypeAlias = ReloadDockDatabase_Request
    Response: TypeAlias = ReloadDockDatabase_Response
    Event: TypeAlias = ReloadDockDatabase_Event

class SaveMap_Request(base.Message):
    map_topic: str
    map_url: str
    image_format: str
    map_mode: str
    free_thresh: float
    occupied_thresh: float
    def __init__(
        self,
        *,
        map_topic: str = ...,
        map_url: str = ...,
        image_format: str = ...,
        map_mode: str = ...,
        free_thresh: float = ...,
        occupied_thresh: float = ...,
    ) -> None: ...

class SaveMap_Response(base.Message):
    result: bool
    def __init__(self, *, result: bool = ...) -> None: ...

class SaveMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SaveMap_Request]
    response: list[SaveMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SaveMap_Request | Mapping[str, object]] = ...,
        response: Sequence[SaveMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SaveMap(base.Service[SaveMap_Request, SaveMap_Response]):
    Request: TypeAlias = SaveMap_Request
    Response: TypeAlias = SaveMap_Response
    Event: TypeAlias = SaveMap_Event

class SetInitialPose_Request(base.Message):
    pose: geometry_msgs.PoseWithCovarianceStamped
    def __init__(self, *, pose: geometry_msgs.PoseWithCovarianceStamped | Mapping[str, object] = ...) -> None: ...

class SetInitialPose_Response(base.Message):
    def __init__(self) -> None: ...

class SetInitialPose_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetInitialPose_Request]
    response: list[SetInitialPose_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetInitialPose_Request | Mapping[str, object]] = ...,
        response: Sequence[SetInitialPose_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetInitialPose(base.Service[SetInitialPose_Request, SetInitialPose_Response]):
    Request: TypeAlias = SetInitialPose_Request
    Response: TypeAlias = SetInitialPose_Response
    Event: TypeAlias = SetInitialPose_Event

class SetRouteGraph_Request(base.Message):
    graph_filepath: str
    def __init__(self, *, graph_filepath: str = ...) -> None: ...

class SetRouteGraph_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class SetRouteGraph_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetRouteGraph_Request]
    response: list[SetRouteGraph_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetRouteGraph_Request | Mapping[str, object]] = ...,
        response: Sequence[SetRouteGraph_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetRouteGraph(base.Service[SetRouteGraph_Request, SetRouteGraph_Response]):
    Request: TypeAlias = SetRouteGraph_Request
    Response: TypeAlias = SetRouteGraph_Response
    Event: TypeAlias = SetRouteGraph_Event

class Toggle_Request(base.Message):
    enable: bool
    def __init__(self, *, enable: bool = ...) -> None: ...

class Toggle_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class Toggle_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Toggle_Request]
    response: list[Toggle_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Toggle_Request | Mapping[str, object]] = ...,
        response: Sequence[Toggle_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Toggle(base.Service[Toggle_Request, Toggle_Response]):
    Request: TypeAlias = Toggle_Request
    Response: TypeAlias = Toggle_Response
    Event: TypeAlias = Toggle_Event

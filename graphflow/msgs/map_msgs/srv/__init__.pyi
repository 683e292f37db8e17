# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.map_msgs import msg as map_msgs
from graphflow.msgs.nav_msgs import msg as nav_msgs
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class GetMapROI_Request(base.Message):
    x: float
    y: float
    l_x: float
    l_y: float
    def __init__(self, *, x: float = ..., y: float = ..., l_x: float = ..., l_y: float = ...) -> None: ...

class GetMapROI_Response(base.Message):
    sub_map: nav_msgs.OccupancyGrid
    def __init__(self, *, sub_map: nav_msgs.OccupancyGrid | Mapping[str, object] = ...) -> None: ...

class GetMapROI_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetMapROI_Request]
    response: list[GetMapROI_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetMapROI_Request | Mapping[str, object]] = ...,
        response: Sequence[GetMapROI_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetMapROI(base.Service[GetMapROI_Request, GetMapROI_Response]):
    Request: TypeAlias = GetMapROI_Request
    Response: TypeAlias = GetMapROI_Response
    Event: TypeAlias = GetMapROI_Event

class GetPointMap_Request(base.Message):
    def __init__(self) -> None: ...

class GetPointMap_Response(base.Message):
    map: sensor_msgs.PointCloud2
    def __init__(self, *, map: sensor_msgs.PointCloud2 | Mapping[str, object] = ...) -> None: ...

class GetPointMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetPointMap_Request]
    response: list[GetPointMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetPointMap_Request | Mapping[str, object]] = ...,
        response: Sequence[GetPointMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetPointMap(base.Service[GetPointMap_Request, GetPointMap_Response]):
    Request: TypeAlias = GetPointMap_Request
    Response: TypeAlias = GetPointMap_Response
    Event: TypeAlias = GetPointMap_Event

class GetPointMapROI_Request(base.Message):
    x: float
    y: float
    z: float
    r: float
    l_x: float
    l_y: float
    l_z: float
    def __init__(
        self,
        *,
        x: float = ...,
        y: float = ...,
        z: float = ...,
        r: float = ...,
        l_x: float = ...,
        l_y: float = ...,
        l_z: float = ...,
    ) -> None: ...

class GetPointMapROI_Response(base.Message):
    sub_map: sensor_msgs.PointCloud2
    def __init__(self, *, sub_map: sensor_msgs.PointCloud2 | Mapping[str, object] = ...) -> None: ...

class GetPointMapROI_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetPointMapROI_Request]
    response: list[GetPointMapROI_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetPointMapROI_Request | Mapping[str, object]] = ...,
        response: Sequence[GetPointMapROI_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetPointMapROI(base.Service[GetPointMapROI_Request, GetPointMapROI_Response]):
    Request: TypeAlias = GetPointMapROI_Request
    Response: TypeAlias = GetPointMapROI_Response
    Event: TypeAlias = GetPointMapROI_Event

class ProjectedMapsInfo_Request(base.Message):
    projected_maps_info: list[map_msgs.ProjectedMapInfo]
    def __init__(
        self,
        *,
        projected_maps_info: Sequence[map_msgs.ProjectedMapInfo | Mapping[str, object]] = ...,
    ) -> None: ...

class ProjectedMapsInfo_Response(base.Message):
    def __init__(self) -> None: ...

class ProjectedMapsInfo_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ProjectedMapsInfo_Request]
    response: list[ProjectedMapsInfo_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ProjectedMapsInfo_Request | Mapping[str, object]] = ...,
        response: Sequence[ProjectedMapsInfo_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ProjectedMapsInfo(base.Service[ProjectedMapsInfo_Request, ProjectedMapsInfo_Response]):
    Request: TypeAlias = ProjectedMapsInfo_Request
    Response: TypeAlias = ProjectedMapsInfo_Response
    Event: TypeAlias = ProjectedMapsInfo_Event

class SaveMap_Request(base.Message):
    filename: std_msgs.String
    def __init__(self, *, filename: std_msgs.String | Mapping[str, object] = ...) -> None: ...

class SaveMap_Response(base.Message):
    def __init__(self) -> None: ...

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

class SetMapProjections_Request(base.Message):
    def __init__(self) -> None: ...

class SetMapProjections_Response(base.Message):
    projected_maps_info: list[map_msgs.ProjectedMapInfo]
    def __init__(
        self,
        *,
        projected_maps_info: Sequence[map_msgs.ProjectedMapInfo | Mapping[str, object]] = ...,
    ) -> None: ...

class SetMapProjections_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetMapProjections_Request]
    response: list[SetMapProjections_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetMapProjections_Request | Mapping[str, object]] = ...,
        response: Sequence[SetMapProjections_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetMapProjections(base.Service[SetMapProjections_Request, SetMapProjections_Response]):
    Request: TypeAlias = SetMapProjections_Request
    Response: TypeAlias = SetMapProjections_Response
    Event: TypeAlias = SetMapProjections_Event

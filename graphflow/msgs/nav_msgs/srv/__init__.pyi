# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.nav_msgs import msg as nav_msgs
from graphflow.msgs.service_msgs import msg as service_msgs

class GetMap_Request(base.Message):
    def __init__(self) -> None: ...

class GetMap_Response(base.Message):
    map: nav_msgs.OccupancyGrid
    def __init__(self, *, map: nav_msgs.OccupancyGrid | Mapping[str, object] = ...) -> None: ...

class GetMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetMap_Request]
    response: list[GetMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetMap_Request | Mapping[str, object]] = ...,
        response: Sequence[GetMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetMap(base.Service[GetMap_Request, GetMap_Response]):
    Request: TypeAlias = GetMap_Request
    Response: TypeAlias = GetMap_Response
    Event: TypeAlias = GetMap_Event

class GetPlan_Request(base.Message):
    start: geometry_msgs.PoseStamped
    goal: geometry_msgs.PoseStamped
    tolerance: float
    def __init__(
        self,
        *,
        start: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        goal: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        tolerance: float = ...,
    ) -> None: ...

class GetPlan_Response(base.Message):
    plan: nav_msgs.Path
    def __init__(self, *, plan: nav_msgs.Path | Mapping[str, object] = ...) -> None: ...

class GetPlan_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetPlan_Request]
    response: list[GetPlan_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetPlan_Request | Mapping[str, object]] = ...,
        response: Sequence[GetPlan_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetPlan(base.Service[GetPlan_Request, GetPlan_Response]):
    Request: TypeAlias = GetPlan_Request
    Response: TypeAlias = GetPlan_Response
    Event: TypeAlias = GetPlan_Event

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

class SetMap_Request(base.Message):
    map: nav_msgs.OccupancyGrid
    initial_pose: geometry_msgs.PoseWithCovarianceStamped
    def __init__(
        self,
        *,
        map: nav_msgs.OccupancyGrid | Mapping[str, object] = ...,
        initial_pose: geometry_msgs.PoseWithCovarianceStamped | Mapping[str, object] = ...,
    ) -> None: ...

class SetMap_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class SetMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetMap_Request]
    response: list[SetMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetMap_Request | Mapping[str, object]] = ...,
        response: Sequence[SetMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetMap(base.Service[SetMap_Request, SetMap_Response]):
    Request: TypeAlias = SetMap_Request
    Response: TypeAlias = SetMap_Response
    Event: TypeAlias = SetMap_Event

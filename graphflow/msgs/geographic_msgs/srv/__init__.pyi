# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.geographic_msgs import msg as geographic_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class GetGeoPath_Request(base.Message):
    start: geographic_msgs.GeoPoint
    goal: geographic_msgs.GeoPoint
    def __init__(
        self,
        *,
        start: geographic_msgs.GeoPoint | Mapping[str, object] = ...,
        goal: geographic_msgs.GeoPoint | Mapping[str, object] = ...,
    ) -> None: ...

class GetGeoPath_Response(base.Message):
    success: bool
    status: str
    plan: geographic_msgs.GeoPath
    network: unique_identifier_msgs.UUID
    start_seg: unique_identifier_msgs.UUID
    goal_seg: unique_identifier_msgs.UUID
    distance: float
    def __init__(
        self,
        *,
        success: bool = ...,
        status: str = ...,
        plan: geographic_msgs.GeoPath | Mapping[str, object] = ...,
        network: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        start_seg: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal_seg: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        distance: float = ...,
    ) -> None: ...

class GetGeoPath_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetGeoPath_Request]
    response: list[GetGeoPath_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetGeoPath_Request | Mapping[str, object]] = ...,
        response: Sequence[GetGeoPath_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetGeoPath(base.Service[GetGeoPath_Request, GetGeoPath_Response]):
    Request: TypeAlias = GetGeoPath_Request
    Response: TypeAlias = GetGeoPath_Response
    Event: TypeAlias = GetGeoPath_Event

class GetGeographicMap_Request(base.Message):
    url: str
    bounds: geographic_msgs.BoundingBox
    def __init__(self, *, url: str = ..., bounds: geographic_msgs.BoundingBox | Mapping[str, object] = ...) -> None: ...

class GetGeographicMap_Response(base.Message):
    success: bool
    status: str
    map: geographic_msgs.GeographicMap
    def __init__(
        self,
        *,
        success: bool = ...,
        status: str = ...,
        map: geographic_msgs.GeographicMap | Mapping[str, object] = ...,
    ) -> None: ...

class GetGeographicMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetGeographicMap_Request]
    response: list[GetGeographicMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetGeographicMap_Request | Mapping[str, object]] = ...,
        response: Sequence[GetGeographicMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetGeographicMap(base.Service[GetGeographicMap_Request, GetGeographicMap_Response]):
    Request: TypeAlias = GetGeographicMap_Request
    Response: TypeAlias = GetGeographicMap_Response
    Event: TypeAlias = GetGeographicMap_Event

class GetRoutePlan_Request(base.Message):
    network: unique_identifier_msgs.UUID
    start: unique_identifier_msgs.UUID
    goal: unique_identifier_msgs.UUID
    def __init__(
        self,
        *,
        network: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        start: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
    ) -> None: ...

class GetRoutePlan_Response(base.Message):
    success: bool
    status: str
    plan: geographic_msgs.RoutePath
    def __init__(
        self,
        *,
        success: bool = ...,
        status: str = ...,
        plan: geographic_msgs.RoutePath | Mapping[str, object] = ...,
    ) -> None: ...

class GetRoutePlan_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetRoutePlan_Request]
    response: list[GetRoutePlan_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetRoutePlan_Request | Mapping[str, object]] = ...,
        response: Sequence[GetRoutePlan_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetRoutePlan(base.Service[GetRoutePlan_Request, GetRoutePlan_Response]):
    Request: TypeAlias = GetRoutePlan_Request
    Response: TypeAlias = GetRoutePlan_Response
    Event: TypeAlias = GetRoutePlan_Event

class UpdateGeographicMap_Request(base.Message):
    updates: geographic_msgs.GeographicMapChanges
    def __init__(self, *, updates: geographic_msgs.GeographicMapChanges | Mapping[str, object] = ...) -> None: ...

class UpdateGeographicMap_Response(base.Message):
    success: bool
    status: str
    def __init__(self, *, success: bool = ..., status: str = ...) -> None: ...

class UpdateGeographicMap_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[UpdateGeographicMap_Request]
    response: list[UpdateGeographicMap_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[UpdateGeographicMap_Request | Mapping[str, object]] = ...,
        response: Sequence[UpdateGeographicMap_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class UpdateGeographicMap(base.Service[UpdateGeographicMap_Request, UpdateGeographicMap_Response]):
    Request: TypeAlias = UpdateGeographicMap_Request
    Response: TypeAlias = UpdateGeographicMap_Response
    Event: TypeAlias = UpdateGeographicMap_Event

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.visualization_msgs import msg as visualization_msgs

class GetInteractiveMarkers_Request(base.Message):
    def __init__(self) -> None: ...

class GetInteractiveMarkers_Response(base.Message):
    sequence_number: int
    markers: list[visualization_msgs.InteractiveMarker]
    def __init__(
        self,
        *,
        sequence_number: int = ...,
        markers: Sequence[visualization_msgs.InteractiveMarker | Mapping[str, object]] = ...,
    ) -> None: ...

class GetInteractiveMarkers_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetInteractiveMarkers_Request]
    response: list[GetInteractiveMarkers_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetInteractiveMarkers_Request | Mapping[str, object]] = ...,
        response: Sequence[GetInteractiveMarkers_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetInteractiveMarkers(base.Service[GetInteractiveMarkers_Request, GetInteractiveMarkers_Response]):
    Request: TypeAlias = GetInteractiveMarkers_Request
    Response: TypeAlias = GetInteractiveMarkers_Response
    Event: TypeAlias = GetInteractiveMarkers_Event

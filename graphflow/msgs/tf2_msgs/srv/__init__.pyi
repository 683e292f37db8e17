# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs

class FrameGraph_Request(base.Message):
    def __init__(self) -> None: ...

class FrameGraph_Response(base.Message):
    frame_yaml: str
    def __init__(self, *, frame_yaml: str = ...) -> None: ...

class FrameGraph_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FrameGraph_Request]
    response: list[FrameGraph_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FrameGraph_Request | Mapping[str, object]] = ...,
        response: Sequence[FrameGraph_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FrameGraph(base.Service[FrameGraph_Request, FrameGraph_Response]):
    Request: TypeAlias = FrameGraph_Request
    Response: TypeAlias = FrameGraph_Response
    Event: TypeAlias = FrameGraph_Event

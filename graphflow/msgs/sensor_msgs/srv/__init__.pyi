# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.service_msgs import msg as service_msgs

class SetCameraInfo_Request(base.Message):
    camera_info: sensor_msgs.CameraInfo
    def __init__(self, *, camera_info: sensor_msgs.CameraInfo | Mapping[str, object] = ...) -> None: ...

class SetCameraInfo_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetCameraInfo_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetCameraInfo_Request]
    response: list[SetCameraInfo_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetCameraInfo_Request | Mapping[str, object]] = ...,
        response: Sequence[SetCameraInfo_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetCameraInfo(base.Service[SetCameraInfo_Request, SetCameraInfo_Response]):
    Request: TypeAlias = SetCameraInfo_Request
    Response: TypeAlias = SetCameraInfo_Response
    Event: TypeAlias = SetCameraInfo_Event

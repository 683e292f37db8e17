# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.service_msgs import msg as service_msgs

class EStop_Request(base.Message):
    e_stop_on: bool
    def __init__(self, *, e_stop_on: bool = ...) -> None: ...

class EStop_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class EStop_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[EStop_Request]
    response: list[EStop_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[EStop_Request | Mapping[str, object]] = ...,
        response: Sequence[EStop_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class EStop(base.Service[EStop_Request, EStop_Response]):
    Request: TypeAlias = EStop_Request
    Response: TypeAlias = EStop_Response
    Event: TypeAlias = EStop_Event

class ResetPose_Request(base.Message):
    pose: geometry_msgs.Pose
    def __init__(self, *, pose: geometry_msgs.Pose | Mapping[str, object] = ...) -> None: ...

class ResetPose_Response(base.Message):
    def __init__(self) -> None: ...

class ResetPose_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ResetPose_Request]
    response: list[ResetPose_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ResetPose_Request | Mapping[str, object]] = ...,
        response: Sequence[ResetPose_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ResetPose(base.Service[ResetPose_Request, ResetPose_Response]):
    Request: TypeAlias = ResetPose_Request
    Response: TypeAlias = ResetPose_Response
    Event: TypeAlias = ResetPose_Event

class RobotPower_Request(base.Message):
    def __init__(self) -> None: ...

class RobotPower_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class RobotPower_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[RobotPower_Request]
    response: list[RobotPower_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[RobotPower_Request | Mapping[str, object]] = ...,
        response: Sequence[RobotPower_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class RobotPower(base.Service[RobotPower_Request, RobotPower_Response]):
    Request: TypeAlias = RobotPower_Request
    Response: TypeAlias = RobotPower_Response
    Event: TypeAlias = RobotPower_Event

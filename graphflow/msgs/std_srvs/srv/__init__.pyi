# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs

class Empty_Request(base.Message):
    def __init__(self) -> None: ...

class Empty_Response(base.Message):
    def __init__(self) -> None: ...

class Empty_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Empty_Request]
    response: list[Empty_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Empty_Request | Mapping[str, object]] = ...,
        response: Sequence[Empty_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Empty(base.Service[Empty_Request, Empty_Response]):
    Request: TypeAlias = Empty_Request
    Response: TypeAlias = Empty_Response
    Event: TypeAlias = Empty_Event

class SetBool_Request(base.Message):
    data: bool
    def __init__(self, *, data: bool = ...) -> None: ...

class SetBool_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class SetBool_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetBool_Request]
    response: list[SetBool_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetBool_Request | Mapping[str, object]] = ...,
        response: Sequence[SetBool_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetBool(base.Service[SetBool_Request, SetBool_Response]):
    Request: TypeAlias = SetBool_Request
    Response: TypeAlias = SetBool_Response
    Event: TypeAlias = SetBool_Event

class Trigger_Request(base.Message):
    def __init__(self) -> None: ...

class Trigger_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class Trigger_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Trigger_Request]
    response: list[Trigger_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Trigger_Request | Mapping[str, object]] = ...,
        response: Sequence[Trigger_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Trigger(base.Service[Trigger_Request, Trigger_Response]):
    Request: TypeAlias = Trigger_Request
    Response: TypeAlias = Trigger_Response
    Event: TypeAlias = Trigger_Event

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs

class AddTwoInts_Request(base.Message):
    a: int
    b: int
    def __init__(self, *, a: int = ..., b: int = ...) -> None: ...

class AddTwoInts_Response(base.Message):
    sum: int
    def __init__(self, *, sum: int = ...) -> None: ...

class AddTwoInts_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[AddTwoInts_Request]
    response: list[AddTwoInts_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[AddTwoInts_Request | Mapping[str, object]] = ...,
        response: Sequence[AddTwoInts_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class AddTwoInts(base.Service[AddTwoInts_Request, AddTwoInts_Response]):
    Request: TypeAlias = AddTwoInts_Request
    Response: TypeAlias = AddTwoInts_Response
    Event: TypeAlias = AddTwoInts_Event

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

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.diagnostic_msgs import msg as diagnostic_msgs
from graphflow.msgs.service_msgs import msg as service_msgs

class AddDiagnostics_Request(base.Message):
    load_namespace: str
    def __init__(self, *, load_namespace: str = ...) -> None: ...

class AddDiagnostics_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class AddDiagnostics_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[AddDiagnostics_Request]
    response: list[AddDiagnostics_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[AddDiagnostics_Request | Mapping[str, object]] = ...,
        response: Sequence[AddDiagnostics_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class AddDiagnostics(base.Service[AddDiagnostics_Request, AddDiagnostics_Response]):
    Request: TypeAlias = AddDiagnostics_Request
    Response: TypeAlias = AddDiagnostics_Response
    Event: TypeAlias = AddDiagnostics_Event

class SelfTest_Request(base.Message):
    def __init__(self) -> None: ...

class SelfTest_Response(base.Message):
    id: str
    passed: int
    status: list[diagnostic_msgs.DiagnosticStatus]
    def __init__(
        self,
        *,
        id: str = ...,
        passed: int | bytes = ...,
        status: Sequence[diagnostic_msgs.DiagnosticStatus | Mapping[str, object]] = ...,
    ) -> None: ...

class SelfTest_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SelfTest_Request]
    response: list[SelfTest_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SelfTest_Request | Mapping[str, object]] = ...,
        response: Sequence[SelfTest_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SelfTest(base.Service[SelfTest_Request, SelfTest_Response]):
    Request: TypeAlias = SelfTest_Request
    Response: TypeAlias = SelfTest_Response
    Event: TypeAlias = SelfTest_Event

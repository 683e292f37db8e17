# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs

class Kill_Request(base.Message):
    name: str
    def __init__(self, *, name: str = ...) -> None: ...

class Kill_Response(base.Message):
    def __init__(self) -> None: ...

class Kill_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Kill_Request]
    response: list[Kill_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Kill_Request | Mapping[str, object]] = ...,
        response: Sequence[Kill_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Kill(base.Service[Kill_Request, Kill_Response]):
    Request: TypeAlias = Kill_Request
    Response: TypeAlias = Kill_Response
    Event: TypeAlias = Kill_Event

class SetPen_Request(base.Message):
    r: int
    g: int
    b: int
    width: int
    off: int
    def __init__(self, *, r: int = ..., g: int = ..., b: int = ..., width: int = ..., off: int = ...) -> None: ...

class SetPen_Response(base.Message):
    def __init__(self) -> None: ...

class SetPen_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetPen_Request]
    response: list[SetPen_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetPen_Request | Mapping[str, object]] = ...,
        response: Sequence[SetPen_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetPen(base.Service[SetPen_Request, SetPen_Response]):
    Request: TypeAlias = SetPen_Request
    Response: TypeAlias = SetPen_Response
    Event: TypeAlias = SetPen_Event

class Spawn_Request(base.Message):
    x: float
    y: float
    theta: float
    name: str
    def __init__(self, *, x: float = ..., y: float = ..., theta: float = ..., name: str = ...) -> None: ...

class Spawn_Response(base.Message):
    name: str
    def __init__(self, *, name: str = ...) -> None: ...

class Spawn_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Spawn_Request]
    response: list[Spawn_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Spawn_Request | Mapping[str, object]] = ...,
        response: Sequence[Spawn_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Spawn(base.Service[Spawn_Request, Spawn_Response]):
    Request: TypeAlias = Spawn_Request
    Response: TypeAlias = Spawn_Response
    Event: TypeAlias = Spawn_Event

class TeleportAbsolute_Request(base.Message):
    x: float
    y: float
    theta: float
    def __init__(self, *, x: float = ..., y: float = ..., theta: float = ...) -> None: ...

class TeleportAbsolute_Response(base.Message):
    def __init__(self) -> None: ...

class TeleportAbsolute_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[TeleportAbsolute_Request]
    response: list[TeleportAbsolute_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[TeleportAbsolute_Request | Mapping[str, object]] = ...,
        response: Sequence[TeleportAbsolute_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class TeleportAbsolute(base.Service[TeleportAbsolute_Request, TeleportAbsolute_Response]):
    Request: TypeAlias = TeleportAbsolute_Request
    Response: TypeAlias = TeleportAbsolute_Response
    Event: TypeAlias = TeleportAbsolute_Event

class TeleportRelative_Request(base.Message):
    linear: float
    angular: float
    def __init__(self, *, linear: float = ..., angular: float = ...) -> None: ...

class TeleportRelative_Response(base.Message):
    def __init__(self) -> None: ...

class TeleportRelative_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[TeleportRelative_Request]
    response: list[TeleportRelative_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[TeleportRelative_Request | Mapping[str, object]] = ...,
        response: Sequence[TeleportRelative_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class TeleportRelative(base.Service[TeleportRelative_Request, TeleportRelative_Response]):
    Request: TypeAlias = TeleportRelative_Request
    Response: TypeAlias = TeleportRelative_Response
    Event: TypeAlias = TeleportRelative_Event

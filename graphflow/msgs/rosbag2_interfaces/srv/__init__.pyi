# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs

class Burst_Request(base.Message):
    num_messages: int
    def __init__(self, *, num_messages: int = ...) -> None: ...

class Burst_Response(base.Message):
    actually_burst: int
    def __init__(self, *, actually_burst: int = ...) -> None: ...

class Burst_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Burst_Request]
    response: list[Burst_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Burst_Request | Mapping[str, object]] = ...,
        response: Sequence[Burst_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Burst(base.Service[Burst_Request, Burst_Response]):
    Request: TypeAlias = Burst_Request
    Response: TypeAlias = Burst_Response
    Event: TypeAlias = Burst_Event

class GetRate_Request(base.Message):
    def __init__(self) -> None: ...

class GetRate_Response(base.Message):
    rate: float
    def __init__(self, *, rate: float = ...) -> None: ...

class GetRate_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetRate_Request]
    response: list[GetRate_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetRate_Request | Mapping[str, object]] = ...,
        response: Sequence[GetRate_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetRate(base.Service[GetRate_Request, GetRate_Response]):
    Request: TypeAlias = GetRate_Request
    Response: TypeAlias = GetRate_Response
    Event: TypeAlias = GetRate_Event

class IsPaused_Request(base.Message):
    def __init__(self) -> None: ...

class IsPaused_Response(base.Message):
    paused: bool
    def __init__(self, *, paused: bool = ...) -> None: ...

class IsPaused_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[IsPaused_Request]
    response: list[IsPaused_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[IsPaused_Request | Mapping[str, object]] = ...,
        response: Sequence[IsPaused_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class IsPaused(base.Service[IsPaused_Request, IsPaused_Response]):
    Request: TypeAlias = IsPaused_Request
    Response: TypeAlias = IsPaused_Response
    Event: TypeAlias = IsPaused_Event

class Pause_Request(base.Message):
    def __init__(self) -> None: ...

class Pause_Response(base.Message):
    def __init__(self) -> None: ...

class Pause_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Pause_Request]
    response: list[Pause_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Pause_Request | Mapping[str, object]] = ...,
        response: Sequence[Pause_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Pause(base.Service[Pause_Request, Pause_Response]):
    Request: TypeAlias = Pause_Request
    Response: TypeAlias = Pause_Response
    Event: TypeAlias = Pause_Event

class PlayNext_Request(base.Message):
    def __init__(self) -> None: ...

class PlayNext_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class PlayNext_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[PlayNext_Request]
    response: list[PlayNext_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[PlayNext_Request | Mapping[str, object]] = ...,
        response: Sequence[PlayNext_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class PlayNext(base.Service[PlayNext_Request, PlayNext_Response]):
    Request: TypeAlias = PlayNext_Request
    Response: TypeAlias = PlayNext_Response
    Event: TypeAlias = PlayNext_Event

class Resume_Request(base.Message):
    def __init__(self) -> None: ...

class Resume_Response(base.Message):
    def __init__(self) -> None: ...

class Resume_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Resume_Request]
    response: list[Resume_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Resume_Request | Mapping[str, object]] = ...,
        response: Sequence[Resume_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Resume(base.Service[Resume_Request, Resume_Response]):
    Request: TypeAlias = Resume_Request
    Response: TypeAlias = Resume_Response
    Event: TypeAlias = Resume_Event

class Seek_Request(base.Message):
    time: builtin_interfaces.Time
    def __init__(self, *, time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...) -> None: ...

class Seek_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class Seek_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Seek_Request]
    response: list[Seek_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Seek_Request | Mapping[str, object]] = ...,
        response: Sequence[Seek_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Seek(base.Service[Seek_Request, Seek_Response]):
    Request: TypeAlias = Seek_Request
    Response: TypeAlias = Seek_Response
    Event: TypeAlias = Seek_Event

class SetRate_Request(base.Message):
    rate: float
    def __init__(self, *, rate: float = ...) -> None: ...

class SetRate_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class SetRate_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetRate_Request]
    response: list[SetRate_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetRate_Request | Mapping[str, object]] = ...,
        response: Sequence[SetRate_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetRate(base.Service[SetRate_Request, SetRate_Response]):
    Request: TypeAlias = SetRate_Request
    Response: TypeAlias = SetRate_Response
    Event: TypeAlias = SetRate_Event

class Snapshot_Request(base.Message):
    def __init__(self) -> None: ...

class Snapshot_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class Snapshot_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Snapshot_Request]
    response: list[Snapshot_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Snapshot_Request | Mapping[str, object]] = ...,
        response: Sequence[Snapshot_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Snapshot(base.Service[Snapshot_Request, Snapshot_Response]):
    Request: TypeAlias = Snapshot_Request
    Response: TypeAlias = Snapshot_Response
    Event: TypeAlias = Snapshot_Event

class SplitBagfile_Request(base.Message):
    def __init__(self) -> None: ...

class SplitBagfile_Response(base.Message):
    def __init__(self) -> None: ...

class SplitBagfile_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SplitBagfile_Request]
    response: list[SplitBagfile_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SplitBagfile_Request | Mapping[str, object]] = ...,
        response: Sequence[SplitBagfile_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SplitBagfile(base.Service[SplitBagfile_Request, SplitBagfile_Response]):
    Request: TypeAlias = SplitBagfile_Request
    Response: TypeAlias = SplitBagfile_Response
    Event: TypeAlias = SplitBagfile_Event

class TogglePaused_Request(base.Message):
    def __init__(self) -> None: ...

class TogglePaused_Response(base.Message):
    def __init__(self) -> None: ...

class TogglePaused_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[TogglePaused_Request]
    response: list[TogglePaused_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[TogglePaused_Request | Mapping[str, object]] = ...,
        response: Sequence[TogglePaused_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class TogglePaused(base.Service[TogglePaused_Request, TogglePaused_Response]):
    Request: TypeAlias = TogglePaused_Request
    Response: TypeAlias = TogglePaused_Response
    Event: TypeAlias = TogglePaused_Event

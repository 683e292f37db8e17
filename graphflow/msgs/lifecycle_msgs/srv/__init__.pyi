# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.lifecycle_msgs import msg as lifecycle_msgs
from graphflow.msgs.service_msgs import msg as service_msgs

class ChangeState_Request(base.Message):
    transition: lifecycle_msgs.Transition
    def __init__(self, *, transition: lifecycle_msgs.Transition | Mapping[str, object] = ...) -> None: ...

class ChangeState_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class ChangeState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ChangeState_Request]
    response: list[ChangeState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ChangeState_Request | Mapping[str, object]] = ...,
        response: Sequence[ChangeState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ChangeState(base.Service[ChangeState_Request, ChangeState_Response]):
    Request: TypeAlias = ChangeState_Request
    Response: TypeAlias = ChangeState_Response
    Event: TypeAlias = ChangeState_Event

class GetAvailableStates_Request(base.Message):
    def __init__(self) -> None: ...

class GetAvailableStates_Response(base.Message):
    available_states: list[lifecycle_msgs.State]
    def __init__(self, *, available_states: Sequence[lifecycle_msgs.State | Mapping[str, object]] = ...) -> None: ...

class GetAvailableStates_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetAvailableStates_Request]
    response: list[GetAvailableStates_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetAvailableStates_Request | Mapping[str, object]] = ...,
        response: Sequence[GetAvailableStates_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetAvailableStates(base.Service[GetAvailableStates_Request, GetAvailableStates_Response]):
    Request: TypeAlias = GetAvailableStates_Request
    Response: TypeAlias = GetAvailableStates_Response
    Event: TypeAlias = GetAvailableStates_Event

class GetAvailableTransitions_Request(base.Message):
    def __init__(self) -> None: ...

class GetAvailableTransitions_Response(base.Message):
    available_transitions: list[lifecycle_msgs.TransitionDescription]
    def __init__(
        self,
        *,
        available_transitions: Sequence[lifecycle_msgs.TransitionDescription | Mapping[str, object]] = ...,
    ) -> None: ...

class GetAvailableTransitions_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetAvailableTransitions_Request]
    response: list[GetAvailableTransitions_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetAvailableTransitions_Request | Mapping[str, object]] = ...,
        response: Sequence[GetAvailableTransitions_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetAvailableTransitions(base.Service[GetAvailableTransitions_Request, GetAvailableTransitions_Response]):
    Request: TypeAlias = GetAvailableTransitions_Request
    Response: TypeAlias = GetAvailableTransitions_Response
    Event: TypeAlias = GetAvailableTransitions_Event

class GetState_Request(base.Message):
    def __init__(self) -> None: ...

class GetState_Response(base.Message):
    current_state: lifecycle_msgs.State
    def __init__(self, *, current_state: lifecycle_msgs.State | Mapping[str, object] = ...) -> None: ...

class GetState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetState_Request]
    response: list[GetState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetState_Request | Mapping[str, object]] = ...,
        response: Sequence[GetState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetState(base.Service[GetState_Request, GetState_Response]):
    Request: TypeAlias = GetState_Request
    Response: TypeAlias = GetState_Response
    Event: TypeAlias = GetState_Event

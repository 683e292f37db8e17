# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class RotateAbsolute_Goal(base.Message):
    theta: float
    def __init__(self, *, theta: float = ...) -> None: ...

class RotateAbsolute_Result(base.Message):
    delta: float
    def __init__(self, *, delta: float = ...) -> None: ...

class RotateAbsolute_Feedback(base.Message):
    remaining: float
    def __init__(self, *, remaining: float = ...) -> None: ...

class RotateAbsolute_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: RotateAbsolute_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: RotateAbsolute_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class RotateAbsolute_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: RotateAbsolute_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: RotateAbsolute_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class RotateAbsolute_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class RotateAbsolute_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[RotateAbsolute_SendGoal_Request]
    response: list[RotateAbsolute_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[RotateAbsolute_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[RotateAbsolute_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class RotateAbsolute_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class RotateAbsolute_GetResult_Response(base.Message):
    status: int
    result: RotateAbsolute_Result
    def __init__(self, *, status: int = ..., result: RotateAbsolute_Result | Mapping[str, object] = ...) -> None: ...

class RotateAbsolute_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[RotateAbsolute_GetResult_Request]
    response: list[RotateAbsolute_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[RotateAbsolute_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[RotateAbsolute_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class RotateAbsolute(base.Action[RotateAbsolute_Goal, RotateAbsolute_Result, RotateAbsolute_Feedback]):
    Goal: TypeAlias = RotateAbsolute_Goal
    Result: TypeAlias = RotateAbsolute_Result
    Feedback: TypeAlias = RotateAbsolute_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

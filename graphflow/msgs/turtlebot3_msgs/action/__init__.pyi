# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class Patrol_Goal(base.Message):
    goal: geometry_msgs.Vector3
    def __init__(self, *, goal: geometry_msgs.Vector3 | Mapping[str, object] = ...) -> None: ...

class Patrol_Result(base.Message):
    result: str
    def __init__(self, *, result: str = ...) -> None: ...

class Patrol_Feedback(base.Message):
    state: str
    def __init__(self, *, state: str = ...) -> None: ...

class Patrol_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: Patrol_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: Patrol_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class Patrol_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: Patrol_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: Patrol_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class Patrol_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class Patrol_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Patrol_SendGoal_Request]
    response: list[Patrol_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Patrol_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[Patrol_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Patrol_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class Patrol_GetResult_Response(base.Message):
    status: int
    result: Patrol_Result
    def __init__(self, *, status: int = ..., result: Patrol_Result | Mapping[str, object] = ...) -> None: ...

class Patrol_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Patrol_GetResult_Request]
    response: list[Patrol_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Patrol_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[Patrol_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Patrol(base.Action[Patrol_Goal, Patrol_Result, Patrol_Feedback]):
    Goal: TypeAlias = Patrol_Goal
    Result: TypeAlias = Patrol_Result
    Feedback: TypeAlias = Patrol_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

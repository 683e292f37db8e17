# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.tf2_msgs import msg as tf2_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class LookupTransform_Goal(base.Message):
    target_frame: str
    source_frame: str
    source_time: builtin_interfaces.Time
    timeout: builtin_interfaces.Duration
    target_time: builtin_interfaces.Time
    fixed_frame: str
    advanced: bool
    def __init__(
        self,
        *,
        target_frame: str = ...,
        source_frame: str = ...,
        source_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        timeout: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        target_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        fixed_frame: str = ...,
        advanced: bool = ...,
    ) -> None: ...

class LookupTransform_Result(base.Message):
    transform: geometry_msgs.TransformStamped
    error: tf2_msgs.TF2Error
    def __init__(
        self,
        *,
        transform: geometry_msgs.TransformStamped | Mapping[str, object] = ...,
        error: tf2_msgs.TF2Error | Mapping[str, object] = ...,
    ) -> None: ...

class LookupTransform_Feedback(base.Message):
    def __init__(self) -> None: ...

class LookupTransform_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: LookupTransform_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: LookupTransform_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class LookupTransform_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: LookupTransform_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: LookupTransform_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class LookupTransform_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class LookupTransform_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LookupTransform_SendGoal_Request]
    response: list[LookupTransform_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LookupTransform_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[LookupTransform_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LookupTransform_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class LookupTransform_GetResult_Response(base.Message):
    status: int
    result: LookupTransform_Result
    def __init__(self, *, status: int = ..., result: LookupTransform_Result | Mapping[str, object] = ...) -> None: ...

class LookupTransform_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LookupTransform_GetResult_Request]
    response: list[LookupTransform_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LookupTransform_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[LookupTransform_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LookupTransform(base.Action[LookupTransform_Goal, LookupTransform_Result, LookupTransform_Feedback]):
    Goal: TypeAlias = LookupTransform_Goal
    Result: TypeAlias = LookupTransform_Result
    Feedback: TypeAlias = LookupTransform_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

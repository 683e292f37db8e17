# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

from graphflow.msgs import base
from graphflow.msgs.action_msgs import msg as action_msgs
from graphflow.msgs.service_msgs import msg as service_msgs

class CancelGoal_Request(base.Message):
    goal_info: action_msgs.GoalInfo
    def __init__(self, *, goal_info: action_msgs.GoalInfo | Mapping[str, object] = ...) -> None: ...

class CancelGoal_Response(base.Message):
    ERROR_NONE: ClassVar[Literal[0]]
    ERROR_REJECTED: ClassVar[Literal[1]]
    ERROR_UNKNOWN_GOAL_ID: ClassVar[Literal[2]]
    ERROR_GOAL_TERMINATED: ClassVar[Literal[3]]
    return_code: int
    goals_canceling: list[action_msgs.GoalInfo]
    def __init__(
        self,
        *,
        return_code: int = ...,
        goals_canceling: Sequence[action_msgs.GoalInfo | Mapping[str, object]] = ...,
    ) -> None: ...

class CancelGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[CancelGoal_Request]
    response: list[CancelGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[CancelGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[CancelGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class CancelGoal(base.Service[CancelGoal_Request, CancelGoal_Response]):
    Request: TypeAlias = CancelGoal_Request
    Response: TypeAlias = CancelGoal_Response
    Event: TypeAlias = CancelGoal_Event

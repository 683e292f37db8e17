# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.simulation_interfaces import msg as simulation_interfaces
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class SimulateSteps_Goal(base.Message):
    steps: int
    def __init__(self, *, steps: int = ...) -> None: ...

class SimulateSteps_Result(base.Message):
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class SimulateSteps_Feedback(base.Message):
    completed_steps: int
    remaining_steps: int
    def __init__(self, *, completed_steps: int = ..., remaining_steps: int = ...) -> None: ...

class SimulateSteps_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: SimulateSteps_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: SimulateSteps_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class SimulateSteps_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: SimulateSteps_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: SimulateSteps_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class SimulateSteps_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class SimulateSteps_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SimulateSteps_SendGoal_Request]
    response: list[SimulateSteps_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SimulateSteps_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[SimulateSteps_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SimulateSteps_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class SimulateSteps_GetResult_Response(base.Message):
    status: int
    result: SimulateSteps_Result
    def __init__(self, *, status: int = ..., result: SimulateSteps_Result | Mapping[str, object] = ...) -> None: ...

class SimulateSteps_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SimulateSteps_GetResult_Request]
    response: list[SimulateSteps_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SimulateSteps_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[SimulateSteps_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SimulateSteps(base.Action[SimulateSteps_Goal, SimulateSteps_Result, SimulateSteps_Feedback]):
    Goal: TypeAlias = SimulateSteps_Goal
    Result: TypeAlias = SimulateSteps_Result
    Feedback: TypeAlias = SimulateSteps_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

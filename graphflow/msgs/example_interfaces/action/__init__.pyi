# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class Fibonacci_Goal(base.Message):
    order: int
    def __init__(self, *, order: int = ...) -> None: ...

class Fibonacci_Result(base.Message):
    sequence: npt.NDArray[np.int32]
    def __init__(self, *, sequence: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...

class Fibonacci_Feedback(base.Message):
    sequence: npt.NDArray[np.int32]
    def __init__(self, *, sequence: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...

class Fibonacci_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: Fibonacci_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: Fibonacci_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class Fibonacci_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: Fibonacci_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: Fibonacci_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class Fibonacci_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class Fibonacci_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Fibonacci_SendGoal_Request]
    response: list[Fibonacci_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Fibonacci_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[Fibonacci_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Fibonacci_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class Fibonacci_GetResult_Response(base.Message):
    status: int
    result: Fibonacci_Result
    def __init__(self, *, status: int = ..., result: Fibonacci_Result | Mapping[str, object] = ...) -> None: ...

class Fibonacci_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Fibonacci_GetResult_Request]
    response: list[Fibonacci_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Fibonacci_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[Fibonacci_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Fibonacci(base.Action[Fibonacci_Goal, Fibonacci_Result, Fibonacci_Feedback]):
    Goal: TypeAlias = Fibonacci_Goal
    Result: TypeAlias = Fibonacci_Result
    Feedback: TypeAlias = Fibonacci_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

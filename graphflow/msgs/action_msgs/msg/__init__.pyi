# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class GoalInfo(base.Message):
    goal_id: unique_identifier_msgs.UUID
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class GoalStatus(base.Message):
    STATUS_UNKNOWN: ClassVar[Literal[0]]
    STATUS_ACCEPTED: ClassVar[Literal[1]]
    STATUS_EXECUTING: ClassVar[Literal[2]]
    STATUS_CANCELING: ClassVar[Literal[3]]
    STATUS_SUCCEEDED: ClassVar[Literal[4]]
    STATUS_CANCELED: ClassVar[Literal[5]]
    STATUS_ABORTED: ClassVar[Literal[6]]
    goal_info: GoalInfo
    status: int
    def __init__(self, *, goal_info: GoalInfo | Mapping[str, object] = ..., status: int = ...) -> None: ...

class GoalStatusArray(base.Message):
    status_list: list[GoalStatus]
    def __init__(self, *, status_list: Sequence[GoalStatus | Mapping[str, object]] = ...) -> None: ...

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.std_msgs import msg as std_msgs

class GoalID(base.Message):
    stamp: builtin_interfaces.Time
    id: str
    def __init__(
        self,
        *,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        id: str = ...,
    ) -> None: ...

class GoalStatus(base.Message):
    PENDING: ClassVar[Literal[0]]
    ACTIVE: ClassVar[Literal[1]]
    PREEMPTED: ClassVar[Literal[2]]
    SUCCEEDED: ClassVar[Literal[3]]
    ABORTED: ClassVar[Literal[4]]
    REJECTED: ClassVar[Literal[5]]
    PREEMPTING: ClassVar[Literal[6]]
    RECALLING: ClassVar[Literal[7]]
    RECALLED: ClassVar[Literal[8]]
    LOST: ClassVar[Literal[9]]
    goal_id: GoalID
    status: int
    text: str
    def __init__(self, *, goal_id: GoalID | Mapping[str, object] = ..., status: int = ..., text: str = ...) -> None: ...

class GoalStatusArray(base.Message):
    header: std_msgs.Header
    status_list: list[GoalStatus]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        status_list: Sequence[GoalStatus | Mapping[str, object]] = ...,
    ) -> None: ...

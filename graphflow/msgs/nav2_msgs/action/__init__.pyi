# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geographic_msgs import msg as geographic_msgs
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.nav2_msgs import msg as nav2_msgs
from graphflow.msgs.nav_msgs import msg as nav_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.std_msgs import msg as std_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class AssistedTeleop_Goal(base.Message):
    time_allowance: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        time_allowance: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class AssistedTeleop_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[730]]
    TIMEOUT: ClassVar[Literal[731]]
    TF_ERROR: ClassVar[Literal[732]]
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class AssistedTeleop_Feedback(base.Message):
    current_teleop_duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        current_teleop_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class AssistedTeleop_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: AssistedTeleop_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: AssistedTeleop_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: AssistedTeleop_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: AssistedTeleop_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[AssistedTeleop_SendGoal_Request]
    response: list[AssistedTeleop_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[AssistedTeleop_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[AssistedTeleop_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class AssistedTeleop_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class AssistedTeleop_GetResult_Response(base.Message):
    status: int
    result: AssistedTeleop_Result
    def __init__(self, *, status: int = ..., result: AssistedTeleop_Result | Mapping[str, object] = ...) -> None: ...

class AssistedTeleop_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[AssistedTeleop_GetResult_Request]
    response: list[AssistedTeleop_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[AssistedTeleop_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[AssistedTeleop_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class AssistedTeleop(base.Action[AssistedTeleop_Goal, AssistedTeleop_Result, AssistedTeleop_Feedback]):
    Goal: TypeAlias = AssistedTeleop_Goal
    Result: TypeAlias = AssistedTeleop_Result
    Feedback: TypeAlias = AssistedTeleop_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class BackUp_Goal(base.Message):
    target: geometry_msgs.Point
    speed: float
    time_allowance: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        target: geometry_msgs.Point | Mapping[str, object] = ...,
        speed: float = ...,
        time_allowance: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class BackUp_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[710]]
    TIMEOUT: ClassVar[Literal[711]]
    TF_ERROR: ClassVar[Literal[712]]
    INVALID_INPUT: ClassVar[Literal[713]]
    COLLISION_AHEAD: ClassVar[Literal[714]]
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class BackUp_Feedback(base.Message):
    distance_traveled: float
    def __init__(self, *, distance_traveled: float = ...) -> None: ...

class BackUp_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: BackUp_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: BackUp_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class BackUp_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: BackUp_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: BackUp_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class BackUp_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class BackUp_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[BackUp_SendGoal_Request]
    response: list[BackUp_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[BackUp_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[BackUp_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class BackUp_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class BackUp_GetResult_Response(base.Message):
    status: int
    result: BackUp_Result
    def __init__(self, *, status: int = ..., result: BackUp_Result | Mapping[str, object] = ...) -> None: ...

class BackUp_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[BackUp_GetResult_Request]
    response: list[BackUp_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[BackUp_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[BackUp_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class BackUp(base.Action[BackUp_Goal, BackUp_Result, BackUp_Feedback]):
    Goal: TypeAlias = BackUp_Goal
    Result: TypeAlias = BackUp_Result
    Feedback: TypeAlias = BackUp_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class ComputeAndTrackRoute_Goal(base.Message):
    start_id: int
    start: geometry_msgs.PoseStamped
    goal_id: int
    goal: geometry_msgs.PoseStamped
    use_start: bool
    use_poses: bool
    def __init__(
        self,
        *,
        start_id: int = ...,
        start: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        goal_id: int = ...,
        goal: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        use_start: bool = ...,
        use_poses: bool = ...,
    ) -> None: ...

class ComputeAndTrackRoute_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[400]]
    TF_ERROR: ClassVar[Literal[401]]
    NO_VALID_GRAPH: ClassVar[Literal[402]]
    INDETERMINANT_NODES_ON_GRAPH: ClassVar[Literal[403]]
    TIMEOUT: ClassVar[Literal[404]]
    NO_VALID_ROUTE: ClassVar[Literal[405]]
    OPERATION_FAILED: ClassVar[Literal[406]]
    INVALID_EDGE_SCORER_USE: ClassVar[Literal[407]]
    execution_duration: builtin_interfaces.Duration
    error_code: int
    def __init__(
        self,
        *,
        execution_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
    ) -> None: ...

class ComputeAndTrackRoute_Feedback(base.Message):
    last_node_id: int
    next_node_id: int
    current_edge_id: int
    route: nav2_msgs.Route
    path: nav_msgs.Path
    operations_triggered: list[str]
    rerouted: bool
    def __init__(
        self,
        *,
        last_node_id: int = ...,
        next_node_id: int = ...,
        current_edge_id: int = ...,
        route: nav2_msgs.Route | Mapping[str, object] = ...,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        operations_triggered: Sequence[str] = ...,
        rerouted: bool = ...,
    ) -> None: ...

class ComputeAndTrackRoute_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: ComputeAndTrackRoute_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: ComputeAndTrackRoute_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: ComputeAndTrackRoute_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: ComputeAndTrackRoute_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputeAndTrackRoute_SendGoal_Request]
    response: list[ComputeAndTrackRoute_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputeAndTrackRoute_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputeAndTrackRoute_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputeAndTrackRoute_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class ComputeAndTrackRoute_GetResult_Response(base.Message):
    status: int
    result: ComputeAndTrackRoute_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ComputeAndTrackRoute_Result | Mapping[str, object] = ...,
    ) -> None: ...

class ComputeAndTrackRoute_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputeAndTrackRoute_GetResult_Request]
    response: list[ComputeAndTrackRoute_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputeAndTrackRoute_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputeAndTrackRoute_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputeAndTrackRoute(
    base.Action[
        ComputeAndTrackRoute_Goal,
        ComputeAndTrackRoute_Result,
        ComputeAndTrackRoute_Feedback,
    ],
):
    Goal: TypeAlias = ComputeAndTrackRoute_Goal
    Result: TypeAlias = ComputeAndTrackRoute_Result
    Feedback: TypeAlias = ComputeAndTrackRoute_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class ComputePathThroughPoses_Goal(base.Message):
    goals: list[geometry_msgs.PoseStamped]
    start: geometry_msgs.PoseStamped
    planner_id: str
    use_start: bool
    def __init__(
        self,
        *,
        goals: Sequence[geometry_msgs.PoseStamped | Mapping[str, object]] = ...,
        start: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        planner_id: str = ...,
        use_start: bool = ...,
    ) -> None: ...

class ComputePathThroughPoses_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[300]]
    INVALID_PLANNER: ClassVar[Literal[301]]
    TF_ERROR: ClassVar[Literal[302]]
    START_OUTSIDE_MAP: ClassVar[Literal[303]]
    GOAL_OUTSIDE_MAP: ClassVar[Literal[304]]
    START_OCCUPIED: ClassVar[Literal[305]]
    GOAL_OCCUPIED: ClassVar[Literal[306]]
    TIMEOUT: ClassVar[Literal[307]]
    NO_VALID_PATH: ClassVar[Literal[308]]
    NO_VIAPOINTS_GIVEN: ClassVar[Literal[309]]
    path: nav_msgs.Path
    planning_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        planning_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class ComputePathThroughPoses_Feedback(base.Message):
    def __init__(self) -> None: ...

class ComputePathThroughPoses_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: ComputePathThroughPoses_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: ComputePathThroughPoses_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: ComputePathThroughPoses_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: ComputePathThroughPoses_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputePathThroughPoses_SendGoal_Request]
    response: list[ComputePathThroughPoses_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputePathThroughPoses_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputePathThroughPoses_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputePathThroughPoses_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class ComputePathThroughPoses_GetResult_Response(base.Message):
    status: int
    result: ComputePathThroughPoses_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ComputePathThroughPoses_Result | Mapping[str, object] = ...,
    ) -> None: ...

class ComputePathThroughPoses_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputePathThroughPoses_GetResult_Request]
    response: list[ComputePathThroughPoses_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputePathThroughPoses_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputePathThroughPoses_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputePathThroughPoses(
    base.Action[
        ComputePathThroughPoses_Goal,
        ComputePathThroughPoses_Result,
        ComputePathThroughPoses_Feedback,
    ],
):
    Goal: TypeAlias = ComputePathThroughPoses_Goal
    Result: TypeAlias = ComputePathThroughPoses_Result
    Feedback: TypeAlias = ComputePathThroughPoses_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class ComputePathToPose_Goal(base.Message):
    goal: geometry_msgs.PoseStamped
    start: geometry_msgs.PoseStamped
    planner_id: str
    use_start: bool
    def __init__(
        self,
        *,
        goal: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        start: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        planner_id: str = ...,
        use_start: bool = ...,
    ) -> None: ...

class ComputePathToPose_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[200]]
    INVALID_PLANNER: ClassVar[Literal[201]]
    TF_ERROR: ClassVar[Literal[202]]
    START_OUTSIDE_MAP: ClassVar[Literal[203]]
    GOAL_OUTSIDE_MAP: ClassVar[Literal[204]]
    START_OCCUPIED: ClassVar[Literal[205]]
    GOAL_OCCUPIED: ClassVar[Literal[206]]
    TIMEOUT: ClassVar[Literal[207]]
    NO_VALID_PATH: ClassVar[Literal[208]]
    path: nav_msgs.Path
    planning_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        planning_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class ComputePathToPose_Feedback(base.Message):
    def __init__(self) -> None: ...

class ComputePathToPose_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: ComputePathToPose_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: ComputePathToPose_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: ComputePathToPose_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: ComputePathToPose_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputePathToPose_SendGoal_Request]
    response: list[ComputePathToPose_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputePathToPose_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputePathToPose_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputePathToPose_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class ComputePathToPose_GetResult_Response(base.Message):
    status: int
    result: ComputePathToPose_Result
    def __init__(self, *, status: int = ..., result: ComputePathToPose_Result | Mapping[str, object] = ...) -> None: ...

class ComputePathToPose_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputePathToPose_GetResult_Request]
    response: list[ComputePathToPose_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputePathToPose_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputePathToPose_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputePathToPose(base.Action[ComputePathToPose_Goal, ComputePathToPose_Result, ComputePathToPose_Feedback]):
    Goal: TypeAlias = ComputePathToPose_Goal
    Result: TypeAlias = ComputePathToPose_Result
    Feedback: TypeAlias = ComputePathToPose_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class ComputeRoute_Goal(base.Message):
    start_id: int
    start: geometry_msgs.PoseStamped
    goal_id: int
    goal: geometry_msgs.PoseStamped
    use_start: bool
    use_poses: bool
    def __init__(
        self,
        *,
        start_id: int = ...,
        start: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        goal_id: int = ...,
        goal: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        use_start: bool = ...,
        use_poses: bool = ...,
    ) -> None: ...

class ComputeRoute_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[400]]
    TF_ERROR: ClassVar[Literal[401]]
    NO_VALID_GRAPH: ClassVar[Literal[402]]
    INDETERMINANT_NODES_ON_GRAPH: ClassVar[Literal[403]]
    TIMEOUT: ClassVar[Literal[404]]
    NO_VALID_ROUTE: ClassVar[Literal[405]]
    INVALID_EDGE_SCORER_USE: ClassVar[Literal[407]]
    planning_time: builtin_interfaces.Duration
    path: nav_msgs.Path
    route: nav2_msgs.Route
    error_code: int
    def __init__(
        self,
        *,
        planning_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        route: nav2_msgs.Route | Mapping[str, object] = ...,
        error_code: int = ...,
    ) -> None: ...

class ComputeRoute_Feedback(base.Message):
    def __init__(self) -> None: ...

class ComputeRoute_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: ComputeRoute_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: ComputeRoute_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class ComputeRoute_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: ComputeRoute_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: ComputeRoute_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class ComputeRoute_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class ComputeRoute_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputeRoute_SendGoal_Request]
    response: list[ComputeRoute_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputeRoute_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputeRoute_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputeRoute_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class ComputeRoute_GetResult_Response(base.Message):
    status: int
    result: ComputeRoute_Result
    def __init__(self, *, status: int = ..., result: ComputeRoute_Result | Mapping[str, object] = ...) -> None: ...

class ComputeRoute_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ComputeRoute_GetResult_Request]
    response: list[ComputeRoute_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ComputeRoute_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[ComputeRoute_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ComputeRoute(base.Action[ComputeRoute_Goal, ComputeRoute_Result, ComputeRoute_Feedback]):
    Goal: TypeAlias = ComputeRoute_Goal
    Result: TypeAlias = ComputeRoute_Result
    Feedback: TypeAlias = ComputeRoute_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class DockRobot_Goal(base.Message):
    use_dock_id: bool
    dock_id: str
    dock_pose: geometry_msgs.PoseStamped
    dock_type: str
    max_staging_time: float
    navigate_to_staging_pose: bool
    def __init__(
        self,
        *,
        use_dock_id: bool = ...,
        dock_id: str = ...,
        dock_pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        dock_type: str = ...,
        max_staging_time: float = ...,
        navigate_to_staging_pose: bool = ...,
    ) -> None: ...

class DockRobot_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    DOCK_NOT_IN_DB: ClassVar[Literal[901]]
    DOCK_NOT_VALID: ClassVar[Literal[902]]
    FAILED_TO_STAGE: ClassVar[Literal[903]]
    FAILED_TO_DETECT_DOCK: ClassVar[Literal[904]]
    FAILED_TO_CONTROL: ClassVar[Literal[905]]
    FAILED_TO_CHARGE: ClassVar[Literal[906]]
    UNKNOWN: ClassVar[Literal[999]]
    success: bool
    error_code: int
    num_retries: int
    error_msg: str
    def __init__(
        self,
        *,
        success: bool = ...,
        error_code: int = ...,
        num_retries: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class DockRobot_Feedback(base.Message):
    NONE: ClassVar[Literal[0]]
    NAV_TO_STAGING_POSE: ClassVar[Literal[1]]
    INITIAL_PERCEPTION: ClassVar[Literal[2]]
    CONTROLLING: ClassVar[Literal[3]]
    WAIT_FOR_CHARGE: ClassVar[Literal[4]]
    RETRY: ClassVar[Literal[5]]
    state: int
    docking_time: builtin_interfaces.Duration
    num_retries: int
    def __init__(
        self,
        *,
        state: int = ...,
        docking_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        num_retries: int = ...,
    ) -> None: ...

class DockRobot_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: DockRobot_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: DockRobot_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class DockRobot_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: DockRobot_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: DockRobot_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class DockRobot_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class DockRobot_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DockRobot_SendGoal_Request]
    response: list[DockRobot_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DockRobot_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[DockRobot_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DockRobot_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class DockRobot_GetResult_Response(base.Message):
    status: int
    result: DockRobot_Result
    def __init__(self, *, status: int = ..., result: DockRobot_Result | Mapping[str, object] = ...) -> None: ...

class DockRobot_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DockRobot_GetResult_Request]
    response: list[DockRobot_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DockRobot_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[DockRobot_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DockRobot(base.Action[DockRobot_Goal, DockRobot_Result, DockRobot_Feedback]):
    Goal: TypeAlias = DockRobot_Goal
    Result: TypeAlias = DockRobot_Result
    Feedback: TypeAlias = DockRobot_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class DriveOnHeading_Goal(base.Message):
    target: geometry_msgs.Point
    speed: float
    time_allowance: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        target: geometry_msgs.Point | Mapping[str, object] = ...,
        speed: float = ...,
        time_allowance: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class DriveOnHeading_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[720]]
    TIMEOUT: ClassVar[Literal[721]]
    TF_ERROR: ClassVar[Literal[722]]
    COLLISION_AHEAD: ClassVar[Literal[723]]
    INVALID_INPUT: ClassVar[Literal[724]]
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class DriveOnHeading_Feedback(base.Message):
    distance_traveled: float
    def __init__(self, *, distance_traveled: float = ...) -> None: ...

class DriveOnHeading_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: DriveOnHeading_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: DriveOnHeading_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: DriveOnHeading_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: DriveOnHeading_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DriveOnHeading_SendGoal_Request]
    response: list[DriveOnHeading_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DriveOnHeading_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[DriveOnHeading_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DriveOnHeading_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class DriveOnHeading_GetResult_Response(base.Message):
    status: int
    result: DriveOnHeading_Result
    def __init__(self, *, status: int = ..., result: DriveOnHeading_Result | Mapping[str, object] = ...) -> None: ...

class DriveOnHeading_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DriveOnHeading_GetResult_Request]
    response: list[DriveOnHeading_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DriveOnHeading_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[DriveOnHeading_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DriveOnHeading(base.Action[DriveOnHeading_Goal, DriveOnHeading_Result, DriveOnHeading_Feedback]):
    Goal: TypeAlias = DriveOnHeading_Goal
    Result: TypeAlias = DriveOnHeading_Result
    Feedback: TypeAlias = DriveOnHeading_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class DummyBehavior_Goal(base.Message):
    command: std_msgs.String
    def __init__(self, *, command: std_msgs.String | Mapping[str, object] = ...) -> None: ...

class DummyBehavior_Result(base.Message):
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class DummyBehavior_Feedback(base.Message):
    def __init__(self) -> None: ...

class DummyBehavior_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: DummyBehavior_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: DummyBehavior_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class DummyBehavior_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: DummyBehavior_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: DummyBehavior_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class DummyBehavior_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class DummyBehavior_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DummyBehavior_SendGoal_Request]
    response: list[DummyBehavior_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DummyBehavior_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[DummyBehavior_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DummyBehavior_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class DummyBehavior_GetResult_Response(base.Message):
    status: int
    result: DummyBehavior_Result
    def __init__(self, *, status: int = ..., result: DummyBehavior_Result | Mapping[str, object] = ...) -> None: ...

class DummyBehavior_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DummyBehavior_GetResult_Request]
    response: list[DummyBehavior_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DummyBehavior_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[DummyBehavior_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DummyBehavior(base.Action[DummyBehavior_Goal, DummyBehavior_Result, DummyBehavior_Feedback]):
    Goal: TypeAlias = DummyBehavior_Goal
    Result: TypeAlias = DummyBehavior_Result
    Feedback: TypeAlias = DummyBehavior_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class FollowGPSWaypoints_Goal(base.Message):
    number_of_loops: int
    goal_index: int
    gps_poses: list[geographic_msgs.GeoPose]
    def __init__(
        self,
        *,
        number_of_loops: int = ...,
        goal_index: int = ...,
        gps_poses: Sequence[geographic_msgs.GeoPose | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowGPSWaypoints_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[600]]
    TASK_EXECUTOR_FAILED: ClassVar[Literal[601]]
    missed_waypoints: list[nav2_msgs.MissedWaypoint]
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        missed_waypoints: Sequence[nav2_msgs.MissedWaypoint | Mapping[str, object]] = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowGPSWaypoints_Feedback(base.Message):
    current_waypoint: int
    def __init__(self, *, current_waypoint: int = ...) -> None: ...

class FollowGPSWaypoints_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: FollowGPSWaypoints_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: FollowGPSWaypoints_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: FollowGPSWaypoints_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: FollowGPSWaypoints_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowGPSWaypoints_SendGoal_Request]
    response: list[FollowGPSWaypoints_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowGPSWaypoints_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowGPSWaypoints_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowGPSWaypoints_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class FollowGPSWaypoints_GetResult_Response(base.Message):
    status: int
    result: FollowGPSWaypoints_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: FollowGPSWaypoints_Result | Mapping[str, object] = ...,
    ) -> None: ...

class FollowGPSWaypoints_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowGPSWaypoints_GetResult_Request]
    response: list[FollowGPSWaypoints_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowGPSWaypoints_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowGPSWaypoints_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowGPSWaypoints(base.Action[FollowGPSWaypoints_Goal, FollowGPSWaypoints_Result, FollowGPSWaypoints_Feedback]):
    Goal: TypeAlias = FollowGPSWaypoints_Goal
    Result: TypeAlias = FollowGPSWaypoints_Result
    Feedback: TypeAlias = FollowGPSWaypoints_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class FollowObject_Goal(base.Message):
    pose_topic: str
    tracked_frame: str
    max_duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        pose_topic: str = ...,
        tracked_frame: str = ...,
        max_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class FollowObject_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    TF_ERROR: ClassVar[Literal[901]]
    FAILED_TO_DETECT_OBJECT: ClassVar[Literal[902]]
    FAILED_TO_CONTROL: ClassVar[Literal[903]]
    TIMEOUT: ClassVar[Literal[904]]
    UNKNOWN: ClassVar[Literal[999]]
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    num_retries: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        num_retries: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowObject_Feedback(base.Message):
    NONE: ClassVar[Literal[0]]
    INITIAL_PERCEPTION: ClassVar[Literal[1]]
    CONTROLLING: ClassVar[Literal[2]]
    STOPPING: ClassVar[Literal[3]]
    RETRY: ClassVar[Literal[4]]
    state: int
    following_time: builtin_interfaces.Duration
    num_retries: int
    def __init__(
        self,
        *,
        state: int = ...,
        following_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        num_retries: int = ...,
    ) -> None: ...

class FollowObject_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: FollowObject_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: FollowObject_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class FollowObject_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: FollowObject_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: FollowObject_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class FollowObject_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class FollowObject_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowObject_SendGoal_Request]
    response: list[FollowObject_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowObject_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowObject_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowObject_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class FollowObject_GetResult_Response(base.Message):
    status: int
    result: FollowObject_Result
    def __init__(self, *, status: int = ..., result: FollowObject_Result | Mapping[str, object] = ...) -> None: ...

class FollowObject_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowObject_GetResult_Request]
    response: list[FollowObject_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowObject_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowObject_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowObject(base.Action[FollowObject_Goal, FollowObject_Result, FollowObject_Feedback]):
    Goal: TypeAlias = FollowObject_Goal
    Result: TypeAlias = FollowObject_Result
    Feedback: TypeAlias = FollowObject_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class FollowPath_Goal(base.Message):
    path: nav_msgs.Path
    controller_id: str
    goal_checker_id: str
    progress_checker_id: str
    def __init__(
        self,
        *,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        controller_id: str = ...,
        goal_checker_id: str = ...,
        progress_checker_id: str = ...,
    ) -> None: ...

class FollowPath_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[100]]
    INVALID_CONTROLLER: ClassVar[Literal[101]]
    TF_ERROR: ClassVar[Literal[102]]
    INVALID_PATH: ClassVar[Literal[103]]
    PATIENCE_EXCEEDED: ClassVar[Literal[104]]
    FAILED_TO_MAKE_PROGRESS: ClassVar[Literal[105]]
    NO_VALID_CONTROL: ClassVar[Literal[106]]
    CONTROLLER_TIMED_OUT: ClassVar[Literal[107]]
    result: std_msgs.Empty
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        result: std_msgs.Empty | Mapping[str, object] = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowPath_Feedback(base.Message):
    distance_to_goal: float
    speed: float
    def __init__(self, *, distance_to_goal: float = ..., speed: float = ...) -> None: ...

class FollowPath_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: FollowPath_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: FollowPath_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class FollowPath_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: FollowPath_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: FollowPath_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class FollowPath_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class FollowPath_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowPath_SendGoal_Request]
    response: list[FollowPath_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowPath_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowPath_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowPath_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class FollowPath_GetResult_Response(base.Message):
    status: int
    result: FollowPath_Result
    def __init__(self, *, status: int = ..., result: FollowPath_Result | Mapping[str, object] = ...) -> None: ...

class FollowPath_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowPath_GetResult_Request]
    response: list[FollowPath_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowPath_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowPath_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowPath(base.Action[FollowPath_Goal, FollowPath_Result, FollowPath_Feedback]):
    Goal: TypeAlias = FollowPath_Goal
    Result: TypeAlias = FollowPath_Result
    Feedback: TypeAlias = FollowPath_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class FollowWaypoints_Goal(base.Message):
    number_of_loops: int
    goal_index: int
    poses: list[geometry_msgs.PoseStamped]
    def __init__(
        self,
        *,
        number_of_loops: int = ...,
        goal_index: int = ...,
        poses: Sequence[geometry_msgs.PoseStamped | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowWaypoints_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[600]]
    TASK_EXECUTOR_FAILED: ClassVar[Literal[601]]
    missed_waypoints: list[nav2_msgs.MissedWaypoint]
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        missed_waypoints: Sequence[nav2_msgs.MissedWaypoint | Mapping[str, object]] = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowWaypoints_Feedback(base.Message):
    current_waypoint: int
    def __init__(self, *, current_waypoint: int = ...) -> None: ...

class FollowWaypoints_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: FollowWaypoints_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: FollowWaypoints_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: FollowWaypoints_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: FollowWaypoints_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowWaypoints_SendGoal_Request]
    response: list[FollowWaypoints_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowWaypoints_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowWaypoints_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowWaypoints_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class FollowWaypoints_GetResult_Response(base.Message):
    status: int
    result: FollowWaypoints_Result
    def __init__(self, *, status: int = ..., result: FollowWaypoints_Result | Mapping[str, object] = ...) -> None: ...

class FollowWaypoints_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowWaypoints_GetResult_Request]
    response: list[FollowWaypoints_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowWaypoints_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowWaypoints_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowWaypoints(base.Action[FollowWaypoints_Goal, FollowWaypoints_Result, FollowWaypoints_Feedback]):
    Goal: TypeAlias = FollowWaypoints_Goal
    Result: TypeAlias = FollowWaypoints_Result
    Feedback: TypeAlias = FollowWaypoints_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class NavigateThroughPoses_Goal(base.Message):
    poses: list[geometry_msgs.PoseStamped]
    behavior_tree: str
    def __init__(
        self,
        *,
        poses: Sequence[geometry_msgs.PoseStamped | Mapping[str, object]] = ...,
        behavior_tree: str = ...,
    ) -> None: ...

class NavigateThroughPoses_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    error_code: int
    error_msg: str
    def __init__(self, *, error_code: int = ..., error_msg: str = ...) -> None: ...

class NavigateThroughPoses_Feedback(base.Message):
    current_pose: geometry_msgs.PoseStamped
    navigation_time: builtin_interfaces.Duration
    estimated_time_remaining: builtin_interfaces.Duration
    number_of_recoveries: int
    distance_remaining: float
    number_of_poses_remaining: int
    def __init__(
        self,
        *,
        current_pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        navigation_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        estimated_time_remaining: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        number_of_recoveries: int = ...,
        distance_remaining: float = ...,
        number_of_poses_remaining: int = ...,
    ) -> None: ...

class NavigateThroughPoses_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: NavigateThroughPoses_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: NavigateThroughPoses_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: NavigateThroughPoses_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: NavigateThroughPoses_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[NavigateThroughPoses_SendGoal_Request]
    response: list[NavigateThroughPoses_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[NavigateThroughPoses_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[NavigateThroughPoses_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class NavigateThroughPoses_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class NavigateThroughPoses_GetResult_Response(base.Message):
    status: int
    result: NavigateThroughPoses_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: NavigateThroughPoses_Result | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateThroughPoses_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[NavigateThroughPoses_GetResult_Request]
    response: list[NavigateThroughPoses_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[NavigateThroughPoses_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[NavigateThroughPoses_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class NavigateThroughPoses(
    base.Action[
        NavigateThroughPoses_Goal,
        NavigateThroughPoses_Result,
        NavigateThroughPoses_Feedback,
    ],
):
    Goal: TypeAlias = NavigateThroughPoses_Goal
    Result: TypeAlias = NavigateThroughPoses_Result
    Feedback: TypeAlias = NavigateThroughPoses_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class NavigateToPose_Goal(base.Message):
    pose: geometry_msgs.PoseStamped
    behavior_tree: str
    def __init__(
        self,
        *,
        pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        behavior_tree: str = ...,
    ) -> None: ...

class NavigateToPose_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    error_code: int
    error_msg: str
    def __init__(self, *, error_code: int = ..., error_msg: str = ...) -> None: ...

class NavigateToPose_Feedback(base.Message):
    current_pose: geometry_msgs.PoseStamped
    navigation_time: builtin_interfaces.Duration
    estimated_time_remaining: builtin_interfaces.Duration
    number_of_recoveries: int
    distance_remaining: float
    def __init__(
        self,
        *,
        current_pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        navigation_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        estimated_time_remaining: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        number_of_recoveries: int = ...,
        distance_remaining: float = ...,
    ) -> None: ...

class NavigateToPose_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: NavigateToPose_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: NavigateToPose_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateToPose_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: NavigateToPose_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: NavigateToPose_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateToPose_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class NavigateToPose_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[NavigateToPose_SendGoal_Request]
    response: list[NavigateToPose_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[NavigateToPose_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[NavigateToPose_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class NavigateToPose_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class NavigateToPose_GetResult_Response(base.Message):
    status: int
    result: NavigateToPose_Result
    def __init__(self, *, status: int = ..., result: NavigateToPose_Result | Mapping[str, object] = ...) -> None: ...

class NavigateToPose_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[NavigateToPose_GetResult_Request]
    response: list[NavigateToPose_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[NavigateToPose_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[NavigateToPose_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class NavigateToPose(base.Action[NavigateToPose_Goal, NavigateToPose_Result, NavigateToPose_Feedback]):
    Goal: TypeAlias = NavigateToPose_Goal
    Result: TypeAlias = NavigateToPose_Result
    Feedback: TypeAlias = NavigateToPose_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class SmoothPath_Goal(base.Message):
    path: nav_msgs.Path
    smoother_id: str
    max_smoothing_duration: builtin_interfaces.Duration
    check_for_collisions: bool
    def __init__(
        self,
        *,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        smoother_id: str = ...,
        max_smoothing_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        check_for_collisions: bool = ...,
    ) -> None: ...

class SmoothPath_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[500]]
    INVALID_SMOOTHER: ClassVar[Literal[501]]
    TIMEOUT: ClassVar[Literal[502]]
    SMOOTHED_PATH_IN_COLLISION: ClassVar[Literal[503]]
    FAILED_TO_SMOOTH_PATH: ClassVar[Literal[504]]
    INVALID_PATH: ClassVar[Literal[505]]
    path: nav_msgs.Path
    smoothing_duration: builtin_interfaces.Duration
    was_completed: bool
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        path: nav_msgs.Path | Mapping[str, object] = ...,
        smoothing_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        was_completed: bool = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class SmoothPath_Feedback(base.Message):
    def __init__(self) -> None: ...

class SmoothPath_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: SmoothPath_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: SmoothPath_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class SmoothPath_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: SmoothPath_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: SmoothPath_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class SmoothPath_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class SmoothPath_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SmoothPath_SendGoal_Request]
    response: list[SmoothPath_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SmoothPath_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[SmoothPath_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SmoothPath_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class SmoothPath_GetResult_Response(base.Message):
    status: int
    result: SmoothPath_Result
    def __init__(self, *, status: int = ..., result: SmoothPath_Result | Mapping[str, object] = ...) -> None: ...

class SmoothPath_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SmoothPath_GetResult_Request]
    response: list[SmoothPath_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SmoothPath_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[SmoothPath_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SmoothPath(base.Action[SmoothPath_Goal, SmoothPath_Result, SmoothPath_Feedback]):
    Goal: TypeAlias = SmoothPath_Goal
    Result: TypeAlias = SmoothPath_Result
    Feedback: TypeAlias = SmoothPath_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class Spin_Goal(base.Message):
    target_yaw: float
    time_allowance: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        target_yaw: float = ...,
        time_allowance: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class Spin_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    UNKNOWN: ClassVar[Literal[700]]
    TIMEOUT: ClassVar[Literal[701]]
    TF_ERROR: ClassVar[Literal[702]]
    COLLISION_AHEAD: ClassVar[Literal[703]]
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class Spin_Feedback(base.Message):
    angular_distance_traveled: float
    def __init__(self, *, angular_distance_traveled: float = ...) -> None: ...

class Spin_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: Spin_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: Spin_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class Spin_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: Spin_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: Spin_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class Spin_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class Spin_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Spin_SendGoal_Request]
    response: list[Spin_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Spin_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[Spin_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Spin_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class Spin_GetResult_Response(base.Message):
    status: int
    result: Spin_Result
    def __init__(self, *, status: int = ..., result: Spin_Result | Mapping[str, object] = ...) -> None: ...

class Spin_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Spin_GetResult_Request]
    response: list[Spin_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Spin_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[Spin_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Spin(base.Action[Spin_Goal, Spin_Result, Spin_Feedback]):
    Goal: TypeAlias = Spin_Goal
    Result: TypeAlias = Spin_Result
    Feedback: TypeAlias = Spin_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class UndockRobot_Goal(base.Message):
    dock_type: str
    max_undocking_time: float
    def __init__(self, *, dock_type: str = ..., max_undocking_time: float = ...) -> None: ...

class UndockRobot_Result(base.Message):
    NONE: ClassVar[Literal[0]]
    DOCK_NOT_VALID: ClassVar[Literal[902]]
    FAILED_TO_CONTROL: ClassVar[Literal[905]]
    UNKNOWN: ClassVar[Literal[999]]
    success: bool
    error_code: int
    error_msg: str
    def __init__(self, *, success: bool = ..., error_code: int = ..., error_msg: str = ...) -> None: ...

class UndockRobot_Feedback(base.Message):
    def __init__(self) -> None: ...

class UndockRobot_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: UndockRobot_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: UndockRobot_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class UndockRobot_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: UndockRobot_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: UndockRobot_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class UndockRobot_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class UndockRobot_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[UndockRobot_SendGoal_Request]
    response: list[UndockRobot_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[UndockRobot_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[UndockRobot_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class UndockRobot_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class UndockRobot_GetResult_Response(base.Message):
    status: int
    result: UndockRobot_Result
    def __init__(self, *, status: int = ..., result: UndockRobot_Result | Mapping[str, object] = ...) -> None: ...

class UndockRobot_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[UndockRobot_GetResult_Request]
    response: list[UndockRobot_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[UndockRobot_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[UndockRobot_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class UndockRobot(base.Action[UndockRobot_Goal, UndockRobot_Result, UndockRobot_Feedback]):
    Goal: TypeAlias = UndockRobot_Goal
    Result: TypeAlias = UndockRobot_Result
    Feedback: TypeAlias = UndockRobot_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class Wait_Goal(base.Message):
    time: builtin_interfaces.Duration
    def __init__(self, *, time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...) -> None: ...

class Wait_Result(base.Message):
    total_elapsed_time: builtin_interfaces.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class Wait_Feedback(base.Message):
    time_left: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        time_left: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class Wait_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: Wait_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: Wait_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class Wait_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: Wait_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: Wait_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class Wait_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class Wait_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Wait_SendGoal_Request]
    response: list[Wait_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Wait_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[Wait_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Wait_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class Wait_GetResult_Response(base.Message):
    status: int
    result: Wait_Result
    def __init__(self, *, status: int = ..., result: Wait_Result | Mapping[str, object] = ...) -> None: ...

class Wait_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Wait_GetResult_Request]
    response: list[Wait_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Wait_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[Wait_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Wait(base.Action[Wait_Goal, Wait_Result, Wait_Feedback]):
    Goal: TypeAlias = Wait_Goal
    Result: TypeAlias = Wait_Result
    Feedback: TypeAlias = Wait_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

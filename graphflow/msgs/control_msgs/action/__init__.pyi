# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.control_msgs import msg as control_msgs
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.std_msgs import msg as std_msgs
from graphflow.msgs.trajectory_msgs import msg as trajectory_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class ExecuteMotionPrimitiveSequence_Goal(base.Message):
    trajectory: control_msgs.MotionPrimitiveSequence
    def __init__(self, *, trajectory: control_msgs.MotionPrimitiveSequence | Mapping[str, object] = ...) -> None: ...

class ExecuteMotionPrimitiveSequence_Result(base.Message):
    SUCCESSFUL: ClassVar[Literal[0]]
    INVALID_GOAL: ClassVar[Literal[-1]]
    OLD_HEADER_TIMESTAMP: ClassVar[Literal[-3]]
    error_code: int
    error_string: str
    def __init__(self, *, error_code: int = ..., error_string: str = ...) -> None: ...

class ExecuteMotionPrimitiveSequence_Feedback(base.Message):
    current_primitive_index: int
    def __init__(self, *, current_primitive_index: int = ...) -> None: ...

class ExecuteMotionPrimitiveSequence_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: ExecuteMotionPrimitiveSequence_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: ExecuteMotionPrimitiveSequence_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class ExecuteMotionPrimitiveSequence_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: ExecuteMotionPrimitiveSequence_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: ExecuteMotionPrimitiveSequence_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class ExecuteMotionPrimitiveSequence_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class ExecuteMotionPrimitiveSequence_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ExecuteMotionPrimitiveSequence_SendGoal_Request]
    response: list[ExecuteMotionPrimitiveSequence_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ExecuteMotionPrimitiveSequence_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[ExecuteMotionPrimitiveSequence_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ExecuteMotionPrimitiveSequence_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class ExecuteMotionPrimitiveSequence_GetResult_Response(base.Message):
    status: int
    result: ExecuteMotionPrimitiveSequence_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ExecuteMotionPrimitiveSequence_Result | Mapping[str, object] = ...,
    ) -> None: ...

class ExecuteMotionPrimitiveSequence_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ExecuteMotionPrimitiveSequence_GetResult_Request]
    response: list[ExecuteMotionPrimitiveSequence_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ExecuteMotionPrimitiveSequence_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[ExecuteMotionPrimitiveSequence_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ExecuteMotionPrimitiveSequence(
    base.Action[
        ExecuteMotionPrimitiveSequence_Goal,
        ExecuteMotionPrimitiveSequence_Result,
        ExecuteMotionPrimitiveSequence_Feedback,
    ],
):
    Goal: TypeAlias = ExecuteMotionPrimitiveSequence_Goal
    Result: TypeAlias = ExecuteMotionPrimitiveSequence_Result
    Feedback: TypeAlias = ExecuteMotionPrimitiveSequence_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class FollowJointTrajectory_Goal(base.Message):
    trajectory: trajectory_msgs.JointTrajectory
    multi_dof_trajectory: trajectory_msgs.MultiDOFJointTrajectory
    path_tolerance: list[control_msgs.JointTolerance]
    component_path_tolerance: list[control_msgs.JointComponentTolerance]
    goal_tolerance: list[control_msgs.JointTolerance]
    component_goal_tolerance: list[control_msgs.JointComponentTolerance]
    goal_time_tolerance: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        trajectory: trajectory_msgs.JointTrajectory | Mapping[str, object] = ...,
        multi_dof_trajectory: trajectory_msgs.MultiDOFJointTrajectory | Mapping[str, object] = ...,
        path_tolerance: Sequence[control_msgs.JointTolerance | Mapping[str, object]] = ...,
        component_path_tolerance: Sequence[control_msgs.JointComponentTolerance | Mapping[str, object]] = ...,
        goal_tolerance: Sequence[control_msgs.JointTolerance | Mapping[str, object]] = ...,
        component_goal_tolerance: Sequence[control_msgs.JointComponentTolerance | Mapping[str, object]] = ...,
        goal_time_tolerance: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class FollowJointTrajectory_Result(base.Message):
    SUCCESSFUL: ClassVar[Literal[0]]
    INVALID_GOAL: ClassVar[Literal[-1]]
    INVALID_JOINTS: ClassVar[Literal[-2]]
    OLD_HEADER_TIMESTAMP: ClassVar[Literal[-3]]
    PATH_TOLERANCE_VIOLATED: ClassVar[Literal[-4]]
    GOAL_TOLERANCE_VIOLATED: ClassVar[Literal[-5]]
    error_code: int
    error_string: str
    def __init__(self, *, error_code: int = ..., error_string: str = ...) -> None: ...

class FollowJointTrajectory_Feedback(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    desired: trajectory_msgs.JointTrajectoryPoint
    actual: trajectory_msgs.JointTrajectoryPoint
    error: trajectory_msgs.JointTrajectoryPoint
    multi_dof_joint_names: list[str]
    multi_dof_desired: trajectory_msgs.MultiDOFJointTrajectoryPoint
    multi_dof_actual: trajectory_msgs.MultiDOFJointTrajectoryPoint
    multi_dof_error: trajectory_msgs.MultiDOFJointTrajectoryPoint
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        desired: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        actual: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        error: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_joint_names: Sequence[str] = ...,
        multi_dof_desired: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_actual: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_error: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
    ) -> None: ...

class FollowJointTrajectory_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: FollowJointTrajectory_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: FollowJointTrajectory_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class FollowJointTrajectory_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: FollowJointTrajectory_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: FollowJointTrajectory_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class FollowJointTrajectory_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class FollowJointTrajectory_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowJointTrajectory_SendGoal_Request]
    response: list[FollowJointTrajectory_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowJointTrajectory_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowJointTrajectory_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowJointTrajectory_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class FollowJointTrajectory_GetResult_Response(base.Message):
    status: int
    result: FollowJointTrajectory_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: FollowJointTrajectory_Result | Mapping[str, object] = ...,
    ) -> None: ...

class FollowJointTrajectory_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[FollowJointTrajectory_GetResult_Request]
    response: list[FollowJointTrajectory_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[FollowJointTrajectory_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[FollowJointTrajectory_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class FollowJointTrajectory(
    base.Action[
        FollowJointTrajectory_Goal,
        FollowJointTrajectory_Result,
        FollowJointTrajectory_Feedback,
    ],
):
    Goal: TypeAlias = FollowJointTrajectory_Goal
    Result: TypeAlias = FollowJointTrajectory_Result
    Feedback: TypeAlias = FollowJointTrajectory_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class GripperCommand_Goal(base.Message):
    command: control_msgs.GripperCommand
    def __init__(self, *, command: control_msgs.GripperCommand | Mapping[str, object] = ...) -> None: ...

class GripperCommand_Result(base.Message):
    position: float
    effort: float
    stalled: bool
    reached_goal: bool
    def __init__(
        self,
        *,
        position: float = ...,
        effort: float = ...,
        stalled: bool = ...,
        reached_goal: bool = ...,
    ) -> None: ...

class GripperCommand_Feedback(base.Message):
    position: float
    effort: float
    stalled: bool
    reached_goal: bool
    def __init__(
        self,
        *,
        position: float = ...,
        effort: float = ...,
        stalled: bool = ...,
        reached_goal: bool = ...,
    ) -> None: ...

class GripperCommand_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: GripperCommand_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: GripperCommand_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class GripperCommand_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: GripperCommand_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: GripperCommand_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class GripperCommand_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class GripperCommand_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GripperCommand_SendGoal_Request]
    response: list[GripperCommand_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GripperCommand_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[GripperCommand_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GripperCommand_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class GripperCommand_GetResult_Response(base.Message):
    status: int
    result: GripperCommand_Result
    def __init__(self, *, status: int = ..., result: GripperCommand_Result | Mapping[str, object] = ...) -> None: ...

class GripperCommand_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GripperCommand_GetResult_Request]
    response: list[GripperCommand_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GripperCommand_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[GripperCommand_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GripperCommand(base.Action[GripperCommand_Goal, GripperCommand_Result, GripperCommand_Feedback]):
    Goal: TypeAlias = GripperCommand_Goal
    Result: TypeAlias = GripperCommand_Result
    Feedback: TypeAlias = GripperCommand_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class JointTrajectory_Goal(base.Message):
    trajectory: trajectory_msgs.JointTrajectory
    def __init__(self, *, trajectory: trajectory_msgs.JointTrajectory | Mapping[str, object] = ...) -> None: ...

class JointTrajectory_Result(base.Message):
    def __init__(self) -> None: ...

class JointTrajectory_Feedback(base.Message):
    def __init__(self) -> None: ...

class JointTrajectory_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: JointTrajectory_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: JointTrajectory_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class JointTrajectory_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: JointTrajectory_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: JointTrajectory_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class JointTrajectory_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class JointTrajectory_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[JointTrajectory_SendGoal_Request]
    response: list[JointTrajectory_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[JointTrajectory_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[JointTrajectory_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class JointTrajectory_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class JointTrajectory_GetResult_Response(base.Message):
    status: int
    result: JointTrajectory_Result
    def __init__(self, *, status: int = ..., result: JointTrajectory_Result | Mapping[str, object] = ...) -> None: ...

class JointTrajectory_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[JointTrajectory_GetResult_Request]
    response: list[JointTrajectory_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[JointTrajectory_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[JointTrajectory_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class JointTrajectory(base.Action[JointTrajectory_Goal, JointTrajectory_Result, JointTrajectory_Feedback]):
    Goal: TypeAlias = JointTrajectory_Goal
    Result: TypeAlias = JointTrajectory_Result
    Feedback: TypeAlias = JointTrajectory_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class ParallelGripperCommand_Goal(base.Message):
    command: sensor_msgs.JointState
    def __init__(self, *, command: sensor_msgs.JointState | Mapping[str, object] = ...) -> None: ...

class ParallelGripperCommand_Result(base.Message):
    state: sensor_msgs.JointState
    stalled: bool
    reached_goal: bool
    def __init__(
        self,
        *,
        state: sensor_msgs.JointState | Mapping[str, object] = ...,
        stalled: bool = ...,
        reached_goal: bool = ...,
    ) -> None: ...

class ParallelGripperCommand_Feedback(base.Message):
    state: sensor_msgs.JointState
    def __init__(self, *, state: sensor_msgs.JointState | Mapping[str, object] = ...) -> None: ...

class ParallelGripperCommand_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: ParallelGripperCommand_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: ParallelGripperCommand_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class ParallelGripperCommand_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: ParallelGripperCommand_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: ParallelGripperCommand_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class ParallelGripperCommand_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class ParallelGripperCommand_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ParallelGripperCommand_SendGoal_Request]
    response: list[ParallelGripperCommand_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ParallelGripperCommand_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[ParallelGripperCommand_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ParallelGripperCommand_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class ParallelGripperCommand_GetResult_Response(base.Message):
    status: int
    result: ParallelGripperCommand_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ParallelGripperCommand_Result | Mapping[str, object] = ...,
    ) -> None: ...

class ParallelGripperCommand_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ParallelGripperCommand_GetResult_Request]
    response: list[ParallelGripperCommand_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ParallelGripperCommand_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[ParallelGripperCommand_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ParallelGripperCommand(
    base.Action[
        ParallelGripperCommand_Goal,
        ParallelGripperCommand_Result,
        ParallelGripperCommand_Feedback,
    ],
):
    Goal: TypeAlias = ParallelGripperCommand_Goal
    Result: TypeAlias = ParallelGripperCommand_Result
    Feedback: TypeAlias = ParallelGripperCommand_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class PointHead_Goal(base.Message):
    target: geometry_msgs.PointStamped
    pointing_axis: geometry_msgs.Vector3
    pointing_frame: str
    min_duration: builtin_interfaces.Duration
    max_velocity: float
    def __init__(
        self,
        *,
        target: geometry_msgs.PointStamped | Mapping[str, object] = ...,
        pointing_axis: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        pointing_frame: str = ...,
        min_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        max_velocity: float = ...,
    ) -> None: ...

class PointHead_Result(base.Message):
    def __init__(self) -> None: ...

class PointHead_Feedback(base.Message):
    pointing_angle_error: float
    def __init__(self, *, pointing_angle_error: float = ...) -> None: ...

class PointHead_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: PointHead_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: PointHead_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class PointHead_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: PointHead_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: PointHead_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class PointHead_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class PointHead_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[PointHead_SendGoal_Request]
    response: list[PointHead_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[PointHead_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[PointHead_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class PointHead_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class PointHead_GetResult_Response(base.Message):
    status: int
    result: PointHead_Result
    def __init__(self, *, status: int = ..., result: PointHead_Result | Mapping[str, object] = ...) -> None: ...

class PointHead_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[PointHead_GetResult_Request]
    response: list[PointHead_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[PointHead_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[PointHead_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class PointHead(base.Action[PointHead_Goal, PointHead_Result, PointHead_Feedback]):
    Goal: TypeAlias = PointHead_Goal
    Result: TypeAlias = PointHead_Result
    Feedback: TypeAlias = PointHead_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class SingleJointPosition_Goal(base.Message):
    position: float
    min_duration: builtin_interfaces.Duration
    max_velocity: float
    def __init__(
        self,
        *,
        position: float = ...,
        min_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        max_velocity: float = ...,
    ) -> None: ...

class SingleJointPosition_Result(base.Message):
    def __init__(self) -> None: ...

class SingleJointPosition_Feedback(base.Message):
    header: std_msgs.Header
    position: float
    velocity: float
    error: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        position: float = ...,
        velocity: float = ...,
        error: float = ...,
    ) -> None: ...

class SingleJointPosition_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: SingleJointPosition_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: SingleJointPosition_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class SingleJointPosition_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: SingleJointPosition_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: SingleJointPosition_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class SingleJointPosition_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class SingleJointPosition_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SingleJointPosition_SendGoal_Request]
    response: list[SingleJointPosition_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SingleJointPosition_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[SingleJointPosition_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SingleJointPosition_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class SingleJointPosition_GetResult_Response(base.Message):
    status: int
    result: SingleJointPosition_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: SingleJointPosition_Result | Mapping[str, object] = ...,
    ) -> None: ...

class SingleJointPosition_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SingleJointPosition_GetResult_Request]
    response: list[SingleJointPosition_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SingleJointPosition_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[SingleJointPosition_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SingleJointPosition(
    base.Action[
        SingleJointPosition_Goal,
        SingleJointPosition_Result,
        SingleJointPosition_Feedback,
    ],
):
    Goal: TypeAlias = SingleJointPosition_Goal
    Result: TypeAlias = SingleJointPosition_Result
    Feedback: TypeAlias = SingleJointPosition_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.irobot_create_msgs import msg as irobot_create_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class AudioNoteSequence_Goal(base.Message):
    INFINITE: ClassVar[Literal[-1]]
    iterations: int
    note_sequence: irobot_create_msgs.AudioNoteVector
    def __init__(
        self,
        *,
        iterations: int = ...,
        note_sequence: irobot_create_msgs.AudioNoteVector | Mapping[str, object] = ...,
    ) -> None: ...

class AudioNoteSequence_Result(base.Message):
    complete: bool
    iterations_played: int
    runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        complete: bool = ...,
        iterations_played: int = ...,
        runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class AudioNoteSequence_Feedback(base.Message):
    iterations_played: int
    current_runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        iterations_played: int = ...,
        current_runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class AudioNoteSequence_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: AudioNoteSequence_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: AudioNoteSequence_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class AudioNoteSequence_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: AudioNoteSequence_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: AudioNoteSequence_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class AudioNoteSequence_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class AudioNoteSequence_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[AudioNoteSequence_SendGoal_Request]
    response: list[AudioNoteSequence_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[AudioNoteSequence_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[AudioNoteSequence_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class AudioNoteSequence_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class AudioNoteSequence_GetResult_Response(base.Message):
    status: int
    result: AudioNoteSequence_Result
    def __init__(self, *, status: int = ..., result: AudioNoteSequence_Result | Mapping[str, object] = ...) -> None: ...

class AudioNoteSequence_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[AudioNoteSequence_GetResult_Request]
    response: list[AudioNoteSequence_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[AudioNoteSequence_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[AudioNoteSequence_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class AudioNoteSequence(base.Action[AudioNoteSequence_Goal, AudioNoteSequence_Result, AudioNoteSequence_Feedback]):
    Goal: TypeAlias = AudioNoteSequence_Goal
    Result: TypeAlias = AudioNoteSequence_Result
    Feedback: TypeAlias = AudioNoteSequence_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class Dock_Goal(base.Message):
    def __init__(self) -> None: ...

class Dock_Result(base.Message):
    is_docked: bool
    def __init__(self, *, is_docked: bool = ...) -> None: ...

class Dock_Feedback(base.Message):
    sees_dock: bool
    def __init__(self, *, sees_dock: bool = ...) -> None: ...

class Dock_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: Dock_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: Dock_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class Dock_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: Dock_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: Dock_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class Dock_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class Dock_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Dock_SendGoal_Request]
    response: list[Dock_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Dock_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[Dock_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Dock_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class Dock_GetResult_Response(base.Message):
    status: int
    result: Dock_Result
    def __init__(self, *, status: int = ..., result: Dock_Result | Mapping[str, object] = ...) -> None: ...

class Dock_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Dock_GetResult_Request]
    response: list[Dock_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Dock_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[Dock_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Dock(base.Action[Dock_Goal, Dock_Result, Dock_Feedback]):
    Goal: TypeAlias = Dock_Goal
    Result: TypeAlias = Dock_Result
    Feedback: TypeAlias = Dock_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class DriveArc_Goal(base.Message):
    TRANSLATE_FORWARD: ClassVar[Literal[1]]
    TRANSLATE_BACKWARD: ClassVar[Literal[-1]]
    translate_direction: int
    angle: float
    radius: float
    max_translation_speed: float
    def __init__(
        self,
        *,
        translate_direction: int = ...,
        angle: float = ...,
        radius: float = ...,
        max_translation_speed: float = ...,
    ) -> None: ...

class DriveArc_Result(base.Message):
    pose: geometry_msgs.PoseStamped
    def __init__(self, *, pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...) -> None: ...

class DriveArc_Feedback(base.Message):
    remaining_angle_travel: float
    def __init__(self, *, remaining_angle_travel: float = ...) -> None: ...

class DriveArc_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: DriveArc_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: DriveArc_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class DriveArc_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: DriveArc_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: DriveArc_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class DriveArc_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class DriveArc_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DriveArc_SendGoal_Request]
    response: list[DriveArc_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DriveArc_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[DriveArc_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DriveArc_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class DriveArc_GetResult_Response(base.Message):
    status: int
    result: DriveArc_Result
    def __init__(self, *, status: int = ..., result: DriveArc_Result | Mapping[str, object] = ...) -> None: ...

class DriveArc_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DriveArc_GetResult_Request]
    response: list[DriveArc_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DriveArc_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[DriveArc_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DriveArc(base.Action[DriveArc_Goal, DriveArc_Result, DriveArc_Feedback]):
    Goal: TypeAlias = DriveArc_Goal
    Result: TypeAlias = DriveArc_Result
    Feedback: TypeAlias = DriveArc_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class DriveDistance_Goal(base.Message):
    distance: float
    max_translation_speed: float
    def __init__(self, *, distance: float = ..., max_translation_speed: float = ...) -> None: ...

class DriveDistance_Result(base.Message):
    pose: geometry_msgs.PoseStamped
    def __init__(self, *, pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...) -> None: ...

class DriveDistance_Feedback(base.Message):
    remaining_travel_distance: float
    def __init__(self, *, remaining_travel_distance: float = ...) -> None: ...

class DriveDistance_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: DriveDistance_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: DriveDistance_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class DriveDistance_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: DriveDistance_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: DriveDistance_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class DriveDistance_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class DriveDistance_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DriveDistance_SendGoal_Request]
    response: list[DriveDistance_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DriveDistance_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[DriveDistance_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DriveDistance_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class DriveDistance_GetResult_Response(base.Message):
    status: int
    result: DriveDistance_Result
    def __init__(self, *, status: int = ..., result: DriveDistance_Result | Mapping[str, object] = ...) -> None: ...

class DriveDistance_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DriveDistance_GetResult_Request]
    response: list[DriveDistance_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DriveDistance_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[DriveDistance_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DriveDistance(base.Action[DriveDistance_Goal, DriveDistance_Result, DriveDistance_Feedback]):
    Goal: TypeAlias = DriveDistance_Goal
    Result: TypeAlias = DriveDistance_Result
    Feedback: TypeAlias = DriveDistance_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class LedAnimation_Goal(base.Message):
    BLINK_LIGHTS: ClassVar[Literal[1]]
    SPIN_LIGHTS: ClassVar[Literal[2]]
    animation_type: int
    lightring: irobot_create_msgs.LightringLeds
    max_runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        animation_type: int = ...,
        lightring: irobot_create_msgs.LightringLeds | Mapping[str, object] = ...,
        max_runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class LedAnimation_Result(base.Message):
    runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class LedAnimation_Feedback(base.Message):
    remaining_runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        remaining_runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class LedAnimation_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: LedAnimation_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: LedAnimation_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class LedAnimation_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: LedAnimation_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: LedAnimation_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class LedAnimation_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class LedAnimation_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LedAnimation_SendGoal_Request]
    response: list[LedAnimation_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LedAnimation_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[LedAnimation_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LedAnimation_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class LedAnimation_GetResult_Response(base.Message):
    status: int
    result: LedAnimation_Result
    def __init__(self, *, status: int = ..., result: LedAnimation_Result | Mapping[str, object] = ...) -> None: ...

class LedAnimation_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LedAnimation_GetResult_Request]
    response: list[LedAnimation_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LedAnimation_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[LedAnimation_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LedAnimation(base.Action[LedAnimation_Goal, LedAnimation_Result, LedAnimation_Feedback]):
    Goal: TypeAlias = LedAnimation_Goal
    Result: TypeAlias = LedAnimation_Result
    Feedback: TypeAlias = LedAnimation_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class NavigateToPosition_Goal(base.Message):
    goal_pose: geometry_msgs.PoseStamped
    achieve_goal_heading: bool
    max_translation_speed: float
    max_rotation_speed: float
    def __init__(
        self,
        *,
        goal_pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
        achieve_goal_heading: bool = ...,
        max_translation_speed: float = ...,
        max_rotation_speed: float = ...,
    ) -> None: ...

class NavigateToPosition_Result(base.Message):
    pose: geometry_msgs.PoseStamped
    def __init__(self, *, pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...) -> None: ...

class NavigateToPosition_Feedback(base.Message):
    ROTATING_TO_GOAL_POSITION: ClassVar[Literal[1]]
    DRIVING_TO_GOAL_POSITION: ClassVar[Literal[2]]
    ROTATING_TO_GOAL_ORIENTATION: ClassVar[Literal[3]]
    navigate_state: int
    remaining_angle_travel: float
    remaining_travel_distance: float
    def __init__(
        self,
        *,
        navigate_state: int = ...,
        remaining_angle_travel: float = ...,
        remaining_travel_distance: float = ...,
    ) -> None: ...

class NavigateToPosition_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: NavigateToPosition_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: NavigateToPosition_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateToPosition_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: NavigateToPosition_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: NavigateToPosition_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateToPosition_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class NavigateToPosition_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[NavigateToPosition_SendGoal_Request]
    response: list[NavigateToPosition_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[NavigateToPosition_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[NavigateToPosition_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class NavigateToPosition_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class NavigateToPosition_GetResult_Response(base.Message):
    status: int
    result: NavigateToPosition_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: NavigateToPosition_Result | Mapping[str, object] = ...,
    ) -> None: ...

class NavigateToPosition_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[NavigateToPosition_GetResult_Request]
    response: list[NavigateToPosition_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[NavigateToPosition_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[NavigateToPosition_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class NavigateToPosition(base.Action[NavigateToPosition_Goal, NavigateToPosition_Result, NavigateToPosition_Feedback]):
    Goal: TypeAlias = NavigateToPosition_Goal
    Result: TypeAlias = NavigateToPosition_Result
    Feedback: TypeAlias = NavigateToPosition_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class RotateAngle_Goal(base.Message):
    angle: float
    max_rotation_speed: float
    def __init__(self, *, angle: float = ..., max_rotation_speed: float = ...) -> None: ...

class RotateAngle_Result(base.Message):
    pose: geometry_msgs.PoseStamped
    def __init__(self, *, pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...) -> None: ...

class RotateAngle_Feedback(base.Message):
    remaining_angle_travel: float
    def __init__(self, *, remaining_angle_travel: float = ...) -> None: ...

class RotateAngle_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: RotateAngle_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: RotateAngle_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class RotateAngle_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: RotateAngle_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: RotateAngle_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class RotateAngle_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class RotateAngle_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[RotateAngle_SendGoal_Request]
    response: list[RotateAngle_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[RotateAngle_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[RotateAngle_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class RotateAngle_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class RotateAngle_GetResult_Response(base.Message):
    status: int
    result: RotateAngle_Result
    def __init__(self, *, status: int = ..., result: RotateAngle_Result | Mapping[str, object] = ...) -> None: ...

class RotateAngle_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[RotateAngle_GetResult_Request]
    response: list[RotateAngle_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[RotateAngle_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[RotateAngle_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class RotateAngle(base.Action[RotateAngle_Goal, RotateAngle_Result, RotateAngle_Feedback]):
    Goal: TypeAlias = RotateAngle_Goal
    Result: TypeAlias = RotateAngle_Result
    Feedback: TypeAlias = RotateAngle_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class Undock_Goal(base.Message):
    def __init__(self) -> None: ...

class Undock_Result(base.Message):
    is_docked: bool
    def __init__(self, *, is_docked: bool = ...) -> None: ...

class Undock_Feedback(base.Message):
    def __init__(self) -> None: ...

class Undock_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: Undock_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: Undock_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class Undock_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: Undock_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: Undock_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class Undock_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class Undock_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Undock_SendGoal_Request]
    response: list[Undock_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Undock_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[Undock_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Undock_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class Undock_GetResult_Response(base.Message):
    status: int
    result: Undock_Result
    def __init__(self, *, status: int = ..., result: Undock_Result | Mapping[str, object] = ...) -> None: ...

class Undock_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Undock_GetResult_Request]
    response: list[Undock_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Undock_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[Undock_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Undock(base.Action[Undock_Goal, Undock_Result, Undock_Feedback]):
    Goal: TypeAlias = Undock_Goal
    Result: TypeAlias = Undock_Result
    Feedback: TypeAlias = Undock_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

class WallFollow_Goal(base.Message):
    FOLLOW_RIGHT: ClassVar[Literal[-1]]
    FOLLOW_LEFT: ClassVar[Literal[1]]
    follow_side: int
    max_runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        follow_side: int = ...,
        max_runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class WallFollow_Result(base.Message):
    runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class WallFollow_Feedback(base.Message):
    engaged: bool
    def __init__(self, *, engaged: bool = ...) -> None: ...

class WallFollow_FeedbackMessage(base.Message):
    goal_id: unique_identifier_msgs.UUID
    feedback: WallFollow_Feedback
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        feedback: WallFollow_Feedback | Mapping[str, object] = ...,
    ) -> None: ...

class WallFollow_SendGoal_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    goal: WallFollow_Goal
    def __init__(
        self,
        *,
        goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        goal: WallFollow_Goal | Mapping[str, object] = ...,
    ) -> None: ...

class WallFollow_SendGoal_Response(base.Message):
    accepted: bool
    stamp: builtin_interfaces.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class WallFollow_SendGoal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[WallFollow_SendGoal_Request]
    response: list[WallFollow_SendGoal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[WallFollow_SendGoal_Request | Mapping[str, object]] = ...,
        response: Sequence[WallFollow_SendGoal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class WallFollow_GetResult_Request(base.Message):
    goal_id: unique_identifier_msgs.UUID
    def __init__(self, *, goal_id: unique_identifier_msgs.UUID | Mapping[str, object] = ...) -> None: ...

class WallFollow_GetResult_Response(base.Message):
    status: int
    result: WallFollow_Result
    def __init__(self, *, status: int = ..., result: WallFollow_Result | Mapping[str, object] = ...) -> None: ...

class WallFollow_GetResult_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[WallFollow_GetResult_Request]
    response: list[WallFollow_GetResult_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[WallFollow_GetResult_Request | Mapping[str, object]] = ...,
        response: Sequence[WallFollow_GetResult_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class WallFollow(base.Action[WallFollow_Goal, WallFollow_Result, WallFollow_Feedback]):
    Goal: TypeAlias = WallFollow_Goal
    Result: TypeAlias = WallFollow_Result
    Feedback: TypeAlias = WallFollow_Feedback
    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.gazebo_msgs import msg as gazebo_msgs
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.std_msgs import msg as std_msgs
from graphflow.msgs.trajectory_msgs import msg as trajectory_msgs

class ApplyBodyWrench_Request(base.Message):
    body_name: str
    reference_frame: str
    reference_point: geometry_msgs.Point
    wrench: geometry_msgs.Wrench
    start_time: builtin_interfaces.Time
    duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        body_name: str = ...,
        reference_frame: str = ...,
        reference_point: geometry_msgs.Point | Mapping[str, object] = ...,
        wrench: geometry_msgs.Wrench | Mapping[str, object] = ...,
        start_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class ApplyBodyWrench_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class ApplyBodyWrench_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ApplyBodyWrench_Request]
    response: list[ApplyBodyWrench_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ApplyBodyWrench_Request | Mapping[str, object]] = ...,
        response: Sequence[ApplyBodyWrench_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ApplyBodyWrench(base.Service[ApplyBodyWrench_Request, ApplyBodyWrench_Response]):
    Request: TypeAlias = ApplyBodyWrench_Request
    Response: TypeAlias = ApplyBodyWrench_Response
    Event: TypeAlias = ApplyBodyWrench_Event

class ApplyJointEffort_Request(base.Message):
    joint_name: str
    effort: float
    start_time: builtin_interfaces.Time
    duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        joint_name: str = ...,
        effort: float = ...,
        start_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class ApplyJointEffort_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class ApplyJointEffort_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ApplyJointEffort_Request]
    response: list[ApplyJointEffort_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ApplyJointEffort_Request | Mapping[str, object]] = ...,
        response: Sequence[ApplyJointEffort_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ApplyJointEffort(base.Service[ApplyJointEffort_Request, ApplyJointEffort_Response]):
    Request: TypeAlias = ApplyJointEffort_Request
    Response: TypeAlias = ApplyJointEffort_Response
    Event: TypeAlias = ApplyJointEffort_Event

class ApplyLinkWrench_Request(base.Message):
    link_name: str
    reference_frame: str
    reference_point: geometry_msgs.Point
    wrench: geometry_msgs.Wrench
    start_time: builtin_interfaces.Time
    duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        link_name: str = ...,
        reference_frame: str = ...,
        reference_point: geometry_msgs.Point | Mapping[str, object] = ...,
        wrench: geometry_msgs.Wrench | Mapping[str, object] = ...,
        start_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class ApplyLinkWrench_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class ApplyLinkWrench_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ApplyLinkWrench_Request]
    response: list[ApplyLinkWrench_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ApplyLinkWrench_Request | Mapping[str, object]] = ...,
        response: Sequence[ApplyLinkWrench_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ApplyLinkWrench(base.Service[ApplyLinkWrench_Request, ApplyLinkWrench_Response]):
    Request: TypeAlias = ApplyLinkWrench_Request
    Response: TypeAlias = ApplyLinkWrench_Response
    Event: TypeAlias = ApplyLinkWrench_Event

class BodyRequest_Request(base.Message):
    body_name: str
    def __init__(self, *, body_name: str = ...) -> None: ...

class BodyRequest_Response(base.Message):
    def __init__(self) -> None: ...

class BodyRequest_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[BodyRequest_Request]
    response: list[BodyRequest_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[BodyRequest_Request | Mapping[str, object]] = ...,
        response: Sequence[BodyRequest_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class BodyRequest(base.Service[BodyRequest_Request, BodyRequest_Response]):
    Request: TypeAlias = BodyRequest_Request
    Response: TypeAlias = BodyRequest_Response
    Event: TypeAlias = BodyRequest_Event

class DeleteEntity_Request(base.Message):
    name: str
    def __init__(self, *, name: str = ...) -> None: ...

class DeleteEntity_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class DeleteEntity_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DeleteEntity_Request]
    response: list[DeleteEntity_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DeleteEntity_Request | Mapping[str, object]] = ...,
        response: Sequence[DeleteEntity_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DeleteEntity(base.Service[DeleteEntity_Request, DeleteEntity_Response]):
    Request: TypeAlias = DeleteEntity_Request
    Response: TypeAlias = DeleteEntity_Response
    Event: TypeAlias = DeleteEntity_Event

class DeleteLight_Request(base.Message):
    light_name: str
    def __init__(self, *, light_name: str = ...) -> None: ...

class DeleteLight_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class DeleteLight_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DeleteLight_Request]
    response: list[DeleteLight_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DeleteLight_Request | Mapping[str, object]] = ...,
        response: Sequence[DeleteLight_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DeleteLight(base.Service[DeleteLight_Request, DeleteLight_Response]):
    Request: TypeAlias = DeleteLight_Request
    Response: TypeAlias = DeleteLight_Response
    Event: TypeAlias = DeleteLight_Event

class DeleteModel_Request(base.Message):
    model_name: str
    def __init__(self, *, model_name: str = ...) -> None: ...

class DeleteModel_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class DeleteModel_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DeleteModel_Request]
    response: list[DeleteModel_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DeleteModel_Request | Mapping[str, object]] = ...,
        response: Sequence[DeleteModel_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DeleteModel(base.Service[DeleteModel_Request, DeleteModel_Response]):
    Request: TypeAlias = DeleteModel_Request
    Response: TypeAlias = DeleteModel_Response
    Event: TypeAlias = DeleteModel_Event

class GetEntityState_Request(base.Message):
    name: str
    reference_frame: str
    def __init__(self, *, name: str = ..., reference_frame: str = ...) -> None: ...

class GetEntityState_Response(base.Message):
    header: std_msgs.Header
    state: gazebo_msgs.EntityState
    success: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        state: gazebo_msgs.EntityState | Mapping[str, object] = ...,
        success: bool = ...,
    ) -> None: ...

class GetEntityState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetEntityState_Request]
    response: list[GetEntityState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetEntityState_Request | Mapping[str, object]] = ...,
        response: Sequence[GetEntityState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntityState(base.Service[GetEntityState_Request, GetEntityState_Response]):
    Request: TypeAlias = GetEntityState_Request
    Response: TypeAlias = GetEntityState_Response
    Event: TypeAlias = GetEntityState_Event

class GetJointProperties_Request(base.Message):
    joint_name: str
    def __init__(self, *, joint_name: str = ...) -> None: ...

class GetJointProperties_Response(base.Message):
    REVOLUTE: ClassVar[Literal[0]]
    CONTINUOUS: ClassVar[Literal[1]]
    PRISMATIC: ClassVar[Literal[2]]
    FIXED: ClassVar[Literal[3]]
    BALL: ClassVar[Literal[4]]
    UNIVERSAL: ClassVar[Literal[5]]
    type: int
    damping: npt.NDArray[np.float64]
    position: npt.NDArray[np.float64]
    rate: npt.NDArray[np.float64]
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        type: int = ...,
        damping: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        rate: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetJointProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetJointProperties_Request]
    response: list[GetJointProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetJointProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[GetJointProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetJointProperties(base.Service[GetJointProperties_Request, GetJointProperties_Response]):
    Request: TypeAlias = GetJointProperties_Request
    Response: TypeAlias = GetJointProperties_Response
    Event: TypeAlias = GetJointProperties_Event

class GetLightProperties_Request(base.Message):
    light_name: str
    def __init__(self, *, light_name: str = ...) -> None: ...

class GetLightProperties_Response(base.Message):
    diffuse: std_msgs.ColorRGBA
    attenuation_constant: float
    attenuation_linear: float
    attenuation_quadratic: float
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        diffuse: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        attenuation_constant: float = ...,
        attenuation_linear: float = ...,
        attenuation_quadratic: float = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetLightProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetLightProperties_Request]
    response: list[GetLightProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetLightProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[GetLightProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetLightProperties(base.Service[GetLightProperties_Request, GetLightProperties_Response]):
    Request: TypeAlias = GetLightProperties_Request
    Response: TypeAlias = GetLightProperties_Response
    Event: TypeAlias = GetLightProperties_Event

class GetLinkProperties_Request(base.Message):
    link_name: str
    def __init__(self, *, link_name: str = ...) -> None: ...

class GetLinkProperties_Response(base.Message):
    com: geometry_msgs.Pose
    gravity_mode: bool
    mass: float
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        com: geometry_msgs.Pose | Mapping[str, object] = ...,
        gravity_mode: bool = ...,
        mass: float = ...,
        ixx: float = ...,
        ixy: float = ...,
        ixz: float = ...,
        iyy: float = ...,
        iyz: float = ...,
        izz: float = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetLinkProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetLinkProperties_Request]
    response: list[GetLinkProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetLinkProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[GetLinkProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetLinkProperties(base.Service[GetLinkProperties_Request, GetLinkProperties_Response]):
    Request: TypeAlias = GetLinkProperties_Request
    Response: TypeAlias = GetLinkProperties_Response
    Event: TypeAlias = GetLinkProperties_Event

class GetLinkState_Request(base.Message):
    link_name: str
    reference_frame: str
    def __init__(self, *, link_name: str = ..., reference_frame: str = ...) -> None: ...

class GetLinkState_Response(base.Message):
    link_state: gazebo_msgs.LinkState
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        link_state: gazebo_msgs.LinkState | Mapping[str, object] = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetLinkState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetLinkState_Request]
    response: list[GetLinkState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetLinkState_Request | Mapping[str, object]] = ...,
        response: Sequence[GetLinkState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetLinkState(base.Service[GetLinkState_Request, GetLinkState_Response]):
    Request: TypeAlias = GetLinkState_Request
    Response: TypeAlias = GetLinkState_Response
    Event: TypeAlias = GetLinkState_Event

class GetModelList_Request(base.Message):
    def __init__(self) -> None: ...

class GetModelList_Response(base.Message):
    header: std_msgs.Header
    model_names: list[str]
    success: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        model_names: Sequence[str] = ...,
        success: bool = ...,
    ) -> None: ...

class GetModelList_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetModelList_Request]
    response: list[GetModelList_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetModelList_Request | Mapping[str, object]] = ...,
        response: Sequence[GetModelList_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetModelList(base.Service[GetModelList_Request, GetModelList_Response]):
    Request: TypeAlias = GetModelList_Request
    Response: TypeAlias = GetModelList_Response
    Event: TypeAlias = GetModelList_Event

class GetModelProperties_Request(base.Message):
    model_name: str
    def __init__(self, *, model_name: str = ...) -> None: ...

class GetModelProperties_Response(base.Message):
    parent_model_name: str
    canonical_body_name: str
    body_names: list[str]
    geom_names: list[str]
    joint_names: list[str]
    child_model_names: list[str]
    is_static: bool
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        parent_model_name: str = ...,
        canonical_body_name: str = ...,
        body_names: Sequence[str] = ...,
        geom_names: Sequence[str] = ...,
        joint_names: Sequence[str] = ...,
        child_model_names: Sequence[str] = ...,
        is_static: bool = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetModelProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetModelProperties_Request]
    response: list[GetModelProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetModelProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[GetModelProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetModelProperties(base.Service[GetModelProperties_Request, GetModelProperties_Response]):
    Request: TypeAlias = GetModelProperties_Request
    Response: TypeAlias = GetModelProperties_Response
    Event: TypeAlias = GetModelProperties_Event

class GetModelState_Request(base.Message):
    model_name: str
    relative_entity_name: str
    def __init__(self, *, model_name: str = ..., relative_entity_name: str = ...) -> None: ...

class GetModelState_Response(base.Message):
    header: std_msgs.Header
    pose: geometry_msgs.Pose
    twist: geometry_msgs.Twist
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        twist: geometry_msgs.Twist | Mapping[str, object] = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetModelState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetModelState_Request]
    response: list[GetModelState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetModelState_Request | Mapping[str, object]] = ...,
        response: Sequence[GetModelState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetModelState(base.Service[GetModelState_Request, GetModelState_Response]):
    Request: TypeAlias = GetModelState_Request
    Response: TypeAlias = GetModelState_Response
    Event: TypeAlias = GetModelState_Event

class GetPhysicsProperties_Request(base.Message):
    def __init__(self) -> None: ...

class GetPhysicsProperties_Response(base.Message):
    time_step: float
    pause: bool
    max_update_rate: float
    gravity: geometry_msgs.Vector3
    ode_config: gazebo_msgs.ODEPhysics
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        time_step: float = ...,
        pause: bool = ...,
        max_update_rate: float = ...,
        gravity: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        ode_config: gazebo_msgs.ODEPhysics | Mapping[str, object] = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetPhysicsProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetPhysicsProperties_Request]
    response: list[GetPhysicsProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetPhysicsProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[GetPhysicsProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetPhysicsProperties(base.Service[GetPhysicsProperties_Request, GetPhysicsProperties_Response]):
    Request: TypeAlias = GetPhysicsProperties_Request
    Response: TypeAlias = GetPhysicsProperties_Response
    Event: TypeAlias = GetPhysicsProperties_Event

class GetWorldProperties_Request(base.Message):
    def __init__(self) -> None: ...

class GetWorldProperties_Response(base.Message):
    sim_time: float
    model_names: list[str]
    rendering_enabled: bool
    success: bool
    status_message: str
    def __init__(
        self,
        *,
        sim_time: float = ...,
        model_names: Sequence[str] = ...,
        rendering_enabled: bool = ...,
        success: bool = ...,
        status_message: str = ...,
    ) -> None: ...

class GetWorldProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetWorldProperties_Request]
    response: list[GetWorldProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetWorldProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[GetWorldProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetWorldProperties(base.Service[GetWorldProperties_Request, GetWorldProperties_Response]):
    Request: TypeAlias = GetWorldProperties_Request
    Response: TypeAlias = GetWorldProperties_Response
    Event: TypeAlias = GetWorldProperties_Event

class JointRequest_Request(base.Message):
    joint_name: str
    def __init__(self, *, joint_name: str = ...) -> None: ...

class JointRequest_Response(base.Message):
    def __init__(self) -> None: ...

class JointRequest_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[JointRequest_Request]
    response: list[JointRequest_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[JointRequest_Request | Mapping[str, object]] = ...,
        response: Sequence[JointRequest_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class JointRequest(base.Service[JointRequest_Request, JointRequest_Response]):
    Request: TypeAlias = JointRequest_Request
    Response: TypeAlias = JointRequest_Response
    Event: TypeAlias = JointRequest_Event

class LinkRequest_Request(base.Message):
    link_name: str
    def __init__(self, *, link_name: str = ...) -> None: ...

class LinkRequest_Response(base.Message):
    def __init__(self) -> None: ...

class LinkRequest_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LinkRequest_Request]
    response: list[LinkRequest_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LinkRequest_Request | Mapping[str, object]] = ...,
        response: Sequence[LinkRequest_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LinkRequest(base.Service[LinkRequest_Request, LinkRequest_Response]):
    Request: TypeAlias = LinkRequest_Request
    Response: TypeAlias = LinkRequest_Response
    Event: TypeAlias = LinkRequest_Event

class SetEntityState_Request(base.Message):
    state: gazebo_msgs.EntityState
    def __init__(self, *, state: gazebo_msgs.EntityState | Mapping[str, object] = ...) -> None: ...

class SetEntityState_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class SetEntityState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetEntityState_Request]
    response: list[SetEntityState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetEntityState_Request | Mapping[str, object]] = ...,
        response: Sequence[SetEntityState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetEntityState(base.Service[SetEntityState_Request, SetEntityState_Response]):
    Request: TypeAlias = SetEntityState_Request
    Response: TypeAlias = SetEntityState_Response
    Event: TypeAlias = SetEntityState_Event

class SetJointProperties_Request(base.Message):
    joint_name: str
    ode_joint_config: gazebo_msgs.ODEJointProperties
    def __init__(
        self,
        *,
        joint_name: str = ...,
        ode_joint_config: gazebo_msgs.ODEJointProperties | Mapping[str, object] = ...,
    ) -> None: ...

class SetJointProperties_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetJointProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetJointProperties_Request]
    response: list[SetJointProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetJointProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[SetJointProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetJointProperties(base.Service[SetJointProperties_Request, SetJointProperties_Response]):
    Request: TypeAlias = SetJointProperties_Request
    Response: TypeAlias = SetJointProperties_Response
    Event: TypeAlias = SetJointProperties_Event

class SetJointTrajectory_Request(base.Message):
    model_name: str
    joint_trajectory: trajectory_msgs.JointTrajectory
    model_pose: geometry_msgs.Pose
    set_model_pose: bool
    disable_physics_updates: bool
    def __init__(
        self,
        *,
        model_name: str = ...,
        joint_trajectory: trajectory_msgs.JointTrajectory | Mapping[str, object] = ...,
        model_pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        set_model_pose: bool = ...,
        disable_physics_updates: bool = ...,
    ) -> None: ...

class SetJointTrajectory_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetJointTrajectory_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetJointTrajectory_Request]
    response: list[SetJointTrajectory_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetJointTrajectory_Request | Mapping[str, object]] = ...,
        response: Sequence[SetJointTrajectory_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetJointTrajectory(base.Service[SetJointTrajectory_Request, SetJointTrajectory_Response]):
    Request: TypeAlias = SetJointTrajectory_Request
    Response: TypeAlias = SetJointTrajectory_Response
    Event: TypeAlias = SetJointTrajectory_Event

class SetLightProperties_Request(base.Message):
    light_name: str
    diffuse: std_msgs.ColorRGBA
    attenuation_constant: float
    attenuation_linear: float
    attenuation_quadratic: float
    def __init__(
        self,
        *,
        light_name: str = ...,
        diffuse: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        attenuation_constant: float = ...,
        attenuation_linear: float = ...,
        attenuation_quadratic: float = ...,
    ) -> None: ...

class SetLightProperties_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetLightProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetLightProperties_Request]
    response: list[SetLightProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetLightProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[SetLightProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetLightProperties(base.Service[SetLightProperties_Request, SetLightProperties_Response]):
    Request: TypeAlias = SetLightProperties_Request
    Response: TypeAlias = SetLightProperties_Response
    Event: TypeAlias = SetLightProperties_Event

class SetLinkProperties_Request(base.Message):
    link_name: str
    com: geometry_msgs.Pose
    gravity_mode: bool
    mass: float
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    def __init__(
        self,
        *,
        link_name: str = ...,
        com: geometry_msgs.Pose | Mapping[str, object] = ...,
        gravity_mode: bool = ...,
        mass: float = ...,
        ixx: float = ...,
        ixy: float = ...,
        ixz: float = ...,
        iyy: float = ...,
        iyz: float = ...,
        izz: float = ...,
    ) -> None: ...

class SetLinkProperties_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetLinkProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetLinkProperties_Request]
    response: list[SetLinkProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetLinkProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[SetLinkProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetLinkProperties(base.Service[SetLinkProperties_Request, SetLinkProperties_Response]):
    Request: TypeAlias = SetLinkProperties_Request
    Response: TypeAlias = SetLinkProperties_Response
    Event: TypeAlias = SetLinkProperties_Event

class SetLinkState_Request(base.Message):
    link_state: gazebo_msgs.LinkState
    def __init__(self, *, link_state: gazebo_msgs.LinkState | Mapping[str, object] = ...) -> None: ...

class SetLinkState_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetLinkState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetLinkState_Request]
    response: list[SetLinkState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetLinkState_Request | Mapping[str, object]] = ...,
        response: Sequence[SetLinkState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetLinkState(base.Service[SetLinkState_Request, SetLinkState_Response]):
    Request: TypeAlias = SetLinkState_Request
    Response: TypeAlias = SetLinkState_Response
    Event: TypeAlias = SetLinkState_Event

class SetModelConfiguration_Request(base.Message):
    model_name: str
    urdf_param_name: str
    joint_names: list[str]
    joint_positions: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        model_name: str = ...,
        urdf_param_name: str = ...,
        joint_names: Sequence[str] = ...,
        joint_positions: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class SetModelConfiguration_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetModelConfiguration_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetModelConfiguration_Request]
    response: list[SetModelConfiguration_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetModelConfiguration_Request | Mapping[str, object]] = ...,
        response: Sequence[SetModelConfiguration_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetModelConfiguration(base.Service[SetModelConfiguration_Request, SetModelConfiguration_Response]):
    Request: TypeAlias = SetModelConfiguration_Request
    Response: TypeAlias = SetModelConfiguration_Response
    Event: TypeAlias = SetModelConfiguration_Event

class SetModelState_Request(base.Message):
    model_state: gazebo_msgs.ModelState
    def __init__(self, *, model_state: gazebo_msgs.ModelState | Mapping[str, object] = ...) -> None: ...

class SetModelState_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetModelState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetModelState_Request]
    response: list[SetModelState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetModelState_Request | Mapping[str, object]] = ...,
        response: Sequence[SetModelState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetModelState(base.Service[SetModelState_Request, SetModelState_Response]):
    Request: TypeAlias = SetModelState_Request
    Response: TypeAlias = SetModelState_Response
    Event: TypeAlias = SetModelState_Event

class SetPhysicsProperties_Request(base.Message):
    time_step: float
    max_update_rate: float
    gravity: geometry_msgs.Vector3
    ode_config: gazebo_msgs.ODEPhysics
    def __init__(
        self,
        *,
        time_step: float = ...,
        max_update_rate: float = ...,
        gravity: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        ode_config: gazebo_msgs.ODEPhysics | Mapping[str, object] = ...,
    ) -> None: ...

class SetPhysicsProperties_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SetPhysicsProperties_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetPhysicsProperties_Request]
    response: list[SetPhysicsProperties_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetPhysicsProperties_Request | Mapping[str, object]] = ...,
        response: Sequence[SetPhysicsProperties_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetPhysicsProperties(base.Service[SetPhysicsProperties_Request, SetPhysicsProperties_Response]):
    Request: TypeAlias = SetPhysicsProperties_Request
    Response: TypeAlias = SetPhysicsProperties_Response
    Event: TypeAlias = SetPhysicsProperties_Event

class SpawnEntity_Request(base.Message):
    name: str
    xml: str
    robot_namespace: str
    initial_pose: geometry_msgs.Pose
    reference_frame: str
    def __init__(
        self,
        *,
        name: str = ...,
        xml: str = ...,
        robot_namespace: str = ...,
        initial_pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        reference_frame: str = ...,
    ) -> None: ...

class SpawnEntity_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SpawnEntity_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SpawnEntity_Request]
    response: list[SpawnEntity_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SpawnEntity_Request | Mapping[str, object]] = ...,
        response: Sequence[SpawnEntity_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SpawnEntity(base.Service[SpawnEntity_Request, SpawnEntity_Response]):
    Request: TypeAlias = SpawnEntity_Request
    Response: TypeAlias = SpawnEntity_Response
    Event: TypeAlias = SpawnEntity_Event

class SpawnModel_Request(base.Message):
    model_name: str
    model_xml: str
    robot_namespace: str
    initial_pose: geometry_msgs.Pose
    reference_frame: str
    def __init__(
        self,
        *,
        model_name: str = ...,
        model_xml: str = ...,
        robot_namespace: str = ...,
        initial_pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        reference_frame: str = ...,
    ) -> None: ...

class SpawnModel_Response(base.Message):
    success: bool
    status_message: str
    def __init__(self, *, success: bool = ..., status_message: str = ...) -> None: ...

class SpawnModel_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SpawnModel_Request]
    response: list[SpawnModel_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SpawnModel_Request | Mapping[str, object]] = ...,
        response: Sequence[SpawnModel_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SpawnModel(base.Service[SpawnModel_Request, SpawnModel_Response]):
    Request: TypeAlias = SpawnModel_Request
    Response: TypeAlias = SpawnModel_Response
    Event: TypeAlias = SpawnModel_Event

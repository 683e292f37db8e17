# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.std_msgs import msg as std_msgs
from graphflow.msgs.trajectory_msgs import msg as trajectory_msgs

class AdmittanceControllerState(base.Message):
    mass: std_msgs.Float64MultiArray
    damping: std_msgs.Float64MultiArray
    stiffness: std_msgs.Float64MultiArray
    rot_base_control: geometry_msgs.Quaternion
    ref_trans_base_ft: geometry_msgs.TransformStamped
    selected_axes: std_msgs.Int8MultiArray
    ft_sensor_frame: std_msgs.String
    admittance_position: geometry_msgs.TransformStamped
    admittance_acceleration: geometry_msgs.TwistStamped
    admittance_velocity: geometry_msgs.TwistStamped
    wrench_base: geometry_msgs.WrenchStamped
    joint_state: sensor_msgs.JointState
    def __init__(
        self,
        *,
        mass: std_msgs.Float64MultiArray | Mapping[str, object] = ...,
        damping: std_msgs.Float64MultiArray | Mapping[str, object] = ...,
        stiffness: std_msgs.Float64MultiArray | Mapping[str, object] = ...,
        rot_base_control: geometry_msgs.Quaternion | Mapping[str, object] = ...,
        ref_trans_base_ft: geometry_msgs.TransformStamped | Mapping[str, object] = ...,
        selected_axes: std_msgs.Int8MultiArray | Mapping[str, object] = ...,
        ft_sensor_frame: std_msgs.String | Mapping[str, object] = ...,
        admittance_position: geometry_msgs.TransformStamped | Mapping[str, object] = ...,
        admittance_acceleration: geometry_msgs.TwistStamped | Mapping[str, object] = ...,
        admittance_velocity: geometry_msgs.TwistStamped | Mapping[str, object] = ...,
        wrench_base: geometry_msgs.WrenchStamped | Mapping[str, object] = ...,
        joint_state: sensor_msgs.JointState | Mapping[str, object] = ...,
    ) -> None: ...

class BatteryStateArray(base.Message):
    battery_states: list[sensor_msgs.BatteryState]
    def __init__(self, *, battery_states: Sequence[sensor_msgs.BatteryState | Mapping[str, object]] = ...) -> None: ...

class DynamicInterfaceGroupValues(base.Message):
    header: std_msgs.Header
    interface_groups: list[str]
    interface_values: list[InterfaceValue]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        interface_groups: Sequence[str] = ...,
        interface_values: Sequence[InterfaceValue | Mapping[str, object]] = ...,
    ) -> None: ...

class DynamicInterfaceValues(base.Message):
    header: std_msgs.Header
    states: InterfaceValue
    commands: InterfaceValue
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        states: InterfaceValue | Mapping[str, object] = ...,
        commands: InterfaceValue | Mapping[str, object] = ...,
    ) -> None: ...

class DynamicJointState(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    interface_values: list[InterfaceValue]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        interface_values: Sequence[InterfaceValue | Mapping[str, object]] = ...,
    ) -> None: ...

class Float64Values(base.Message):
    header: std_msgs.Header
    values: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        values: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class GripperCommand(base.Message):
    position: float
    max_effort: float
    def __init__(self, *, position: float = ..., max_effort: float = ...) -> None: ...

class InterfaceValue(base.Message):
    interface_names: list[str]
    values: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        interface_names: Sequence[str] = ...,
        values: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class JointComponentTolerance(base.Message):
    X_AXIS: ClassVar[Literal[1]]
    Y_AXIS: ClassVar[Literal[2]]
    Z_AXIS: ClassVar[Literal[3]]
    TRANSLATION: ClassVar[Literal[4]]
    ROTATION: ClassVar[Literal[5]]
    joint_name: str
    component: int
    position: float
    velocity: float
    acceleration: float
    def __init__(
        self,
        *,
        joint_name: str = ...,
        component: int = ...,
        position: float = ...,
        velocity: float = ...,
        acceleration: float = ...,
    ) -> None: ...

class JointControllerState(base.Message):
    header: std_msgs.Header
    set_point: float
    process_value: float
    process_value_dot: float
    error: float
    time_step: float
    command: float
    p: float
    i: float
    d: float
    i_clamp: float
    antiwindup: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        set_point: float = ...,
        process_value: float = ...,
        process_value_dot: float = ...,
        error: float = ...,
        time_step: float = ...,
        command: float = ...,
        p: float = ...,
        i: float = ...,
        d: float = ...,
        i_clamp: float = ...,
        antiwindup: bool = ...,
    ) -> None: ...

class JointJog(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    displacements: npt.NDArray[np.float64]
    velocities: npt.NDArray[np.float64]
    duration: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        displacements: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        velocities: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        duration: float = ...,
    ) -> None: ...

class JointTolerance(base.Message):
    name: str
    position: float
    velocity: float
    acceleration: float
    def __init__(
        self,
        *,
        name: str = ...,
        position: float = ...,
        velocity: float = ...,
        acceleration: float = ...,
    ) -> None: ...

class JointTrajectoryControllerState(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    reference: trajectory_msgs.JointTrajectoryPoint
    feedback: trajectory_msgs.JointTrajectoryPoint
    error: trajectory_msgs.JointTrajectoryPoint
    output: trajectory_msgs.JointTrajectoryPoint
    multi_dof_joint_names: list[str]
    multi_dof_reference: trajectory_msgs.MultiDOFJointTrajectoryPoint
    multi_dof_feedback: trajectory_msgs.MultiDOFJointTrajectoryPoint
    multi_dof_error: trajectory_msgs.MultiDOFJointTrajectoryPoint
    multi_dof_output: trajectory_msgs.MultiDOFJointTrajectoryPoint
    speed_scaling_factor: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        reference: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        feedback: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        error: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        output: trajectory_msgs.JointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_joint_names: Sequence[str] = ...,
        multi_dof_reference: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_feedback: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_error: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
        multi_dof_output: trajectory_msgs.MultiDOFJointTrajectoryPoint | Mapping[str, object] = ...,
        speed_scaling_factor: float = ...,
    ) -> None: ...

class Keys(base.Message):
    header: std_msgs.Header
    keys: list[str]
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., keys: Sequence[str] = ...) -> None: ...

class MecanumDriveControllerState(base.Message):
    header: std_msgs.Header
    front_left_wheel_velocity: float
    back_left_wheel_velocity: float
    back_right_wheel_velocity: float
    front_right_wheel_velocity: float
    reference_velocity: geometry_msgs.Twist
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        front_left_wheel_velocity: float = ...,
        back_left_wheel_velocity: float = ...,
        back_right_wheel_velocity: float = ...,
        front_right_wheel_velocity: float = ...,
        reference_velocity: geometry_msgs.Twist | Mapping[str, object] = ...,
    ) -> None: ...

class MotionArgument(base.Message):
    name: str
    value: float
    def __init__(self, *, name: str = ..., value: float = ...) -> None: ...

class MotionPrimitive(base.Message):
    UNKNOWN: ClassVar[Literal[-1]]
    LINEAR_JOINT: ClassVar[Literal[0]]
    LINEAR_CARTESIAN: ClassVar[Literal[50]]
    CIRCULAR_CARTESIAN: ClassVar[Literal[51]]
    type: int
    blend_radius: float
    additional_arguments: list[MotionArgument]
    poses: list[geometry_msgs.PoseStamped]
    joint_positions: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        type: int = ...,
        blend_radius: float = ...,
        additional_arguments: Sequence[MotionArgument | Mapping[str, object]] = ...,
        poses: Sequence[geometry_msgs.PoseStamped | Mapping[str, object]] = ...,
        joint_positions: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class MotionPrimitiveSequence(base.Message):
    motions: list[MotionPrimitive]
    def __init__(self, *, motions: Sequence[MotionPrimitive | Mapping[str, object]] = ...) -> None: ...

class MultiDOFCommand(base.Message):
    dof_names: list[str]
    values: npt.NDArray[np.float64]
    values_dot: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        dof_names: Sequence[str] = ...,
        values: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        values_dot: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class MultiDOFStateStamped(base.Message):
    header: std_msgs.Header
    dof_states: list[SingleDOFState]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        dof_states: Sequence[SingleDOFState | Mapping[str, object]] = ...,
    ) -> None: ...

class PidState(base.Message):
    header: std_msgs.Header
    timestep: builtin_interfaces.Duration
    error: float
    error_dot: float
    p_error: float
    i_error: float
    d_error: float
    p_term: float
    i_term: float
    d_term: float
    i_max: float
    i_min: float
    output: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        timestep: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        error: float = ...,
        error_dot: float = ...,
        p_error: float = ...,
        i_error: float = ...,
        d_error: float = ...,
        p_term: float = ...,
        i_term: float = ...,
        d_term: float = ...,
        i_max: float = ...,
        i_min: float = ...,
        output: float = ...,
    ) -> None: ...

class SingleDOFState(base.Message):
    name: str
    reference: float
    feedback: float
    feedback_dot: float
    error: float
    error_dot: float
    time_step: float
    output: float
    def __init__(
        self,
        *,
        name: str = ...,
        reference: float = ...,
        feedback: float = ...,
        feedback_dot: float = ...,
        error: float = ...,
        error_dot: float = ...,
        time_step: float = ...,
        output: float = ...,
    ) -> None: ...

class SingleDOFStateStamped(base.Message):
    header: std_msgs.Header
    dof_state: SingleDOFState
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        dof_state: SingleDOFState | Mapping[str, object] = ...,
    ) -> None: ...

class SpeedScalingFactor(base.Message):
    factor: float
    def __init__(self, *, factor: float = ...) -> None: ...

class SteeringControllerStatus(base.Message):
    header: std_msgs.Header
    traction_wheels_position: npt.NDArray[np.float64]
    traction_wheels_velocity: npt.NDArray[np.float64]
    steer_positions: npt.NDArray[np.float64]
    linear_velocity_command: npt.NDArray[np.float64]
    steering_angle_command: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        traction_wheels_position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        traction_wheels_velocity: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        steer_positions: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        linear_velocity_command: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        steering_angle_command: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class VDA5050SafetyState(base.Message):
    AUTO_ACK: ClassVar[Literal["autoAck"]]
    MANUAL: ClassVar[Literal["manual"]]
    REMOTE: ClassVar[Literal["remote"]]
    NONE: ClassVar[Literal["none"]]
    e_stop: str
    field_violation: bool
    def __init__(self, *, e_stop: str = ..., field_violation: bool = ...) -> None: ...

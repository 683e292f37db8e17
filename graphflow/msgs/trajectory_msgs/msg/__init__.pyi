# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class JointTrajectory(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    points: list[JointTrajectoryPoint]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        points: Sequence[JointTrajectoryPoint | Mapping[str, object]] = ...,
    ) -> None: ...

class JointTrajectoryPoint(base.Message):
    positions: npt.NDArray[np.float64]
    velocities: npt.NDArray[np.float64]
    accelerations: npt.NDArray[np.float64]
    effort: npt.NDArray[np.float64]
    time_from_start: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        positions: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        velocities: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        accelerations: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        effort: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        time_from_start: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class MultiDOFJointTrajectory(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    points: list[MultiDOFJointTrajectoryPoint]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        points: Sequence[MultiDOFJointTrajectoryPoint | Mapping[str, object]] = ...,
    ) -> None: ...

class MultiDOFJointTrajectoryPoint(base.Message):
    transforms: list[geometry_msgs.Transform]
    velocities: list[geometry_msgs.Twist]
    accelerations: list[geometry_msgs.Twist]
    time_from_start: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        transforms: Sequence[geometry_msgs.Transform | Mapping[str, object]] = ...,
        velocities: Sequence[geometry_msgs.Twist | Mapping[str, object]] = ...,
        accelerations: Sequence[geometry_msgs.Twist | Mapping[str, object]] = ...,
        time_from_start: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs

class QueryCalibrationState_Request(base.Message):
    def __init__(self) -> None: ...

class QueryCalibrationState_Response(base.Message):
    is_calibrated: bool
    def __init__(self, *, is_calibrated: bool = ...) -> None: ...

class QueryCalibrationState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[QueryCalibrationState_Request]
    response: list[QueryCalibrationState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[QueryCalibrationState_Request | Mapping[str, object]] = ...,
        response: Sequence[QueryCalibrationState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class QueryCalibrationState(base.Service[QueryCalibrationState_Request, QueryCalibrationState_Response]):
    Request: TypeAlias = QueryCalibrationState_Request
    Response: TypeAlias = QueryCalibrationState_Response
    Event: TypeAlias = QueryCalibrationState_Event

class QueryTrajectoryState_Request(base.Message):
    time: builtin_interfaces.Time
    def __init__(self, *, time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...) -> None: ...

class QueryTrajectoryState_Response(base.Message):
    success: bool
    message: str
    name: list[str]
    position: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    acceleration: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        success: bool = ...,
        message: str = ...,
        name: Sequence[str] = ...,
        position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        velocity: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        acceleration: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class QueryTrajectoryState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[QueryTrajectoryState_Request]
    response: list[QueryTrajectoryState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[QueryTrajectoryState_Request | Mapping[str, object]] = ...,
        response: Sequence[QueryTrajectoryState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class QueryTrajectoryState(base.Service[QueryTrajectoryState_Request, QueryTrajectoryState_Response]):
    Request: TypeAlias = QueryTrajectoryState_Request
    Response: TypeAlias = QueryTrajectoryState_Response
    Event: TypeAlias = QueryTrajectoryState_Event

class SetOdometry_Request(base.Message):
    x: float
    y: float
    z: float
    roll: float
    pitch: float
    yaw: float
    def __init__(
        self,
        *,
        x: float = ...,
        y: float = ...,
        z: float = ...,
        roll: float = ...,
        pitch: float = ...,
        yaw: float = ...,
    ) -> None: ...

class SetOdometry_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class SetOdometry_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetOdometry_Request]
    response: list[SetOdometry_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetOdometry_Request | Mapping[str, object]] = ...,
        response: Sequence[SetOdometry_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetOdometry(base.Service[SetOdometry_Request, SetOdometry_Response]):
    Request: TypeAlias = SetOdometry_Request
    Response: TypeAlias = SetOdometry_Response
    Event: TypeAlias = SetOdometry_Event

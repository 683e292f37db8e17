# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.std_msgs import msg as std_msgs

class Actuators(base.Message):
    header: std_msgs.Header
    position: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    normalized: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        velocity: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        normalized: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class ActuatorsAngularPosition(base.Message):
    position: npt.NDArray[np.float64]
    def __init__(self, *, position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class ActuatorsAngularVelocity(base.Message):
    velocity: npt.NDArray[np.float64]
    def __init__(self, *, velocity: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class ActuatorsLinearPosition(base.Message):
    position: npt.NDArray[np.float64]
    def __init__(self, *, position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class ActuatorsLinearVelocity(base.Message):
    velocity: npt.NDArray[np.float64]
    def __init__(self, *, velocity: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class ActuatorsNormalized(base.Message):
    header: std_msgs.Header
    normalized: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        normalized: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class ActuatorsPosition(base.Message):
    header: std_msgs.Header
    angular: ActuatorsAngularPosition
    linear: ActuatorsLinearPosition
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        angular: ActuatorsAngularPosition | Mapping[str, object] = ...,
        linear: ActuatorsLinearPosition | Mapping[str, object] = ...,
    ) -> None: ...

class ActuatorsVelocity(base.Message):
    header: std_msgs.Header
    angular: ActuatorsAngularVelocity
    linear: ActuatorsLinearVelocity
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        angular: ActuatorsAngularVelocity | Mapping[str, object] = ...,
        linear: ActuatorsLinearVelocity | Mapping[str, object] = ...,
    ) -> None: ...

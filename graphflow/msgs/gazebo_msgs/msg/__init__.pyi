# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class ContactState(base.Message):
    info: str
    collision1_name: str
    collision2_name: str
    wrenches: list[geometry_msgs.Wrench]
    total_wrench: geometry_msgs.Wrench
    contact_positions: list[geometry_msgs.Vector3]
    contact_normals: list[geometry_msgs.Vector3]
    depths: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        info: str = ...,
        collision1_name: str = ...,
        collision2_name: str = ...,
        wrenches: Sequence[geometry_msgs.Wrench | Mapping[str, object]] = ...,
        total_wrench: geometry_msgs.Wrench | Mapping[str, object] = ...,
        contact_positions: Sequence[geometry_msgs.Vector3 | Mapping[str, object]] = ...,
        contact_normals: Sequence[geometry_msgs.Vector3 | Mapping[str, object]] = ...,
        depths: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class ContactsState(base.Message):
    header: std_msgs.Header
    states: list[ContactState]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        states: Sequence[ContactState | Mapping[str, object]] = ...,
    ) -> None: ...

class EntityState(base.Message):
    name: str
    pose: geometry_msgs.Pose
    twist: geometry_msgs.Twist
    reference_frame: str
    def __init__(
        self,
        *,
        name: str = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        twist: geometry_msgs.Twist | Mapping[str, object] = ...,
        reference_frame: str = ...,
    ) -> None: ...

class LinkState(base.Message):
    link_name: str
    pose: geometry_msgs.Pose
    twist: geometry_msgs.Twist
    reference_frame: str
    def __init__(
        self,
        *,
        link_name: str = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        twist: geometry_msgs.Twist | Mapping[str, object] = ...,
        reference_frame: str = ...,
    ) -> None: ...

class LinkStates(base.Message):
    name: list[str]
    pose: list[geometry_msgs.Pose]
    twist: list[geometry_msgs.Twist]
    def __init__(
        self,
        *,
        name: Sequence[str] = ...,
        pose: Sequence[geometry_msgs.Pose | Mapping[str, object]] = ...,
        twist: Sequence[geometry_msgs.Twist | Mapping[str, object]] = ...,
    ) -> None: ...

class ModelState(base.Message):
    model_name: str
    pose: geometry_msgs.Pose
    twist: geometry_msgs.Twist
    reference_frame: str
    def __init__(
        self,
        *,
        model_name: str = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        twist: geometry_msgs.Twist | Mapping[str, object] = ...,
        reference_frame: str = ...,
    ) -> None: ...

class ModelStates(base.Message):
    name: list[str]
    pose: list[geometry_msgs.Pose]
    twist: list[geometry_msgs.Twist]
    def __init__(
        self,
        *,
        name: Sequence[str] = ...,
        pose: Sequence[geometry_msgs.Pose | Mapping[str, object]] = ...,
        twist: Sequence[geometry_msgs.Twist | Mapping[str, object]] = ...,
    ) -> None: ...

class ODEJointProperties(base.Message):
    damping: npt.NDArray[np.float64]
    hi_stop: npt.NDArray[np.float64]
    lo_stop: npt.NDArray[np.float64]
    erp: npt.NDArray[np.float64]
    cfm: npt.NDArray[np.float64]
    stop_erp: npt.NDArray[np.float64]
    stop_cfm: npt.NDArray[np.float64]
    fudge_factor: npt.NDArray[np.float64]
    fmax: npt.NDArray[np.float64]
    vel: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        damping: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        hi_stop: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        lo_stop: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        erp: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        cfm: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        stop_erp: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        stop_cfm: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        fudge_factor: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        fmax: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        vel: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class ODEPhysics(base.Message):
    auto_disable_bodies: bool
    sor_pgs_precon_iters: int
    sor_pgs_iters: int
    sor_pgs_w: float
    sor_pgs_rms_error_tol: float
    contact_surface_layer: float
    contact_max_correcting_vel: float
    cfm: float
    erp: float
    max_contacts: int
    def __init__(
        self,
        *,
        auto_disable_bodies: bool = ...,
        sor_pgs_precon_iters: int = ...,
        sor_pgs_iters: int = ...,
        sor_pgs_w: float = ...,
        sor_pgs_rms_error_tol: float = ...,
        contact_surface_layer: float = ...,
        contact_max_correcting_vel: float = ...,
        cfm: float = ...,
        erp: float = ...,
        max_contacts: int = ...,
    ) -> None: ...

class PerformanceMetrics(base.Message):
    header: std_msgs.Header
    real_time_factor: float
    sensors: list[SensorPerformanceMetric]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        real_time_factor: float = ...,
        sensors: Sequence[SensorPerformanceMetric | Mapping[str, object]] = ...,
    ) -> None: ...

class SensorPerformanceMetric(base.Message):
    name: str
    sim_update_rate: float
    real_update_rate: float
    fps: float
    def __init__(
        self,
        *,
        name: str = ...,
        sim_update_rate: float = ...,
        real_update_rate: float = ...,
        fps: float = ...,
    ) -> None: ...

class WheelSlip(base.Message):
    name: list[str]
    lateral_slip: npt.NDArray[np.float64]
    longitudinal_slip: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        name: Sequence[str] = ...,
        lateral_slip: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        longitudinal_slip: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class WorldState(base.Message):
    header: std_msgs.Header
    name: list[str]
    pose: list[geometry_msgs.Pose]
    twist: list[geometry_msgs.Twist]
    wrench: list[geometry_msgs.Wrench]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        name: Sequence[str] = ...,
        pose: Sequence[geometry_msgs.Pose | Mapping[str, object]] = ...,
        twist: Sequence[geometry_msgs.Twist | Mapping[str, object]] = ...,
        wrench: Sequence[geometry_msgs.Wrench | Mapping[str, object]] = ...,
    ) -> None: ...

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.rcl_interfaces import msg as rcl_interfaces
from graphflow.msgs.std_msgs import msg as std_msgs

class AirSpeed(base.Message):
    header: std_msgs.Header
    diff_pressure: float
    temperature: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        diff_pressure: float = ...,
        temperature: float = ...,
    ) -> None: ...

class Altimeter(base.Message):
    header: std_msgs.Header
    vertical_position: float
    vertical_velocity: float
    vertical_reference: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        vertical_position: float = ...,
        vertical_velocity: float = ...,
        vertical_reference: float = ...,
    ) -> None: ...

class Contact(base.Message):
    collision1: Entity
    collision2: Entity
    positions: list[geometry_msgs.Vector3]
    normals: list[geometry_msgs.Vector3]
    depths: npt.NDArray[np.float64]
    wrenches: list[JointWrench]
    def __init__(
        self,
        *,
        collision1: Entity | Mapping[str, object] = ...,
        collision2: Entity | Mapping[str, object] = ...,
        positions: Sequence[geometry_msgs.Vector3 | Mapping[str, object]] = ...,
        normals: Sequence[geometry_msgs.Vector3 | Mapping[str, object]] = ...,
        depths: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        wrenches: Sequence[JointWrench | Mapping[str, object]] = ...,
    ) -> None: ...

class Contacts(base.Message):
    header: std_msgs.Header
    contacts: list[Contact]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        contacts: Sequence[Contact | Mapping[str, object]] = ...,
    ) -> None: ...

class Dataframe(base.Message):
    header: std_msgs.Header
    src_address: str
    dst_address: str
    data: npt.NDArray[np.uint8]
    rssi: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        src_address: str = ...,
        dst_address: str = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
        rssi: float = ...,
    ) -> None: ...

class Entity(base.Message):
    NONE: ClassVar[Literal[0]]
    LIGHT: ClassVar[Literal[1]]
    MODEL: ClassVar[Literal[2]]
    LINK: ClassVar[Literal[3]]
    VISUAL: ClassVar[Literal[4]]
    COLLISION: ClassVar[Literal[5]]
    SENSOR: ClassVar[Literal[6]]
    JOINT: ClassVar[Literal[7]]
    id: int
    name: str
    type: int
    def __init__(self, *, id: int = ..., name: str = ..., type: int = ...) -> None: ...

class EntityFactory(base.Message):
    name: str
    allow_renaming: bool
    sdf: str
    sdf_filename: str
    clone_name: str
    pose: geometry_msgs.Pose
    relative_to: str
    def __init__(
        self,
        *,
        name: str = ...,
        allow_renaming: bool = ...,
        sdf: str = ...,
        sdf_filename: str = ...,
        clone_name: str = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        relative_to: str = ...,
    ) -> None: ...

class EntityWrench(base.Message):
    header: std_msgs.Header
    entity: Entity
    wrench: geometry_msgs.Wrench
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        entity: Entity | Mapping[str, object] = ...,
        wrench: geometry_msgs.Wrench | Mapping[str, object] = ...,
    ) -> None: ...

class Float32Array(base.Message):
    data: npt.NDArray[np.float32]
    def __init__(self, *, data: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class GuiCamera(base.Message):
    header: std_msgs.Header
    name: str
    view_controller: str
    pose: geometry_msgs.Pose
    track: TrackVisual
    projection_type: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        name: str = ...,
        view_controller: str = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        track: TrackVisual | Mapping[str, object] = ...,
        projection_type: str = ...,
    ) -> None: ...

class JointWrench(base.Message):
    header: std_msgs.Header
    body_1_name: std_msgs.String
    body_1_id: std_msgs.UInt32
    body_2_name: std_msgs.String
    body_2_id: std_msgs.UInt32
    body_1_wrench: geometry_msgs.Wrench
    body_2_wrench: geometry_msgs.Wrench
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        body_1_name: std_msgs.String | Mapping[str, object] = ...,
        body_1_id: std_msgs.UInt32 | Mapping[str, object] = ...,
        body_2_name: std_msgs.String | Mapping[str, object] = ...,
        body_2_id: std_msgs.UInt32 | Mapping[str, object] = ...,
        body_1_wrench: geometry_msgs.Wrench | Mapping[str, object] = ...,
        body_2_wrench: geometry_msgs.Wrench | Mapping[str, object] = ...,
    ) -> None: ...

class Light(base.Message):
    POINT: ClassVar[Literal[0]]
    SPOT: ClassVar[Literal[1]]
    DIRECTIONAL: ClassVar[Literal[2]]
    header: std_msgs.Header
    name: str
    type: int
    pose: geometry_msgs.Pose
    diffuse: std_msgs.ColorRGBA
    specular: std_msgs.ColorRGBA
    attenuation_constant: float
    attenuation_linear: float
    attenuation_quadratic: float
    direction: geometry_msgs.Vector3
    range: float
    cast_shadows: bool
    spot_inner_angle: float
    spot_outer_angle: float
    spot_falloff: float
    id: int
    parent_id: int
    intensity: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        name: str = ...,
        type: int = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        diffuse: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        specular: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        attenuation_constant: float = ...,
        attenuation_linear: float = ...,
        attenuation_quadratic: float = ...,
        direction: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        range: float = ...,
        cast_shadows: bool = ...,
        spot_inner_angle: float = ...,
        spot_outer_angle: float = ...,
        spot_falloff: float = ...,
        id: int = ...,
        parent_id: int = ...,
        intensity: float = ...,
    ) -> None: ...

class LogPlaybackStatistics(base.Message):
    header: std_msgs.Header
    start_time: builtin_interfaces.Time
    end_time: builtin_interfaces.Time
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        start_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        end_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class LogicalCameraImage(base.Message):
    header: std_msgs.Header
    pose: geometry_msgs.Pose
    model: list[LogicalCameraImageModel]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        model: Sequence[LogicalCameraImageModel | Mapping[str, object]] = ...,
    ) -> None: ...

class LogicalCameraImageModel(base.Message):
    name: str
    pose: geometry_msgs.Pose
    def __init__(self, *, name: str = ..., pose: geometry_msgs.Pose | Mapping[str, object] = ...) -> None: ...

class MaterialColor(base.Message):
    FIRST: ClassVar[Literal[0]]
    ALL: ClassVar[Literal[1]]
    header: std_msgs.Header
    entity: Entity
    ambient: std_msgs.ColorRGBA
    diffuse: std_msgs.ColorRGBA
    specular: std_msgs.ColorRGBA
    emissive: std_msgs.ColorRGBA
    shininess: float
    entity_match: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        entity: Entity | Mapping[str, object] = ...,
        ambient: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        diffuse: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        specular: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        emissive: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        shininess: float = ...,
        entity_match: int = ...,
    ) -> None: ...

class ParamVec(base.Message):
    header: std_msgs.Header
    params: list[rcl_interfaces.Parameter]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        params: Sequence[rcl_interfaces.Parameter | Mapping[str, object]] = ...,
    ) -> None: ...

class SensorNoise(base.Message):
    NONE: ClassVar[Literal[0]]
    GAUSSIAN: ClassVar[Literal[2]]
    GAUSSIAN_QUANTIZED: ClassVar[Literal[3]]
    header: std_msgs.Header
    type: int
    mean: float
    stddev: float
    bias_mean: float
    bias_stddev: float
    precision: float
    dynamic_bias_stddev: float
    dynamic_bias_correlation_time: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        type: int = ...,
        mean: float = ...,
        stddev: float = ...,
        bias_mean: float = ...,
        bias_stddev: float = ...,
        precision: float = ...,
        dynamic_bias_stddev: float = ...,
        dynamic_bias_correlation_time: float = ...,
    ) -> None: ...

class StringVec(base.Message):
    header: std_msgs.Header
    data: list[str]
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., data: Sequence[str] = ...) -> None: ...

class TrackVisual(base.Message):
    header: std_msgs.Header
    name: str
    id: int
    inherit_orientation: bool
    min_dist: float
    max_dist: float
    is_static: bool
    use_model_frame: bool
    xyz: geometry_msgs.Vector3
    inherit_yaw: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        name: str = ...,
        id: int = ...,
        inherit_orientation: bool = ...,
        min_dist: float = ...,
        max_dist: float = ...,
        is_static: bool = ...,
        use_model_frame: bool = ...,
        xyz: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        inherit_yaw: bool = ...,
    ) -> None: ...

class VideoRecord(base.Message):
    header: std_msgs.Header
    start: bool
    stop: bool
    format: str
    save_filename: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        start: bool = ...,
        stop: bool = ...,
        format: str = ...,
        save_filename: str = ...,
    ) -> None: ...

class WorldControl(base.Message):
    pause: bool
    step: bool
    multi_step: int
    reset: WorldReset
    seed: int
    run_to_sim_time: builtin_interfaces.Time
    def __init__(
        self,
        *,
        pause: bool = ...,
        step: bool = ...,
        multi_step: int = ...,
        reset: WorldReset | Mapping[str, object] = ...,
        seed: int = ...,
        run_to_sim_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
    ) -> None: ...

class WorldReset(base.Message):
    all: bool
    time_only: bool
    model_only: bool
    def __init__(self, *, all: bool = ..., time_only: bool = ..., model_only: bool = ...) -> None: ...

class WorldStatistics(base.Message):
    header: std_msgs.Header
    sim_time: builtin_interfaces.Time
    pause_time: builtin_interfaces.Time
    real_time: builtin_interfaces.Time
    paused: bool
    iterations: int
    model_count: int
    log_playback_statistics: LogPlaybackStatistics
    real_time_factor: float
    step_size: builtin_interfaces.Time
    stepping: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        sim_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        pause_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        real_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        paused: bool = ...,
        iterations: int = ...,
        model_count: int = ...,
        log_playback_statistics: LogPlaybackStatistics | Mapping[str, object] = ...,
        real_time_factor: float = ...,
        step_size: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        stepping: bool = ...,
    ) -> None: ...

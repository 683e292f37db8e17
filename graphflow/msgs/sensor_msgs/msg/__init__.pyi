# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class BatteryState(base.Message):
    POWER_SUPPLY_STATUS_UNKNOWN: ClassVar[Literal[0]]
    POWER_SUPPLY_STATUS_CHARGING: ClassVar[Literal[1]]
    POWER_SUPPLY_STATUS_DISCHARGING: ClassVar[Literal[2]]
    POWER_SUPPLY_STATUS_NOT_CHARGING: ClassVar[Literal[3]]
    POWER_SUPPLY_STATUS_FULL: ClassVar[Literal[4]]
    POWER_SUPPLY_HEALTH_UNKNOWN: ClassVar[Literal[0]]
    POWER_SUPPLY_HEALTH_GOOD: ClassVar[Literal[1]]
    POWER_SUPPLY_HEALTH_OVERHEAT: ClassVar[Literal[2]]
    POWER_SUPPLY_HEALTH_DEAD: ClassVar[Literal[3]]
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: ClassVar[Literal[4]]
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: ClassVar[Literal[5]]
    POWER_SUPPLY_HEALTH_COLD: ClassVar[Literal[6]]
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: ClassVar[Literal[7]]
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: ClassVar[Literal[8]]
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: ClassVar[Literal[0]]
    POWER_SUPPLY_TECHNOLOGY_NIMH: ClassVar[Literal[1]]
    POWER_SUPPLY_TECHNOLOGY_LION: ClassVar[Literal[2]]
    POWER_SUPPLY_TECHNOLOGY_LIPO: ClassVar[Literal[3]]
    POWER_SUPPLY_TECHNOLOGY_LIFE: ClassVar[Literal[4]]
    POWER_SUPPLY_TECHNOLOGY_NICD: ClassVar[Literal[5]]
    POWER_SUPPLY_TECHNOLOGY_LIMN: ClassVar[Literal[6]]
    POWER_SUPPLY_TECHNOLOGY_TERNARY: ClassVar[Literal[7]]
    POWER_SUPPLY_TECHNOLOGY_VRLA: ClassVar[Literal[8]]
    header: std_msgs.Header
    voltage: float
    temperature: float
    current: float
    charge: float
    capacity: float
    design_capacity: float
    percentage: float
    power_supply_status: int
    power_supply_health: int
    power_supply_technology: int
    present: bool
    cell_voltage: npt.NDArray[np.float32]
    cell_temperature: npt.NDArray[np.float32]
    location: str
    serial_number: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        voltage: float = ...,
        temperature: float = ...,
        current: float = ...,
        charge: float = ...,
        capacity: float = ...,
        design_capacity: float = ...,
        percentage: float = ...,
        power_supply_status: int = ...,
        power_supply_health: int = ...,
        power_supply_technology: int = ...,
        present: bool = ...,
        cell_voltage: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        cell_temperature: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        location: str = ...,
        serial_number: str = ...,
    ) -> None: ...

class CameraInfo(base.Message):
    header: std_msgs.Header
    height: int
    width: int
    distortion_model: str
    d: npt.NDArray[np.float64]
    k: npt.NDArray[np.float64]
    r: npt.NDArray[np.float64]
    p: npt.NDArray[np.float64]
    binning_x: int
    binning_y: int
    roi: RegionOfInterest
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        height: int = ...,
        width: int = ...,
        distortion_model: str = ...,
        d: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        k: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        r: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        p: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        binning_x: int = ...,
        binning_y: int = ...,
        roi: RegionOfInterest | Mapping[str, object] = ...,
    ) -> None: ...

class ChannelFloat32(base.Message):
    name: str
    values: npt.NDArray[np.float32]
    def __init__(
        self,
        *,
        name: str = ...,
        values: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class CompressedImage(base.Message):
    header: std_msgs.Header
    format: str
    data: npt.NDArray[np.uint8]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        format: str = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class FluidPressure(base.Message):
    header: std_msgs.Header
    fluid_pressure: float
    variance: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        fluid_pressure: float = ...,
        variance: float = ...,
    ) -> None: ...

class Illuminance(base.Message):
    header: std_msgs.Header
    illuminance: float
    variance: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        illuminance: float = ...,
        variance: float = ...,
    ) -> None: ...

class Image(base.Message):
    header: std_msgs.Header
    height: int
    width: int
    encoding: str
    is_bigendian: int
    step: int
    data: npt.NDArray[np.uint8]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        height: int = ...,
        width: int = ...,
        encoding: str = ...,
        is_bigendian: int = ...,
        step: int = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...
    def to_numpy(self) -> npt.NDArray[Any]: ...

class Imu(base.Message):
    header: std_msgs.Header
    orientation: geometry_msgs.Quaternion
    orientation_covariance: npt.NDArray[np.float64]
    angular_velocity: geometry_msgs.Vector3
    angular_velocity_covariance: npt.NDArray[np.float64]
    linear_acceleration: geometry_msgs.Vector3
    linear_acceleration_covariance: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        orientation: geometry_msgs.Quaternion | Mapping[str, object] = ...,
        orientation_covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        angular_velocity: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        angular_velocity_covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        linear_acceleration: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        linear_acceleration_covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class JointState(base.Message):
    header: std_msgs.Header
    name: list[str]
    position: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    effort: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        name: Sequence[str] = ...,
        position: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        velocity: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        effort: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class Joy(base.Message):
    header: std_msgs.Header
    axes: npt.NDArray[np.float32]
    buttons: npt.NDArray[np.int32]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        axes: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        buttons: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class JoyFeedback(base.Message):
    TYPE_LED: ClassVar[Literal[0]]
    TYPE_RUMBLE: ClassVar[Literal[1]]
    TYPE_BUZZER: ClassVar[Literal[2]]
    type: int
    id: int
    intensity: float
    def __init__(self, *, type: int = ..., id: int = ..., intensity: float = ...) -> None: ...

class JoyFeedbackArray(base.Message):
    array: list[JoyFeedback]
    def __init__(self, *, array: Sequence[JoyFeedback | Mapping[str, object]] = ...) -> None: ...

class LaserEcho(base.Message):
    echoes: npt.NDArray[np.float32]
    def __init__(self, *, echoes: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class LaserScan(base.Message):
    header: std_msgs.Header
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: npt.NDArray[np.float32]
    intensities: npt.NDArray[np.float32]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        angle_min: float = ...,
        angle_max: float = ...,
        angle_increment: float = ...,
        time_increment: float = ...,
        scan_time: float = ...,
        range_min: float = ...,
        range_max: float = ...,
        ranges: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        intensities: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...
    def to_numpy(self) -> npt.NDArray[Any]: ...

class MagneticField(base.Message):
    header: std_msgs.Header
    magnetic_field: geometry_msgs.Vector3
    magnetic_field_covariance: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        magnetic_field: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        magnetic_field_covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class MultiDOFJointState(base.Message):
    header: std_msgs.Header
    joint_names: list[str]
    transforms: list[geometry_msgs.Transform]
    twist: list[geometry_msgs.Twist]
    wrench: list[geometry_msgs.Wrench]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        joint_names: Sequence[str] = ...,
        transforms: Sequence[geometry_msgs.Transform | Mapping[str, object]] = ...,
        twist: Sequence[geometry_msgs.Twist | Mapping[str, object]] = ...,
        wrench: Sequence[geometry_msgs.Wrench | Mapping[str, object]] = ...,
    ) -> None: ...

class MultiEchoLaserScan(base.Message):
    header: std_msgs.Header
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: list[LaserEcho]
    intensities: list[LaserEcho]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        angle_min: float = ...,
        angle_max: float = ...,
        angle_increment: float = ...,
        time_increment: float = ...,
        scan_time: float = ...,
        range_min: float = ...,
        range_max: float = ...,
        ranges: Sequence[LaserEcho | Mapping[str, object]] = ...,
        intensities: Sequence[LaserEcho | Mapping[str, object]] = ...,
    ) -> None: ...

class NavSatFix(base.Message):
    COVARIANCE_TYPE_UNKNOWN: ClassVar[Literal[0]]
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[Literal[1]]
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[Literal[2]]
    COVARIANCE_TYPE_KNOWN: ClassVar[Literal[3]]
    header: std_msgs.Header
    status: NavSatStatus
    latitude: float
    longitude: float
    altitude: float
    position_covariance: npt.NDArray[np.float64]
    position_covariance_type: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        status: NavSatStatus | Mapping[str, object] = ...,
        latitude: float = ...,
        longitude: float = ...,
        altitude: float = ...,
        position_covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        position_covariance_type: int = ...,
    ) -> None: ...

class NavSatStatus(base.Message):
    STATUS_UNKNOWN: ClassVar[Literal[-2]]
    STATUS_NO_FIX: ClassVar[Literal[-1]]
    STATUS_FIX: ClassVar[Literal[0]]
    STATUS_SBAS_FIX: ClassVar[Literal[1]]
    STATUS_GBAS_FIX: ClassVar[Literal[2]]
    SERVICE_UNKNOWN: ClassVar[Literal[0]]
    SERVICE_GPS: ClassVar[Literal[1]]
    SERVICE_GLONASS: ClassVar[Literal[2]]
    SERVICE_COMPASS: ClassVar[Literal[4]]
    SERVICE_GALILEO: ClassVar[Literal[8]]
    status: int
    service: int
    def __init__(self, *, status: int = ..., service: int = ...) -> None: ...

class PointCloud(base.Message):
    header: std_msgs.Header
    points: list[geometry_msgs.Point32]
    channels: list[ChannelFloat32]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        points: Sequence[geometry_msgs.Point32 | Mapping[str, object]] = ...,
        channels: Sequence[ChannelFloat32 | Mapping[str, object]] = ...,
    ) -> None: ...

class PointCloud2(base.Message):
    header: std_msgs.Header
    height: int
    width: int
    fields: list[PointField]
    is_bigendian: bool
    point_step: int
    row_step: int
    data: npt.NDArray[np.uint8]
    is_dense: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        height: int = ...,
        width: int = ...,
        fields: Sequence[PointField | Mapping[str, object]] = ...,
        is_bigendian: bool = ...,
        point_step: int = ...,
        row_step: int = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
        is_dense: bool = ...,
    ) -> None: ...
    def to_numpy(self) -> npt.NDArray[Any]: ...

class PointField(base.Message):
    INT8: ClassVar[Literal[1]]
    UINT8: ClassVar[Literal[2]]
    INT16: ClassVar[Literal[3]]
    UINT16: ClassVar[Literal[4]]
    INT32: ClassVar[Literal[5]]
    UINT32: ClassVar[Literal[6]]
    FLOAT32: ClassVar[Literal[7]]
    FLOAT64: ClassVar[Literal[8]]
    name: str
    offset: int
    datatype: int
    count: int
    def __init__(self, *, name: str = ..., offset: int = ..., datatype: int = ..., count: int = ...) -> None: ...

class Range(base.Message):
    ULTRASOUND: ClassVar[Literal[0]]
    INFRARED: ClassVar[Literal[1]]
    header: std_msgs.Header
    radiation_type: int
    field_of_view: float
    min_range: float
    max_range: float
    range: float
    variance: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        radiation_type: int = ...,
        field_of_view: float = ...,
        min_range: float = ...,
        max_range: float = ...,
        range: float = ...,
        variance: float = ...,
    ) -> None: ...

class RegionOfInterest(base.Message):
    x_offset: int
    y_offset: int
    height: int
    width: int
    do_rectify: bool
    def __init__(
        self,
        *,
        x_offset: int = ...,
        y_offset: int = ...,
        height: int = ...,
        width: int = ...,
        do_rectify: bool = ...,
    ) -> None: ...

class RelativeHumidity(base.Message):
    header: std_msgs.Header
    relative_humidity: float
    variance: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        relative_humidity: float = ...,
        variance: float = ...,
    ) -> None: ...

class Temperature(base.Message):
    header: std_msgs.Header
    temperature: float
    variance: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        temperature: float = ...,
        variance: float = ...,
    ) -> None: ...

class TimeReference(base.Message):
    header: std_msgs.Header
    time_ref: builtin_interfaces.Time
    source: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        time_ref: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        source: str = ...,
    ) -> None: ...

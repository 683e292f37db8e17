# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.std_msgs import msg as std_msgs

class AudioNote(base.Message):
    frequency: int
    max_runtime: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        frequency: int = ...,
        max_runtime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class AudioNoteVector(base.Message):
    header: std_msgs.Header
    notes: list[AudioNote]
    append: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        notes: Sequence[AudioNote | Mapping[str, object]] = ...,
        append: bool = ...,
    ) -> None: ...

class Button(base.Message):
    header: std_msgs.Header
    is_pressed: bool
    last_start_pressed_time: builtin_interfaces.Time
    last_pressed_duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        is_pressed: bool = ...,
        last_start_pressed_time: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        last_pressed_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class DockStatus(base.Message):
    header: std_msgs.Header
    dock_visible: bool
    is_docked: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        dock_visible: bool = ...,
        is_docked: bool = ...,
    ) -> None: ...

class HazardDetection(base.Message):
    BACKUP_LIMIT: ClassVar[Literal[0]]
    BUMP: ClassVar[Literal[1]]
    CLIFF: ClassVar[Literal[2]]
    STALL: ClassVar[Literal[3]]
    WHEEL_DROP: ClassVar[Literal[4]]
    OBJECT_PROXIMITY: ClassVar[Literal[5]]
    header: std_msgs.Header
    type: int
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., type: int = ...) -> None: ...

class HazardDetectionVector(base.Message):
    header: std_msgs.Header
    detections: list[HazardDetection]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        detections: Sequence[HazardDetection | Mapping[str, object]] = ...,
    ) -> None: ...

class InterfaceButtons(base.Message):
    header: std_msgs.Header
    button_1: Button
    button_power: Button
    button_2: Button
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        button_1: Button | Mapping[str, object] = ...,
        button_power: Button | Mapping[str, object] = ...,
        button_2: Button | Mapping[str, object] = ...,
    ) -> None: ...

class IrIntensity(base.Message):
    header: std_msgs.Header
    value: int
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., value: int = ...) -> None: ...

class IrIntensityVector(base.Message):
    header: std_msgs.Header
    readings: list[IrIntensity]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        readings: Sequence[IrIntensity | Mapping[str, object]] = ...,
    ) -> None: ...

class IrOpcode(base.Message):
    CODE_IR_FORCE_FIELD: ClassVar[Literal[161]]
    CODE_IR_VIRTUAL_WALL: ClassVar[Literal[162]]
    CODE_IR_BUOY_GREEN: ClassVar[Literal[164]]
    CODE_IR_BUOY_RED: ClassVar[Literal[168]]
    CODE_IR_BUOY_BOTH: ClassVar[Literal[172]]
    CODE_IR_EVAC_GREEN_FIELD: ClassVar[Literal[244]]
    CODE_IR_EVAC_RED_FIELD: ClassVar[Literal[248]]
    CODE_IR_EVAC_BOTH_FIELD: ClassVar[Literal[252]]
    SENSOR_OMNI: ClassVar[Literal[0]]
    SENSOR_DIRECTIONAL_FRONT: ClassVar[Literal[1]]
    header: std_msgs.Header
    opcode: int
    sensor: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        opcode: int = ...,
        sensor: int = ...,
    ) -> None: ...

class KidnapStatus(base.Message):
    header: std_msgs.Header
    is_kidnapped: bool
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., is_kidnapped: bool = ...) -> None: ...

class LedColor(base.Message):
    red: int
    green: int
    blue: int
    def __init__(self, *, red: int = ..., green: int = ..., blue: int = ...) -> None: ...

class LightringLeds(base.Message):
    header: std_msgs.Header
    leds: list[LedColor]
    override_system: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        leds: Sequence[LedColor | Mapping[str, object]] = ...,
        override_system: bool = ...,
    ) -> None: ...

class Mouse(base.Message):
    header: std_msgs.Header
    integrated_x: float
    integrated_y: float
    frame_id: int
    last_squal: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        integrated_x: float = ...,
        integrated_y: float = ...,
        frame_id: int = ...,
        last_squal: int = ...,
    ) -> None: ...

class SlipStatus(base.Message):
    header: std_msgs.Header
    is_slipping: bool
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., is_slipping: bool = ...) -> None: ...

class StopStatus(base.Message):
    header: std_msgs.Header
    is_stopped: bool
    def __init__(self, *, header: std_msgs.Header | Mapping[str, object] = ..., is_stopped: bool = ...) -> None: ...

class WheelStatus(base.Message):
    header: std_msgs.Header
    current_ma_left: int
    current_ma_right: int
    pwm_left: int
    pwm_right: int
    wheels_enabled: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        current_ma_left: int = ...,
        current_ma_right: int = ...,
        pwm_left: int = ...,
        pwm_right: int = ...,
        wheels_enabled: bool = ...,
    ) -> None: ...

class WheelTicks(base.Message):
    header: std_msgs.Header
    ticks_left: int
    ticks_right: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        ticks_left: int = ...,
        ticks_right: int = ...,
    ) -> None: ...

class WheelVels(base.Message):
    header: std_msgs.Header
    velocity_left: float
    velocity_right: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        velocity_left: float = ...,
        velocity_right: float = ...,
    ) -> None: ...

# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping
from typing import ClassVar, Literal

from graphflow.msgs import base
from graphflow.msgs.std_msgs import msg as std_msgs

class SensorState(base.Message):
    BUMPER_FORWARD: ClassVar[Literal[1]]
    BUMPER_BACKWARD: ClassVar[Literal[2]]
    CLIFF: ClassVar[Literal[1]]
    SONAR: ClassVar[Literal[1]]
    ILLUMINATION: ClassVar[Literal[1]]
    BUTTON0: ClassVar[Literal[1]]
    BUTTON1: ClassVar[Literal[2]]
    ERROR_LEFT_MOTOR: ClassVar[Literal[1]]
    ERROR_RIGHT_MOTOR: ClassVar[Literal[2]]
    TORQUE_ON: ClassVar[Literal[1]]
    TORQUE_OFF: ClassVar[Literal[2]]
    header: std_msgs.Header
    bumper: int
    cliff: float
    sonar: float
    illumination: float
    led: int
    button: int
    torque: bool
    left_encoder: int
    right_encoder: int
    battery: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        bumper: int = ...,
        cliff: float = ...,
        sonar: float = ...,
        illumination: float = ...,
        led: int = ...,
        button: int = ...,
        torque: bool = ...,
        left_encoder: int = ...,
        right_encoder: int = ...,
        battery: float = ...,
    ) -> None: ...

class Sound(base.Message):
    OFF: ClassVar[Literal[0]]
    ON: ClassVar[Literal[1]]
    LOW_BATTERY: ClassVar[Literal[2]]
    ERROR: ClassVar[Literal[3]]
    BUTTON1: ClassVar[Literal[4]]
    BUTTON2: ClassVar[Literal[5]]
    value: int
    def __init__(self, *, value: int = ...) -> None: ...

class VersionInfo(base.Message):
    hardware: str
    firmware: str
    software: str
    def __init__(self, *, hardware: str = ..., firmware: str = ..., software: str = ...) -> None: ...

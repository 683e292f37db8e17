# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping

from graphflow.msgs import base
from graphflow.msgs.std_msgs import msg as std_msgs

class AckermannDrive(base.Message):
    steering_angle: float
    steering_angle_velocity: float
    speed: float
    acceleration: float
    jerk: float
    def __init__(
        self,
        *,
        steering_angle: float = ...,
        steering_angle_velocity: float = ...,
        speed: float = ...,
        acceleration: float = ...,
        jerk: float = ...,
    ) -> None: ...

class AckermannDriveStamped(base.Message):
    header: std_msgs.Header
    drive: AckermannDrive
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        drive: AckermannDrive | Mapping[str, object] = ...,
    ) -> None: ...

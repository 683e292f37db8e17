"""The kinds of clocks."""

from enum import IntEnum


class ClockType(IntEnum):
    """What a clock goes by: the simulator's time or else the time of day, the time of day, or time that never jumps."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3

"""The kinds of clocks."""

from enum import IntEnum


class ClockType(IntEnum):
    """The time that a clock shows: simulated time or else wall time, wall time, or monotonic time."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3

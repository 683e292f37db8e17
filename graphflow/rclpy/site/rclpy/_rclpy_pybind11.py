"""Names that code imports from rclpy's extension module: its exceptions, and a few of its enumerations.

There is no extension here. What wraps rcl's own objects, such as wait sets, has no equivalent.
"""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import Any


class RCLError(RuntimeError):
    """What rcl reports."""


class RCLInvalidROSArgsError(RCLError):
    """An argument after `--ros-args` is wrong."""


class UnknownROSArgsError(RuntimeError):
    """Arguments after `--ros-args` that are not ROS's."""


class NodeNameNonExistentError(RCLError):
    """There is no node of that name."""


class UnsupportedEventTypeError(RCLError):
    """The middleware has no such event."""


class RCUtilsError(RuntimeError):
    """What rcutils reports."""


class RMWError(RuntimeError):
    """What the middleware reports."""


class TimerCancelledError(RCLError):
    """The timer was cancelled."""


class InvalidHandle(RuntimeError):
    """What is used was destroyed before."""


class SignalHandlerOptions(Enum):
    """Signals that rclpy handles."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


class ClockChange(IntEnum):
    """How a clock changed its source when it jumped."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class GoalEvent(Enum):
    """What happens to a goal at its server."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


class TransitionCallbackReturnType(Enum):
    """What a lifecycle callback answers."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99


class rmw_qos_profile_t:  # noqa: N801 - rmw's name
    """rmw's profiles."""

    @staticmethod
    def predefined(name: str) -> Any:
        """One of them by its name: `qos_profile_default`."""
        from rclpy import qos

        return getattr(qos, name)


class ServiceIntrospectionState(Enum):
    """What is published of each call of a service."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2

"""Names that programs import from rclpy's extension module: its exceptions and a few enumerations.

There is no extension here: wrappers of rcl objects, such as wait sets, have no equivalent.
"""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import Any


class RCLError(RuntimeError):
    """An error from rcl."""


class RCLInvalidROSArgsError(RCLError):
    """An argument after `--ros-args` is wrong."""


class UnknownROSArgsError(RuntimeError):
    """Arguments after `--ros-args` are not ROS arguments."""


class NodeNameNonExistentError(RCLError):
    """No node has that name."""


class UnsupportedEventTypeError(RCLError):
    """The middleware has no such event."""


class RCUtilsError(RuntimeError):
    """An error from rcutils."""


class RMWError(RuntimeError):
    """An error from the middleware."""


class TimerCancelledError(RCLError):
    """The timer was cancelled."""


class InvalidHandle(RuntimeError):
    """An entity was used after it was destroyed."""


class SignalHandlerOptions(Enum):
    """The signals that rclpy handles."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


class ClockChange(IntEnum):
    """A change of a clock's source in a jump."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class GoalEvent(Enum):
    """The events of a goal at its server."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


class TransitionCallbackReturnType(Enum):
    """The result of a lifecycle callback."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99


class rmw_qos_profile_t:  # noqa: N801 - rmw's name
    """rmw's QoS profiles."""

    @staticmethod
    def predefined(name: str) -> Any:
        """Return a predefined profile by name: `qos_profile_default`."""
        from rclpy import qos

        return getattr(qos, name)


class ServiceIntrospectionState(Enum):
    """The part of a service's calls that is published."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2

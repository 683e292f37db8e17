"""The default context, and queries about the middleware."""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence

from graphflow.errors import GraphflowError
from graphflow.rclpy.context_state import parse_only_ros
from rclpy._rclpy_pybind11 import RCLInvalidROSArgsError
from rclpy.constants import S_TO_NS
from rclpy.context import Context

_default: Context | None = None
_lock = threading.Lock()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the context that is used where none is named; a new one once it was shut down.

    Args:
        shutting_down: Whether it is about to be shut down: then the existing one is returned, and there must be one.
    """
    global _default
    with _lock:
        if shutting_down:
            if _default is None:
                raise RuntimeError("There is no default context to be shutdown")
            former, _default = _default, None
            return former
        if _default is None:
            _default = Context()
        return _default


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return a command line without its ROS arguments.

    Raises:
        RCLInvalidROSArgsError: A ROS argument is wrong.
    """
    words = list(sys.argv if args is None else args)
    kept: list[str] = []
    in_ros = False
    for word in words:
        if word == "--ros-args":
            in_ros = True
        elif in_ros and word == "--":
            in_ros = False
        elif not in_ros:
            kept.append(word)
    try:
        parse_only_ros(words)
    except GraphflowError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from None
    return kept


def ok(*, context: Context | None = None) -> bool:
    """Whether a context is initialized and not shut down."""
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None) -> None:
    """Shut a context down. Raises RuntimeError if that was done before."""
    if context is None:
        current = _default
        if current is None or current.life is None:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        current.shutdown()
        _replace(current)
    else:
        context.shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """Shut a context down if that was not done before."""
    current = _default if context is None else context
    if current is not None and current.try_shutdown() and context is None:
        _replace(current)


def _replace(ended: Context) -> None:
    """Make another context the default, unless it is already, or another thread has initialized this one again."""
    global _default
    with _lock:
        if _default is ended and not ended.ok():
            _default = None


def get_rmw_implementation_identifier() -> str:
    """Return the name of the middleware whose wire protocol is used."""
    return "rmw_zenoh_cpp"


def get_available_rmw_implementations() -> set[str]:
    """Return the available middlewares."""
    return {get_rmw_implementation_identifier()}


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Convert seconds to nanoseconds; -1 for no limit."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(float(timeout_sec) * S_TO_NS)

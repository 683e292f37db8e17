"""A client of a transform buffer in another process, which serves it by an action."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from action_msgs.msg import GoalStatus
from geometry_msgs.msg import TransformStamped
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error
from tf2_py import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from rclpy.action.client import ActionClient
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tf2_ros.buffer_interface import AT_ONCE, BufferInterface

_ERRORS = {
    TF2Error.LOOKUP_ERROR: LookupException,
    TF2Error.CONNECTIVITY_ERROR: ConnectivityException,
    TF2Error.EXTRAPOLATION_ERROR: ExtrapolationException,
    TF2Error.INVALID_ARGUMENT_ERROR: InvalidArgumentException,
    TF2Error.TIMEOUT_ERROR: TimeoutException,
}


class BufferClient(BufferInterface):
    """A client of a buffer server. Another thread must spin the node meanwhile.

    Args:
        node: The node of the client.
        ns: The name of the server's action.
        check_frequency: Ignored: answers are not polled.
        timeout_padding: The time that the server may take beyond its own limit.
    """

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = Duration(seconds=2.0),  # noqa: B008 - as rclpy has it; it does not change
    ) -> None:
        super().__init__()
        self.node = node
        self.action_client = ActionClient(node, LookupTransform, ns)
        self.check_frequency = check_frequency
        self.timeout_padding = timeout_padding

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: object, timeout: Duration = AT_ONCE
    ) -> TransformStamped:
        """Look up a transform as `Buffer.lookup_transform` does.

        Raises:
            TransformException: There is none; TimeoutException if the server is unavailable.
        """
        goal = LookupTransform.Goal(target_frame=target_frame, source_frame=source_frame, source_time=_message(time))
        return self._graphflow_request(goal, timeout)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> TransformStamped:
        """Look up a transform as `Buffer.lookup_transform_full` does. Errors as for `lookup_transform`."""
        goal = LookupTransform.Goal(
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=_message(source_time),
            target_time=_message(target_time),
            fixed_frame=fixed_frame,
            advanced=True,
        )
        return self._graphflow_request(goal, timeout)

    def can_transform(self, target_frame: str, source_frame: str, time: object, timeout: Duration = AT_ONCE) -> bool:
        """Whether `lookup_transform` would return a transform."""
        return _succeeds(lambda: self.lookup_transform(target_frame, source_frame, time, timeout))

    def can_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> bool:
        """Whether `lookup_transform_full` would return a transform."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return _succeeds(lambda: self.lookup_transform_full(*asked, timeout))

    def destroy(self) -> None:
        """Destroy the client."""
        self.action_client.destroy()

    def _graphflow_request(self, goal: LookupTransform.Goal, timeout: Duration) -> TransformStamped:
        goal.timeout = timeout.to_msg()
        if not self.action_client.server_is_ready():
            raise TimeoutException("The BufferServer is not ready.")
        limit = (timeout.nanoseconds + self.timeout_padding.nanoseconds) / 1e9
        handle = _waited_for(self.action_client.send_goal_async(goal), limit)
        if not handle.accepted:
            raise TimeoutException("The BufferServer did not accept the LookupTransform goal.")
        answer = _waited_for(handle.get_result_async(), limit)
        error = answer.result.error
        if error.error != TF2Error.NO_ERROR or answer.status != GoalStatus.STATUS_SUCCEEDED:
            raise _ERRORS.get(error.error, TransformException)(error.error_string)
        transform: TransformStamped = answer.result.transform
        return transform


def _succeeds(look_up: Callable[[], TransformStamped]) -> bool:
    try:
        look_up()
    except TransformException:
        return False
    return True


def _waited_for(future: Future, limit: float) -> Any:
    """Return a future's result within some seconds."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    if not done.wait(limit):
        raise TimeoutException("The BufferServer did not answer the LookupTransform goal in the specified time.")
    return future.result()


def _message(time: object) -> object:
    return time.to_msg() if isinstance(time, Time) else time

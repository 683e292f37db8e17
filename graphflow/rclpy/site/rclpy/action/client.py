"""Action clients."""

from __future__ import annotations

import logging
import sys
import uuid
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from graphflow.machines.goal import GoalStatus as Status
from graphflow.rclpy.messages import classes
from graphflow.rclpy.wake import Wake
from rclpy._rclpy_pybind11 import RCLError
from rclpy.impl.action_internals import ActionClientInternals
from rclpy.impl.callers import caller
from rclpy.impl.mistakes.arguments import explained
from rclpy.impl.mistakes.unended_goals import warn_of_unended
from rclpy.impl.nodes import internals_of
from rclpy.impl.reexports import passed_on
from rclpy.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from rclpy.task import Future
from rclpy.type_support import check_for_type_support
from rclpy.waitable import NumberOfEntities, Waitable

if TYPE_CHECKING:
    from action_msgs.srv import CancelGoal
    from builtin_interfaces.msg import Time as TimeMessage
    from unique_identifier_msgs.msg import UUID

    from rclpy.callback_groups import CallbackGroup
    from rclpy.node import Node

__all__ = ["ActionClient", "ClientGoalHandle"]

logger = logging.getLogger("graphflow")


class ClientGoalHandle:
    """The client's handle of a goal that the server has answered."""

    def __init__(self, action_client: ActionClient, goal_id: UUID, goal_response: Any) -> None:
        self._action_client, self._goal_id, self._goal_response = action_client, goal_id, goal_response
        self._status = int(Status.UNKNOWN)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other.goal_id

    def __hash__(self) -> int:
        return hash(bytes(self._goal_id.uuid))

    def __repr__(self) -> str:
        return (
            f"ClientGoalHandle <id={bytes(self._goal_id.uuid).hex()}, accepted={self.accepted}, status={self.status}>"
        )

    @property
    def goal_id(self) -> UUID:
        """The goal's id, a unique_identifier_msgs/msg/UUID."""
        return self._goal_id

    @property
    def stamp(self) -> TimeMessage:
        """The time of the server's answer."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the goal was accepted."""
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """The last known status, a value of action_msgs/msg/GoalStatus."""
        return self._status

    def note_status(self, status: int) -> None:
        """Note a status that the server has reported. graphflow's own."""
        self._status = status

    def cancel_goal(self) -> CancelGoal.Response:
        """Request cancellation and block until the answer; another thread must be spinning."""
        return internals_of(self._action_client).block_on(self.cancel_goal_async())

    def cancel_goal_async(self) -> Future:
        """Request cancellation; the future yields a CancelGoal.Response."""
        return internals_of(self._action_client).request_cancel(self.goal_id)

    def get_result(self) -> Any:
        """Block until the goal ends and return its result; another thread must be spinning."""
        return internals_of(self._action_client).block_on(self.get_result_async())

    def get_result_async(self) -> Future:
        """Return a future of `status` and `result`; for a rejected goal both are empty."""
        if not self.accepted and (asked := caller(1)) is not None:
            text = "%s: the goal was rejected and has no result: check goal_handle.accepted before get_result_async()"
            logger.warning(text, asked.place)
        return internals_of(self._action_client).request_result(self)


class ActionClient(Waitable):
    """A client of an action."""

    @explained
    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008 - never changed
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        check_for_type_support(action_type)
        self._node, self._action_type, self._action_name = node, action_type, action_name
        # No endpoint exists before `open`, and another thread may be spinning the node meanwhile.
        self._graphflow = inner = ActionClientInternals(node, action_type, action_name)
        self._goal_handles, self._feedback_callbacks = inner.handles, inner.feedback_callbacks
        inner.open(
            self,
            goal_qos=goal_service_qos_profile,
            result_qos=result_service_qos_profile,
            cancel_qos=cancel_service_qos_profile,
            feedback_qos=feedback_sub_qos_profile,
            status_qos=status_sub_qos_profile,
        )
        node.add_waitable(self)

    # the executor's interface

    def is_ready(self, wait_set: object) -> bool:
        return self._graphflow.has_work()

    def take_data(self) -> list[Callable[[], object]]:
        inner = self._graphflow
        work: list[Callable[[], object]] = []
        status = inner.status.take()
        if status is not None:
            work.append(partial(self._graphflow_heard_status, status.payload))
        answers: list[Callable[[], object]] = []
        for client in inner.clients:
            answered = client.take()
            if answered is not None:
                answers.append(partial(inner.settle, client, answered))
        # Taken after the answers and executed before them: feedback comes by another thread of Zenoh's than a result.
        for _ in range(inner.feedback.waiting):  # all that came before a result
            feedback = inner.feedback.take()
            if feedback is not None:
                work.append(partial(self._graphflow_heard_feedback, feedback.payload))
        return [*work, *answers]

    async def execute(self, taken_data: list[Callable[[], Any]]) -> None:
        for work in taken_data:
            result = work()
            if result is not None:
                await result

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(num_subs=2, num_clients=3)

    def add_to_wait_set(self, wait_set: object) -> None:
        """Do nothing: there are no wait sets."""

    def _graphflow_heard_feedback(self, payload: bytes) -> None:
        message = classes.decode(self._action_type.Impl.FeedbackMessage, payload)
        callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
        if callback is not None:
            callback(message)

    def _graphflow_heard_status(self, payload: bytes) -> None:
        message = classes.decode(self._action_type.Impl.GoalStatusMessage, payload)
        for row in message.status_list:
            key = bytes(row.goal_info.goal_id.uuid)
            handle = self._goal_handles.get(key)
            if handle is not None:
                handle.note_status(row.status)
                if Status(row.status).is_terminal:
                    del self._goal_handles[key]

    # goals

    def send_goal(self, goal: object, **kwargs: Any) -> Any:
        """Send a goal and block until it ends; another thread must be spinning.

        Args:
            kwargs: As for `send_goal_async`.

        Returns:
            `status` and `result`; None if it was rejected.

        Raises:
            TypeError: Not a goal of the action's type.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError(
                f"Expected {self._action_type.Goal}, got {classes.what_came(goal)}: {self._graphflow_way()}"
            )
        handle = self._graphflow.block_on(self.send_goal_async(goal, **kwargs))
        return handle.get_result() if handle is not None and handle.accepted else None

    def _graphflow_way(self) -> str:
        """Return how a goal is made."""
        fields = [*self._action_type.Goal.get_fields_and_field_types()]
        given = f"{fields[0]}=..." if fields else ""
        return f"make one, as in {self._action_type.__name__}.Goal({given})"

    def send_goal_async(
        self, goal: object, feedback_callback: Callable[..., object] | None = None, goal_uuid: UUID | None = None
    ) -> Future:
        """Send a goal; the future yields a `ClientGoalHandle` when the server answers.

        Args:
            feedback_callback: Called with each feedback message.
            goal_uuid: The goal's id; None for a new one.

        Raises:
            TypeError: Not a goal of the action's type.
        """
        from unique_identifier_msgs import msg

        if not isinstance(goal, self._action_type.Goal):
            raise TypeError(
                f"Expected {self._action_type.Goal}, got {classes.what_came(goal)}: {self._graphflow_way()}"
            )
        carrier = self._action_type.Impl.SendGoalService
        goal_id = msg.UUID(uuid=list(uuid.uuid4().bytes)) if goal_uuid is None else goal_uuid
        key = bytes(goal_id.uuid)
        if feedback_callback is not None:
            self._feedback_callbacks[key] = feedback_callback

        def made(payload: bytes) -> ClientGoalHandle:
            response = classes.decode(carrier.Response, payload)
            handle = ClientGoalHandle(self, goal_id, response)
            if handle.accepted:
                self._goal_handles[key] = handle
            else:
                self._feedback_callbacks.pop(key, None)
            return handle

        warn_of_unended(self._graphflow.full_name, self._graphflow.unended)
        return self._graphflow.send(self._graphflow.goals, carrier.Request(goal_id=goal_id, goal=goal), made)

    # servers

    def server_is_ready(self) -> bool:
        """Whether a server with all its parts is available. Raises RCLError if the context was shut down."""
        if not self._node.context.ok():
            raise RCLError("Failed to check if action server is available: rcl node's context is invalid")
        return self._graphflow.has_server()

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Block until a server is available, at most `timeout_sec` seconds; return whether one is."""
        life, wake = self._node.context.life, Wake()
        assert life is not None  # a node has joined it
        self._graphflow.server_wakes[wake] = None
        life.on_end(wake)
        limit = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
        try:
            is_there = (
                wake.wait_until(lambda: not life.is_ok or self.server_is_ready(), limit) and self.server_is_ready()
            )
        finally:
            life.forget(wake)
            self._graphflow.server_wakes.pop(wake, None)
        if is_there:
            self._graphflow.successes.note(sys._getframe(1))
        return is_there

    def destroy(self) -> None:
        """Withdraw the client. Goals continue."""
        inner = self._graphflow
        if not inner.is_open:
            return
        inner.is_open = False
        if self in self._node.waitables:
            self._node.remove_waitable(self)
        if self._node.context.ok():
            inner.close()


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

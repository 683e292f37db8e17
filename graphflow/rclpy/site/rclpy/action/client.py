"""Action clients."""

from __future__ import annotations

import logging
import threading
import uuid
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from graphflow.errors import ServerLost
from graphflow.machines.goal import GoalStatus as Status
from graphflow.msgs import registry
from graphflow.rclpy import node_bridge
from graphflow.rclpy.messages import classes
from graphflow.rclpy.wake import Wake
from graphflow.runtime.endpoints.threaded import Answered, ThreadedClient, ThreadedSubscription
from rclpy._rclpy_pybind11 import RCLError
from rclpy.handle import sending
from rclpy.impl.callers import caller
from rclpy.impl.mistakes.arguments import explained
from rclpy.impl.nodes import internals_of
from rclpy.impl.reexports import passed_on
from rclpy.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default, to_graphflow
from rclpy.task import Future
from rclpy.type_support import check_for_type_support
from rclpy.waitable import NumberOfEntities, Waitable

if TYPE_CHECKING:
    from action_msgs.srv import CancelGoal
    from builtin_interfaces.msg import Time as TimeMessage
    from unique_identifier_msgs.msg import UUID

    from graphflow.runtime.node_core import NodeCore
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

    def cancel_goal(self) -> CancelGoal.Response:
        """Request cancellation and block until the answer; another thread must be spinning."""
        return self._action_client._graphflow_block_on(self.cancel_goal_async())

    def cancel_goal_async(self) -> Future:
        """Request cancellation; the future yields a CancelGoal.Response."""
        return self._action_client._graphflow_cancel(self)

    def get_result(self) -> Any:
        """Block until the goal ends and return its result; another thread must be spinning."""
        return self._action_client._graphflow_block_on(self.get_result_async())

    def get_result_async(self) -> Future:
        """Return a future of `status` and `result`; for a rejected goal both are empty."""
        if not self.accepted and (asked := caller(1)) is not None:
            text = "%s: the goal was rejected and has no result: check goal_handle.accepted before get_result_async()"
            logger.warning(text, asked.place)
        return self._action_client._graphflow_result_of(self)


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
        self._graphflow_lock = threading.RLock()
        self._graphflow_waiting: dict[tuple[ThreadedClient, int], tuple[Future, Callable[[bytes], object]]] = {}
        """Pending calls by client and number: the future, and the conversion of the response."""
        self._goal_handles: dict[bytes, ClientGoalHandle] = {}
        self._feedback_callbacks: dict[bytes, Callable[..., object]] = {}
        self._graphflow_changed: dict[Wake, None] = {}
        self._graphflow_is_open = False  # another thread may be spinning the node
        name = node.resolve_service_name(action_name)
        carriers = action_type.Impl
        mark = partial(internals_of(node).bell.mark, self)

        def client(carrier: type, part: str, qos: QoSProfile) -> ThreadedClient:
            type_ = registry.interface_class(classes.type_name(carrier))
            full = f"{name}/_action/{part}"
            return node_bridge.add(
                internals_of(node).node,
                lambda core: ThreadedClient(
                    core, type_, full, to_graphflow(qos), internals_of(node).bell, mark, self._graphflow_server_changed
                ),
            )

        def subscription(carrier: type, part: str, qos: QoSProfile) -> ThreadedSubscription:
            full, bell = f"{name}/_action/{part}", internals_of(node).bell

            def make(core: NodeCore) -> ThreadedSubscription:
                made = ThreadedSubscription(
                    core, carrier, full, to_graphflow(qos), bell, mark, lambda event: self._graphflow_server_changed()
                )
                made.in_order = part == "feedback"
                return made

            return node_bridge.add(internals_of(node).node, make)

        self._graphflow_goals = client(carriers.SendGoalService, "send_goal", goal_service_qos_profile)
        self._graphflow_cancels = client(carriers.CancelGoalService, "cancel_goal", cancel_service_qos_profile)
        self._graphflow_results = client(carriers.GetResultService, "get_result", result_service_qos_profile)
        self._graphflow_feedback = subscription(carriers.FeedbackMessage, "feedback", feedback_sub_qos_profile)
        self._graphflow_status = subscription(carriers.GoalStatusMessage, "status", status_sub_qos_profile)
        # From here on `is_ready` may read the five endpoints; one that is missing would be an AttributeError there.
        self._graphflow_is_open = True
        node.add_waitable(self)

    def _graphflow_server_changed(self) -> None:
        """React to a server that has appeared or left."""
        for wake in list(self._graphflow_changed):
            wake.set()

    # the executor's interface

    def is_ready(self, wait_set: object) -> bool:
        if not self._graphflow_is_open:
            return False
        clients = (self._graphflow_goals, self._graphflow_cancels, self._graphflow_results)
        return (
            any(c.inbox.items for c in clients)
            or self._graphflow_feedback.waiting > 0
            or self._graphflow_status.waiting > 0
        )

    def take_data(self) -> list[Callable[[], object]]:
        work: list[Callable[[], object]] = []
        status = self._graphflow_status.take()
        if status is not None:
            work.append(partial(self._graphflow_heard_status, status.payload))
        answers: list[Callable[[], object]] = []
        for client in (self._graphflow_goals, self._graphflow_cancels, self._graphflow_results):
            answered = client.take()
            if answered is not None:
                answers.append(partial(self._graphflow_settle, client, answered))
        # Taken after the answers and executed before them: feedback comes by another thread of Zenoh's than a result.
        for _ in range(self._graphflow_feedback.waiting):  # all that came before a result
            feedback = self._graphflow_feedback.take()
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

    def _graphflow_settle(self, client: ThreadedClient, answered: Answered) -> None:
        with self._graphflow_lock:
            found = self._graphflow_waiting.pop((client, answered.sequence), None)
        if found is None or found[0].cancelled():
            return
        future, made = found
        future.run_callbacks_here()
        if answered.error is None:
            future.set_result(made(answered.payload))
        elif not isinstance(answered.error, ServerLost):  # ROS 2 leaves such a future pending
            future.set_exception(answered.error)

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
                handle._status = row.status
                if Status(row.status).is_terminal:
                    del self._goal_handles[key]

    # goals

    def _graphflow_send(self, client: ThreadedClient, request: object, made: Callable[[bytes], object]) -> Future:
        future: Future = Future()
        with self._graphflow_lock:
            with sending():
                # Under the lock that `_graphflow_settle` takes: the answer may come before the future is stored.
                sequence = client.send(classes.encode(request))
            self._graphflow_waiting[client, sequence] = (future, made)
        return future

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
            raise TypeError(f"Expected {self._action_type.Goal}, got {type(goal)}")
        handle = self._graphflow_block_on(self.send_goal_async(goal, **kwargs))
        return handle.get_result() if handle is not None and handle.accepted else None

    def _graphflow_block_on(self, future: Future) -> Any:
        """Block until a future is done or the context is shut down."""
        life, wake = self._node.context.life, Wake()
        assert life is not None  # a node has joined it
        future.when_done(wake.set)
        life.on_end(wake)
        try:
            wake.wait()
        finally:
            life.forget(wake)
        return future.result()

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
            raise TypeError(f"Expected {self._action_type.Goal}, got {type(goal)}")
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

        return self._graphflow_send(self._graphflow_goals, carrier.Request(goal_id=goal_id, goal=goal), made)

    def _graphflow_cancel(self, goal_handle: ClientGoalHandle) -> Future:
        """Request the cancellation of a goal. Raises TypeError if it is not a goal handle."""
        from action_msgs import srv

        if not isinstance(goal_handle, ClientGoalHandle):
            raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
        request = srv.CancelGoal.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        return self._graphflow_send(
            self._graphflow_cancels, request, lambda payload: classes.decode(srv.CancelGoal.Response, payload)
        )

    def _graphflow_result_of(self, goal_handle: ClientGoalHandle) -> Future:
        """Request the result of a goal. Raises TypeError if it is not a goal handle."""
        if not isinstance(goal_handle, ClientGoalHandle):
            raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
        carrier, key = self._action_type.Impl.GetResultService, bytes(goal_handle.goal_id.uuid)

        def made(payload: bytes) -> object:
            # Not at a terminal status: feedback may still be on its way, and is executed before the result.
            self._feedback_callbacks.pop(key, None)
            self._goal_handles.pop(key, None)
            response = classes.decode(carrier.Response, payload)
            goal_handle._status = response.status
            return response

        return self._graphflow_send(self._graphflow_results, carrier.Request(goal_id=goal_handle.goal_id), made)

    # servers

    def server_is_ready(self) -> bool:
        """Whether a server with all its parts is available. Raises RCLError if the context was shut down."""
        if not self._node.context.ok():
            raise RCLError("Failed to check if action server is available: rcl node's context is invalid")
        clients = (self._graphflow_goals, self._graphflow_cancels, self._graphflow_results)
        return (
            all(c.has_server for c in clients)
            and bool(self._graphflow_feedback.matched)
            and bool(self._graphflow_status.matched)
        )

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Block until a server is available, at most `timeout_sec` seconds; return whether one is."""
        life, wake = self._node.context.life, Wake()
        assert life is not None  # a node has joined it
        self._graphflow_changed[wake] = None
        life.on_end(wake)
        limit = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
        try:
            return wake.wait_until(lambda: not life.is_ok or self.server_is_ready(), limit) and self.server_is_ready()
        finally:
            life.forget(wake)
            self._graphflow_changed.pop(wake, None)

    def destroy(self) -> None:
        """Withdraw the client. Goals continue."""
        if not self._graphflow_is_open:
            return
        self._graphflow_is_open = False
        if self in self._node.waitables:
            self._node.remove_waitable(self)
        if self._node.context.ok():
            for endpoint in (
                self._graphflow_goals,
                self._graphflow_cancels,
                self._graphflow_results,
                self._graphflow_feedback,
                self._graphflow_status,
            ):
                node_bridge.remove(endpoint)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

"""Action servers.

An action is three services and two topics. One waitable serves them, in the server's callback group; the bodies of
goals run as tasks of the executor, outside groups.
"""

from __future__ import annotations

import threading
import traceback
from collections.abc import Awaitable, Callable
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Any

from graphflow.machines.goal import CancelCode
from graphflow.machines.goal import GoalStatus as Status
from graphflow.rclpy.context_state import LOOP
from graphflow.rclpy.hints.tracebacks import shorten
from graphflow.rclpy.messages import classes
from graphflow.runtime.endpoints.threaded import Asked
from rclpy._rclpy_pybind11 import GoalEvent, RCLError
from rclpy.executors import await_or_execute
from rclpy.handle import sending
from rclpy.impl.action_internals import ActionServerInternals
from rclpy.impl.mistakes.arguments import described, explained, must_return
from rclpy.impl.mistakes.uncancelled import Uncancelled
from rclpy.impl.nodes import internals_of
from rclpy.impl.reexports import passed_on
from rclpy.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from rclpy.task import Future
from rclpy.time import Time
from rclpy.type_support import check_for_type_support
from rclpy.waitable import NumberOfEntities, Waitable

if TYPE_CHECKING:
    from action_msgs.msg import GoalInfo
    from unique_identifier_msgs.msg import UUID

    from rclpy.callback_groups import CallbackGroup
    from rclpy.node import Node

__all__ = ["ActionServer", "CancelResponse", "GoalEvent", "GoalResponse", "RCLError", "ServerGoalHandle"]


class GoalResponse(Enum):
    """The answer to a goal request."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """The answer to a cancellation request."""

    REJECT = 1
    ACCEPT = 2


_STEPS = {
    (Status.ACCEPTED, GoalEvent.EXECUTE): Status.EXECUTING,
    (Status.ACCEPTED, GoalEvent.CANCEL_GOAL): Status.CANCELING,
    (Status.EXECUTING, GoalEvent.CANCEL_GOAL): Status.CANCELING,
    (Status.EXECUTING, GoalEvent.SUCCEED): Status.SUCCEEDED,
    (Status.EXECUTING, GoalEvent.ABORT): Status.ABORTED,
    (Status.CANCELING, GoalEvent.SUCCEED): Status.SUCCEEDED,
    (Status.CANCELING, GoalEvent.ABORT): Status.ABORTED,
    (Status.CANCELING, GoalEvent.CANCELED): Status.CANCELED,
}
"""The status that follows each event of a goal. Source: the ROS 2 design article "Actions"."""


class ServerGoalHandle:
    """The server's handle of a goal, passed to its callbacks."""

    def __init__(self, action_server: ActionServer, goal_info: GoalInfo, goal_request: object) -> None:
        self._action_server, self._goal_request = action_server, goal_request
        self._goal_id, self.stamp = goal_info.goal_id, goal_info.stamp
        self.state = Status.ACCEPTED  # graphflow's own
        self._has_warned = False
        self._uncancelled = Uncancelled(action_server)
        self._lock = threading.Lock()
        self.result_future: Future = Future()
        self.result_requests: list[Asked] = []
        """The requests that wait for the result. graphflow's own, as is the future."""

    @property
    def action_server(self) -> ActionServer:
        """The goal's server. graphflow's own."""
        return self._action_server

    @property
    def request(self) -> Any:
        """The goal message."""
        return self._goal_request

    @property
    def goal_id(self) -> UUID:
        """The goal's id, a unique_identifier_msgs/msg/UUID."""
        return self._goal_id

    @property
    def is_active(self) -> bool:
        """Whether the goal has not ended."""
        return not self.state.is_terminal

    @property
    def is_cancel_requested(self) -> bool:
        """Whether cancellation was accepted: call `canceled` then, and return."""
        self._uncancelled.look()
        return self.state is Status.CANCELING

    @property
    def status(self) -> int:
        """The status, a value of action_msgs/msg/GoalStatus."""
        self._uncancelled.look()
        return int(self.state)

    def step(self, event: GoalEvent) -> None:
        """Move to the status that follows an event, and publish it. Raises RCLError if none does. graphflow's own."""
        with self._lock:
            following = _STEPS.get((self.state, event))
            if following is None:
                raise RCLError(
                    f"goal_handle attempted invalid transition from state {self.state.name} with event {event.name}"
                )
            self.state = following
        if following is Status.CANCELING:
            self._uncancelled.cancelled()
        internals_of(self.action_server).publish_status()
        if following.is_terminal:
            self.action_server.notify_goal_done()

    _update_state = step
    """rclpy's name."""

    def execute(self, execute_callback: Callable[[ServerGoalHandle], object] | None = None) -> None:
        """Start the execution, by `execute_callback` or else by the server's."""
        # Cancelled before it began: CANCELING cannot become EXECUTING; the callback ends such a goal.
        if self.state is not Status.CANCELING:
            self.step(GoalEvent.EXECUTE)
        self.action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: object) -> None:
        """Publish feedback to the client. Raises TypeError if it is not of the action's feedback type."""
        if self.state.is_terminal and not self._has_warned:
            self._has_warned = True
            word = {Status.SUCCEEDED: "succeed", Status.ABORTED: "abort"}.get(self.state, "canceled")
            text = f"feedback after {word}(): the client has its status already; call {word}() last, before the return"
            self.action_server.warn(text)
        self._uncancelled.sent_feedback()
        internals_of(self.action_server).publish_feedback(self.goal_id, feedback)

    def succeed(self) -> None:
        """Mark the goal as succeeded. Raises RCLError if it has ended already."""
        self._uncancelled.succeeds()
        self.step(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """Mark the goal as aborted. Raises RCLError if it has ended already."""
        self.step(GoalEvent.ABORT)

    def canceled(self) -> None:
        """Mark the goal as cancelled. Raises RCLError if no cancellation was requested, or it has ended already."""
        self.step(GoalEvent.CANCELED)

    def destroy(self) -> None:
        """Forget the goal."""
        internals_of(self.action_server).forget(self)


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute the goal."""
    goal_handle.execute()


def default_goal_callback(goal_request: object) -> GoalResponse:
    """Accept every goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: object) -> CancelResponse:
    """Reject every cancellation."""
    return CancelResponse.REJECT


class ActionServer(Waitable):
    """An action server.

    Args:
        execute_callback: Called with each goal's handle; it returns the result, after `succeed`, `abort` or `canceled`.
        goal_callback: Called with each goal message; returns whether to accept it.
        handle_accepted_callback: Called with each accepted goal's handle; executes it, now or later.
        cancel_callback: Called with the handle of a goal whose cancellation is requested; returns whether to accept.
        result_timeout: Seconds for which results are kept after the goal ends.

    Raises:
        TypeError: `execute_callback` cannot be called.
    """

    @explained
    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], object],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[..., object] = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], object] = default_handle_accepted_callback,
        cancel_callback: Callable[..., object] = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008 - never changed
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 900,  # as in Jazzy; later versions have 10
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        check_for_type_support(action_type)
        self._node, self._action_type, self._action_name = node, action_type, action_name
        self._graphflow_result_timeout = result_timeout
        # No endpoint exists before `open`, and another thread may be spinning the node meanwhile.
        self._graphflow = inner = ActionServerInternals(node, action_type, action_name)
        self._lock, self._goal_handles = inner.lock, inner.handles
        self._logger = node.get_logger().get_child("action_server")
        inner.open(
            self,
            goal_qos=goal_service_qos_profile,
            result_qos=result_service_qos_profile,
            cancel_qos=cancel_service_qos_profile,
            feedback_qos=feedback_pub_qos_profile,
            status_qos=status_pub_qos_profile,
        )
        node.add_waitable(self)

    @property
    def action_type(self) -> Any:
        return self._action_type

    # the executor's interface

    def is_ready(self, wait_set: object) -> bool:
        return self._graphflow.has_work()

    def take_data(self) -> list[tuple[Callable[[Asked], Awaitable[None]], Asked]]:
        inner = self._graphflow
        services = (
            (inner.goals, self._graphflow_goal),
            (inner.cancels, self._graphflow_cancel),
            (inner.results, self._graphflow_result),
        )
        taken = [(do, service.take()) for service, do in services]
        return [(do, asked) for do, asked in taken if asked is not None]

    async def execute(self, taken_data: list[tuple[Callable[[Asked], Awaitable[None]], Asked]]) -> None:
        for do, asked in taken_data:
            await do(asked)

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(num_timers=1, num_services=3)

    def add_to_wait_set(self, wait_set: object) -> None:
        """Do nothing: there are no wait sets."""

    # goals

    async def _graphflow_goal(self, asked: Asked) -> None:
        carrier = self._action_type.Impl.SendGoalService
        request = classes.decode(carrier.Request, asked.payload)
        key = bytes(request.goal_id.uuid)
        is_known = key in self._goal_handles
        answer: object = None
        if is_known:
            self._logger.error(f"Failed to accept new goal with ID {key.hex()}: it is under way")
        else:
            try:
                answer = await await_or_execute(self._goal_callback, request.goal)
            except Exception as error:  # a user's callback may raise anything: the goal is rejected first
                self._logger.error(f"Error raised in goal callback: {error}")
                shorten(error)
                traceback.print_exception(error)
                with sending():
                    self._graphflow.goals.answer(asked, classes.encode(carrier.Response(accepted=False)))
                raise
            if not isinstance(answer, GoalResponse):
                way = must_return(self._goal_callback, "GoalResponse.ACCEPT", answer)
                self._logger.warning(f"Goal request callback did not return a GoalResponse type. Rejecting goal: {way}")
        accepted = answer is GoalResponse.ACCEPT
        stamp = self._node.get_clock().now().to_msg()
        handle = None
        if accepted:
            from action_msgs import msg

            handle = ServerGoalHandle(self, msg.GoalInfo(goal_id=request.goal_id, stamp=stamp), request.goal)
            with self._lock:
                # Before the answer: the client may request the result or a cancellation as soon as it has that.
                self._goal_handles[key] = handle
            self._graphflow.publish_status()
        with sending():
            self._graphflow.goals.answer(asked, classes.encode(carrier.Response(accepted=accepted, stamp=stamp)))
        if handle is not None:
            await await_or_execute(self._handle_accepted_callback, handle)

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[[ServerGoalHandle], object] | None
    ) -> None:
        """Schedule a goal's execution on the node's executor."""
        callback = execute_callback or self._execute_callback
        executor = self._node.executor
        if executor is None:
            raise RuntimeError("a goal cannot be executed while the node is in no executor: spin it")
        # As a task, not as a callback: so the body of a goal is outside the callback group, as in rclpy.
        executor.create_task(self._execute_goal, callback, goal_handle)

    async def _execute_goal(
        self, execute_callback: Callable[[ServerGoalHandle], object], goal_handle: ServerGoalHandle
    ) -> None:
        self._logger.debug(f"Executing goal with ID {bytes(goal_handle.goal_id.uuid).hex()}")
        way = f": {described(execute_callback)} returned without goal_handle.succeed()"
        try:
            result = await await_or_execute(execute_callback, goal_handle)
        except Exception as error:  # a user's callback may raise anything: the goal is aborted, as in ROS 2
            way, result = "", self._action_type.Result()
            self._logger.error(f"Error raised in execute callback: {error}")
            shorten(error)
            traceback.print_exception(error)
        if not isinstance(result, self._action_type.Result):
            raise AssertionError(must_return(execute_callback, f"a {self._action_type.__name__}.Result()", result))
        if goal_handle.is_active:
            shown = bytes(goal_handle.goal_id.uuid).hex()
            self._logger.warning(f"Goal state not set, assuming aborted. Goal ID: {shown}{way}")
            goal_handle.abort()
        self._logger.debug(f"Goal with ID {bytes(goal_handle.goal_id.uuid).hex()} finished")
        carrier = self._action_type.Impl.GetResultService
        # The status is read last: `succeed`, `abort`, `canceled` or the line above has set it.
        response = carrier.Response(status=int(goal_handle.state), result=result)
        goal_handle.result_future.set_result(response)
        if self._graphflow_result_timeout >= 0:
            LOOP.soon(self._graphflow_expire_later, goal_handle)

    def _graphflow_expire_later(self, goal_handle: ServerGoalHandle) -> None:
        LOOP.start().call_later(self._graphflow_result_timeout, self._graphflow.forget, goal_handle)

    async def _graphflow_cancel(self, asked: Asked) -> None:
        from action_msgs import msg
        from action_msgs.srv import CancelGoal

        request = classes.decode(CancelGoal.Request, asked.payload)
        code, wanted = self._graphflow_to_cancel(request.goal_info)
        response = CancelGoal.Response(return_code=int(code))
        for goal in wanted:
            answer = await await_or_execute(self._cancel_callback, goal)
            if answer is CancelResponse.ACCEPT:
                try:
                    goal.step(GoalEvent.CANCEL_GOAL)
                except RCLError as error:  # it ended meanwhile
                    self._logger.debug(f"Failed to cancel goal in cancel callback: {error}")
                    continue
                response.goals_canceling.append(msg.GoalInfo(goal_id=goal.goal_id, stamp=goal.stamp))
        if wanted and not response.goals_canceling:
            response.return_code = int(CancelCode.REJECTED)
            if self._cancel_callback is default_cancel_callback:
                way = "give the ActionServer a cancel_callback that returns CancelResponse.ACCEPT"
                self._logger.warning(f"a request to cancel is refused, as by default: {way}")
        with sending():
            self._graphflow.cancels.answer(asked, classes.encode(response))

    def _graphflow_to_cancel(self, info: GoalInfo) -> tuple[CancelCode, list[ServerGoalHandle]]:
        """Return the goals that a request matches: one by id, those up to a time, or all. Source: CancelGoal.srv."""
        key, until_ns = bytes(info.goal_id.uuid), Time.from_msg(info.stamp).nanoseconds
        with self._lock:
            goals = dict(self._goal_handles)
        is_any = not any(key)
        if not is_any and not until_ns:
            goal = goals.get(key)
            if goal is None:
                return CancelCode.UNKNOWN_GOAL_ID, []
            return (CancelCode.NONE, [goal]) if goal.is_active else (CancelCode.GOAL_TERMINATED, [])
        found = [
            goal
            for name, goal in goals.items()
            if goal.is_active
            and ((is_any and not until_ns) or name == key or Time.from_msg(goal.stamp).nanoseconds <= until_ns)
        ]
        return CancelCode.NONE, found

    async def _graphflow_result(self, asked: Asked) -> None:
        carrier = self._action_type.Impl.GetResultService
        request = classes.decode(carrier.Request, asked.payload)
        goal = self._goal_handles.get(bytes(request.goal_id.uuid))
        if goal is None:
            self._logger.debug("Sending result response for unknown goal ID")
            with sending():
                self._graphflow.results.answer(asked, classes.encode(carrier.Response(status=int(Status.UNKNOWN))))
            return
        goal.result_requests.append(asked)
        # No reference to the goal.
        goal.result_future.when_done(partial(self._graphflow.answer_result, asked, goal.result_future))

    def notify_goal_done(self) -> None:
        """Start the time for which an ended goal's result is kept."""

    # callbacks

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], object] | None
    ) -> None:
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_goal_callback(self, goal_callback: Callable[..., object] | None) -> None:
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(self, cancel_callback: Callable[..., object] | None) -> None:
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[[ServerGoalHandle], object]) -> None:
        if not callable(execute_callback):
            raise TypeError(f"Failed to register goal execution callback: not callable: {execute_callback!r}")
        self._execute_callback = execute_callback

    def warn(self, text: str) -> None:
        """Log a warning. graphflow's own."""
        self._logger.warning(text)

    def destroy(self) -> None:
        """Withdraw the server. Running goals continue, but their results are lost."""
        inner = self._graphflow
        if not inner.is_open:
            return
        inner.is_open = False
        with self._lock:
            self._goal_handles.clear()
        if self in self._node.waitables:
            self._node.remove_waitable(self)
        if self._node.context.ok():
            inner.close()


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)

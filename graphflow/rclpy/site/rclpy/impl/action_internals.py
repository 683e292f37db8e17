"""The internals of action clients and servers: their endpoints, the calls without an answer, and the known goals.

An action is three services and two topics. A client or server holds its internals under one name that no program's
subclass uses; the deadlock detector and the watches read them with `rclpy.impl.nodes.internals_of`.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from graphflow.errors import ServerLost
from graphflow.msgs import registry
from graphflow.rclpy import node_bridge
from graphflow.rclpy.messages import classes
from graphflow.rclpy.wake import Wake
from graphflow.runtime.endpoints.threaded import (
    Answered,
    Asked,
    ThreadedClient,
    ThreadedPublisher,
    ThreadedService,
    ThreadedSubscription,
)
from rclpy.handle import sending
from rclpy.impl.mistakes.inverted_waits import Successes
from rclpy.impl.nodes import internals_of
from rclpy.qos import QoSProfile, to_graphflow
from rclpy.task import Future

if TYPE_CHECKING:
    from unique_identifier_msgs.msg import UUID

    from graphflow.runtime.node_core import NodeCore
    from rclpy.action.client import ClientGoalHandle
    from rclpy.action.server import ServerGoalHandle
    from rclpy.node import Node


class ActionInternals:
    """The common part: the node, the action's type, and its name as given and in full."""

    def __init__(self, node: Node, action_type: Any, action_name: str) -> None:
        self.node, self.action_type, self.action_name = node, action_type, action_name
        self.full_name = node.resolve_service_name(action_name)
        self.is_open = False


class ActionClientInternals(ActionInternals):
    """The endpoints of an action client, its pending calls, and the threads that wait for its server.

    Attributes:
        goals, cancels, results: The clients of the three services; there are none before `open`.
        feedback, status: The subscriptions of the two topics.
    """

    goals: ThreadedClient
    cancels: ThreadedClient
    results: ThreadedClient
    feedback: ThreadedSubscription
    status: ThreadedSubscription

    def __init__(self, node: Node, action_type: Any, action_name: str) -> None:
        super().__init__(node, action_type, action_name)
        self.waiting: dict[tuple[ThreadedClient, int], tuple[Future, Callable[[bytes], object]]] = {}
        """Pending calls by client and number: the future, and the conversion of the response."""
        self.server_wakes: dict[Wake, None] = {}
        self.successes = Successes()
        """The wake-ups of threads that wait for a server."""
        self.handles: dict[bytes, ClientGoalHandle] = {}
        """The accepted goals that have not ended, by id."""
        self.feedback_callbacks: dict[bytes, Callable[..., object]] = {}
        self._lock = threading.RLock()

    def open(
        self,
        entity: object,
        *,
        goal_qos: QoSProfile,
        result_qos: QoSProfile,
        cancel_qos: QoSProfile,
        feedback_qos: QoSProfile,
        status_qos: QoSProfile,
    ) -> None:
        """Create the endpoints; arrivals mark `entity` as ready. `is_open` is set when all are there."""
        inner, carriers = internals_of(self.node), self.action_type.Impl
        mark, prefix = partial(inner.bell.mark, entity), f"{self.full_name}/_action"

        def client(carrier: type, part: str, qos: QoSProfile) -> ThreadedClient:
            type_, full = registry.interface_class(classes.type_name(carrier)), f"{prefix}/{part}"
            profile, changed = to_graphflow(qos), self._server_changed
            return node_bridge.add(
                inner.node, lambda core: ThreadedClient(core, type_, full, profile, inner.bell, mark, changed)
            )

        def subscription(carrier: type, part: str, qos: QoSProfile) -> ThreadedSubscription:
            def make(core: NodeCore) -> ThreadedSubscription:
                full, profile = f"{prefix}/{part}", to_graphflow(qos)
                made = ThreadedSubscription(
                    core, carrier, full, profile, inner.bell, mark, lambda event: self._server_changed()
                )
                made.in_order = part == "feedback"
                return made

            return node_bridge.add(inner.node, make)

        self.goals = client(carriers.SendGoalService, "send_goal", goal_qos)
        self.cancels = client(carriers.CancelGoalService, "cancel_goal", cancel_qos)
        self.results = client(carriers.GetResultService, "get_result", result_qos)
        self.feedback = subscription(carriers.FeedbackMessage, "feedback", feedback_qos)
        self.status = subscription(carriers.GoalStatusMessage, "status", status_qos)
        # From here on `has_work` may read the five endpoints; one that is missing would be an AttributeError there.
        self.is_open = True

    def close(self) -> None:
        """Withdraw the endpoints."""
        for endpoint in (*self.clients, self.feedback, self.status):
            node_bridge.remove(endpoint)

    @property
    def clients(self) -> tuple[ThreadedClient, ThreadedClient, ThreadedClient]:
        return self.goals, self.cancels, self.results

    @property
    def unended(self) -> int:
        """The number of goals that are sent and have not ended."""
        with self._lock:
            return len(self.handles) + sum(client is self.goals for client, _ in self.waiting)

    def has_work(self) -> bool:
        """Whether anything has arrived."""
        return self.is_open and (
            any(c.inbox.items for c in self.clients) or self.feedback.waiting > 0 or self.status.waiting > 0
        )

    def has_server(self) -> bool:
        """Whether a server with all its parts is available."""
        return all(c.has_server for c in self.clients) and bool(self.feedback.matched) and bool(self.status.matched)

    def _server_changed(self) -> None:
        """React to a server that has appeared or left."""
        for wake in list(self.server_wakes):
            wake.set()

    def send(self, client: ThreadedClient, request: object, made: Callable[[bytes], object]) -> Future:
        """Send a request; the future yields what `made` makes of the response."""
        future: Future = Future()
        with self._lock:
            with sending():
                # Under the lock that `settle` takes: the answer may come before the future is stored.
                sequence = client.send(classes.encode(request))
            self.waiting[client, sequence] = (future, made)
        return future

    def request_cancel(self, goal_id: UUID) -> Future:
        """Request the cancellation of a goal."""
        from action_msgs import srv

        request = srv.CancelGoal.Request()
        request.goal_info.goal_id = goal_id
        return self.send(self.cancels, request, lambda payload: classes.decode(srv.CancelGoal.Response, payload))

    def request_result(self, goal_handle: ClientGoalHandle) -> Future:
        """Request the result of a goal."""
        carrier, key = self.action_type.Impl.GetResultService, bytes(goal_handle.goal_id.uuid)

        def made(payload: bytes) -> object:
            # Not at a terminal status: feedback may still be on its way, and is executed before the result.
            self.feedback_callbacks.pop(key, None)
            self.handles.pop(key, None)
            response = classes.decode(carrier.Response, payload)
            goal_handle.note_status(response.status)
            return response

        return self.send(self.results, carrier.Request(goal_id=goal_handle.goal_id), made)

    def settle(self, client: ThreadedClient, answered: Answered) -> None:
        """Complete the future of an answered call."""
        with self._lock:
            found = self.waiting.pop((client, answered.sequence), None)
        if found is None or found[0].cancelled():
            return
        future, made = found
        future.run_callbacks_here()
        if answered.error is None:
            future.set_result(made(answered.payload))
        elif not isinstance(answered.error, ServerLost):  # ROS 2 leaves such a future pending
            future.set_exception(answered.error)

    def block_on(self, future: Future) -> Any:
        """Block until a future is done or the context is shut down; return its result."""
        life, wake = self.node.context.life, Wake()
        assert life is not None  # a node has joined it
        future.when_done(wake.set)
        life.on_end(wake)
        try:
            wake.wait()
        finally:
            life.forget(wake)
        return future.result()


class ActionServerInternals(ActionInternals):
    """The endpoints of an action server, and its goals.

    Attributes:
        goals, cancels, results: The servers of the three services; there are none before `open`.
        feedback, status: The publishers of the two topics.
    """

    goals: ThreadedService
    cancels: ThreadedService
    results: ThreadedService
    feedback: ThreadedPublisher
    status: ThreadedPublisher

    def __init__(self, node: Node, action_type: Any, action_name: str) -> None:
        super().__init__(node, action_type, action_name)
        self.lock = threading.RLock()
        self.handles: dict[bytes, ServerGoalHandle] = {}
        """The known goals by id."""

    def open(
        self,
        entity: object,
        *,
        goal_qos: QoSProfile,
        result_qos: QoSProfile,
        cancel_qos: QoSProfile,
        feedback_qos: QoSProfile,
        status_qos: QoSProfile,
    ) -> None:
        """Create the endpoints; arrivals mark `entity` as ready. `is_open` is set when all are there."""
        inner, carriers = internals_of(self.node), self.action_type.Impl
        mark, prefix = partial(inner.bell.mark, entity), f"{self.full_name}/_action"

        def service(carrier: type, part: str, qos: QoSProfile) -> ThreadedService:
            type_, full = registry.interface_class(classes.type_name(carrier)), f"{prefix}/{part}"
            return node_bridge.add(
                inner.node, lambda core: ThreadedService(core, type_, full, to_graphflow(qos), inner.bell, mark)
            )

        def publisher(carrier: type, part: str, qos: QoSProfile) -> ThreadedPublisher:
            full = f"{prefix}/{part}"
            return node_bridge.add(inner.node, lambda core: ThreadedPublisher(core, carrier, full, to_graphflow(qos)))

        self.feedback = publisher(carriers.FeedbackMessage, "feedback", feedback_qos)
        self.status = publisher(carriers.GoalStatusMessage, "status", status_qos)
        self.cancels = service(carriers.CancelGoalService, "cancel_goal", cancel_qos)
        self.results = service(carriers.GetResultService, "get_result", result_qos)
        self.goals = service(carriers.SendGoalService, "send_goal", goal_qos)
        self.is_open = True

    def close(self) -> None:
        """Withdraw the endpoints."""
        for endpoint in (self.goals, self.results, self.cancels, self.feedback, self.status):
            node_bridge.remove(endpoint)

    @property
    def services(self) -> tuple[ThreadedService, ThreadedService, ThreadedService]:
        return self.goals, self.cancels, self.results

    def has_work(self) -> bool:
        """Whether a request has arrived."""
        return self.is_open and any(s.inbox.items for s in self.services)

    def forget(self, goal_handle: ServerGoalHandle) -> None:
        """Drop a goal and its result."""
        with self.lock:
            self.handles.pop(bytes(goal_handle.goal_id.uuid), None)

    def publish_status(self) -> None:
        """Publish the statuses of all known goals."""
        from action_msgs import msg

        with self.lock:
            goals = list(self.handles.values())
        rows = [
            msg.GoalStatus(goal_info=msg.GoalInfo(goal_id=goal.goal_id, stamp=goal.stamp), status=int(goal.state))
            for goal in goals
        ]
        if self.is_open:
            message = self.action_type.Impl.GoalStatusMessage(status_list=rows)
            with sending():
                self.status.put(classes.encode(message))

    def publish_feedback(self, goal_id: UUID, feedback: object) -> None:
        """Publish feedback on a goal. Raises TypeError if it is not of the action's feedback type."""
        if not isinstance(feedback, self.action_type.Feedback):
            way = f"write publish_feedback({self.action_type.__name__}.Feedback(...))"
            raise TypeError(f"Expected {self.action_type.Feedback}, got {classes.what_came(feedback)}: {way}")
        message = self.action_type.Impl.FeedbackMessage(goal_id=goal_id, feedback=feedback)
        if self.is_open:
            with sending():
                self.feedback.put(classes.encode(message))

    def answer_result(self, asked: Asked, result: Future) -> None:
        """Answer a request for a goal's result, which is there."""
        if self.is_open:
            with sending():
                self.results.answer(asked, classes.encode(result.result()))

"""Actions at work, on the server's side: goals that are accepted, run under a group, cancelled and remembered.

On the network an action is five ordinary entities: the services send_goal, cancel_goal and get_result and the topics
feedback and status. The services are the control lane: they never wait for a group of the user's, so that a goal can
be cancelled, and asked for, whatever its group is doing. Only the goal's body takes a slot.

Source: wire as of rcl_action; the life of a goal in `machines.goal`.
"""

from __future__ import annotations

import asyncio
from asyncio import CancelledError, Future
from collections import deque
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from inspect import isawaitable
from typing import TYPE_CHECKING, Any, Generic

from graphflow.errors import Abort, EncodeError
from graphflow.interface import GoalPolicy, OnClientLoss
from graphflow.machines import waits
from graphflow.machines.goal import CancelCode, GoalBook, GoalEvent, GoalStatus
from graphflow.msgs import registry
from graphflow.msgs.base import Action, Feedback, Goal, Handle, Result
from graphflow.qos import ACTION_STATUS, SERVICES, Qos
from graphflow.runtime.clock import Clock
from graphflow.runtime.groups import HandlerGroup
from graphflow.runtime.scheduler import Runner
from graphflow.runtime.services import ServiceServer
from graphflow.runtime.topics import TopicPublisher
from graphflow.times import NANOSECONDS, to_ns
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

QUEUE_DEPTH = 16
"""Goals that wait for their turn under the policy `queue`; more are rejected."""
ACCEPT_LIMIT = 1.0
"""Seconds that an accept hook may take; then the goal is rejected."""
CLIENT_GRACE = 5.0
"""Seconds that a client may be gone before `on_client_loss` says what becomes of its goal."""
RESULT_KEPT = 900.0
"""Seconds that a result can be asked for, from the goal's end on."""
STATUS_KEPT = 10.0
"""Seconds that the list of states tells how a goal has ended, as in ROS 2."""
RESULTS_KEPT = 1_000


class ServerGoal(Handle[Goal, Result, Feedback]):
    """A goal at its server: the `Handle` that the action's handler gets."""

    def __init__(
        self, server: GoalServer[Goal, Result, Feedback], goal_id: bytes, request: Goal, client: bytes
    ) -> None:
        self.request = request
        self.partial: Result = server.result_class()
        self.client = client
        """The GID of the client that sent it."""
        self.result: Result | None = None
        """With which it ended."""
        self.waiters: list[Future[None]] = []
        """Who waits for its end."""
        self.is_preempted = False
        self.entry = server.entry_class(goal_info=server.info(goal_id))
        """What the list of states says of it."""
        self._server, self._id = server, goal_id

    def __repr__(self) -> str:
        return f"<goal {self._id.hex()[:8]} of {self._server.name}: {self.status.name}>"

    @property
    def goal_id(self) -> bytes:
        return self._id

    @property
    def status(self) -> GoalStatus:
        record = self._server.book.goals.get(self._id)
        return GoalStatus.UNKNOWN if record is None else record.status

    @property
    def is_cancel_requested(self) -> bool:
        return self.is_preempted or self.status is GoalStatus.CANCELING or self.is_over

    @property
    def is_over(self) -> bool:
        """Whether it has ended, however long ago."""
        return self.status.is_terminal or self.status is GoalStatus.UNKNOWN

    def feedback(self, feedback: Feedback) -> None:
        self._server.send_feedback(self._id, feedback)


@dataclass
class _Decision:
    """Whether a goal is to be accepted, while it is not known."""

    client: bytes
    is_wanted: bool = True
    is_client_gone: bool = False
    is_made: asyncio.Event = field(default_factory=asyncio.Event)


class GoalServer(Generic[Goal, Result, Feedback]):
    """An action at work.

    Args:
        callback: The handler: takes the `Handle`, returns the result.
        accept: Called with the goal's message before it is accepted; False rejects it. May be `async def`.
        cancellable: Whether cancel requests are granted; or a function of the `Handle` that decides.
        cleanup_timeout: Seconds that a cancelled body gets; then its goal is aborted, and its slot stays taken.
    """

    def __init__(
        self,
        node: Node,
        type_: type[Action[Goal, Result, Feedback]],
        name: str,
        callback: Callable[[Any], Any],
        label: str,
        group: HandlerGroup | None = None,
        *,
        policy: GoalPolicy = "reject",
        accept: Callable[[Any], bool | Awaitable[bool]] | None = None,
        cancellable: bool | Callable[[Any], bool] = True,
        on_client_loss: OnClientLoss = "continue",
        cleanup_timeout: float = 10.0,
    ) -> None:
        self.node, self.type, self.name = node, type_, name
        self.policy = policy
        self.entry_class: type[Any] = registry.interface_class("action_msgs/msg/GoalStatus")
        self.result_class: type[Any] = registry.interface_class(f"{type_.NAME}_Result")
        self._encode_result = registry.codec(f"{type_.NAME}_Result").encode
        self.book = GoalBook(to_ns(RESULT_KEPT), to_ns(STATUS_KEPT), RESULTS_KEPT)
        self.goals: dict[bytes, ServerGoal[Goal, Result, Feedback]] = {}
        self.runner: Runner | None = None
        self.is_degraded = False
        """Whether a body has outstayed its cancellation."""
        self._callback, self._label, self._group = callback, label, group
        self._accept, self._cancellable = accept, cancellable
        self._on_client_loss, self._cleanup_timeout = on_client_loss, cleanup_timeout
        self._waiting: deque[Any] = deque()
        self._deciding: dict[bytes, _Decision] = {}
        """Goals whose accept hook runs."""
        self._arriving = 0
        """Goals that were accepted and are put into the queue when their answers have gone out."""
        self._clock: Clock
        """Also when the node has stopped, and a body has not."""
        self._feedback_message: type[Any] = registry.interface_class(f"{type_.NAME}_FeedbackMessage")
        self._feedback_class: type[Any] = registry.interface_class(f"{type_.NAME}_Feedback")
        send: Any = registry.interface_class(f"{type_.NAME}_SendGoal")
        get: Any = registry.interface_class(f"{type_.NAME}_GetResult")
        cancel: Any = registry.interface_class("action_msgs/srv/CancelGoal")
        self._send_response, self._get_response = send.Response, get.Response
        self._cancel_response = cancel.Response
        self._status: TopicPublisher[Any] = self._topic("status", "action_msgs/msg/GoalStatusArray", ACTION_STATUS)
        self._feedback: TopicPublisher[Any] = self._topic("feedback", f"{type_.NAME}_FeedbackMessage", Qos())
        self.endpoints = (
            self._status,
            self._feedback,
            _GoalService(self, get, "get_result", self._get_result),
            _GoalService(self, cancel, "cancel_goal", self._cancel_goal),
            # The last to be seen is the first to be used: whoever can send a goal can do everything else.
            _GoalService(self, send, "send_goal", self._send_goal),
        )

    def __repr__(self) -> str:
        return f"<GoalServer {self.name} [{self.type.NAME}]>"

    def _topic(self, part: str, type_name: str, qos: Qos) -> TopicPublisher[Any]:
        message: Any = registry.interface_class(type_name)
        return TopicPublisher(self.node, message, f"{self.name}/_action/{part}", qos)

    @property
    def title(self) -> str:
        return f"action {self.name}"

    def statistics(self) -> dict[str, Any]:
        """Goals begun, failed, active and waiting for their turn."""
        runs, errors = (0, 0) if self.runner is None else (self.runner.runs, self.runner.errors)
        return {"runs": runs, "errors": errors, "active": self.book.active(), "waiting": len(self._waiting)}

    def open(self) -> None:
        self._clock = self.node.clock
        queue = (self._waiting, self._run, self._finished, self._refused)
        runner = self.node.runner(self._label, self._group, *queue, kind="action")
        runner.one_at_a_time = self.policy != "parallel"
        self.runner = runner
        for endpoint in self.endpoints:
            endpoint.open()
        self._tell_status()

    def drop_waiting(self) -> None:
        """The node stops: goals that wait for their turn will not have it."""
        while self._waiting:
            goal = self._waiting.popleft()
            self._end(goal, GoalEvent.ABORT, goal.partial)

    def close(self) -> None:
        """Withdraw it; goals under way are cancelled."""
        self.drop_waiting()
        if self.runner is not None:
            self.runner.cancel()
        for endpoint in reversed(self.endpoints):
            endpoint.close()
        self.node.forget(self)

    # what clients ask

    async def _send_goal(self, request: Any, client: bytes) -> Any:
        goal_id = bytes(request.goal_id.uuid)
        known = self.book.goals.get(goal_id)
        # Asked twice, by a client that has not heard the answer.
        if known is None and goal_id in self._deciding:
            await self._deciding[goal_id].is_made.wait()
            known = self.book.goals.get(goal_id)
            return self._send_response(accepted=known is not None, stamp=_stamp(known.accepted_ns if known else 0))
        if known is not None:
            return self._send_response(accepted=True, stamp=_stamp(known.accepted_ns))
        if self._is_full():
            return self._send_response(accepted=False)
        decision = self._deciding[goal_id] = _Decision(client)
        try:
            is_accepted = await self._is_accepted(request.goal) and decision.is_wanted and not self._is_full()
            if not is_accepted:
                return self._send_response(accepted=False)
            return self._accepted(goal_id, request.goal, decision)
        finally:
            del self._deciding[goal_id]
            decision.is_made.set()

    def _accepted(self, goal_id: bytes, request: Any, decision: _Decision) -> Any:
        record = self.book.accept(goal_id, self._clock.time_ns())
        self._forget_old()
        goal = self.goals[goal_id] = ServerGoal(self, goal_id, request, decision.client)
        self._tell_status()
        # The answer goes out first.
        self._arriving += 1
        self.node.context.loop.call_soon(self._begin, goal)
        if decision.is_client_gone:
            self.client_gone(decision.client)
        return self._send_response(accepted=True, stamp=_stamp(record.accepted_ns))

    def _is_full(self) -> bool:
        if self.runner is None or self.runner.closed:
            return True
        if self.policy == "reject":
            return self.book.active() > 0
        return self.policy == "queue" and len(self._waiting) + self._arriving >= QUEUE_DEPTH

    async def _is_accepted(self, goal: Goal) -> bool:
        if self._accept is None:
            return True
        try:
            async with asyncio.timeout(ACCEPT_LIMIT):
                answer = self._accept(goal)
                return bool(await answer if isawaitable(answer) else answer)
        except TimeoutError:
            self.node.log.warning("%s: accept took more than %g s; the goal is rejected", self._label, ACCEPT_LIMIT)
        except Exception as error:
            self.node.report_error(f"{self._label}: accept", error)
        return False

    def _begin(self, goal: ServerGoal[Goal, Result, Feedback]) -> None:
        self._arriving -= 1
        if self.runner is None or goal.status is not GoalStatus.ACCEPTED:
            return
        if self.runner.closed:  # the node has stopped meanwhile
            self._end(goal, GoalEvent.ABORT, goal.partial)
            return
        if self.policy == "preempt":
            for other in list(self.goals.values()):
                if other is not goal and not other.status.is_terminal:
                    self._preempt(other)
        self._waiting.append(goal)
        self.runner.wake()

    def _cancel_goal(self, request: Any, client: bytes) -> Any:
        info = request.goal_info
        stamp = info.stamp.sec * NANOSECONDS + info.stamp.nanosec
        if (asked := bytes(info.goal_id.uuid)) in self._deciding:  # its client has given up: it will not be accepted
            self._deciding[asked].is_wanted = False
        code, meant = self.book.to_cancel(asked, stamp)
        granted = [goal_id for goal_id in meant if self._grants_cancel(self.goals[goal_id])]
        if meant and not granted:
            code = CancelCode.REJECTED
        for goal_id in granted:
            self.cancel(self.goals[goal_id])
        infos = [self.goals[goal_id].entry.goal_info for goal_id in granted]
        return self._cancel_response(return_code=int(code), goals_canceling=infos)

    def _grants_cancel(self, goal: ServerGoal[Goal, Result, Feedback]) -> bool:
        if not callable(self._cancellable):
            return self._cancellable
        try:
            return bool(self._cancellable(goal))
        except Exception as error:
            self.node.report_error(f"{self._label}: cancellable", error)
            return False

    async def _get_result(self, request: Any, client: bytes) -> Any:
        goal = self.goals.get(bytes(request.goal_id.uuid))
        if goal is None:
            return self._get_response(status=int(GoalStatus.UNKNOWN))
        if not goal.status.is_terminal:
            goal.waiters.append(ended := self.node.context.loop.create_future())
            served = self.node.context.waits.served
            served[ended] = waits.goal_id(goal.goal_id)
            try:
                await ended
            finally:
                del served[ended]
        return self._get_response(status=int(goal.status), result=goal.result)

    # what becomes of a goal

    def cancel(self, goal: ServerGoal[Goal, Result, Feedback]) -> None:
        """A cancel request was granted: the body gets CancelledError, once; a goal that waits ends without running."""
        if goal.status.is_cancelable:
            self._step(goal, GoalEvent.CANCEL_GOAL)
            if not goal.is_preempted:  # else its body is being cancelled as it is
                self._cancel_body(goal, "cancel requested")

    def _preempt(self, goal: ServerGoal[Goal, Result, Feedback]) -> None:
        if goal.is_preempted:
            return
        goal.is_preempted = True
        if goal.status is not GoalStatus.CANCELING:  # its body is being cancelled as it is
            self._cancel_body(goal, "a newer goal has come")

    def _cancel_body(self, goal: ServerGoal[Goal, Result, Feedback], why: str) -> None:
        assert self.runner is not None
        if goal in self._waiting:
            self._waiting.remove(goal)
            self._end_cancelled(goal)
            return
        for run in self.runner.active:
            if run.item is goal:
                run.cancel(why)
                limit = self._clock.monotonic_ns() + to_ns(self._cleanup_timeout)
                self._clock.call_at(limit, lambda: self._outstayed(goal))
                return
        if goal.status in (GoalStatus.ACCEPTED, GoalStatus.CANCELING) and not self._has_begun(goal):
            self._end_cancelled(goal)  # its answer is on its way, and it has not been put into the queue yet

    def _has_begun(self, goal: ServerGoal[Goal, Result, Feedback]) -> bool:
        return self.runner is not None and any(run.item is goal for run in self.runner.active)

    def _outstayed(self, goal: ServerGoal[Goal, Result, Feedback]) -> None:
        if not goal.is_over:
            self.is_degraded = True
            self.node.log.error(
                "%s still runs %g s after it was cancelled; its goal is aborted, and it keeps its slot",
                self._label,
                self._cleanup_timeout,
            )
            self._end(goal, GoalEvent.ABORT, goal.partial)

    def _run(self, goal: ServerGoal[Goal, Result, Feedback]) -> Any:
        self._step(goal, GoalEvent.EXECUTE)
        return self._callback(goal)

    def _refused(self, goal: ServerGoal[Goal, Result, Feedback]) -> None:
        """It was dropped from the queue by the rules of its group."""
        self._end(goal, GoalEvent.ABORT, goal.partial)

    def _finished(self, goal: ServerGoal[Goal, Result, Feedback], result: Any, error: BaseException | None) -> None:
        if goal.is_over:  # it outstayed its cancellation
            return
        if error is None:
            if result is None and not self.result_class.SCHEMA.fields:
                result = self.result_class()
            if result.__class__ is not self.result_class:
                error = TypeError(
                    f"the handler of {self.name} returned {result!r}, not {self.result_class.__qualname__}"
                )
            elif (error := self._why_unfit(result)) is None:
                self._end(goal, GoalEvent.SUCCEED, result)
                return
        if isinstance(error, CancelledError):
            self._end_cancelled(goal)
            return
        given = goal.partial
        if isinstance(error, Abort):
            if error.result.__class__ is self.result_class:
                given = error.result  # type: ignore[assignment]
            if str(error):
                self.node.log.warning("%s: aborted: %s", self._label, error)
        else:
            self.node.report_error(self._label, error)
        self._end(goal, GoalEvent.ABORT, given)

    def _end_cancelled(self, goal: ServerGoal[Goal, Result, Feedback]) -> None:
        """Canceled if a client asked for it, aborted if the server did: for a newer goal, or because it stops."""
        asked = goal.status is GoalStatus.CANCELING
        if goal.status is GoalStatus.ACCEPTED:
            self._step(goal, GoalEvent.EXECUTE)
        self._end(goal, GoalEvent.CANCELED if asked else GoalEvent.ABORT, goal.partial)

    def _why_unfit(self, result: Any) -> Exception | None:
        """Why a result cannot be sent."""
        try:
            self._encode_result(result)
        except (EncodeError, AttributeError) as error:
            return error
        return None

    def _end(self, goal: ServerGoal[Goal, Result, Feedback], event: GoalEvent, result: Any) -> None:
        if event is not GoalEvent.SUCCEED and (wrong := self._why_unfit(result)) is not None:
            self.node.report_error(f"{self._label}, its partial result", wrong)
            result = self.result_class()
        if goal.status is GoalStatus.ACCEPTED:
            self._step(goal, GoalEvent.EXECUTE)
        self._step(goal, event)
        goal.result = result
        for waiter in goal.waiters:
            if not waiter.done():
                waiter.set_result(None)
        goal.waiters.clear()

    def _step(self, goal: ServerGoal[Goal, Result, Feedback], event: GoalEvent) -> GoalStatus:
        status = self.book.step(goal.goal_id, event, self._clock.monotonic_ns())
        self._tell_status()
        return status

    def _forget_old(self) -> None:
        for goal_id in self.book.expire(self._clock.monotonic_ns()):
            del self.goals[goal_id]

    def client_gone(self, client: bytes) -> None:
        """A client's token is gone; it may come back."""
        for decision in self._deciding.values():
            decision.is_client_gone |= decision.client == client
        mine = [goal for goal in self.goals.values() if goal.client == client and not goal.status.is_terminal]
        if not mine or self._on_client_loss == "continue":
            return

        def still_gone() -> None:
            if self.endpoints[-1].is_open and not any(e.gid == client for e in self.endpoints[-1].matched.values()):
                for goal in mine:
                    if goal.status.is_cancelable:
                        self.node.log.warning("%s: its client has gone; %r is cancelled", self._label, goal)
                        self.cancel(goal)

        self._clock.call_at(self._clock.monotonic_ns() + to_ns(CLIENT_GRACE), still_gone)

    # what clients hear

    def send_feedback(self, goal_id: bytes, feedback: Any) -> None:
        """Tell the clients how a goal goes.

        Raises:
            TypeError: It is no feedback of this action.
        """
        if feedback.__class__ is not self._feedback_class:
            raise TypeError(f"{self.name} sends {self._feedback_class.__qualname__}, not {feedback!r}")
        self._feedback.publish(self._feedback_message(goal_id={"uuid": list(goal_id)}, feedback=feedback))

    def info(self, goal_id: bytes) -> dict[str, Any]:
        """The fields of action_msgs/msg/GoalInfo."""
        return {"goal_id": {"uuid": list(goal_id)}, "stamp": _stamp(self.book.goals[goal_id].accepted_ns)}

    def _tell_status(self) -> None:
        if self._status.is_open:
            message = self._status.type()
            for goal_id, record in self.book.shown(self._clock.monotonic_ns()):
                entry = self.goals[goal_id].entry
                entry.status = int(record.status)
                message.status_list.append(entry)
            self._status.publish(message)


class _GoalService(ServiceServer[Any, Any]):
    """One of an action's services; its callback is also told who asks."""

    is_inner = True

    def __init__(self, server: GoalServer[Any, Any, Any], type_: Any, part: str, callback: Any) -> None:
        name = f"{server.name}/_action/{part}"
        lane = HandlerGroup(None, part)
        super().__init__(server.node, type_, name, SERVICES, callback, f"{server._label} {part}", lane)
        self._server = server

    def _invoke(self, request: Any) -> Any:
        asked = attachment.unpack((request.attachment or b"")[: attachment.SIZE])
        return self._callback(self._decode(request.payload), asked.gid)  # type: ignore[call-arg]

    def _matched(self, other: Entity, alive: bool) -> None:
        super()._matched(other, alive)
        if not alive:
            self._server.client_gone(other.gid)


def _stamp(ns: int) -> dict[str, int]:
    return {"sec": ns // NANOSECONDS, "nanosec": ns % NANOSECONDS}

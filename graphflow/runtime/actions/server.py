"""Action servers: accept goals, run them in a group, cancel them and keep their results.

On the network an action is five ordinary entities: the services send_goal, cancel_goal and get_result and the topics
feedback and status. The services never wait for a user's group, so that a goal can be cancelled and its result be
requested while the group is full. Only the goal's handler takes a slot.

The state machine in `machines.goal` decides; `ActionServer` feeds it events and carries out its effects.

Source: rcl_action, for the wire.
"""

from __future__ import annotations

import asyncio
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable
from functools import partial
from inspect import isawaitable
from typing import TYPE_CHECKING, Any, Generic

from graphflow.analysis.swallowed import where_caught
from graphflow.errors import Abort, EncodeError
from graphflow.executor.clock import Clock
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec, title_of
from graphflow.machines.goal import CancelCode, Do, GoalBook, GoalEvent, GoalRules, GoalStatus, Phase
from graphflow.msgs import registry
from graphflow.msgs.base import Action, Feedback, Goal, Result, ServerGoalHandle, Service, made_as
from graphflow.qos import ACTION_STATUS, Qos
from graphflow.runtime.actions.goal_handles import ServedGoal
from graphflow.runtime.actions.goal_service import Answer, GoalService
from graphflow.runtime.callables import name_of as callable_name
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.serialized import RawPublisher
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.mistakes.rclpy_words import MadeByNodes
from graphflow.runtime.part import Host, Part
from graphflow.times import NANOSECONDS, to_ns
from graphflow.wire.goal_status import GoalStates

if TYPE_CHECKING:
    from graphflow.msgs.action_msgs.srv import CancelGoal_Request

RESULT_KEPT = 900.0
"""Seconds that a result is kept after the goal's end."""
STATUS_KEPT = 10.0
"""Seconds that an ended goal stays in the status array, as in ROS 2."""
RESULTS_KEPT = 1_000
_RETURNED_ALL_THE_SAME = (
    "%s: %r was cancelled, but its handler returned a result: the goal succeeds. To end it as cancelled, "
    "set goal.partial and let CancelledError propagate%s"
)
_WHY = {GoalEvent.NEWER: "a newer goal has come"}


class ActionServer(MadeByNodes, Part, Generic[Goal, Result, Feedback]):
    """An action server.

    Args:
        callback: The handler; takes a `ServerGoalHandle` and returns the result.
        accept: Called with the goal message; rejects the goal by returning False or the reason as text. May be an
            `async def`.
        cancellable: Whether cancel requests are granted; or a function of the `ServerGoalHandle` that decides.
    """

    MAKER = 'create_action_server(Type, "name", self.execute), or declare @action(Type, "name") on the method'

    def __init__(
        self,
        host: Host,
        type_: type[Action[Goal, Result, Feedback]],
        name: str,
        callback: Callable[[ServerGoalHandle[Goal, Result, Feedback]], object],
        label: str,
        group: HandlerGroup | None = None,
        *,
        rules: GoalRules | None = None,
        accept: Callable[[Goal], object] | None = None,
        cancellable: bool | Callable[[ServerGoalHandle[Goal, Result, Feedback]], bool] = True,
    ) -> None:
        self.host, self.type, self.name = host, type_, name
        self.rules = GoalRules() if rules is None else rules
        self.result_class: type[Result] = registry.interface_class(f"{type_.NAME}_Result")
        self._results = registry.codec(f"{type_.NAME}_Result")
        self.book = GoalBook(self.rules, to_ns(RESULT_KEPT), to_ns(STATUS_KEPT), RESULTS_KEPT)
        self.goals: dict[bytes, ServedGoal[Goal, Result, Feedback]] = {}
        """Accepted goals, by id."""
        self.runner: Runner | None = None
        self.is_degraded = False
        """Whether a handler has not ended in time after its cancellation."""
        self._callback, self._label, self._group = callback, label, group
        self._accept, self._cancellable = accept, cancellable
        self._waiting: deque[ServedGoal[Goal, Result, Feedback]] = deque()
        self._deciding: dict[bytes, ServedGoal[Goal, Result, Feedback]] = {}
        """Goals being accepted or rejected, by id."""
        self._clock: Clock
        """Kept for handlers that outlive the node's stop."""
        self._feedback_message: type[Any] = registry.interface_class(f"{type_.NAME}_FeedbackMessage")
        self._feedback_class: type[Feedback] = registry.interface_class(f"{type_.NAME}_Feedback")
        send: Any = registry.interface_class(f"{type_.NAME}_SendGoal")
        get: Any = registry.interface_class(f"{type_.NAME}_GetResult")
        cancel: Any = registry.interface_class("action_msgs/srv/CancelGoal")
        self._send_response, self._get_response = send.Response, get.Response
        self._cancel_response = cancel.Response
        self._states = GoalStates()
        self._status = RawPublisher(host, "action_msgs/msg/GoalStatusArray", f"{name}/_action/status", ACTION_STATUS)
        self._feedback: TopicPublisher[Any] = self._topic("feedback", f"{type_.NAME}_FeedbackMessage", Qos())
        # The service that clients use first is announced last: a client that can send a goal can also do the rest.
        self._send_service = self._service(send, "send_goal", self._send_goal)
        self._services = (
            self._service(get, "get_result", self._get_result),
            self._service(cancel, "cancel_goal", self._cancel_goal),
            self._send_service,
        )

    def __repr__(self) -> str:
        return f"<ActionServer {self.name} [{self.type.NAME}]>"

    def _topic(self, part: str, type_name: str, qos: Qos) -> TopicPublisher[Any]:
        message: Any = registry.interface_class(type_name)
        return TopicPublisher(self.host, message, f"{self.name}/_action/{part}", qos)

    def _service(self, type_: type[Service[Any, Any]], part: str, answer: Answer) -> GoalService:
        name, label = f"{self.name}/_action/{part}", f"{self._label} {part}"
        return GoalService(self.host, type_, name, answer, label, self.client_gone)

    @property
    def handler_title(self) -> str:
        return title_of("action", self._label)

    @property
    def title(self) -> str:
        return f"action {self.name}"

    @property
    def endpoints(self) -> tuple[Endpoint, ...]:
        return (self._status, self._feedback, *self._services)

    def statistics(self) -> dict[str, object]:
        """Return the numbers of goals started, failed, running and waiting for a slot."""
        runs, errors = (0, 0) if self.runner is None else (self.runner.runs, self.runner.errors)
        return {"runs": runs, "errors": errors, "active": self.book.active(), "waiting": len(self._waiting)}

    def open(self) -> None:
        self._clock = self.host.clock
        self.host.context.reasons.open()  # before a client can send a goal
        tell = (self._run, self._finished, self.host.full_name)
        is_serial = self.rules.policy != "parallel"
        spec = RunnerSpec(self._label, *tell, "action", self._refused, is_serial=is_serial)
        self.runner = self.host.runner(spec, self._waiting, self._group)
        for endpoint in self.endpoints:
            endpoint.open()
        self._publish_states()

    def begin_to_stop(self) -> Runner | None:
        """Stop starting goals; those that wait for a slot never run."""
        for goal in [*self._deciding.values(), *self.goals.values()]:
            self._step(goal, GoalEvent.STOPPING)
        return self.runner

    def pause(self, why: str) -> Runner | None:
        """Reject new goals and abort those that run."""
        super().pause(why)
        return self.begin_to_stop()

    def resume(self) -> Runner | None:
        super().resume()
        if self.runner is not None:
            self.runner.reopen()
        return self.runner

    def close(self) -> None:
        """Close the server; running goals are cancelled."""
        self.begin_to_stop()
        if self.runner is not None:
            self.runner.cancel()
        for endpoint in reversed(self.endpoints):
            endpoint.close()
        self.host.forget(self)

    # requests of clients

    async def _send_goal(self, request: Any, client: bytes) -> object:
        goal_id = bytes(request.goal_id.uuid)
        if goal_id in self._deciding:  # a repeated request, from a client that has not received the response
            await self._deciding[goal_id].decided.wait()
        elif goal_id not in self.book.goals:
            reason = self._why_full() or await self._decide(goal_id, request.goal, client)
            if reason:
                self.host.context.reasons.note(goal_id, reason)
                self.host.log.info("%s: goal %s is rejected: %s", self._label, goal_id.hex()[:8], reason)
        known = self.book.goals.get(goal_id)
        if known is None:
            return self._send_response(accepted=False)
        return self._send_response(accepted=True, stamp=_stamp(known.accepted_ns))

    def _why_full(self) -> str:
        """Return the reason why no goal can be accepted now; "" if one can."""
        if self.idle_because:
            return self.idle_because
        if self.runner is None or self.runner.closed:
            return "the server is stopping"
        if self.book.has_room():
            return ""
        if self.rules.policy == "queue":
            return f"{self.rules.queue_depth} goals are waiting already"
        return "another goal is running, and policy='reject' allows only one; other policies: queue, preempt, parallel"

    async def _decide(self, goal_id: bytes, request: Goal, client: bytes) -> str:
        """Decide whether to accept a goal; returns the reason for a rejection, "" if accepted."""
        goal = ServedGoal(self, goal_id, request, self.book.ask(goal_id, client))
        self._deciding[goal_id] = goal
        reason = "the server is stopping"
        try:
            reason = await self._reject_reason(request) or self._why_full()
        finally:
            del self._deciding[goal_id]
            self._step(goal, GoalEvent.REFUSED if reason else GoalEvent.ACCEPTED)
            goal.decided.set()
        if not goal.is_over:
            self._forget_old()
            # The response to send_goal goes out first.
            self.host.context.loop.call_soon(self._step, goal, GoalEvent.ANSWERED)
        return reason

    async def _reject_reason(self, goal: Goal) -> str:
        """Call `accept`; returns its reason for a rejection, "" for none."""
        if self._accept is None:
            return ""
        limit = self.rules.accept_limit
        name = callable_name(self._accept, "accept")
        try:
            async with asyncio.timeout(limit):
                answer = self._accept(goal)
                answer = await answer if isawaitable(answer) else answer
        except TimeoutError:
            return f"{name} took more than {limit:g} s to decide"
        except Abort as error:
            return str(error) or f"{name} refused it"
        except Exception as error:  # raised by the user's `accept`, which thereby rejects the goal
            self.host.report_error(f"{self._label}: {name}", error)
            return f"{name} failed: {type(error).__name__}: {error}"
        if isinstance(answer, str):
            return answer
        if answer is None:
            return f"{name} returned None: it must return True, False, or the reason for the rejection"
        return "" if answer else f"{name} returned {answer!r}"

    def _cancel_goal(self, request: CancelGoal_Request, client: bytes) -> object:
        info = request.goal_info
        stamp = info.stamp.sec * NANOSECONDS + info.stamp.nanosec
        asked = bytes(info.goal_id.uuid)
        if asked in self._deciding:
            self._step(self._deciding[asked], GoalEvent.CANCEL)
        code, meant = self.book.to_cancel(asked, stamp)
        granted = [self.goals[goal_id] for goal_id in meant if self._grants_cancel(self.goals[goal_id])]
        if meant and not granted:
            code = CancelCode.REJECTED
        for goal in granted:
            self._step(goal, GoalEvent.CANCEL)
        return self._cancel_response(return_code=int(code), goals_canceling=[_info(goal) for goal in granted])

    def _grants_cancel(self, goal: ServedGoal[Goal, Result, Feedback]) -> bool:
        if not callable(self._cancellable):
            return self._cancellable
        try:
            return bool(self._cancellable(goal))
        except Exception as error:  # raised by the user's `cancellable`, which thereby refuses
            self.host.report_error(f"{self._label}: cancellable", error)
            return False

    async def _get_result(self, request: Any, client: bytes) -> object:
        goal = self.goals.get(bytes(request.goal_id.uuid))
        if goal is None:
            return self._get_response(status=int(GoalStatus.UNKNOWN))
        if not goal.is_over:
            goal.waiters.append(ended := self.host.context.loop.create_future())
            with self.host.context.ledger.serving(ended, goal.goal_id):
                await ended
        return self._get_response(status=int(goal.status), result=goal.result)

    def client_gone(self, client: bytes) -> None:
        """Note that a client's token is gone; the client may come back."""
        for goal in [*self._deciding.values(), *self.goals.values()]:
            if goal.record.client == client:
                self._step(goal, GoalEvent.CLIENT_LOST)

    # life of a goal

    def _step(self, goal: ServedGoal[Goal, Result, Feedback], event: GoalEvent, result: Result | None = None) -> None:
        """Apply an event to a goal's state machine and carry out the effects.

        Args:
            result: The final result if the goal ends, else the partial one.
        """
        if goal.is_over:
            return
        now_ns = self._clock.time_ns() if event is GoalEvent.ACCEPTED else self._clock.monotonic_ns()
        outcome = self.book.step(goal.goal_id, event, now_ns)
        if event is GoalEvent.ACCEPTED:
            self._states.add(goal.goal_id, goal.record.accepted_ns)
            self.goals[goal.goal_id] = goal
        if goal.is_over and goal.goal_id in self.goals:
            goal.result = self._fit_result(goal, event, goal.partial if result is None else result)
        for status in outcome.statuses:
            self._states.put(goal.goal_id, int(status))
            self._publish_states()
        for do in outcome.do:
            self._carry_out(do, goal, event)
        if goal.is_over:
            for waiter in goal.waiters:
                if not waiter.done():
                    waiter.set_result(None)
            goal.waiters.clear()

    def _carry_out(self, do: Do, goal: ServedGoal[Goal, Result, Feedback], event: GoalEvent) -> None:
        assert self.runner is not None
        match do:
            case Do.PREEMPT_OTHERS:
                for other in [other for other in self.goals.values() if other is not goal and not other.is_over]:
                    self._step(other, GoalEvent.NEWER)
            case Do.ENQUEUE:
                self._waiting.append(goal)
                self.runner.wake()
            case Do.DEQUEUE:
                self._waiting.remove(goal)
            case Do.CANCEL_BODY:
                for run in [run for run in self.runner.active if run.item is goal]:
                    run.cancel(_WHY.get(event, "cancel requested"))
            case Do.LIMIT_CLEANUP:
                self._later(self.rules.cleanup_timeout, partial(self._step, goal, GoalEvent.OUTSTAYED))
            case Do.AWAIT_CLIENT:
                self._later(self.rules.client_grace, partial(self._check_client, goal))
            case Do.DEGRADE:
                self.is_degraded = True
                self.host.log.error(
                    "%s is still running %g s after it was cancelled; its goal is aborted, and it keeps its slot%s",
                    *(self._label, self.rules.cleanup_timeout, where_caught(self._callback)),
                )

    def _later(self, seconds: float, callback: Callable[[], None]) -> None:
        self._clock.call_at(self._clock.monotonic_ns() + to_ns(seconds), callback)

    def _check_client(self, goal: ServedGoal[Goal, Result, Feedback]) -> None:
        """Treat a goal's client as lost unless it has come back by now."""
        clients = self._send_service.matched.values()
        if self._send_service.is_open and not any(e.gid == goal.record.client for e in clients):
            if goal.status.is_cancelable:
                self.host.log.warning("%s: its client has gone; %r is cancelled", self._label, goal)
            self._step(goal, GoalEvent.CLIENT_AWAY)

    def _run(self, goal: ServedGoal[Goal, Result, Feedback]) -> object:
        self._step(goal, GoalEvent.BEGUN)
        return self._callback(goal)

    def _refused(self, goal: ServedGoal[Goal, Result, Feedback]) -> None:
        self._step(goal, GoalEvent.DROPPED)

    def _finished(self, goal: ServedGoal[Goal, Result, Feedback], result: Any, error: BaseException | None) -> None:
        if goal.is_over:  # its handler outlived the time for cleanup
            return
        if error is None:
            if result is None and not self.result_class.SCHEMA.fields:
                result = self.result_class()
            error = self._why_no_result(result)
        if error is None:
            if goal.record.phase is Phase.CANCELING:
                self.host.log.warning(_RETURNED_ALL_THE_SAME, self._label, goal, where_caught(self._callback))
            self._step(goal, GoalEvent.RETURNED, result)
        elif isinstance(error, CancelledError):
            self._step(goal, GoalEvent.UNWOUND)
        else:
            explain(error)
            given = error.result if isinstance(error, Abort) else None
            goal.reason = str(error) if isinstance(error, Abort) else f"{type(error).__name__}: {error}"
            if goal.reason:
                self.host.context.reasons.note(goal.goal_id, goal.reason)
            if not isinstance(error, Abort):
                self.host.report_error(self._label, error)
            elif goal.reason:
                self.host.log.warning("%s: aborted: %s", self._label, goal.reason)
            self._step(goal, GoalEvent.FAILED, given if given.__class__ is self.result_class else None)

    def _why_no_result(self, returned: object) -> Exception | None:
        """Return the error that keeps a handler's return value from being sent as the result; None if it can be."""
        if returned.__class__ is not self.result_class:
            from graphflow.runtime.mistakes.wrong_returns import wrong_return  # most programs never need it

            return wrong_return(returned, self.result_class, self._callback)
        return self._why_unfit(returned)

    def _why_unfit(self, result: object) -> Exception | None:
        try:
            self._results.encode(result)
        except (EncodeError, AttributeError) as error:
            return error
        return None

    def _fit_result(self, goal: ServedGoal[Goal, Result, Feedback], event: GoalEvent, result: Result) -> Result:
        """Return a goal's final result: an empty one if the partial result cannot be encoded."""
        if event is GoalEvent.RETURNED or (wrong := self._why_unfit(result)) is None:
            return result
        self.host.report_error(f"{self._label}, its partial result", wrong)
        return self.result_class()

    def _forget_old(self) -> None:
        for goal_id in self.book.expire(self._clock.monotonic_ns()):
            del self.goals[goal_id]

    # messages to clients

    def send_feedback(self, goal_id: bytes, feedback: Feedback) -> None:
        """Publish feedback of a goal.

        Raises:
            TypeError: The message is not a Feedback of this action.
        """
        if feedback.__class__ is not self._feedback_class:
            raise TypeError(f"{self.name} sends feedback as {made_as(self._feedback_class)}, not {feedback!r}")
        self._feedback.publish(self._feedback_message(goal_id={"uuid": list(goal_id)}, feedback=feedback))

    def _publish_states(self) -> None:
        """Publish the status array."""
        for goal_id in self.book.hide(self._clock.monotonic_ns()):
            self._states.remove(goal_id)
        if self._status.is_open:
            self._status.publish(self._states.to_bytes())


def _info(goal: ServedGoal[Goal, Result, Feedback]) -> dict[str, object]:
    """Return the fields of an `action_msgs/msg/GoalInfo`."""
    return {"goal_id": {"uuid": list(goal.goal_id)}, "stamp": _stamp(goal.record.accepted_ns)}


def _stamp(ns: int) -> dict[str, int]:
    return {"sec": ns // NANOSECONDS, "nanosec": ns % NANOSECONDS}

"""Action clients: send goals, follow them, and cancel them when their block exits."""

from __future__ import annotations

import asyncio
from asyncio import CancelledError
from collections.abc import Coroutine
from contextlib import suppress
from typing import Any, Generic, TypeAlias

from graphflow.errors import (
    CallError,
    CallTimeout,
    ClosedError,
    DecodeError,
    EncodeError,
    GoalAborted,
    GoalCanceled,
    GoalError,
    GoalLost,
    GoalRejected,
    ServerBusy,
    ServerLost,
    ServiceUnavailable,
)
from graphflow.interface import CALL_TIMEOUT
from graphflow.machines.goal import CancelCode, GoalStatus
from graphflow.msgs import registry
from graphflow.msgs.base import Action, Feedback, Goal, Result
from graphflow.qos import ACTION_STATUS, SERVICES, Qos
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.runtime.actions.sending import Sending
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.serialized import RawSubscription
from graphflow.runtime.endpoints.service_client import DISCOVERY_GRACE, ServiceClient
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.mistakes.network.other_domains import alone_here
from graphflow.runtime.mistakes.network.unserved import Unserved, nobody_acts
from graphflow.runtime.mistakes.rclpy_words import MadeByNodes
from graphflow.runtime.part import Host, Part
from graphflow.times import to_ns
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.goal_status import states_in
from graphflow.wire.liveliness import Kind

AnyClient: TypeAlias = ServiceClient[Any, Any]
"""A client of a service whose classes are derived from an action's."""
CANCEL_TIMEOUT = 2.0
"""Seconds to wait for a goal's end when its block exits."""
_STATES = frozenset(state for state in GoalStatus if state >= 0)
"""The goal states that ROS 2 defines."""
LOST_GRACE = 1.0
"""Seconds for a lost server to reappear, and for feedback to arrive after the result."""
RESULT_PATIENCE, RESULT_LONGEST = 10.0, 600.0
"""Seconds until a result is requested again: the first time, and at most."""


class GoalClient(MadeByNodes, Part, Generic[Goal, Result, Feedback]):
    """An action client."""

    MAKER = 'create_action_client(Type, "name")'

    def __init__(self, host: Host, type_: type[Action[Goal, Result, Feedback]], name: str) -> None:
        self.host, self.type, self.name = host, type_, name
        self._goal_class: type[Goal] = registry.interface_class(f"{type_.NAME}_Goal")
        self._goals: dict[bytes, ClientGoalHandle[Goal, Result, Feedback]] = {}
        self._running = set[bytes]()
        """Ids of goals that have not ended, and of some that ended since the last status message."""
        self._followers: set[asyncio.Task[None]] = set()
        self._unserved = Unserved(host, self._nobody)
        self._send = self._service("send_goal", f"{type_.NAME}_SendGoal")
        self._cancel = self._service("cancel_goal", "action_msgs/srv/CancelGoal")
        self._get = self._service("get_result", f"{type_.NAME}_GetResult")
        feedback: Any = registry.interface_class(f"{type_.NAME}_FeedbackMessage")
        at = f"{name}/_action"
        self._feedback = TopicSubscription[Any](host, feedback, f"{at}/feedback", Qos(), self._feedback_received)
        # The result of a goal must not overtake its feedback.
        self._feedback.in_order = True
        status = "action_msgs/msg/GoalStatusArray"
        self._status = RawSubscription(host, status, f"{at}/status", ACTION_STATUS, self._status_received)

    def __repr__(self) -> str:
        return f"<GoalClient {self.name} [{self.type.NAME}]>"

    def _service(self, part: str, type_name: str) -> AnyClient:
        type_: Any = registry.interface_class(type_name)
        return ServiceClient(self.host, type_, f"{self.name}/_action/{part}", SERVICES)

    @property
    def endpoints(self) -> tuple[Endpoint, ...]:
        # In the order of opening: the topics first, so that nothing of a goal is missed; `send`, which begins one,
        # last.
        return (self._feedback, self._status, self._get, self._cancel, self._send)

    def open(self) -> None:
        for endpoint in self.endpoints:
            endpoint.open()

    def close(self) -> None:
        """Close the client. Its goals keep running at the server, but their end is not reported here."""
        for task in self._followers:
            task.cancel()
        for goal in list(self._goals.values()):
            goal.end(GoalStatus.LOST, None, GoalLost(f"the client of {self.name} was closed before the goal ended"))
        for endpoint in reversed(self.endpoints):
            endpoint.close()
        self.host.forget(self)

    def server_is_ready(self) -> bool:
        """Whether an action server of this name and type is in the graph, with all its five entities."""
        services = (self._send, self._cancel, self._get)
        return all(s.service_is_ready() for s in services) and bool(self._feedback.matched and self._status.matched)

    async def wait_ready(self, timeout: float | None = None) -> bool:
        """Wait for a server; returns whether one is ready.

        Args:
            timeout: Seconds; None for no limit.
        """
        return await self._wait_ready(timeout)

    async def _wait_ready(self, timeout: float | None, *, raises: bool = False) -> bool:
        if self.server_is_ready():
            return True
        try:
            async with self.host.clock.timeout(timeout if timeout is not None else 1e9):
                with self._unserved.waiting(raises=raises):
                    await self._all_ready()
        except TimeoutError:
            return False
        return True

    async def _all_ready(self) -> None:
        for service in (self._send, self._cancel, self._get):
            await service.wait_ready()
        for topic in (self._feedback, self._status):
            await topic.wait_matched()

    async def expect_ready(self, timeout: float | None) -> None:
        """Wait for a server as `wait_ready`, but raise ServiceUnavailable if none is ready in time."""
        if not await self._wait_ready(timeout, raises=True):
            alone = await alone_here(self.host.context, self.host.full_name)
            raise ServiceUnavailable(f"{await self._nobody()}{alone}")

    async def _nobody(self) -> str:
        cache = self.host.context.cache
        if any(server.type == self._send.type_name for server in cache.endpoints(Kind.SERVICE, self._send.name)):
            return await self._send.nobody()
        return nobody_acts(cache, self.name, self.type.NAME)

    def send(
        self, goal: Goal, *, timeout: float | None = CALL_TIMEOUT, detach: bool = False
    ) -> Sending[ClientGoalHandle[Goal, Result, Feedback]]:
        """Send a goal for the length of a block; the goal is cancelled if the block exits before it has ended.

            async with self.fibonacci.send(Fibonacci.Goal(order=10)) as goal:
                async for feedback in goal.feedback():
                    ...
                result = await goal.result()

        Args:
            timeout: Seconds for the server to accept the goal.
            detach: Whether the goal keeps running after the block.

        Raises:
            GoalRejected: The server rejected the goal.
            CallError: The server did not answer in time, or there is none.
            EncodeError: A field does not fit its type.
        """
        return Sending(self, goal, timeout, detach=detach)

    async def send_goal(
        self, goal: Goal, *, timeout: float | None = CALL_TIMEOUT
    ) -> ClientGoalHandle[Goal, Result, Feedback]:
        """Send a goal that keeps running after the caller has ended. Arguments and errors as for `send`."""
        if goal.__class__ is not self._goal_class:
            wanted = self._goal_class.__qualname__
            raise EncodeError(f"{self.name} takes {wanted}, not {goal!r}; write {wanted.replace('_', '.')}(...)")
        self.host.context.refuse_other_threads(
            f"send of {self.name}", "node.spawn(fn, ...) runs a coroutine function there"
        )
        sent = ClientGoalHandle(self, goal)
        self._running.add(sent.goal_id)
        self._goals[sent.goal_id] = sent  # registered first: its status may arrive before the response
        request = self._send.request_class(goal_id={"uuid": list(sent.goal_id)}, goal=goal)
        may_be_there = False
        try:
            if not self.server_is_ready():
                await self.expect_ready(DISCOVERY_GRACE if timeout is None else min(timeout, DISCOVERY_GRACE))
            may_be_there = True
            answer = await self._send.call(request, timeout=timeout)
        except (CancelledError, CallTimeout) as error:
            # The server may have accepted the goal all the same, and nobody else knows the id by which to cancel it.
            self._forget(sent)
            if may_be_there and self._cancel.is_open:
                withdrawing = self._in_background(self._withdraw(sent))
                if isinstance(error, CancelledError):  # the caller's node may be about to stop
                    await _seen_through(withdrawing)
            raise
        except BaseException:  # any failure, cancellation included: no goal is left to follow
            self._forget(sent)
            raise
        if not answer.accepted:
            self._forget(sent)
            reason = await self._why(sent)
            raise GoalRejected(f"{self.name} rejected the goal{reason and f': {reason}'}")
        if sent.status is GoalStatus.UNKNOWN:
            sent.status = GoalStatus.ACCEPTED
        self._in_background(self._follow(sent))
        return sent

    async def cancel(
        self, goal: ClientGoalHandle[Goal, Result, Feedback], *, timeout: float | None = CALL_TIMEOUT
    ) -> bool:
        """Request cancellation, as `ClientGoalHandle.cancel` does."""
        answer = await self._cancel.call(self._cancel_request(goal), timeout=timeout)
        granted = [bytes(info.goal_id.uuid) for info in answer.goals_canceling]
        # rclpy's servers refuse with ERROR_NONE and an empty list.
        return answer.return_code == CancelCode.NONE and goal.goal_id in granted

    def _cancel_request(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> Any:
        return self._cancel.request_class(goal_info={"goal_id": {"uuid": list(goal.goal_id)}})

    async def leave(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> None:
        """Cancel a goal whose block exits, and briefly wait for its end, even if the caller is cancelled."""
        await _seen_through(self._in_background(self._cancel_and_wait(goal)))

    async def _cancel_and_wait(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> None:
        try:
            async with self.host.clock.timeout(CANCEL_TIMEOUT):
                answer = await self._cancel.call(self._cancel_request(goal), timeout=None)
                if answer.return_code == CancelCode.REJECTED:
                    self.host.log.warning("%s: the server refuses to cancel %r, which goes on", self.name, goal)
                    return
                with suppress(GoalError):  # only the goal's end matters here
                    await asyncio.shield(goal.ended)
        except TimeoutError:
            self.host.log.warning("%s: %r has not ended %g s after it was cancelled", self.name, goal, CANCEL_TIMEOUT)
        except (CallError, ClosedError) as error:
            if not goal.status.is_terminal:  # the end is known already, and only the server has gone
                self.host.log.warning("%s: %r could not be cancelled: %s", self.name, goal, error)

    async def _withdraw(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> None:
        with suppress(CallError, ClosedError):  # the outcome of the cancel request does not matter here
            await self._cancel.call(self._cancel_request(goal), timeout=CANCEL_TIMEOUT)

    async def _follow(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> None:
        """Wait for a goal to end."""
        context = self.host.context
        try:
            with context.ledger.goal(goal.ended, goal):
                answer = await self._result_of(goal)
            await self._take(goal, answer)
        except (CallError, ClosedError, ValueError) as error:
            known = f"last known as {goal.status.name}"
            if isinstance(error, (ServerLost, ServiceUnavailable, ClosedError)):
                lost = f"{self.name}: the server has gone, and with it the goal, {known}"
            else:
                lost = f"{self.name}: the goal's result is not available, {known}: {error}"
            goal.end(GoalStatus.LOST, None, GoalLost(lost))
        finally:
            clock = context.clock
            clock.call_at(clock.monotonic_ns() + to_ns(LOST_GRACE), lambda: self._forget(goal))

    async def _take(self, goal: ClientGoalHandle[Goal, Result, Feedback], answer: Any) -> None:
        """Record the end of a goal from its result response."""
        status = GoalStatus(answer.status)
        self._end(goal, status, answer.result, await self._why(goal) if status is GoalStatus.ABORTED else "")

    async def _why(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> str:
        """Return the server's reason for rejecting or aborting a goal; "" if it gives none."""
        for server in list(self._send.matched.values()):
            if reason := await self.host.context.reasons.ask(server.zid, goal.goal_id):
                return reason
        return "" if self._send.matched else "its server has gone"

    async def _result_of(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> Any:
        """Return the response that reports a goal's end, however long it takes."""
        request = self._get.request_class(goal_id={"uuid": list(goal.goal_id)})
        patience = RESULT_PATIENCE
        while True:
            try:
                return await self._get.call(request, timeout=patience)
            except ServerBusy:
                await self.host.context.clock.sleep(RESULT_PATIENCE)
            except CallTimeout:  # the goal takes long, or the network has lost the request or the response
                patience = min(2 * patience, RESULT_LONGEST)
            except ServerLost:
                # If only the connection was lost, the server still knows the goal.
                await self._get.expect_ready(LOST_GRACE)

    def _forget(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> None:
        self._goals.pop(goal.goal_id, None)
        self._running.discard(goal.goal_id)

    def _end(
        self, goal: ClientGoalHandle[Goal, Result, Feedback], status: GoalStatus, result: Result, reason: str
    ) -> None:
        error: GoalError | None = None
        if goal.done:
            return
        if status is GoalStatus.ABORTED:
            error = GoalAborted(f"{self.name} aborted the goal{f': {reason}' if reason else ''}", result)
        elif status is GoalStatus.CANCELED:
            error = GoalCanceled(f"the goal of {self.name} was cancelled", result)
        elif status is not GoalStatus.SUCCEEDED:  # a restarted server does not know the goal
            status, error = GoalStatus.LOST, GoalLost(f"{self.name} does not know the goal: its server was replaced")
        goal.end(status, result, error)

    def _feedback_received(self, message: Any) -> None:
        goal = self._goals.get(bytes(message.goal_id.uuid))
        if goal is not None:
            goal.receive(message.feedback)

    def _status_received(self, payload: bytes, _: MessageInfo) -> None:
        try:
            self._running = {goal_id for goal_id in self._running if not self._goals[goal_id].done}
            states = states_in(payload, self._running)
        except DecodeError as error:
            self._status.count_malformed(error)
            return
        for goal_id, number in states.items():
            goal = self._goals[goal_id]
            if number not in _STATES:
                continue
            state = GoalStatus(number)
            if not state.is_terminal:
                goal.status = max(goal.status, state)  # status messages may arrive out of order
            elif not goal.is_requested_again and self.host.is_running:
                # The result reports the end, but its response may have been lost.
                goal.is_requested_again = True
                self._in_background(self._request_again(goal))

    async def _request_again(self, goal: ClientGoalHandle[Goal, Result, Feedback]) -> None:
        """Request the result of an ended goal again if no response arrives."""
        await self.host.clock.sleep(LOST_GRACE)
        if not goal.done:
            with suppress(CallError, ClosedError):  # the following task keeps requesting
                request = self._get.request_class(goal_id={"uuid": list(goal.goal_id)})
                await self._take(goal, await self._get.call(request))

    def _in_background(self, work: Coroutine[object, object, None]) -> asyncio.Task[None]:
        task = self.host.context.loop.create_task(work, name=f"{self.host.full_name}: {self.name}")
        self._followers.add(task)
        task.add_done_callback(self._followers.discard)
        return task


async def _seen_through(task: asyncio.Task[None]) -> None:
    """Wait for a task to end even if the wait is cancelled."""
    cancelled: CancelledError | None = None
    while not task.done():
        try:
            await asyncio.shield(task)
        except CancelledError as error:
            if not task.cancelled():  # closing the client cancels it
                cancelled = error
    if cancelled is not None:
        raise cancelled

"""The handles of goals: as their clients see them, and as their servers and handlers do."""

from __future__ import annotations

import asyncio
import os
from asyncio import Future
from collections import deque
from collections.abc import AsyncIterator
from typing import Any, Generic, Protocol, TypeVar

from graphflow.errors import GoalError
from graphflow.executor.ledger import PendingGoal
from graphflow.interface import CALL_TIMEOUT
from graphflow.machines.goal import GoalRecord, GoalStatus, Phase
from graphflow.msgs.base import Action, Feedback, Goal, Message, Result, ServerGoalHandle
from graphflow.runtime.mistakes.rclpy_words import AttributeHints
from graphflow.runtime.part import Host

R_co = TypeVar("R_co", bound=Message, covariant=True)
F_contra = TypeVar("F_contra", bound=Message, contravariant=True)

FEEDBACK_KEPT = 100
"""Feedback messages buffered for a slow reader; the oldest are dropped."""


class _Client(Protocol[Goal, Result, Feedback]):
    """A client as its goals see it."""

    @property
    def host(self) -> Host: ...

    @property
    def name(self) -> str: ...

    @property
    def type(self) -> type[Action[Goal, Result, Feedback]]: ...

    async def cancel(
        self, goal: ClientGoalHandle[Goal, Result, Feedback], *, timeout: float | None = CALL_TIMEOUT
    ) -> bool: ...


class ClientGoalHandle(AttributeHints, PendingGoal, Generic[Goal, Result, Feedback]):
    """A goal, as its client sees it."""

    def __init__(self, client: _Client[Goal, Result, Feedback], request: Goal) -> None:
        self.request = request
        self.goal_id = os.urandom(16)
        self.status = GoalStatus.UNKNOWN
        """The last known status of the goal; `LOST` when the server has gone."""
        self.latest: Feedback | None = None
        """The latest feedback; None until one arrives."""
        self.is_requested_again = False
        self.dropped = 0
        """Feedback messages dropped because a reader was too slow."""
        loop = client.host.context.loop
        self.ended: Future[Result] = loop.create_future()
        self._client = client
        self._readers: list[tuple[deque[Feedback], list[Future[None]]]] = []
        """For each iteration of the feedback: its unread messages, and the future it waits for."""
        self._unread: deque[Feedback] = deque(maxlen=FEEDBACK_KEPT)
        """Feedback that arrived before any iteration."""
        self.action = client.name
        self.began_ns = client.host.context.clock.monotonic_ns()

    def __repr__(self) -> str:
        return f"<goal {self.goal_id.hex()[:8]} to {self._client.name}: {self.status.name}>"

    def _hint(self, name: str) -> str:
        action: Any = self._client.type
        if name in action.Result.__struct_fields__:
            return f"that is the goal; its result has it: (await IT.result()).{name}"
        is_feedback = name in action.Feedback.__struct_fields__
        return "that is the goal; read its feedback with async for feedback in IT.feedback():" if is_feedback else ""

    @property
    def done(self) -> bool:
        """Whether the goal has ended."""
        return self.status.is_terminal

    async def feedback(self) -> AsyncIterator[Feedback]:
        """Iterate over the feedback until the goal ends; the first iteration starts with the feedback so far."""
        ledger, loop = self._client.host.context.ledger, self._client.host.context.loop
        queue: deque[Feedback] = deque(self._unread, FEEDBACK_KEPT)
        self._unread.clear()
        reader: tuple[deque[Feedback], list[Future[None]]] = (queue, [])
        self._readers.append(reader)
        try:
            while True:
                while queue:
                    yield queue.popleft()
                if self.done:
                    return
                reader[1][:] = [news := loop.create_future()]
                with ledger.goal(news, self):
                    await news
        finally:
            self._readers.remove(reader)

    async def result(self, *, timeout: float | None = None) -> Result:
        """Wait for the goal to succeed; returns its result.

        Args:
            timeout: Seconds; None for no limit.

        Raises:
            GoalAborted, GoalCanceled: The goal did not succeed; the error's `result` is the server's final result.
            GoalLost: The server has gone.
            DeadlockError: The server waits for the caller, and the graph's deadlock policy is `break`.
            TimeoutError: The goal has not ended in time; it keeps running.
        """
        if timeout is not None:
            async with self._client.host.clock.timeout(timeout):
                return await self.result()
        # Shielded: a caller that is cancelled must not cancel `ended`, for which others may wait.
        with self._client.host.context.ledger.goal(ended := asyncio.shield(self.ended), self):
            return await ended

    async def cancel(self, *, timeout: float | None = CALL_TIMEOUT) -> bool:
        """Request cancellation; returns whether the server accepts. The goal ends later, and may still succeed.

        Raises:
            CallError: The server did not answer.
        """
        return await self._client.cancel(self, timeout=timeout)

    def receive(self, feedback: Feedback) -> None:
        """Receive feedback. Called by the client."""
        self.latest = feedback
        for queue in [queue for queue, _ in self._readers] or [self._unread]:
            self.dropped += len(queue) == FEEDBACK_KEPT
            queue.append(feedback)
        self._wake()

    def end(self, status: GoalStatus, result: Any, error: GoalError | None) -> None:
        """Record the end of the goal. Called by the client."""
        if self.done:
            return
        self.status = status
        if not self.ended.done():
            if error is None:
                self.ended.set_result(result)
            else:
                self.ended.set_exception(error)
                self.ended.exception()  # a caller that never awaits the result must not get a warning about its error
        self._wake()

    def _wake(self) -> None:
        for _, waiting in self._readers:
            for news in waiting:
                if not news.done():
                    news.set_result(None)


class _Server(Protocol[R_co, F_contra]):
    """A server as its goals see it."""

    @property
    def name(self) -> str: ...

    @property
    def result_class(self) -> type[R_co]: ...

    def send_feedback(self, goal_id: bytes, feedback: F_contra) -> None: ...


class ServedGoal(AttributeHints, ServerGoalHandle[Goal, Result, Feedback]):
    """A goal, as its server and handler see it."""

    def __init__(self, server: _Server[Result, Feedback], goal_id: bytes, request: Goal, record: GoalRecord) -> None:
        self.request = request
        self.partial: Result = server.result_class()
        self.record = record
        self.result: Result | None = None
        """The result of the ended goal."""
        self.reason = ""
        """The reason why the goal was aborted; "" for none."""
        self.waiters: list[Future[None]] = []
        """Futures of get_result requests that wait for the goal's end."""
        self.decided = asyncio.Event()
        """Set when the goal has been accepted or rejected."""
        self._server, self._id = server, goal_id

    def __repr__(self) -> str:
        return f"<goal {self._id.hex()[:8]} of {self._server.name}: {self.status.name}>"

    def _hint(self, name: str) -> str:
        return (
            f"the client's request has it: goal.request.{name}" if name in type(self.request).__struct_fields__ else ""
        )

    @property
    def goal_id(self) -> bytes:
        return self._id

    @property
    def status(self) -> GoalStatus:
        return self.record.status

    @property
    def is_preempted(self) -> bool:
        return self.record.is_preempted

    @property
    def is_cancel_requested(self) -> bool:
        return self.is_preempted or self.record.phase is Phase.CANCELING or self.is_over

    @property
    def is_over(self) -> bool:
        """Whether the goal has ended."""
        return self.record.phase.is_over

    def feedback(self, feedback: Feedback) -> None:
        self._server.send_feedback(self._id, feedback)

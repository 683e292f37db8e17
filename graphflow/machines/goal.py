"""The life of an action's goals, as ROS 2's state machine, and the book that a server keeps of them.

    ACCEPTED --execute--> EXECUTING --succeed--> SUCCEEDED
        |                     |------abort-----> ABORTED
        `----cancel_goal------|
                              v
                          CANCELING --canceled-> CANCELED     (it may still succeed or abort)

A goal that was accepted ends once, in one of the three terminal states. A client's cancelling makes it CANCELING, and
its body decides what comes of that. What the server ends by itself, for a newer goal say, is ABORTED.

Source: rcl_action goal_state_machine.c; action_msgs/srv/CancelGoal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum


class GoalStatus(IntEnum):
    """The states of action_msgs/msg/GoalStatus, and LOST, which only a client knows: the server is gone."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6
    LOST = -1

    @property
    def is_terminal(self) -> bool:
        return self in _TERMINAL

    @property
    def is_cancelable(self) -> bool:
        return self in (GoalStatus.ACCEPTED, GoalStatus.EXECUTING)


_TERMINAL = (GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED, GoalStatus.LOST)


class GoalEvent(Enum):
    """What can happen to a goal."""

    EXECUTE = "execute"
    CANCEL_GOAL = "cancel_goal"
    SUCCEED = "succeed"
    ABORT = "abort"
    CANCELED = "canceled"


TRANSITIONS: Mapping[tuple[GoalStatus, GoalEvent], GoalStatus] = {
    (GoalStatus.ACCEPTED, GoalEvent.EXECUTE): GoalStatus.EXECUTING,
    (GoalStatus.ACCEPTED, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.EXECUTING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.CANCELING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.CANCELED): GoalStatus.CANCELED,
}


def step(status: GoalStatus, event: GoalEvent) -> GoalStatus:
    """The state after `event`.

    Raises:
        ValueError: The event cannot happen in this state.
    """
    try:
        return TRANSITIONS[status, event]
    except KeyError:
        raise ValueError(f"a goal that is {status.name} cannot {event.value}") from None


class CancelCode(IntEnum):
    """Return codes of action_msgs/srv/CancelGoal."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL_ID = 2
    GOAL_TERMINATED = 3


ALL_GOALS = bytes(16)
"""The goal id of a cancel request that means more than one goal."""


@dataclass
class GoalRecord:
    """What the server's book says of one goal."""

    accepted_ns: int
    status: GoalStatus = GoalStatus.ACCEPTED
    ended_ns: int | None = None


class GoalBook:
    """The goals of one server, by id.

    Args:
        keep_ns: How long the result of a goal can be asked for, from its end on.
        show_ns: How long its end is told in the list of states.
        keep_most: The oldest results go when there are more.
    """

    def __init__(self, keep_ns: int, show_ns: int, keep_most: int) -> None:
        self._keep_ns, self._show_ns, self._keep_most = keep_ns, show_ns, keep_most
        self.goals: dict[bytes, GoalRecord] = {}

    def accept(self, goal_id: bytes, now_ns: int) -> GoalRecord:
        """Enter a goal.

        Raises:
            ValueError: It is known already.
        """
        if goal_id in self.goals:
            raise ValueError(f"goal {goal_id.hex()} is known already")
        self.goals[goal_id] = record = GoalRecord(now_ns)
        return record

    def step(self, goal_id: bytes, event: GoalEvent, now_ns: int) -> GoalStatus:
        """Something happened to a goal; returns its new state. Errors as `step`."""
        record = self.goals[goal_id]
        record.status = step(record.status, event)
        if record.status.is_terminal:
            record.ended_ns = now_ns
        return record.status

    def active(self) -> int:
        """Goals that have not ended."""
        return sum(1 for record in self.goals.values() if record.ended_ns is None)

    def shown(self, now_ns: int) -> list[tuple[bytes, GoalRecord]]:
        """What the list of states tells: goals that have not ended, or not long ago."""
        return [
            (goal_id, record)
            for goal_id, record in self.goals.items()
            if record.ended_ns is None or now_ns - record.ended_ns <= self._show_ns
        ]

    def expire(self, now_ns: int) -> list[bytes]:
        """Forget goals whose results were kept long enough; returns their ids."""
        ended = sorted(
            ((record.ended_ns, goal_id) for goal_id, record in self.goals.items() if record.ended_ns is not None)
        )
        surplus = len(ended) - self._keep_most
        gone = [goal_id for i, (when, goal_id) in enumerate(ended) if i < surplus or now_ns - when > self._keep_ns]
        for goal_id in gone:
            del self.goals[goal_id]
        return gone

    def to_cancel(self, goal_id: bytes, stamp_ns: int) -> tuple[CancelCode, list[bytes]]:
        """Which goals a cancel request means.

        Args:
            goal_id: One goal, or `ALL_GOALS`.
            stamp_ns: Goals accepted at or before it; 0 for no such condition.
        """
        if goal_id != ALL_GOALS and not stamp_ns:
            record = self.goals.get(goal_id)
            if record is None:
                return CancelCode.UNKNOWN_GOAL_ID, []
            if not record.status.is_cancelable:
                return CancelCode.GOAL_TERMINATED, []
            return CancelCode.NONE, [goal_id]
        meant = [
            known
            for known, record in self.goals.items()
            if record.status.is_cancelable
            and (known == goal_id or (record.accepted_ns <= stamp_ns if stamp_ns else goal_id == ALL_GOALS))
        ]
        return CancelCode.NONE, meant

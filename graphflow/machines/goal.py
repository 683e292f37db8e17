"""The life cycle of an action's goals at their server: one table of phases, and the book of all goals.

A goal is in one *phase* at a time; to clients each phase shows as one of ROS 2's states:

    phase       state        what happens
    DECIDING    -            the server decides whether to accept the goal
    ANSWERING   ACCEPTED     it is accepted; the answer goes out before anything else happens
    QUEUED      ACCEPTED     it waits for its turn, and for a slot of its group
    RUNNING     EXECUTING    its body runs
    CANCELING   CANCELING    a client has cancelled it; its body cleans up
    PREEMPTED   EXECUTING    the server ends it for a newer goal; its body cleans up
    REJECTED, SUCCEEDED, CANCELED, ABORTED                it has ended

`STEPS` gives, for each phase and each event, the next phase and the effects that the server carries out. `step` removes
the effects that the server's `GoalRules` do not ask for. A goal that has ended stays as it is, whatever comes late. One
that a client has cancelled ends as its body decides; one that the server ends by itself ends as ABORTED.

Source: rcl_action goal_state_machine.c; action_msgs/srv/CancelGoal.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum, auto

from graphflow.interface import GoalPolicy, OnClientLoss


class GoalStatus(IntEnum):
    """The states of action_msgs/msg/GoalStatus, and LOST, which only a client has: its server is gone."""

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


class Phase(Enum):
    """The phases of a goal; see the table above."""

    DECIDING = auto()
    ANSWERING = auto()
    QUEUED = auto()
    RUNNING = auto()
    CANCELING = auto()
    PREEMPTED = auto()
    REJECTED = auto()
    SUCCEEDED = auto()
    CANCELED = auto()
    ABORTED = auto()

    @property
    def is_over(self) -> bool:
        return self in (Phase.REJECTED, Phase.SUCCEEDED, Phase.CANCELED, Phase.ABORTED)

    @property
    def status(self) -> GoalStatus:
        """State that clients see."""
        return _STATUS.get(self, GoalStatus.UNKNOWN)


_STATUS = {
    Phase.ANSWERING: GoalStatus.ACCEPTED,
    Phase.QUEUED: GoalStatus.ACCEPTED,
    Phase.RUNNING: GoalStatus.EXECUTING,
    Phase.CANCELING: GoalStatus.CANCELING,
    Phase.PREEMPTED: GoalStatus.EXECUTING,
    Phase.SUCCEEDED: GoalStatus.SUCCEEDED,
    Phase.CANCELED: GoalStatus.CANCELED,
    Phase.ABORTED: GoalStatus.ABORTED,
}


class GoalEvent(Enum):
    """The events in the life of a goal."""

    ACCEPTED = "the decision is to accept it"
    REFUSED = "the decision is to reject it"
    ANSWERED = "the answer has gone out"
    BEGUN = "its turn has come, and a slot is free"
    CANCEL = "a client cancels it, and may"
    NEWER = "a newer goal takes its place"
    CLIENT_LOST = "its client has gone"
    CLIENT_AWAY = "its client has not come back in time"
    RETURNED = "its body has returned a result"
    FAILED = "its body has raised, or returned something that is not a result"
    UNWOUND = "its body has ended by being cancelled"
    OUTSTAYED = "its body is still running long after it was cancelled"
    DROPPED = "its group drops work that finds it full"
    STOPPING = "the server stops"


class Do(Enum):
    """The effects of an event, which the server carries out."""

    PREEMPT_OTHERS = "say NEWER to every other goal that has not ended"
    ENQUEUE = "put it in its runner's queue"
    DEQUEUE = "take it out of that queue"
    CANCEL_BODY = "cancel its body"
    LIMIT_CLEANUP = "say OUTSTAYED when `cleanup_timeout` has passed"
    AWAIT_CLIENT = "say CLIENT_AWAY when `client_grace` has passed and its client has not come back"
    DEGRADE = "report that a body has outstayed its cancellation"


@dataclass(frozen=True, slots=True)
class GoalRules:
    """The policies and limits of one server.

    Attributes:
        policy: Treatment of a goal that arrives while another is under way.
        on_client_loss: Treatment of a goal whose client has gone.
        queue_depth: Goals that may wait for their turn under the policy `queue`; any more are rejected.
        accept_limit: Seconds for the decision; after them the goal is rejected.
        client_grace: Seconds that a client may be gone before `on_client_loss` applies.
        cleanup_timeout: Seconds for a cancelled body to end; after them its goal is aborted, and its slot stays taken.
    """

    policy: GoalPolicy = "reject"
    on_client_loss: OnClientLoss = "continue"
    queue_depth: int = 16
    accept_limit: float = 1.0
    client_grace: float = 5.0
    cleanup_timeout: float = 10.0


@dataclass(frozen=True, slots=True)
class Step:
    """The consequence of an event: the next phase and the effects.

    Attributes:
        through: A state that ROS 2 has between the old and the new one, which clients must see, too.
    """

    phase: Phase
    do: tuple[Do, ...] = ()
    through: GoalStatus | None = None


_CANCELED_UNBEGUN = Step(Phase.CANCELED, (), GoalStatus.CANCELING)
_ABORTED_UNBEGUN = Step(Phase.ABORTED, (), GoalStatus.EXECUTING)
_STOP_BODY = (Do.CANCEL_BODY, Do.LIMIT_CLEANUP)

STEPS: Mapping[tuple[Phase, GoalEvent], Step] = {
    (Phase.DECIDING, GoalEvent.ACCEPTED): Step(Phase.ANSWERING),
    (Phase.DECIDING, GoalEvent.REFUSED): Step(Phase.REJECTED),
    (Phase.DECIDING, GoalEvent.CANCEL): Step(Phase.REJECTED),  # its client has given up
    (Phase.DECIDING, GoalEvent.CLIENT_LOST): Step(Phase.DECIDING, (Do.AWAIT_CLIENT,)),
    (Phase.DECIDING, GoalEvent.CLIENT_AWAY): Step(Phase.REJECTED),
    (Phase.DECIDING, GoalEvent.STOPPING): Step(Phase.REJECTED),
    #
    (Phase.ANSWERING, GoalEvent.ANSWERED): Step(Phase.QUEUED, (Do.PREEMPT_OTHERS, Do.ENQUEUE)),
    (Phase.ANSWERING, GoalEvent.CANCEL): _CANCELED_UNBEGUN,
    (Phase.ANSWERING, GoalEvent.NEWER): _ABORTED_UNBEGUN,
    (Phase.ANSWERING, GoalEvent.CLIENT_LOST): Step(Phase.ANSWERING, (Do.AWAIT_CLIENT,)),
    (Phase.ANSWERING, GoalEvent.CLIENT_AWAY): _CANCELED_UNBEGUN,
    (Phase.ANSWERING, GoalEvent.STOPPING): _ABORTED_UNBEGUN,
    #
    (Phase.QUEUED, GoalEvent.BEGUN): Step(Phase.RUNNING),
    (Phase.QUEUED, GoalEvent.CANCEL): Step(Phase.CANCELED, (Do.DEQUEUE,), GoalStatus.CANCELING),
    (Phase.QUEUED, GoalEvent.NEWER): Step(Phase.ABORTED, (Do.DEQUEUE,), GoalStatus.EXECUTING),
    (Phase.QUEUED, GoalEvent.CLIENT_LOST): Step(Phase.QUEUED, (Do.AWAIT_CLIENT,)),
    (Phase.QUEUED, GoalEvent.CLIENT_AWAY): Step(Phase.CANCELED, (Do.DEQUEUE,), GoalStatus.CANCELING),
    (Phase.QUEUED, GoalEvent.DROPPED): _ABORTED_UNBEGUN,
    (Phase.QUEUED, GoalEvent.STOPPING): Step(Phase.ABORTED, (Do.DEQUEUE,), GoalStatus.EXECUTING),
    #
    (Phase.RUNNING, GoalEvent.CANCEL): Step(Phase.CANCELING, _STOP_BODY),
    (Phase.RUNNING, GoalEvent.NEWER): Step(Phase.PREEMPTED, _STOP_BODY),
    (Phase.RUNNING, GoalEvent.CLIENT_LOST): Step(Phase.RUNNING, (Do.AWAIT_CLIENT,)),
    (Phase.RUNNING, GoalEvent.CLIENT_AWAY): Step(Phase.CANCELING, _STOP_BODY),
    (Phase.RUNNING, GoalEvent.RETURNED): Step(Phase.SUCCEEDED),
    (Phase.RUNNING, GoalEvent.FAILED): Step(Phase.ABORTED),
    # No client has cancelled it, so it may not end as CANCELED.
    (Phase.RUNNING, GoalEvent.UNWOUND): Step(Phase.ABORTED),
    (Phase.RUNNING, GoalEvent.STOPPING): Step(Phase.RUNNING),  # the node cancels all bodies
    #
    (Phase.CANCELING, GoalEvent.NEWER): Step(Phase.CANCELING),
    (Phase.CANCELING, GoalEvent.CLIENT_LOST): Step(Phase.CANCELING),
    (Phase.CANCELING, GoalEvent.CLIENT_AWAY): Step(Phase.CANCELING),
    (Phase.CANCELING, GoalEvent.RETURNED): Step(Phase.SUCCEEDED),
    (Phase.CANCELING, GoalEvent.FAILED): Step(Phase.ABORTED),
    (Phase.CANCELING, GoalEvent.UNWOUND): Step(Phase.CANCELED),
    (Phase.CANCELING, GoalEvent.OUTSTAYED): Step(Phase.ABORTED, (Do.DEGRADE,)),
    (Phase.CANCELING, GoalEvent.STOPPING): Step(Phase.CANCELING),
    #
    (Phase.PREEMPTED, GoalEvent.CANCEL): Step(Phase.CANCELING),  # its body is already being cancelled
    (Phase.PREEMPTED, GoalEvent.NEWER): Step(Phase.PREEMPTED),
    (Phase.PREEMPTED, GoalEvent.CLIENT_LOST): Step(Phase.PREEMPTED, (Do.AWAIT_CLIENT,)),
    (Phase.PREEMPTED, GoalEvent.CLIENT_AWAY): Step(Phase.CANCELING),
    (Phase.PREEMPTED, GoalEvent.RETURNED): Step(Phase.SUCCEEDED),
    (Phase.PREEMPTED, GoalEvent.FAILED): Step(Phase.ABORTED),
    (Phase.PREEMPTED, GoalEvent.UNWOUND): Step(Phase.ABORTED),
    (Phase.PREEMPTED, GoalEvent.OUTSTAYED): Step(Phase.ABORTED, (Do.DEGRADE,)),
    (Phase.PREEMPTED, GoalEvent.STOPPING): Step(Phase.PREEMPTED),
}
"""The step for each event in each phase, for a server whose rules ask for all effects."""


def step(phase: Phase, event: GoalEvent, rules: GoalRules) -> Step:
    """Return the consequence of an event, under the rules of one server.

    Raises:
        ValueError: The event cannot happen in this phase.
    """
    if phase.is_over:
        return Step(phase)
    try:
        following = STEPS[phase, event]
    except KeyError:
        raise ValueError(f"a goal that is {phase.name} cannot have {event.name}") from None
    not_done = set()
    if rules.policy != "preempt":
        not_done.add(Do.PREEMPT_OTHERS)
    if rules.on_client_loss != "cancel":
        not_done.add(Do.AWAIT_CLIENT)
    return Step(following.phase, tuple(do for do in following.do if do not in not_done), following.through)


class CancelCode(IntEnum):
    """Return codes of action_msgs/srv/CancelGoal."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL_ID = 2
    GOAL_TERMINATED = 3


ALL_GOALS = bytes(16)
"""The goal id of a cancel request that covers more than one goal."""


@dataclass
class GoalRecord:
    """The entry of one goal in the server's book."""

    client: bytes = bytes(16)
    """GID of the client that sent it."""
    phase: Phase = Phase.DECIDING
    accepted_ns: int = 0
    ended_ns: int | None = None
    is_preempted: bool = False
    """Whether a newer goal has arrived, however this one ends."""

    @property
    def status(self) -> GoalStatus:
        """State that clients see."""
        return self.phase.status


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of an event that was applied to a goal."""

    record: GoalRecord
    do: tuple[Do, ...]
    """Effects for the server to carry out, in order."""
    statuses: tuple[GoalStatus, ...]
    """States to publish, in order: none if clients see no change."""


class GoalBook:
    """The goals of one server, by id.

    Args:
        keep_ns: Nanoseconds for which a result can be requested after the goal's end.
        show_ns: Nanoseconds for which an ended goal stays in the status list.
        keep_most: Results to keep at most; the oldest go first.
    """

    def __init__(self, rules: GoalRules, keep_ns: int, show_ns: int, keep_most: int) -> None:
        self.rules = rules
        self._keep_ns, self._show_ns, self._keep_most = keep_ns, show_ns, keep_most
        self.goals: dict[bytes, GoalRecord] = {}
        """Accepted goals, in the order of acceptance."""
        self.deciding: dict[bytes, GoalRecord] = {}
        """Goals in the phase DECIDING."""
        self._ended: dict[bytes, int] = {}
        """Times at which the goals with a kept result ended, the oldest first."""
        self._shown: deque[tuple[bytes, int]] = deque()
        """The same for goals in the status list."""

    def has_room(self) -> bool:
        """Whether one more goal may be accepted now."""
        if self.rules.policy == "reject":
            return self.active() == 0
        if self.rules.policy != "queue":
            return True
        waiting = sum(record.phase in (Phase.ANSWERING, Phase.QUEUED) for record in self.goals.values())
        return waiting < self.rules.queue_depth

    def ask(self, goal_id: bytes, client: bytes) -> GoalRecord:
        """Add a goal that is not decided on yet.

        Raises:
            ValueError: The goal is already known.
        """
        if goal_id in self.goals or goal_id in self.deciding:
            raise ValueError(f"goal {goal_id.hex()} is already known")
        self.deciding[goal_id] = record = GoalRecord(client)
        return record

    def step(self, goal_id: bytes, event: GoalEvent, now_ns: int) -> Outcome:
        """Apply an event to a goal.

        Args:
            now_ns: The time of day for ACCEPTED, which clients see; for any other event the clock of `expire`.

        Raises:
            ValueError: The event cannot happen in the goal's phase.
        """
        record = self.goals.get(goal_id) or self.deciding[goal_id]
        before = record.phase
        following = step(before, event, self.rules)
        record.phase = following.phase
        record.is_preempted |= event is GoalEvent.NEWER and not before.is_over
        if before is Phase.DECIDING and record.phase is not Phase.DECIDING:
            del self.deciding[goal_id]
            if record.phase is Phase.ANSWERING:
                record.accepted_ns = now_ns
                self.goals[goal_id] = record
        if record.phase.is_over and not before.is_over:
            record.ended_ns = now_ns
            if goal_id in self.goals:
                self._ended[goal_id] = now_ns
                self._shown.append((goal_id, now_ns))
        states = (*([following.through] if following.through else []), record.status)
        return Outcome(record, following.do, states if record.status is not before.status else ())

    def of_client(self, client: bytes) -> list[bytes]:
        """Return the goals of a client that have not ended."""
        known = {**self.deciding, **self.goals}
        return [goal_id for goal_id, record in known.items() if record.client == client and not record.phase.is_over]

    def active(self) -> int:
        """Return the number of accepted goals that have not ended."""
        return len(self.goals) - len(self._ended)

    def hide(self, now_ns: int) -> list[bytes]:
        """Remove goals from the status list that ended long ago or are forgotten; return their ids, each once."""
        hidden = []
        while self._shown and (now_ns - self._shown[0][1] > self._show_ns or self._shown[0][0] not in self.goals):
            hidden.append(self._shown.popleft()[0])
        return hidden

    def expire(self, now_ns: int) -> list[bytes]:
        """Forget goals whose results were kept long enough; return their ids."""
        gone = []
        while self._ended:
            goal_id, when = next(iter(self._ended.items()))
            if len(self._ended) <= self._keep_most and now_ns - when <= self._keep_ns:
                break
            del self._ended[goal_id], self.goals[goal_id]
            gone.append(goal_id)
        return gone

    def to_cancel(self, goal_id: bytes, stamp_ns: int) -> tuple[CancelCode, list[bytes]]:
        """Return the goals that a cancel request covers, and its return code.

        The two fields combine as in action_msgs/srv/CancelGoal: an id alone means that goal, a time alone all goals
        accepted up to it, both together their union, neither all goals.

        Args:
            goal_id: One goal, or `ALL_GOALS`.
            stamp_ns: Time up to which goals were accepted; 0 for no such condition.
        """
        if goal_id != ALL_GOALS and not stamp_ns:
            record = self.goals.get(goal_id)
            if record is None:
                return CancelCode.UNKNOWN_GOAL_ID, []
            if not record.status.is_cancelable:
                return CancelCode.GOAL_TERMINATED, []
            return CancelCode.NONE, [goal_id]
        covered = [
            known
            for known, record in self.goals.items()
            if record.status.is_cancelable
            and (known == goal_id or (record.accepted_ns <= stamp_ns if stamp_ns else goal_id == ALL_GOALS))
        ]
        return CancelCode.NONE, covered

"""A model of goals: through which states each must have gone by now, and with what it must end.

The hooks of the server's own user tell what its bodies do; from that a `Life` knows how its goal should fare.
"""

from __future__ import annotations

import asyncio
import logging
from asyncio import CancelledError
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal

import pytest

from graphflow import Abort, ActionClient, GoalStatus, Group, Node
from graphflow.interface import GoalPolicy, OnClientLoss
from graphflow.machines.goal import GoalBook, GoalEvent, GoalRecord, GoalRules, Outcome
from graphflow.msgs.action_msgs.msg import GoalStatusArray
from graphflow.msgs.action_msgs.srv import CancelGoal
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.registry import interface_class
from graphflow.qos import ACTION_STATUS
from graphflow.runtime.actions import client, server
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.runtime.actions.server import RESULT_KEPT
from tests.machines.rcl_goals import NEXT

CLEANUP = 2.0537
"""Seconds that cancelled bodies get. Nothing that they do takes just as long."""
RULES = GoalRules()
"""What servers go by that say nothing else."""
DEPTH = 2
"""Goals that may wait for their turn."""
MOMENT = 1e-3
"""Seconds that are too short for anything to happen in them that is not due."""
BARE: dict[str, Any] = {"start_parameter_services": False, "enable_rosout": False, "enable_logger_service": False}

ACCEPTED, EXECUTING, CANCELING = GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING
SUCCEEDED, CANCELED, ABORTED, LOST = GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED, GoalStatus.LOST

SendGoal: Any = interface_class("example_interfaces/action/Fibonacci_SendGoal")
GetResult: Any = interface_class("example_interfaces/action/Fibonacci_GetResult")


def now() -> float:
    return asyncio.get_running_loop().time()


@dataclass(frozen=True)
class Plan:
    """What a body does, and what the hooks of its server say of its goal."""

    rests: tuple[float, ...] = ()
    """Seconds of work, each of which ends with feedback and a partial result."""
    ends: Literal["returns", "aborts", "aborts with", "fails", "lies", "never"] = "returns"
    if_cancelled: Literal["ends", "cleans up", "outstays", "goes on", "returns", "aborts", "fails"] = "ends"
    decides: float = 0.0
    """Seconds that its acceptance takes."""
    is_wanted: bool = True
    may_end: bool = True
    """Whether it may be cancelled."""


@dataclass(eq=False)
class Life:
    """A goal, as the hooks of its server have seen it."""

    n: int
    plan: Plan
    book: Book | None = None
    record: GoalRecord | None = None
    path: list[GoalStatus] = field(default_factory=list)
    """Its states in the server's book."""
    accepted: float = 0.0
    told: float | None = None
    """When it was first told to end, by a cancel request or for a newer goal."""
    began: float | None = None
    ended: float | None = None
    """Its body."""
    changed: float = 0.0
    """When its state last did."""
    over: float | None = None
    """When it reached a terminal state."""
    outcome: str = ""
    partials: list[tuple[float, list[int]]] = field(default_factory=list)
    feedback: list[list[int]] = field(default_factory=list)
    must_stop: bool = False
    """Whether it was told while its body ran."""
    cancels: int = 0
    """How often its body got CancelledError."""
    is_granted: bool = False
    is_refused: bool = False
    is_preempted: bool = False
    """Whether it was cancelled after a newer goal had come."""
    is_withdrawn: bool = False
    """Whether somebody has asked to cancel it."""
    is_forgotten: bool = False

    @property
    def goal_id(self) -> bytes:
        return self.n.to_bytes(16, "big")

    @property
    def stamp_ns(self) -> int:
        return 0 if self.record is None else self.record.accepted_ns

    @property
    def is_cancelable(self) -> bool:
        return self.path[-1:] in ([ACCEPTED], [EXECUTING])

    @property
    def result(self) -> list[int]:
        return self.ending()[1]

    def tell_to_end(self) -> None:
        if self.told is None:
            self.told, self.must_stop = now(), self.began is not None and self.ended is None

    def ending(self) -> tuple[GoalStatus, list[int]]:
        """How it must end, and with what, now that it has."""
        cut = CANCELED if CANCELING in self.path else ABORTED
        if self.began is None:
            return cut, []
        limit = float("inf") if self.told is None else self.told + CLEANUP
        so_far = ([], *(numbers for when, numbers in self.partials if when < limit))[-1]
        if self.ended is None or self.ended > limit:
            return ABORTED, so_far
        match self.outcome:
            case "returned":
                return SUCCEEDED, [self.n, 1000]
            case "aborted with":
                return ABORTED, [self.n, 2000]
            case "cancelled":
                return cut, so_far
            case _:
                return ABORTED, so_far

    def should_be(self) -> list[GoalStatus]:
        """The states that it must have gone through by now."""
        states = [ACCEPTED]
        if self.began is not None:
            states.append(EXECUTING)
        if self.is_granted or CANCELING in self.path:
            states.append(CANCELING)
        if self.over is not None:
            states += [] if len(states) > 1 else [EXECUTING]
            states.append(self.ending()[0])
        return states

    # what its body does

    async def live(self, goal: Fibonacci.Handle, sleep: Callable[[float], Coroutine[Any, Any, None]]) -> Any:
        left, ends = list(self.plan.rests), self.plan.ends
        while left or (ends == "never" and not self.cancels):
            try:
                if left:
                    await sleep(left[0])
                    self.tell(goal, len(left))
                    left.pop(0)
                else:
                    await asyncio.get_running_loop().create_future()
            except CancelledError:
                self.cancels += 1
                ends = await self.clean_up(sleep) or ends
                left = left if self.plan.if_cancelled == "goes on" else []
        if ends == "aborts with":
            raise Abort(Fibonacci.Result(sequence=[self.n, 2000]))
        if ends == "aborts":
            raise Abort("for no reason")
        if ends == "fails":
            raise KeyError("lost")
        return Fibonacci.Feedback() if ends == "lies" else Fibonacci.Result(sequence=[self.n, 1000])

    def tell(self, goal: Fibonacci.Handle, step: int) -> None:
        self.feedback.append([self.n, step])
        goal.feedback(Fibonacci.Feedback(sequence=[self.n, step]))
        self.partials.append((now(), [self.n, step]))
        goal.partial = Fibonacci.Result(sequence=[self.n, step])

    async def clean_up(self, sleep: Callable[[float], Coroutine[Any, Any, None]]) -> Any:
        """Called while CancelledError is under way: raises, or says how to end."""
        match self.plan.if_cancelled:
            case "ends" | "cleans up" | "outstays" as how:
                try:
                    await sleep({"ends": 0.0, "cleans up": 0.5, "outstays": 5.0}[how])
                except CancelledError:
                    self.cancels += 1
                raise CancelledError
            case "goes on":
                return ""
            case how:
                return how


class Model:
    """All goals of a program, and what has gone wrong."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.lives: dict[int, Life] = {}
        self.faults: list[str] = []
        self.died: dict[int, float] = {}
        """When the client of a goal did."""
        self.seen: dict[int, SeenGoal] = {}
        """Goals at their clients."""

    def new(self, plan: Plan) -> Life:
        life = self.lives[len(self.lives) + 1] = Life(len(self.lives) + 1, plan)
        return life

    def of(self, goal_id: Any) -> Life:
        return self.lives[int.from_bytes(bytes(goal_id), "big")]

    def wrong(self, what: str) -> None:
        """For hooks: an error in them would be taken for a user's."""
        self.faults.append(what)


class Book(GoalBook):
    """A server's book, read as it is written."""

    def __init__(self, model: Model, rules: GoalRules, *limits: int) -> None:
        super().__init__(replace(rules, queue_depth=DEPTH), *limits)
        self.model = model
        self.lives: list[Life] = []
        self.stopped: float | None = None
        """When its server was stopped or killed."""
        self.bodies: list[Life] = []
        """Those that have begun, in order."""

    def accept(self, goal_id: bytes, record: GoalRecord) -> None:
        life = self.model.of(goal_id)
        if life.record is not None:
            self.model.wrong(f"{life.n} is accepted twice")
        if self.model.setting.policy == "reject" and any(other.over is None for other in self.lives):
            self.model.wrong(f"{life.n} is accepted while another is under way")
        for other in self.lives:
            other.is_forgotten |= other.over is not None and now() - other.over > RESULT_KEPT
        if not life.plan.is_wanted or life.plan.decides > RULES.accept_limit:
            self.model.wrong(f"{life.n} is accepted against its server's will")
        life.book, life.record, life.accepted, life.path = self, record, now(), [record.status]
        life.changed = now()
        self.lives.append(life)
        if self.model.setting.policy == "preempt":
            asyncio.get_running_loop().call_soon(self._preempt, life)

    def _preempt(self, newer: Life) -> None:
        """What is about to be done for a newer goal."""
        for life in self.lives:
            if life is not newer and life.over is None and newer.is_cancelable and self.stopped is None:
                life.is_preempted = True
                life.tell_to_end()

    def step(self, goal_id: bytes, event: GoalEvent, now_ns: int) -> Outcome:
        outcome, life = super().step(goal_id, event, now_ns), self.model.of(goal_id)
        if event is GoalEvent.ACCEPTED:
            self.accept(goal_id, outcome.record)
            return outcome
        for status in outcome.statuses:
            if life.over is not None:
                self.model.wrong(f"{life.n} ends twice")
            life.path.append(status)
            life.changed = now()
            if status.is_terminal:
                life.over = now()
        if CANCELING in outcome.statuses:
            life.tell_to_end()
            if not life.is_granted and not self._client_is_lost(life):
                self.model.wrong(f"{life.n} is cancelled, and nobody has asked for it")
        return outcome

    def _client_is_lost(self, life: Life) -> bool:
        died = self.model.died.get(life.n)
        return (
            self.model.setting.on_client_loss == "cancel"
            and died is not None
            and now() > died + RULES.client_grace - MOMENT
        )


class SeenGoal(ClientGoalHandle[Any, Any, Any]):
    """A goal at its client, which remembers its states."""

    path: list[GoalStatus]

    def __init__(self, model: Model, client: Any, request: Any) -> None:
        self.path = []
        super().__init__(client, request)
        self.goal_id = request.order.to_bytes(16, "big")
        model.seen[request.order] = self

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "status" and self.path[-1:] != [value]:
            self.path.append(value)
        super().__setattr__(name, value)


class Doer(Node):
    """Carries plans out."""

    def __init__(self, model: Model) -> None:
        super().__init__("doer", **BARE)
        self.model, self.busy, setting = model, list[Life](), model.setting
        self.at_work = self.create_action_server(
            Fibonacci,
            "do",
            self.body,
            group=None if setting.limit is None else Group(setting.limit),
            policy=setting.policy,
            accept=self.accept,
            cancellable=self.may_end,
            on_client_loss=setting.on_client_loss,
            cleanup_timeout=CLEANUP,
        )
        book = self.at_work.book
        assert isinstance(book, Book)
        self.book = book

    def accept(self, goal: Fibonacci.Goal) -> Any:
        plan = self.model.lives[goal.order].plan
        return self.decide(plan) if plan.decides else plan.is_wanted

    async def decide(self, plan: Plan) -> bool:
        await self.clock.sleep(plan.decides)
        return plan.is_wanted

    def may_end(self, goal: Fibonacci.Handle) -> bool:
        life = self.model.lives[goal.request.order]
        if life.plan.may_end:
            life.is_granted = True
        else:
            life.is_refused = True
        return life.plan.may_end

    async def body(self, goal: Fibonacci.Handle) -> Any:
        life = self.model.lives[goal.request.order]
        if life.began is not None or life.over is not None:
            self.model.wrong(f"{life.n} begins twice, or after its end")
        life.began = now()
        self.book.bodies.append(life)
        self.busy.append(life)
        if len(self.busy) > (self.most or len(self.busy)):
            self.model.wrong(f"bodies at the same time: {[other.n for other in self.busy]}")
        try:
            result = await life.live(goal, self.clock.sleep)
            life.outcome = "returned" if isinstance(result, Fibonacci.Result) else "lied"
            return result
        except CancelledError:
            life.outcome = "cancelled"
            raise
        except Abort as error:
            life.outcome = "aborted" if error.result is None else "aborted with"
            raise
        except KeyError:
            life.outcome = "failed"
            raise
        finally:
            life.ended = now()
            self.busy.remove(life)

    @property
    def most(self) -> int | None:
        """Bodies that may run at one time."""
        return self.model.setting.limit if self.model.setting.policy == "parallel" else 1


class Asker(Node):
    """Has goals carried out."""

    do = ActionClient(Fibonacci, "do")


class Operator(Node):
    """Uses the services of an action without being its client, and hears its states."""

    def __init__(self, heard: Callable[[GoalStatusArray], None]) -> None:
        super().__init__("operator", **BARE)
        self.sending = self.create_client(SendGoal, "do/_action/send_goal")
        self.cancelling = self.create_client(CancelGoal, "do/_action/cancel_goal")
        self.asking = self.create_client(GetResult, "do/_action/get_result")
        self.create_subscription(GoalStatusArray, "do/_action/status", heard, ACTION_STATUS)


@dataclass(frozen=True)
class Setting:
    policy: GoalPolicy
    limit: int | None
    """Of the group of the server's bodies; None for a group of their own."""
    on_client_loss: OnClientLoss
    delay: float
    loss: float
    reorders: bool
    seed: int


def _follow() -> dict[GoalStatus, set[GoalStatus]]:
    """Which states a client may see after which: it may miss some."""
    follow: dict[GoalStatus, set[GoalStatus]] = {status: set() for status in GoalStatus}
    for _ in GoalStatus:
        for before, afters in NEXT.items():
            for after in afters:
                follow[before] |= {after, LOST} | follow[after]
    follow[GoalStatus.UNKNOWN] = set(GoalStatus)
    return follow


FOLLOW = _follow()


@contextmanager
def watched(model: Model) -> Iterator[None]:
    """Have what happens to goals written down, and nothing logged."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(server, "GoalBook", partial(Book, model))
        patch.setattr(client, "ClientGoalHandle", partial(SeenGoal, model))
        logging.disable()
        try:
            yield
        finally:
            logging.disable(logging.NOTSET)

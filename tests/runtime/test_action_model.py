"""Actions against a model: whatever clients, servers and the network do, every goal ends once, and as it should.

Programs of steps run in a simulation. The hooks of the server's own user tell what its bodies do; from that a `Life`
knows through which states its goal must have gone and with what it must end, and everybody else is held to it.
"""

from __future__ import annotations

import asyncio
import gc
import logging
import threading
import warnings
from asyncio import CancelledError, Task
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal

import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from graphflow import (
    Abort,
    ActionClient,
    CallError,
    Client,
    GoalAborted,
    GoalCanceled,
    GoalLost,
    GoalRejected,
    GoalStatus,
    Group,
    Node,
    Publisher,
    Subscription,
    action,
    service,
)
from graphflow.errors import ClosedError, GoalError
from graphflow.interface import GoalPolicy, OnClientLoss
from graphflow.machines.goal import ALL_GOALS, CancelCode, GoalBook, GoalEvent, GoalRecord, GoalRules, Outcome
from graphflow.msgs.action_msgs.msg import GoalStatusArray
from graphflow.msgs.action_msgs.srv import CancelGoal
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.registry import interface_class
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.qos import ACTION_STATUS
from graphflow.runtime.actions import client, server
from graphflow.runtime.actions.client import CANCEL_TIMEOUT, LOST_GRACE, RESULT_LONGEST, ClientGoalHandle
from graphflow.runtime.actions.server import RESULT_KEPT
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.testing.simulation import Seeded, World, simulate
from graphflow.times import NANOSECONDS
from tests.cases import cases, count, limit, slow
from tests.machines.rcl_goals import NEXT

CASES = count(few=30, full=180)
"""Programs that are tried."""
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


# The model


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


# The nodes


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


# Programs


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


@dataclass(frozen=True)
class Send:
    client: int
    plan: Plan
    patience: float
    """Seconds within which it must be accepted."""
    stays: float | None
    """Seconds after which the block of the goal is left; None to wait for its end without a block."""


@dataclass(frozen=True)
class Cancel:
    """What a client's cancelling is, and one by everybody who knows the id."""

    goal: int
    by: Literal["client", "id", "time", "id and time", "all"]


@dataclass(frozen=True)
class OnGoal:
    what: Literal["give up", "ask for the result", "send again"]
    goal: int


@dataclass(frozen=True)
class OnNode:
    what: Literal["kill client", "new client", "kill server", "stop server", "new server", "replace server"]
    client: int


Step = tuple[Send | Cancel | OnGoal | OnNode, float | None]
"""What is done, and the seconds until the next step; None for no turn of the loop between."""


def often(*weighted: tuple[int, st.SearchStrategy[Any]]) -> st.SearchStrategy[Any]:
    """One of several, as often as its number says."""
    return st.sampled_from([what for number, what in weighted for _ in range(number)]).flatmap(lambda what: what)


REST = st.sampled_from([0.0, 0.1, 0.3, 0.7, 1.1])
PLANS = st.builds(
    Plan,
    st.lists(REST, max_size=3).map(tuple),
    st.sampled_from(["returns", "returns", "aborts", "aborts with", "fails", "lies", "never", "never"]),
    st.sampled_from(["ends", "ends", "cleans up", "outstays", "goes on", "returns", "aborts", "fails"]),
    st.sampled_from([0.0, 0.0, 0.0, 0.0, 0.2, 0.5, 1.5]),
    st.sampled_from([True, True, True, True, True, False]),
    st.just(True),
)
REFUSING = st.builds(Plan, st.lists(REST, max_size=3).map(tuple), st.just("returns"), may_end=st.just(False))
SENDS = st.builds(
    Send,
    st.integers(0, 2),
    often((7, PLANS), (1, REFUSING)),
    st.sampled_from([0.05, 0.4, 10.0, 10.0, 10.0]),
    st.sampled_from([None, None, 0.0, 0.2, 1.0, 1000.0]),
)
GOALS = st.integers(0, 40)
CANCELS = st.builds(Cancel, GOALS, st.sampled_from(["client", "client", "id", "time", "id and time", "all"]))
ON_GOAL = st.builds(OnGoal, st.sampled_from(["give up", "ask for the result", "send again"]), GOALS)
ON_NODE = st.builds(
    OnNode,
    st.sampled_from(
        [
            "kill client",
            "new client",
            "new client",
            "kill server",
            "stop server",
            *["new server"] * 3,
            *["replace server"] * 2,
        ]
    ),
    st.integers(0, 2),
)
PAUSES = st.sampled_from([None, None, 0.0, 0.01, 0.01, 0.1, 0.1, 0.5, 0.5, 2.0, 2.0, 6.0, 20.0, 889.955, 951.37])
STEPS = st.tuples(often((8, SENDS), (5, CANCELS), (3, ON_GOAL), (1, ON_NODE)), PAUSES)
SETTINGS = st.builds(
    Setting,
    st.sampled_from(["reject", "queue", "preempt", "parallel"]),
    st.sampled_from([None, None, 1, 2]),
    st.sampled_from(["continue", "cancel"]),
    st.sampled_from([0.0, 0.02, 0.3]),
    st.sampled_from([0.0, 0.0, 0.1, 0.4]),
    st.booleans(),
    st.integers(0, 2**16),
)


@dataclass(eq=False)
class Sent:
    """A goal at whoever has sent it."""

    life: Life
    asker: Asker
    when: float
    task: Task[None] | None = None
    accepted: float | None = None
    left: float | None = None
    """When its block was left, with the goal under way."""
    is_given_up: bool = False
    outcome: Any = None
    """The result, or the error instead."""


class Play:
    """A program under way."""

    def __init__(self, world: World, model: Model) -> None:
        self.world, self.model, self.setting = world, model, model.setting
        self.askers: list[Asker] = []
        self.doer: Doer | None = None
        self.doers: list[Doer] = []
        self.is_stopping = False
        self.gone_since = 0.0
        self.sent: list[Sent] = []
        self.tasks: list[Task[None]] = []
        self.heard: dict[int, list[GoalStatus]] = {}
        """What the list of states has told of each goal."""
        self.operator = Operator(self.hear)

    # its steps

    async def run(self, steps: Sequence[Step]) -> None:
        await self.world.start(self.operator)
        await self.new_server()
        await self.new_client()
        for step, pause in steps:
            await self.do(step)
            if pause is not None:
                await asyncio.sleep(pause)
            self.check()
        await self.end()

    async def do(self, step: Send | Cancel | OnGoal | OnNode) -> None:
        """Begin a step; what takes time goes on beside the next."""
        if isinstance(step, Send):
            if self.askers:
                asker = self.askers[step.client % len(self.askers)]
                self.sent.append(sent := Sent(self.model.new(step.plan), asker, now()))
                sent.task = self.later(self.send(sent, step))
        elif isinstance(step, OnNode):
            await self.do_on_node(step)
        elif self.sent:
            sent = self.sent[step.goal % len(self.sent)]
            if isinstance(step, OnGoal):
                self.do_on_goal(step, sent)
            elif step.by == "client":
                self.later(self.cancel_by_client(sent))
            else:
                self.later(self.cancel_by_others(sent.life, step.by))

    def do_on_goal(self, step: OnGoal, sent: Sent) -> None:
        match step.what:
            case "give up":
                assert sent.task is not None
                sent.is_given_up = sent.is_given_up or not sent.task.done()
                sent.life.is_withdrawn |= sent.is_given_up
                sent.task.cancel()
            case "ask for the result":
                self.later(self.ask_for_the_result(sent.life))
            case "send again":
                self.later(self.send_again(sent.life))

    async def do_on_node(self, step: OnNode) -> None:
        match step.what:
            case "new client":
                await self.new_client()
            case "new server":
                await self.new_server()
            case "kill client" if self.askers:
                self.later(self.kill_client(self.askers.pop(step.client % len(self.askers))))
            case "replace server" if self.doer is not None and not self.is_stopping:
                self.later(self.end_server(self.doer, is_killed=True))
                await asyncio.sleep(0)
                await self.new_server()
            case "kill server" | "stop server" if self.doer is not None and not self.is_stopping:
                self.is_stopping = True
                self.later(self.end_server(self.doer, is_killed=step.what == "kill server"))

    def later(self, work: Coroutine[Any, Any, None]) -> Task[None]:
        self.tasks.append(asyncio.create_task(work))
        return self.tasks[-1]

    async def new_server(self) -> None:
        if self.doer is None:
            self.doer = Doer(self.model)
            self.doers.append(self.doer)
            await self.world.start(self.doer)

    async def new_client(self) -> None:
        if len(self.askers) < 3:
            asker = Asker(f"asker_{len(self.tasks)}", **BARE)
            await self.world.start(asker)
            self.askers.append(asker)

    async def kill_client(self, asker: Asker) -> None:
        for sent in self.sent:
            if sent.asker is asker:
                self.model.died[sent.life.n] = now()
        await self.world.kill(asker)

    async def end_server(self, doer: Doer, *, is_killed: bool) -> None:
        doer.book.stopped = now()
        if is_killed:
            self.doer, self.is_stopping, self.gone_since = None, False, now()
            await self.world.kill(doer)
        else:
            await core_of(doer).stop()
            # A request that is on its way when its server stops may have to time out.
            self.doer, self.is_stopping, self.gone_since = None, False, now() + RESULT_LONGEST

    async def send(self, sent: Sent, step: Send) -> None:
        do, goal = sent.asker.do, Fibonacci.Goal(order=sent.life.n)
        try:
            if step.stays is None:
                made = await do.send_goal(goal, timeout=step.patience)
                sent.accepted = now()
                sent.outcome = await made.result()
            else:
                async with do.send(goal, timeout=step.patience) as made:
                    sent.accepted = now()
                    try:
                        sent.outcome = await made.result(timeout=step.stays)
                    finally:
                        if not made.done:
                            sent.left, sent.life.is_withdrawn = now(), True
        except (CallError, GoalError, ClosedError, TimeoutError, CancelledError) as error:
            sent.outcome = error
        if sent.left is not None:
            assert now() <= sent.left + CANCEL_TIMEOUT + MOMENT
            assert not self.is_sure(sent) or not sent.life.is_cancelable or sent.life.is_refused

    def is_sure(self, sent: Sent) -> bool:
        """Whether nothing has been lost between a client and the server of its goal."""
        book = sent.life.book
        is_lost = self.setting.loss or sent.life.n in self.model.died
        return not is_lost and book is not None and book.stopped is None and not sent.life.is_forgotten

    async def cancel_by_client(self, sent: Sent) -> None:
        goal, life = self.model.seen.get(sent.life.n), sent.life
        if goal is None:
            return
        life.is_withdrawn, was_accepted = True, bool(life.path)
        try:
            is_granted = await goal.cancel(timeout=5.0)
        except (CallError, ClosedError):
            return
        if is_granted:
            assert life.is_granted
        elif was_accepted and life.book is self.book:
            assert life.is_refused or not life.is_cancelable

    @property
    def book(self) -> Book | None:
        return None if self.doer is None else self.doer.book

    async def cancel_by_others(self, life: Life, by: str) -> None:
        """Ask, and compare the answer with what was and what has become."""
        goal_id = life.goal_id if by in ("id", "id and time") else ALL_GOALS
        stamp_ns = life.stamp_ns if by in ("time", "id and time") else 0
        info: dict[str, Any] = {"goal_id": {"uuid": list(goal_id)}}
        info["stamp"] = {"sec": stamp_ns // NANOSECONDS, "nanosec": stamp_ns % NANOSECONDS}
        is_one = goal_id != ALL_GOALS and not stamp_ns
        life.is_withdrawn |= goal_id != ALL_GOALS
        book, was_accepted = self.book, bool(life.path)
        before = [] if book is None else [other for other in book.lives if other.is_cancelable]
        try:
            answer = await self.operator.cancelling.call(CancelGoal.Request(goal_info=info), timeout=5.0)
        except CallError:
            return
        told = [self.model.of(given.goal_id.uuid) for given in answer.goals_canceling]
        if is_one:
            meant = [life]
        else:
            meant = [m for m in before if m.goal_id == goal_id or not stamp_ns or m.stamp_ns <= stamp_ns]
            assert all(t.stamp_ns <= stamp_ns or t.goal_id == goal_id or not stamp_ns for t in told)
        assert all(t.is_granted for t in told)
        if self.book is not book or book is None or book.stopped is not None:
            return
        match CancelCode(answer.return_code):
            case CancelCode.NONE if is_one:
                assert told == [life]
            case CancelCode.NONE:
                assert not any(m.is_cancelable and not m.is_refused for m in meant)
            case CancelCode.REJECTED:
                assert not told
                assert any(m.is_refused for m in self.model.lives.values())
            case CancelCode.UNKNOWN_GOAL_ID:
                assert is_one
                assert not was_accepted or life.book is not book or life.is_forgotten
            case CancelCode.GOAL_TERMINATED:
                assert is_one
                assert not life.is_cancelable

    async def ask_for_the_result(self, life: Life) -> None:
        book, was_accepted = self.book, bool(life.path)
        try:
            request = GetResult.Request(goal_id={"uuid": list(life.goal_id)})
            answer = await self.operator.asking.call(request, timeout=RESULT_LONGEST)
        except CallError:
            return
        if answer.status:
            assert (answer.status, list(answer.result.sequence)) == (life.path[-1], life.result)
        elif book is self.book:
            assert not was_accepted or life.is_forgotten or life.book is not book
            assert list(answer.result.sequence) == []

    async def send_again(self, life: Life) -> None:
        """Whoever has not heard the answer asks again, and starts nothing by it."""
        over = now() if life.over is None else life.over
        if self.book is None or life.book is not self.book or now() > over + RESULT_KEPT / 2:
            return
        try:
            request = SendGoal.Request(goal_id={"uuid": list(life.goal_id)}, goal=Fibonacci.Goal(order=life.n))
            answer = await self.operator.sending.call(request, timeout=5.0)
        except CallError:
            return
        assert answer.accepted
        assert answer.stamp.sec * NANOSECONDS + answer.stamp.nanosec == life.stamp_ns

    def hear(self, message: GoalStatusArray) -> None:
        for entry in message.status_list:
            told = self.heard.setdefault(self.model.of(entry.goal_info.goal_id.uuid).n, [])
            if told[-1:] != [GoalStatus(entry.status)]:
                told.append(GoalStatus(entry.status))

    # what must hold

    def check(self) -> None:
        assert self.model.faults == []
        for task in self.tasks:
            if task.done() and not task.cancelled():
                task.result()
        for life in self.model.lives.values():
            self.check_at_server(life)
        for doer in self.doers:
            self.check_server(doer)
        for sent in self.sent:
            self.check_at_client(sent)

    def check_at_server(self, life: Life) -> None:
        book = life.book
        if book is None:
            assert life.began is None
            return
        assert life.path == life.should_be()
        assert life.record is not None
        assert life.record.status is life.path[-1]
        heard = self.heard.get(life.n, [])
        assert set(heard) <= set(life.path)
        assert self.setting.reorders or heard == [status for status in life.path if status in heard]
        if book.stopped is not None:
            return
        if not self.setting.loss and not self.setting.reorders and now() > life.changed + self.setting.delay + MOMENT:
            assert heard[-1] is life.path[-1]
        assert not life.is_granted or CANCELING in life.path
        if life.over is None:
            assert life.ended is None
            assert life.told is None or now() < life.told + CLEANUP
            died = self.model.died.get(life.n)
            if self.setting.on_client_loss == "cancel" and died is not None and life.accepted <= died:
                assert not life.is_cancelable or now() <= died + RULES.client_grace + MOMENT
        elif life.began is None and CANCELING not in life.path:
            assert life.is_preempted
        if life.must_stop and life.told != now():
            assert life.cancels == 1
        elif not life.must_stop:
            assert life.cancels == 0

    def check_server(self, doer: Doer) -> None:
        book, at_work = doer.book, doer.at_work
        kept = [life for life in book.lives if not life.is_forgotten]
        assert [life.goal_id for life in kept] == list(book.goals) == list(at_work.goals)
        assert book.active() == sum(life.over is None for life in kept)
        for life in kept:
            result = at_work.goals[life.goal_id].result
            assert (result is None) is (life.over is None)
            assert result is None or list(result.sequence) == life.result
        order = [life for life in book.lives if life.began is not None]
        assert order == book.bodies
        if book.stopped is None and self.setting.policy != "parallel" and not doer.busy:
            assert all(life.over is not None or life.accepted == now() for life in book.lives)

    def check_at_client(self, sent: Sent) -> None:
        goal, life = self.model.seen.get(sent.life.n), sent.life
        if goal is None:
            return
        assert all(after in FOLLOW[before] for before, after in zip(goal.path, goal.path[1:], strict=False))
        assert [status for status in goal.path if status.is_terminal] == [goal.status] * goal.done
        is_dead, is_gone = life.n in self.model.died, life.book is None or life.book.stopped is not None
        if goal.status is LOST:
            assert is_dead or is_gone or life.is_forgotten
        elif goal.done:
            assert goal.status is life.path[-1]
            assert list(self.result_of(goal).sequence) == life.result
        elif sent.accepted is not None:
            patience = 4 * self.setting.delay + MOMENT
            assert not is_dead or now() <= self.model.died[life.n] + 5.0
            if self.is_sure(sent):
                assert life.over is None or now() <= max(life.over, sent.accepted) + patience
            elif self.doer is None:
                assert now() <= max(self.gone_since, sent.accepted) + LOST_GRACE + patience

    @staticmethod
    def result_of(goal: SeenGoal) -> Any:
        error = goal.ended.exception()
        return goal.ended.result() if error is None else error.result  # type: ignore[attr-defined]

    # its end

    async def end(self) -> None:
        """The network recovers and everybody calls his goals off: everything must come to an end in a limited time."""
        carrier = self.world.network.carrier
        assert isinstance(carrier, Seeded)
        carrier._loss = 0.0
        await asyncio.sleep(1.0)
        if self.sent:
            await self.cancel_by_others(self.sent[0].life, "all")
        await asyncio.sleep(RESULT_LONGEST + 200.0)
        self.check()
        assert all(task.done() for task in self.tasks)
        for sent in self.sent:
            self.check_outcome(sent)
        if self.doer is not None:
            await self.check_expiry(self.doer)
        self.check_leaks()
        for doer in self.doers:
            await core_of(doer).stop()
        for asker in self.askers:
            await core_of(asker).stop()
        assert asyncio.all_tasks() == {asyncio.current_task()}

    def check_outcome(self, sent: Sent) -> None:
        life, outcome = sent.life, sent.outcome
        goal = self.model.seen.get(life.n)
        event(f"{type(outcome).__name__}")
        match outcome:
            case Fibonacci.Result():
                assert life.path[-1] is SUCCEEDED
                assert list(outcome.sequence) == life.result
            case GoalCanceled() | GoalAborted():
                assert life.path[-1] is (CANCELED if isinstance(outcome, GoalCanceled) else ABORTED)
                assert list(outcome.result.sequence) == life.result  # type: ignore[attr-defined]
            case GoalRejected():
                assert not life.path
                assert self.may_be_rejected(sent)
            case GoalLost():
                assert goal is not None
                assert goal.status is LOST
            case ClosedError():
                assert life.n in self.model.died
            case None | CancelledError():
                assert sent.is_given_up or (sent.left is not None and life.n in self.model.died)
            case TimeoutError() | CallError():
                pass
            case _:
                raise AssertionError(f"{life.n} has the outcome {outcome!r}")

    def may_be_rejected(self, sent: Sent) -> bool:
        plan, policy = sent.life.plan, self.setting.policy
        if not plan.is_wanted or plan.decides > RULES.accept_limit or sent.life.is_withdrawn:
            return True
        books = [doer.book for doer in self.doers]
        others = [other for book in books for other in book.lives if other.over is None or other.over >= sent.when]
        enough = {"reject": 1, "queue": DEPTH}.get(policy)
        return any(book.stopped is not None for book in books) or (enough is not None and len(others) >= enough)

    async def check_expiry(self, doer: Doer) -> None:
        """A quarter of an hour later the next goal finds the server empty."""
        await asyncio.sleep(RESULT_KEPT + 1.0)
        life = self.model.new(Plan())
        request = SendGoal.Request(goal_id={"uuid": list(life.goal_id)}, goal=Fibonacci.Goal(order=life.n))
        while not life.path:  # where messages overtake each other, the end of a call may overtake its answer
            with suppress(CallError):
                assert (await self.operator.sending.call(request)).accepted
        await asyncio.sleep(1.0)
        assert list(doer.at_work.goals) == list(doer.book.goals) == [life.goal_id]
        assert life.path == [ACCEPTED, EXECUTING, SUCCEEDED]

    def check_leaks(self) -> None:
        for doer in self.doers:
            assert doer.busy == []
            assert not doer.at_work._waiting
            assert not doer.at_work._deciding
            assert doer is not self.doer or not any(goal.waiters for goal in doer.at_work.goals.values())
            runners: list[Any] = [endpoint.runner for endpoint in doer.at_work.endpoints if hasattr(endpoint, "runner")]
            assert not any(runner.active or (doer is self.doer and runner.items) for runner in runners)
        clients = [sent.asker.do for sent in self.sent]
        for do in clients:
            assert not do._goals
            assert not do._followers
            assert not do._send._pending | do._get._pending | do._cancel._pending
        nodes: list[Node] = [node for node in (*self.askers, self.doer) if node is not None]
        for ledger in [node.context.ledger for node in nodes]:
            assert not ledger.calls
            assert not ledger.goals
            assert not ledger.served


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


def play(setting: Setting, steps: Sequence[Step]) -> None:
    """Run a program; raises AssertionError where it does not go as it should."""
    model = Model(setting)
    failures: list[str] = []

    def failed(_: object, context: dict[str, Any]) -> None:
        # A node that has stopped may be asked by what still runs of it.
        if not isinstance(context.get("exception"), ClosedError):
            failures.append(repr(context))

    async def story(world: World) -> None:
        asyncio.get_running_loop().set_exception_handler(failed)
        await Play(world, model).run(steps)

    with watched(model):
        simulate(story, setting.seed, delay=(0.0, setting.delay), loss=setting.loss, reorders=setting.reorders)
    assert not failures, failures[0]


@limit(CASES)
@cases(CASES)
@given(SETTINGS, st.lists(STEPS, min_size=8, max_size=40))
def test_against_the_model(setting: Setting, steps: list[Step]) -> None:
    """What servers, clients and bystanders see of each goal is what the model says, at every step of every program."""
    play(setting, steps)


# By hand


@slow
def test_a_thousand_preemptions() -> None:
    """By three clients over a slow network: never two bodies at once, however they end, and the newest goal wins."""
    model = Model(Setting("preempt", None, "continue", 0.05, 0.0, False, 0))

    async def story(world: World) -> None:
        askers, random = [Asker(f"asker_{n}", **BARE) for n in range(3)], world.random
        await world.start(doer := Doer(model), *askers)
        async with asyncio.TaskGroup() as group:
            for n in range(1000):
                how: Any = random.choice(("ends", "cleans up", "goes on", "returns", "aborts", "fails"))
                life = model.new(Plan((0.1, 0.1), "returns", how))
                group.create_task(askers[n % 3].do.send_goal(Fibonacci.Goal(order=life.n)))
                await asyncio.sleep(random.choice((0.0, 0.0, 0.05, 3.0)))
        await asyncio.sleep(5.0)

        assert model.faults == []
        assert [life.path for life in doer.book.lives] == [life.should_be() for life in doer.book.lives]
        assert doer.book.lives[-1].path[-1] is SUCCEEDED
        assert len(doer.book.lives) == 1000
        assert len(doer.book.bodies) > 200
        assert all(life.cancels == life.must_stop for life in doer.book.bodies)

    with watched(model):
        simulate(story, 4, delay=(0.0, 0.05))


class Stuck(Node):
    """Bodies of order 1 ask a service of their own group, which cannot answer while they wait."""

    work = Group(1)
    asking = Client(Trigger, "answer")

    @service(Trigger, "answer", group=work)
    async def answer(self, _: Trigger.Request) -> Trigger.Response:
        return Trigger.Response()

    @service(Trigger, "hold", group=work)
    async def hold(self, _: Trigger.Request) -> Trigger.Response:
        await self.clock.sleep(3.0)
        return Trigger.Response()

    @action(Fibonacci, "do", group=work, policy="queue")
    async def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        goal.partial = Fibonacci.Result(sequence=[1])
        if goal.request.order == 1:
            await self.asking.call(Trigger.Request(), timeout=None)
        return Fibonacci.Result(sequence=[2])


def test_cancelling_in_a_deadlock(caplog: pytest.LogCaptureFixture) -> None:
    """It is answered while the group is deadlocked, for the goal that waits and for the one that holds the slot."""

    async def story(world: World) -> None:
        await world.start(Stuck(), asker := Asker())
        first, second = [await asker.do.send_goal(Fibonacci.Goal(order=1)) for _ in range(2)]
        await asyncio.sleep(5.0)
        assert [first.status, second.status] == [EXECUTING, ACCEPTED]
        assert "DEADLOCK" in caplog.text
        async with asyncio.timeout(0.5):
            for goal, numbers in ((second, []), (first, [1])):
                assert await goal.cancel()
                with pytest.raises(GoalCanceled) as caught:
                    await goal.result()
                assert list(caught.value.result.sequence) == numbers  # type: ignore[attr-defined]
            third = await asker.do.send_goal(Fibonacci.Goal(order=2))
            assert list((await third.result()).sequence) == [2]

    simulate(story, 1, delay=(0.0, 0.02), deadlock="report")


def test_cancelling_before_execution_begins() -> None:
    """A goal whose group is busy with something else is CANCELED at once, and its body never runs."""

    async def story(world: World) -> None:
        await world.start(stuck := Stuck(), asker := Asker())
        held = asyncio.create_task(asker.create_client(Trigger, "hold").call(Trigger.Request()))
        await asyncio.sleep(0.1)
        goal = await asker.do.send_goal(Fibonacci.Goal(order=2))
        await asyncio.sleep(1.0)
        assert goal.status is ACCEPTED
        async with asyncio.timeout(0.2):
            assert await goal.cancel()
            with pytest.raises(GoalCanceled):
                await goal.result()
        await held
        await asyncio.sleep(1.0)
        assert stuck.statistics()["action /do"] == {"runs": 0, "errors": 0, "active": 0, "waiting": 0}
        assert stuck.statistics()["group work"]["running"] == 0

    simulate(story, 2, delay=(0.0, 0.02))


def test_cancelling_in_a_flood_of_feedback() -> None:
    """A body that tells more than its client can read is cancelled as any other; the oldest feedback is dropped."""

    class Flood(Node):
        @action(Fibonacci, "do")
        async def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            n = 0
            while True:
                for _ in range(100):
                    goal.feedback(Fibonacci.Feedback(sequence=[n := n + 1]))
                goal.partial = Fibonacci.Result(sequence=[n])
                await self.clock.sleep(0.001)

    async def story(world: World) -> None:
        await world.start(Flood(), asker := Asker())
        goal, read = await asker.do.send_goal(Fibonacci.Goal()), list[int]()

        async def slowly() -> None:
            async for feedback in goal.feedback():
                read.append(feedback.sequence[0])
                await asyncio.sleep(0.001)

        reading = asyncio.create_task(slowly())
        await asyncio.sleep(0.05)
        async with asyncio.timeout(0.05):
            assert await goal.cancel()
            with pytest.raises(GoalCanceled) as caught:
                await goal.result()
        await reading
        assert caught.value.result.sequence[0] >= 4000  # type: ignore[attr-defined]
        assert read == sorted(read)
        assert goal.dropped > 1000

    simulate(story, 3, delay=(0.0, 0.005))


@pytest.mark.parametrize("decides", [0.5, 0.9])
def test_giving_up_before_acceptance(decides: float) -> None:
    """Whoever stops waiting while the server decides has sent nothing: no goal is accepted."""
    model = Model(Setting("queue", None, "continue", 0.0, 0.0, False, 0))

    async def story(world: World) -> None:
        await world.start(doer := Doer(model), asker := Asker())
        goals = [Fibonacci.Goal(order=model.new(Plan(decides=decides)).n) for _ in range(2)]
        sending = asyncio.create_task(asker.do.send_goal(goals[0]))
        await asyncio.sleep(0.2)
        sending.cancel()
        with pytest.raises(CancelledError):
            await sending
        with pytest.raises(CallError):
            await asker.do.send_goal(goals[1], timeout=0.3)
        await asyncio.sleep(5.0)
        assert doer.book.lives == []
        assert model.faults == []
        assert not asker.do._goals

    with watched(model):
        simulate(story)


def test_two_goals_decided_at_the_same_time() -> None:
    """Only one of them is accepted where goals are rejected while another is under way."""
    model = Model(Setting("reject", None, "continue", 0.0, 0.0, False, 0))

    async def story(world: World) -> None:
        await world.start(doer := Doer(model), asker := Asker())
        plans = [Plan((1.0,), decides=decides) for decides in (0.5, 0.7)]
        sending = [asker.do.send_goal(Fibonacci.Goal(order=model.new(plan).n)) for plan in plans]
        _, second = await asyncio.gather(*sending, return_exceptions=True)
        await asyncio.sleep(5.0)
        assert isinstance(second, GoalRejected)
        assert [life.path for life in doer.book.lives] == [[ACCEPTED, EXECUTING, SUCCEEDED]]
        assert model.faults == []

    with watched(model):
        simulate(story)


class Cleaner(Node):
    """Works until it is cancelled, and takes its time to clean up."""

    def __init__(self, takes: float = 1.0, **options: Any) -> None:
        super().__init__()
        self.takes, self.cancels, self.cleaned = takes, 0, 0
        self.at_work = self.create_action_server(Fibonacci, "do", self.body, **options)

    async def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        clock = self.clock
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            self.cancels += 1
            try:
                if self.takes:
                    await clock.sleep(self.takes)
                self.cleaned += 1
            except CancelledError:
                self.cancels += 1
                raise
        return Fibonacci.Result()


async def test_a_newer_goal_that_is_cancelled_at_once(graph: Graph) -> None:
    """A goal that is cancelled before anything comes of it pre-empts nobody."""
    await graph.start(cleaner := Cleaner(0.0, policy="preempt"), asker := Asker(), operator := Operator(lambda _: None))
    older = await asker.do.send_goal(Fibonacci.Goal())
    await graph.settle()
    goal_id = {"uuid": [7] * 16}
    _, answer = await asyncio.gather(
        operator.sending.call(SendGoal.Request(goal_id=goal_id, goal=Fibonacci.Goal())),
        operator.cancelling.call(CancelGoal.Request(goal_info={"goal_id": goal_id})),
    )
    await graph.settle()

    assert (answer.return_code, len(answer.goals_canceling)) == (0, 1)
    assert [goal.status for goal in cleaner.at_work.goals.values()] == [EXECUTING, CANCELED]
    assert older.status is EXECUTING
    assert cleaner.cancels == 0


def test_a_server_that_is_replaced() -> None:
    """Its goals are lost, and not aborted: who has come in its place knows nothing of them."""

    async def story(world: World) -> None:
        await world.start(old := Cleaner(0.0), asker := Asker())
        goal = await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await world.kill(old)
        await world.start(Cleaner(0.0))
        with pytest.raises(GoalLost, match="does not know the goal: its server was replaced"):
            await goal.result(timeout=2.0)
        assert goal.status is LOST

    simulate(story, delay=(0.0, 0.02))


# Races of goals, clients and servers that end


async def begun(world: World, cleaner: Cleaner) -> tuple[Asker, ClientGoalHandle[Any, Any, Any]]:
    await world.start(cleaner, asker := Asker())
    goal = await asker.do.send_goal(Fibonacci.Goal())
    await asyncio.sleep(0.1)
    return asker, goal


async def decide(_: Fibonacci.Goal) -> bool:
    await asyncio.sleep(0.5)
    return True


def background_errors(story: Callable[[World], Coroutine[Any, Any, None]], **options: Any) -> list[str]:
    """What the loop's exception handler was told in a story."""
    errors: list[str] = []

    async def watched(world: World) -> None:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: errors.append(f"{context['message']}: {context['exception']!r}"))
        await story(world)

    simulate(watched, **options)
    return errors


def test_cancelling_what_was_preempted() -> None:
    """A body that cleans up for a newer goal is not disturbed when a client cancels its goal too."""

    async def story(world: World) -> None:
        asker, goal = await begun(world, cleaner := Cleaner(policy="preempt"))
        await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await goal.cancel()
        await asyncio.sleep(2.0)
        assert (cleaner.cancels, cleaner.cleaned) == (1, 1)

    simulate(story)


def test_stopping_while_a_body_cleans_up() -> None:
    """A node that stops leaves bodies alone that were cancelled before; they have their time."""

    async def story(world: World) -> None:
        _, goal = await begun(world, cleaner := Cleaner())
        await goal.cancel()
        await core_of(cleaner).stop()
        assert (cleaner.cancels, cleaner.cleaned) == (1, 1)

    simulate(story)


async def test_many_goals_at_once_for_a_queue(graph: Graph) -> None:
    """No more of them wait than may."""
    await graph.start(Cleaner(0.0, policy="queue"), asker := Asker())
    await asker.do.send_goal(Fibonacci.Goal())
    await graph.settle()
    goals = [asker.do.send_goal(Fibonacci.Goal()) for _ in range(40)]
    outcomes = await asyncio.gather(*goals, return_exceptions=True)

    assert sum(isinstance(outcome, GoalRejected) for outcome in outcomes) == 40 - RULES.queue_depth


def test_a_goal_sent_twice_while_the_server_decides() -> None:
    """Both requests get the same answer."""

    async def story(world: World) -> None:
        await world.start(Cleaner(accept=decide), operator := Operator(lambda _: None))
        request = SendGoal.Request(goal_id={"uuid": [7] * 16}, goal=Fibonacci.Goal())
        asked = [operator.sending.call(request) for _ in range(2)]
        answers = await asyncio.gather(*asked, return_exceptions=True)
        assert [getattr(answer, "accepted", answer) for answer in answers] == [True, True]

    simulate(story)


def test_a_client_that_dies_before_its_goal_is_accepted() -> None:
    """Its goal is cancelled too, where the server cancels those of clients that have gone."""

    async def story(world: World) -> None:
        await world.start(cleaner := Cleaner(accept=decide, on_client_loss="cancel"), asker := Asker())
        sending = asyncio.create_task(asker.do.send_goal(Fibonacci.Goal()))
        await asyncio.sleep(0.1)
        await world.kill(asker)
        await asyncio.gather(sending, return_exceptions=True)
        await asyncio.sleep(20.0)
        assert cleaner.at_work.book.active() == 0

    simulate(story)


async def test_a_thread_that_looks_late(graph: Graph) -> None:
    """A body in a thread is told that it is to end also when it looks after its time to clean up."""
    may_look, has_looked, told = threading.Event(), asyncio.Event(), list[bool]()

    class Blocking(Node):
        @action(Fibonacci, "do", thread=True, cleanup_timeout=2.0)
        def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            may_look.wait(20.0)
            told.append(goal.is_cancel_requested)
            self.context.loop.call_soon_threadsafe(has_looked.set)
            return Fibonacci.Result()

    graph.waits_outside = False
    await graph.start(Blocking(), asker := Asker())
    goal = await asker.do.send_goal(Fibonacci.Goal())
    await graph.settle()
    assert await goal.cancel()
    await graph.clock.advance(2.0)
    may_look.set()
    await has_looked.wait()

    assert told == [True]


def test_a_body_that_ends_when_its_goal_is_forgotten() -> None:
    """Nothing comes of it."""

    async def story(world: World) -> None:
        await world.start(Cleaner(1000.0, policy="parallel"), asker := Asker())
        goal = await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await goal.cancel()
        await asyncio.sleep(950.0)
        await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(100.0)

    assert background_errors(story) == []


def test_a_body_that_outlives_its_server() -> None:
    """A body that goes on when its node has stopped ends without an error in the background."""

    async def story(world: World) -> None:
        await world.start(cleaner := Cleaner(5.0), asker := Asker())
        await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await core_of(cleaner).stop()
        await asyncio.sleep(10.0)

    assert background_errors(story) == []


def test_a_request_that_arrives_when_its_server_has_stopped() -> None:
    """Its caller is told soon."""

    async def story(world: World) -> None:
        await world.start(cleaner := Cleaner(), asker := Asker())
        sending = asyncio.create_task(asker.do.send_goal(Fibonacci.Goal(), timeout=100.0))
        await asyncio.sleep(0.01)
        await core_of(cleaner).stop()
        await asyncio.gather(sending, return_exceptions=True)
        assert now() < 2.0

    assert background_errors(story, delay=(0.05, 0.05)) == []


def test_a_client_that_is_closed_while_a_block_is_left() -> None:
    """The block is left; whoever leaves it is not cancelled by that."""

    async def story(world: World) -> None:
        await world.start(Cleaner(), asker := Asker())

        async def ask() -> None:
            async with asker.do.send(Fibonacci.Goal()):
                pass

        asking = asyncio.create_task(ask())
        await asyncio.sleep(0.1)
        await core_of(asker).stop()
        await asyncio.wait([asking])
        assert not asking.cancelled()

    simulate(story)


def test_a_sender_that_is_cancelled_when_its_node_has_stopped() -> None:
    """It gets its CancelledError."""

    async def story(world: World) -> bool:
        await world.start(Cleaner(accept=decide), asker := Asker())
        sending = asyncio.create_task(asker.do.send_goal(Fibonacci.Goal()))
        await asyncio.sleep(0.1)
        await core_of(asker).stop()
        sending.cancel()
        await asyncio.gather(sending, return_exceptions=True)
        return sending.cancelled()

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # what it would do in the background is never awaited
        was_cancelled = simulate(story)
        gc.collect()
    assert was_cancelled


def test_states_that_overtake_each_other() -> None:
    """A client never sees a goal go back, from CANCELING to EXECUTING."""
    model = Model(Setting("parallel", None, "continue", 0.3, 0.0, True, 0))

    async def story(world: World) -> None:
        await world.start(Doer(model), asker := Asker())
        await asyncio.sleep(1.0)
        goal = await asker.do.send_goal(Fibonacci.Goal(order=model.new(Plan(ends="never")).n))
        await goal.cancel()
        await asyncio.sleep(1.0)

    with watched(model):
        for seed in range(20):
            model.lives.clear()
            simulate(story, seed, delay=(0.0, 0.3), reorders=True)
            path = model.seen[1].path
            assert all(after in FOLLOW[before] for before, after in zip(path, path[1:], strict=False))


def test_calls_where_messages_overtake_each_other() -> None:
    """A server that is alive is not lost."""

    async def story(world: World) -> None:
        await world.start(Stuck(), asker := Asker())
        calls = [asker.create_client(Trigger, "answer").call(Trigger.Request()) for _ in range(20)]
        await asyncio.gather(*calls)

    simulate(story, 1, delay=(0.0, 0.1), reorders=True)


def test_a_node_that_was_killed_is_silent() -> None:
    """What a simulated node does in its stopping, after its death, reaches nobody."""

    class Dying(Node):
        said = Publisher(Int32, "said")

        async def on_shutdown(self) -> None:
            self.said.publish(Int32(data=1))

    class Hearer(Node):
        heard = Subscription(Int32, "said")

    async def story(world: World) -> None:
        await world.start(dying := Dying(), hearer := Hearer())
        await asyncio.sleep(1.0)
        await world.kill(dying)
        await asyncio.sleep(1.0)
        assert hearer.heard.received == 0

    simulate(story)

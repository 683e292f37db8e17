"""Programs of steps that clients, servers and bystanders of an action take, held to the model at every step."""

from __future__ import annotations

import asyncio
from asyncio import CancelledError, Task
from collections.abc import Coroutine, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Literal

from hypothesis import event
from hypothesis import strategies as st

from graphflow import CallError, GoalAborted, GoalCanceled, GoalLost, GoalRejected, GoalStatus, Node
from graphflow.errors import ClosedError, GoalError
from graphflow.machines.goal import ALL_GOALS, CancelCode
from graphflow.msgs.action_msgs.msg import GoalStatusArray
from graphflow.msgs.action_msgs.srv import CancelGoal
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.runtime.actions.client import CANCEL_TIMEOUT, LOST_GRACE, RESULT_LONGEST
from graphflow.runtime.actions.server import RESULT_KEPT
from graphflow.runtime.node_core import core_of
from graphflow.testing.simulation import Seeded, World, simulate
from graphflow.times import NANOSECONDS
from tests.runtime.action_model import (
    ABORTED,
    ACCEPTED,
    BARE,
    CANCELED,
    CANCELING,
    CLEANUP,
    DEPTH,
    EXECUTING,
    FOLLOW,
    LOST,
    MOMENT,
    RULES,
    SUCCEEDED,
    Asker,
    Book,
    Doer,
    GetResult,
    Life,
    Model,
    Operator,
    Plan,
    SeenGoal,
    SendGoal,
    Setting,
    now,
    watched,
)


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

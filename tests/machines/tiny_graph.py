"""A graph so small that all its futures can be tried: the slow and obvious twin of `machines.waits`.

Handlers (services and timers) run under groups, behind themselves, or both; tasks hold no slot. What a run does is a
finite list of steps: ask services, rest, await tasks, all or any of these; with its slot or without it meanwhile, or
without awaiting, so that it blocks the event loop of its process. The rules are those of the runtime: a request stands
in the queue of its handler; the head of a queue begins when there is a slot; the run holds it until its steps are
done, and then the request is answered. Slots go to whoever wants one, in any order: more may happen here than where
tickets are kept, and no less.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from typing import NamedTuple

from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    GroupView,
    Join,
    QueueView,
    Slot,
    WaitGraph,
)

# What is to be done


@dataclass(frozen=True, slots=True)
class Rest:
    """Wait for something outside of the graph."""


@dataclass(frozen=True, slots=True)
class Ask:
    """Call a service; `steps` is what its handler does for this request."""

    service: int
    steps: tuple[Step, ...] = ()


@dataclass(frozen=True, slots=True)
class Meet:
    """Await one of the tasks."""

    task: int


@dataclass(frozen=True, slots=True)
class Both:
    """Await all of them."""

    of: tuple[Work, ...]


@dataclass(frozen=True, slots=True)
class Either:
    """Await one of them, whichever is first."""

    of: tuple[Work, ...]


Work = Rest | Ask | Meet | Both | Either


@dataclass(frozen=True, slots=True)
class Step:
    """One suspension of a handler."""

    work: Work
    released: bool = False
    """Without its slot, which it takes again afterwards."""
    blocks: bool = False
    """It keeps the event loop of its process meanwhile."""


Steps = tuple[Step, ...]


@dataclass(frozen=True, slots=True)
class Handler:
    """A service or a timer."""

    group: int | None
    """None: it queues behind itself only."""
    process: int = 0
    alone: bool = False
    """It queues behind itself too where its group allows more, as an action does."""


@dataclass(frozen=True, slots=True)
class System:
    """A graph before its start."""

    limits: tuple[int, ...]
    """Of the groups."""
    services: tuple[Handler, ...]
    timers: tuple[tuple[Handler, Steps], ...] = ()
    """Each is due once, from the start."""
    tasks: tuple[tuple[int, Steps], ...] = ()
    """Process, and what to do."""


# What has been done


class Run(NamedTuple):
    """A run under way: `id` is also the name of the request that it answers."""

    id: str
    step: int
    wait: Condition
    holds: tuple[str, ...]
    """The groups of which it holds a slot."""
    blocks: bool


class State(NamedTuple):
    """Everything that changes."""

    runs: tuple[Run, ...]
    queues: tuple[tuple[str, ...], ...]
    """Ids of requests, by handler."""


class _Stage(NamedTuple):
    """A step with all names made: nothing is made up while a graph runs, so equal states are equal values."""

    wait: Condition
    asks: tuple[tuple[int, str], ...]
    """Handler and id of each request."""
    released: bool
    blocks: bool


class TinyGraph:
    """The rules, for one system."""

    def __init__(self, system: System) -> None:
        self._handlers = [*system.services, *(handler for handler, _ in system.timers)]
        self._limits = {f"group{i}": limit for i, limit in enumerate(system.limits)}
        self._needs: dict[str, tuple[str, ...]] = {}
        """The groups under which a request is handled, by its id; none for tasks."""
        self._process: dict[str, str] = {}
        self._stages: dict[str, tuple[_Stage, ...]] = {}
        for i, handler in enumerate(self._handlers):
            if handler.group is None or handler.alone:
                self._limits[f"own{i}"] = 1
        for i, (process, steps) in enumerate(system.tasks):
            self._name(f"task{i}", (), process, steps)
        for i, (_, steps) in enumerate(system.timers, len(system.services)):
            self._name_request(f"tick{i}", i, steps)
        self.start = State(
            tuple(Run(f"task{i}", -1, FREE, (), False) for i in range(len(system.tasks))),
            tuple((f"tick{i}",) if i >= len(system.services) else () for i in range(len(self._handlers))),
        )

    def _name_request(self, id_: str, handler: int, steps: Steps) -> None:
        self._name(id_, self._groups(handler), self._handlers[handler].process, steps)

    def _name(self, id_: str, needs: tuple[str, ...], process: int, steps: Steps) -> None:
        self._needs[id_], self._process[id_] = needs, f"process{process}"
        stages = []
        for i, step in enumerate(steps):
            asks: list[tuple[int, str]] = []
            wait = self._condition(step.work, f"{id_}.{i}", asks)
            stages.append(_Stage(wait, tuple(asks), step.released and needs != (), step.blocks))
        self._stages[id_] = tuple(stages)

    def _condition(self, work: Work, id_: str, asks: list[tuple[int, str]]) -> Condition:
        match work:
            case Rest():
                return FREE
            case Meet(task=task):
                return Join(f"task{task}")
            case Ask(service=service, steps=steps):
                asks.append((service, id_))
                self._name_request(id_, service, steps)
                return Call(id_, f"service{service}")
            case Both(of=works):
                return All(tuple(self._condition(w, f"{id_}{i}", asks) for i, w in zip("abcdef", works, strict=False)))
            case Either(of=works):
                return AnyOf(
                    tuple(self._condition(w, f"{id_}{i}", asks) for i, w in zip("abcdef", works, strict=False))
                )

    def _groups(self, handler: int) -> tuple[str, ...]:
        """The groups of which a run takes a slot; it can release that of the first."""
        group, alone = self._handlers[handler].group, self._handlers[handler].alone
        own = () if group is not None and not alone else (f"own{handler}",)
        return own if group is None else (f"group{group}", *own)

    # the rules

    def moves(self, state: State, *, may_end: bool = False, may_fail: bool = False) -> Iterator[tuple[str, State]]:
        """Everything that may happen next: who takes a step (empty: a run begins), and what comes of it.

        Args:
            may_end: Whoever takes a step may also end with it, whatever it has left to do.
            may_fail: What ends may end with an error, and so end a wait for all of several.
        """
        taken = Counter(group for run in state.runs for group in run.holds)
        unfinished = {run.id for run in state.runs}.union(*state.queues)
        blockers = {self._process[run.id]: run for run in state.runs if run.blocks}
        for run in state.runs:
            blocker = blockers.get(self._process[run.id], run)
            if blocker is run and self._is_met(run, taken, unfinished, any if may_fail else all):
                others = State(tuple(r for r in state.runs if r is not run), state.queues)
                yield run.id, self._step(others, run)
                if may_end:
                    yield run.id, others
        for handler, queue in enumerate(state.queues):
            process, needs = f"process{self._handlers[handler].process}", self._groups(handler)
            if queue and process not in blockers and all(taken[group] < self._limits[group] for group in needs):
                rest = State(state.runs, (*state.queues[:handler], queue[1:], *state.queues[handler + 1 :]))
                yield "", self._step(rest, Run(queue[0], -1, FREE, needs, False))
                if may_end:
                    yield "", rest

    def _is_met(
        self, run: Run, taken: Counter[str], unfinished: set[str], all_of: Callable[[Iterable[bool]], bool]
    ) -> bool:
        def holds(condition: Condition) -> bool:
            match condition:
                case Call(id=id_) | Join(activity=id_):
                    # Whoever blocks the loop hears of nothing that comes through it.
                    return id_ not in unfinished and not run.blocks
                case Slot(group=group):
                    return taken[group] < self._limits[group]
                case All(of=conditions):
                    return all_of(holds(c) for c in conditions)
                case AnyOf(of=conditions):
                    return any(holds(c) for c in conditions)
                case _:
                    return True

        return holds(run.wait)

    def _step(self, others: State, run: Run) -> State:
        """Have a run go on to its next suspension, or to its end."""
        needs = self._needs[run.id]
        if run.holds != needs and not isinstance(run.wait, Slot):
            return _with(others, run._replace(wait=Slot(needs[0], 0)))
        step = run.step + 1
        if step == len(self._stages[run.id]):
            return others
        wait, asks, released, blocks = self._stages[run.id][step]
        queues = list(others.queues)
        for handler, id_ in asks:
            queues[handler] = (*queues[handler], id_)
        holds = needs[1:] if released else needs
        return _with(State(others.runs, tuple(queues)), Run(run.id, step, wait, holds, blocks))

    def picture(self, state: State) -> WaitGraph:
        """What graphflow would see."""
        activities = (
            ActivityView(run.id, run.id, "/n", run.holds, run.wait, run.id, process=self._process[run.id])
            for run in state.runs
        )
        queues = (
            QueueView(
                f"queue{i}", f"handler{i}", "/n", self._groups(i), ids, process=f"process{self._handlers[i].process}"
            )
            for i, ids in enumerate(state.queues)
        )
        return WaitGraph(
            {a.id: a for a in activities},
            {name: GroupView(name, name, "/n", limit) for name, limit in self._limits.items()},
            {q.id: q for q in queues},
            {self._process[run.id]: run.id for run in state.runs if run.blocks},
        )


def _with(state: State, run: Run) -> State:
    return State(tuple(sorted((*state.runs, run), key=lambda r: r.id)), state.queues)


def stuck_for_ever(
    graph: TinyGraph, state: State, known: AbstractSet[str] = frozenset(), *, may_fail: bool = False
) -> set[str]:
    """The runs that take no further step in any future, found by trying every one.

    What has not happened yet is unknown to a picture. So a run that goes on, and one that begins, may do here what its
    steps say, or end at once; with `may_fail`, by an error too.

    Args:
        known: Who was found at an earlier moment of the same graph, and so need not be found again.
    """
    still = {run.id for run in state.runs} - known
    seen, todo = {state}, [state]
    while todo and still:
        for who, after in graph.moves(todo.pop(), may_end=True, may_fail=may_fail):
            still.discard(who)
            if after not in seen:
                seen.add(after)
                todo.append(after)
    return still | known

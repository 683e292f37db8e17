"""A node's groups by name, where a graph file's word counts most, and the slots that runs hand over, give and take."""

from __future__ import annotations

import asyncio
from asyncio import CancelledError
from collections import deque
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from graphflow.errors import DeclarationError
from graphflow.executor.groups import Groups, HandlerGroup, Placement
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.interface import NO_GROUP, GroupChange
from graphflow.machines.regrouping import Regrouping
from graphflow.runtime.declarations.declare import Group
from graphflow.testing.clock import settle


class Waits:
    """Queues for a slot, and remembers of which group it got one."""

    def __init__(self) -> None:
        self.slots: list[HandlerGroup] = []

    def granted(self, group: HandlerGroup) -> None:
        self.slots.append(group)

    def yields(self) -> None:
        """Do nothing."""

    def wake(self) -> None:
        """Do nothing."""


def full(limit: int, waiting: int) -> tuple[HandlerGroup, list[Waits]]:
    """Return a full group and its waiters."""
    group = HandlerGroup(limit, "motion")
    for _ in range(limit):
        assert group.admit(Waits())
    queue = [Waits() for _ in range(waiting)]
    assert not any(map(group.admit, queue))
    return group, queue


# slots


async def test_a_slot_passes_to_who_has_waited_longest(graphflow_runner: asyncio.Runner) -> None:
    """At the loop's next turn, and not inside of the run that ends."""
    group, [first, second] = full(1, waiting=2)

    group.give_back(asyncio.get_running_loop())
    assert first.slots == []
    await settle()

    assert (first.slots, second.slots) == ([group], [])
    assert group.running == 1


async def test_a_slot_that_nobody_wants_is_free(graphflow_runner: asyncio.Runner) -> None:
    """It stays free."""
    group, _ = full(1, waiting=0)

    group.give_back(asyncio.get_running_loop())

    assert group.running == 0


@pytest.mark.parametrize(("limit", "more"), [(3, 2), (None, 3), (1, 0)])
async def test_another_limit(graphflow_runner: asyncio.Runner, limit: int | None, more: int) -> None:
    """A larger limit admits waiters at once, in order; a smaller one does not end runs."""
    group, queue = full(1, waiting=3)

    group.set_limit(limit, asyncio.get_running_loop())
    await settle()

    assert [len(waits.slots) for waits in queue] == [1] * more + [0] * (3 - more)
    assert group.running == 1 + more


async def test_another_limit_for_a_handler_that_holds_all_slots(graphflow_runner: asyncio.Runner) -> None:
    """It has no ticket for more than there were, and runs again nevertheless."""
    group, gate = HandlerGroup(1, "motion"), asyncio.Event()

    async def body(_: Any) -> None:
        await gate.wait()

    made, ended = runner(group, body, 1, 2, 3)
    await settle()
    assert len(made.active) == 1

    group.set_limit(2, asyncio.get_running_loop())
    await settle()
    assert (len(made.active), len(made.items)) == (2, 1)
    gate.set()
    await settle()
    assert ended == [None, None, None]


# `released`


def runner(group: HandlerGroup, body: Callable[[Any], Awaitable[None]], *items: Any) -> tuple[Runner, list[Any]]:
    """A handler of a group with work to do, and how its runs ended."""
    ended: list[Any] = []
    loop = asyncio.get_running_loop()
    spec = RunnerSpec("handler", body, lambda _, __, error: ended.append(error))
    made = Runner(Ledger(loop), spec, deque(items), group)
    loop.call_soon(made.wake)
    return made, ended


async def test_a_slot_is_released_for_a_while(graphflow_runner: asyncio.Runner) -> None:
    """Other runs may use it, even of the same handler; the run queues behind the waiters."""
    group, gate, log = HandlerGroup(1, "motion"), asyncio.Event(), list[str]()

    async def body(item: str) -> None:
        if item == "first":
            async with group.released():
                log.append("away")
                await gate.wait()
        log.append(item)

    bench, ended = runner(group, body, "first", "second")
    await settle()
    assert log == ["away", "second"]
    gate.set()
    await settle()

    assert log == ["away", "second", "first"]
    assert ended == [None, None]
    assert group.running == 0
    assert not bench.active


async def test_the_way_back_is_known(graphflow_runner: asyncio.Runner) -> None:
    """The search sees which group a run waits to return to, and that the run has no slot; the wait raises an alert."""
    group, alerts = HandlerGroup(1, "motion"), list[str]()

    async def body(_: object) -> None:
        async with group.released():
            assert group.admit(Waits())  # somebody is quicker

    bench, _ = runner(group, body, 0)
    bench._ledger.alert = lambda: alerts.append("looked")
    await settle()

    [run] = bench.active
    assert (run.group, run.returning_to) == (None, group)
    assert alerts == ["looked"]
    group.give_back(asyncio.get_running_loop())
    await settle()
    assert not bench.active


async def test_a_cancelled_run_comes_back_first(graphflow_runner: asyncio.Runner) -> None:
    """It waits for its slot before it cleans up, however often it is cancelled, and is cancelled then."""
    group, log = HandlerGroup(1, "motion"), list[str]()

    async def body(_: object) -> None:
        try:
            async with group.released():
                assert group.admit(Waits())
                await asyncio.Event().wait()
        finally:
            log.append(f"cleans up with {group.running} slot taken")

    bench, ended = runner(group, body, 0)
    await settle()
    [run] = bench.active
    for _ in range(2):
        run.cancel()
        await settle()
    assert log == []
    group.give_back(asyncio.get_running_loop())
    await settle()

    assert log == ["cleans up with 1 slot taken"]
    assert isinstance(ended[0], CancelledError)
    assert group.running == 0


async def test_who_may_release(graphflow_runner: asyncio.Runner) -> None:
    """Neither a task that is no run, nor a run of another group."""
    group, other = HandlerGroup(1, "motion"), HandlerGroup(1, "other")

    async def body(_: object) -> None:
        async with group.released():
            """Not reached."""

    with pytest.raises(RuntimeError, match="group 'motion' cannot be released here"):
        await body(0)
    _, ended = runner(other, body, 0)
    await settle()
    assert "group 'motion' cannot be released here" in str(ended[0])


async def test_statistics(graphflow_runner: asyncio.Runner) -> None:
    """They count slots, members that wait, and all members' runs and errors."""
    group = HandlerGroup(2, "motion")

    async def body(item: str) -> None:
        if item == "fails":
            raise ValueError
        await asyncio.Event().wait()

    runner(group, body, "fails", "stays")
    runner(group, body, "stays", "waits")
    await settle()

    assert group.statistics() == {"limit": 2, "running": 2, "waiting": 1, "runs": 3, "errors": 1}


# where handlers run


def groups(default: Group | None = None, **changes: GroupChange) -> tuple[Groups, dict[str, Group]]:
    """A node's groups whose class declares two, and a graph file changes some."""
    declared = {"motion": Group(2, thread=True, name="motion"), "sense": Group(1, "drop_old", name="sense")}
    return Groups(declared, default, Regrouping(changes)), declared


def test_declared_groups() -> None:
    """Each becomes one group at work, with all that was declared of it."""
    made, declared = groups()

    motion, sense = (made.at_work(group) for group in declared.values())
    assert made.by_name == {"motion": motion, "sense": sense}
    assert (motion.limit, motion.when_full, motion.is_threaded) == (2, "wait", True)
    assert (sense.limit, sense.when_full, sense.is_threaded) == (1, "drop_old", False)
    assert made.at_work(motion) is motion
    assert made.known == {"motion", "sense"}


def test_where_a_handler_runs() -> None:
    """In the group that it declares, else in the default one, else in none."""
    default = Group(1, name="rest")
    made, declared = groups(default)

    assert made.place("on_go", declared["motion"]) == Placement(made.by_name["motion"], is_threaded=True)
    assert made.place("on_scan", None) == Placement(made.by_name["rest"])
    assert groups()[0].place("on_scan", None) == Placement(None)


def test_the_word_of_a_graph_file() -> None:
    """It assigns handlers to groups, new ones too, and removes them from groups, whatever the class declares."""
    changes = {"sense": GroupChange(("on_go",)), "new": GroupChange(("on_scan",)), NO_GROUP: GroupChange(("on_odom",))}
    made, declared = groups(Group(1), **changes)

    placed = {name: made.place(name, declared["motion"]).group for name in ("on_go", "on_scan", "on_odom", "tick")}
    by_name = made.by_name
    assert placed == {"on_go": by_name["sense"], "on_scan": by_name["new"], "on_odom": None, "tick": by_name["motion"]}
    assert (by_name["new"].limit, NO_GROUP in by_name) == (1, False)
    assert made.known == {"motion", "sense", "new", NO_GROUP}


@pytest.mark.parametrize(
    ("change", "limit", "when_full", "is_threaded"),
    [
        (GroupChange(), 2, "wait", True),
        (GroupChange(limit=5, sets_limit=True), 5, "wait", True),
        (GroupChange(limit=None, sets_limit=True), None, "wait", True),
        (GroupChange(when_full="drop_new"), 2, "drop_new", True),
        (GroupChange(thread=False), 2, "wait", False),
    ],
)
def test_what_a_graph_file_changes(change: GroupChange, limit: int | None, when_full: str, is_threaded: bool) -> None:
    """Only its entries differ from the declaration."""
    motion = groups(motion=change)[0].by_name["motion"]

    assert (motion.limit, motion.when_full, motion.is_threaded) == (limit, when_full, is_threaded)


def test_a_handler_in_two_groups() -> None:
    """It can be in one."""
    with pytest.raises(DeclarationError, match="on_go is put in two groups, 'motion' and 'sense'"):
        groups(motion=GroupChange(("on_go",)), sense=GroupChange(("on_go",)))


def test_a_handler_that_there_is_not() -> None:
    """A graph file that names one is refused, with the nearest of those there are, once they are all made."""
    made, _ = groups(motion=GroupChange(("on_goo",)))
    made.place("on_go", None)

    with pytest.raises(DeclarationError, match=r"group 'motion' names 'on_goo', which is not a handler .*on_go"):
        made.refuse_strays()
    made.place("on_goo", None)
    made.refuse_strays()


def test_groups_made_in_passing() -> None:
    """Each declaration is a group of its own, and no two have one name."""
    made, _ = groups()
    one, two, named = Group(1), Group(1), Group(1, name="motion")

    found = [made.at_work(group) for group in (one, two, named, one)]
    assert [group.name for group in found] == ["group_1", "group_2", "motion_3", "group_1"]
    assert found[3] is found[0]
    assert all(made.by_name[group.name] is group for group in found)


def test_a_group_by_its_name() -> None:
    """It is made if there is none; the word for none means none, and other words are refused."""
    made, _ = groups()

    assert made.named("motion") is made.by_name["motion"]
    assert made.named("fresh") is made.named("fresh") is made.by_name["fresh"]
    assert made.named(NO_GROUP) is None
    with pytest.raises(DeclarationError, match="'two words' is not a group name"):
        made.named("two words")

"""Which waits are deadlocks: by hand, and against every future of thousands of tiny graphs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from random import Random

import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Edge, explained
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Condition,
    GroupView,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
    joined,
)
from tests.cases import cases, count, limit, slow
from tests.machines.pictures import BACKGROUND, DEAD, LIVE, call, circle, group, picture, queue, run, waits_for_itself
from tests.machines.tiny_graph import (
    Ask,
    Both,
    Either,
    Handler,
    Meet,
    Rest,
    State,
    Step,
    Steps,
    System,
    TinyGraph,
    Work,
    stuck_for_ever,
)

CASES = count(few=60, full=1000)
"""Tiny graphs that are tried."""


# Calls and slots


def test_a_call_of_its_own_group() -> None:
    """A run that calls a service of its own mutex group waits for itself."""
    seen = picture(run("tick", call("add"), holds="g"), group("g"), queue("add", "g", "add"))

    assert deadlocked(seen) == {"tick"}
    (found,) = explained(seen, {"tick"})
    assert found.ring == ("tick",)
    assert found.edges == (Edge("tick", call("add"), queue="add", group="g"),)
    assert (found.victims, found.is_likely, found.is_partial) == ((), False, False)


def test_a_call_of_another_group() -> None:
    """The same call under a group of its own can be answered."""
    assert not deadlocked(
        picture(run("tick", call("add"), holds="g"), group("g"), group("h"), queue("add", "h", "add"))
    )


ASKED = replace(call("add"), servers=2)
KEPT_OUT = queue("add", "g", "add")


@pytest.mark.parametrize(
    ("servers", "is_dead"),
    [
        ((KEPT_OUT, queue("other", "g", "add")), True),
        ((KEPT_OUT, run("server", call("back"), serves="add"), queue("back", "g", "back")), True),
        ((KEPT_OUT,), False),
        ((KEPT_OUT, queue("other", "h", "add"), group("h")), False),
        ((KEPT_OUT, run("server", serves="add")), False),
        ((run("server", serves="add"), replace(KEPT_OUT, label="reply /add")), True),
    ],
    ids=["both kept out", "one calls back", "one is not seen", "one is free", "one works", "the answer is kept out"],
)
def test_a_call_that_two_servers_have(
    servers: Sequence[ActivityView | GroupView | QueueView], *, is_dead: bool
) -> None:
    """Each may answer; an answer that has come must be let in."""
    seen = picture(run("tick", ASKED, holds="g"), group("g"), *servers)

    assert ("tick" in deadlocked(seen)) is is_dead
    assert bool(explained(seen, deadlocked(seen))) is is_dead


@pytest.mark.parametrize("length", [2, 3])
def test_nodes_that_call_each_other(length: int) -> None:
    """Two nodes that cross, and three in a circle, are dead; the ring goes once round."""
    seen = circle(length)

    everybody = [f"tick{i}" for i in range(length)]
    assert deadlocked(seen) == set(everybody)
    (found,) = explained(seen, deadlocked(seen))
    assert list(found.ring) == everybody
    assert [edge.to for edge in found.edges] == [*everybody[1:], everybody[0]]
    assert found.victims == ()


@pytest.mark.parametrize("missing", ["tick1", "g1", "service1"])
def test_an_open_circle_is_no_ring(missing: str) -> None:
    """A run that ended, a group that nobody holds, a request that was taken: each opens the circle."""
    seen = circle(3)

    left = [t for part in (seen.activities, seen.groups, seen.queues) for t in part.values() if t.id != missing]
    assert not deadlocked(picture(*left))


@pytest.mark.parametrize(("depth", "dead"), [(1, set()), (2, {"tick", "run1"})])
def test_recursion_against_the_limit(depth: int, dead: set[str]) -> None:
    """With two slots a handler may call its own group once, but not twice."""
    runs = [run("tick", call("call0"), holds="g"), run("run1", call("call1"), holds="g", serves="call0")]

    seen = picture(*runs[:depth], group("g", 2), queue("again", "g", f"call{depth - 1}"))

    assert deadlocked(seen) == dead


def test_fewer_holders_than_the_limit() -> None:
    """A slot that nobody holds is free, even if those who hold the others are dead."""
    runs = [run("a", call("c"), holds="g"), run("b", call("stuck_call"), holds="g")]
    stuck = (*BACKGROUND, queue("s", "g", "c"))

    assert deadlocked(picture(*stuck, *runs, group("g", 3))) == {"stuck", "waits_on_stuck", "b"}
    assert deadlocked(picture(*stuck, *runs, group("g", 2))) == {"stuck", "waits_on_stuck", "b", "a"}


def test_a_group_without_limit() -> None:
    """Nobody waits for a slot of a group that has no limit."""
    assert not deadlocked(picture(run("tick", call("add"), holds="g"), group("g", None), queue("add", "g", "add")))


def test_a_slot_that_a_live_run_holds() -> None:
    """One of several holders that can go on is enough for all who want a slot."""
    things = (run("a", call("c"), holds="g"), group("g", 2), queue("s", "g", "c", "d"), run("b", call("d")))

    assert not deadlocked(picture(*things, run("busy", holds="g")))
    assert deadlocked(picture(*things, run("lazy", call("d"), holds="g"))) == {"a", "b", "lazy"}


def test_a_handler_behind_itself() -> None:
    """A handler without a group takes its requests one by one: to call itself is to wait for itself."""
    own = GroupView("own", "", "/node", 1)
    seen = picture(run("add", call("again"), holds="own", serves="first"), own, queue("s", "own", "again"))

    assert deadlocked(seen) == {"add"}
    (found,) = explained(seen, {"add"})
    assert found.ring == ("add",)


def test_a_handler_of_a_group_behind_itself() -> None:
    """A run that needs two slots needs both: its group's, and the handler's own; a run that holds two keeps both."""
    groups = group("g", 2), GroupView("own", "", "/node", 1)
    server = QueueView("s", "action s", "/node", ("g", "own"), ("c",), 1)
    asks = run("asks", call("c"), serves="answer")

    for held in (("own",), ("g", "own")):
        holder = ActivityView("holder", "action s", "/node", held, call("answer"))
        assert deadlocked(picture(asks, holder, server, *groups)) == {"asks", "holder"}
    assert not deadlocked(picture(asks, run("holder", call("answer"), holds="g"), server, *groups))
    both = run("one", call("answer"), holds="g"), run("two", call("answer"), holds="g")
    assert deadlocked(picture(asks, *both, server, *groups)) == {"asks", "one", "two"}


def test_the_way_back_to_a_group() -> None:
    """Who has released its slot waits, to take it again, for those who hold the group now."""
    comes_back = run("a", Slot("g", 7), serves="c")

    assert deadlocked(picture(comes_back, group("g"), run("b", call("c"), holds="g"))) == {"a", "b"}
    assert deadlocked(picture(comes_back, group("g"), run("b", holds="g"))) == set()
    assert deadlocked(picture(comes_back, group("g"))) == set()


def test_a_service_that_is_not_there_yet() -> None:
    """It opens when nothing keeps out the handler of one of those who will offer it."""
    start, waits = group("start"), run("on_start", Opening("/add"), holds="start")
    here, there = (replace(queue(name, f"{name}_start"), opens=("/add",)) for name in ("here", "there"))
    mine = replace(queue("mine", "start"), opens=("/add",))

    assert deadlocked(picture(waits, start, mine)) == {"on_start"}
    assert deadlocked(picture(waits, start, mine, there)) == set()
    assert deadlocked(picture(waits, start)) == set()
    assert deadlocked(picture(waits, start, here, run("b", holds="here_start"), group("here_start"))) == set()


# Other waits


@pytest.mark.parametrize(
    ("wait", "dead"),
    [
        (All((DEAD, LIVE)), True),
        (All((LIVE, LIVE)), False),
        (All(()), False),
        (AnyOf((DEAD, LIVE)), False),
        (AnyOf((DEAD, DEAD)), True),
        (AnyOf((DEAD, FREE)), False),
        (All((AnyOf((DEAD, LIVE)), LIVE)), False),
        (All((AnyOf((DEAD, DEAD)), LIVE)), True),
        (AnyOf((All((DEAD, LIVE)), DEAD)), True),
        (Join("waits_on_stuck"), True),
        (Join("busy"), False),
    ],
)
def test_waits_for_several_and_for_tasks(wait: Condition, dead: bool) -> None:
    """All is dead with one of its parts, AnyOf with every one; the end of a task is dead with the task."""
    assert ("me" in deadlocked(picture(*BACKGROUND, run("me", wait)))) is dead


def test_tasks_that_await_each_other() -> None:
    """Joins make rings as calls do."""
    seen = picture(run("a", Join("b")), run("b", Join("c")), run("c", Join("a")), run("d", Join("a")))

    (found,) = explained(seen, deadlocked(seen))
    assert set(found.ring) == {"a", "b", "c"}
    assert found.victims == ("d",)
    assert not found.is_likely


def test_a_setter_that_cannot_run() -> None:
    """Who waits for a flag, and keeps the slot that every handler needs which sets it, is likely dead."""
    arrived = SetBy("self.arrived", ("on_scan", "on_odom"))
    seen = picture(run("tick", arrived, holds="g"), group("g"), queue("on_scan", "g"), queue("on_odom", "g"))

    assert deadlocked(seen) == {"tick"}
    (found,) = explained(seen, {"tick"})
    assert found.edges == (Edge("tick", arrived, queue="on_scan", group="g"),)
    assert found.is_likely


@pytest.mark.parametrize(
    ("wait", "dead"),
    [
        (SetBy("it", ("needs_g",)), True),
        (SetBy("it", ("needs_g", "needs_h")), False),
        (SetBy("it", ("needs_g",), ("busy",)), False),
        (SetBy("it", ("needs_g",), ("stuck",)), True),
        (SetBy("it", (), ("stuck",)), True),
        (SetBy("it", (), ("busy",)), False),
    ],
)
def test_setters(wait: SetBy, dead: bool) -> None:
    """One handler that may run, or one task that may go on, is enough for a flag to be set."""
    things = (group("g"), group("h"), queue("needs_g", "g"), queue("needs_h", "h"))
    seen = picture(*BACKGROUND, *things, run("me", wait, holds="g"))

    assert ("me" in deadlocked(seen)) is dead


def test_a_task_that_sets() -> None:
    """A task is in a ring with whoever waits for what only it sets."""
    seen = picture(run("a", SetBy("self.arrived", (), ("b",)), age=9.0), run("b", Join("a")))

    (found,) = explained(seen, deadlocked(seen))
    assert found.ring == ("a", "b")
    assert found.is_likely


def test_a_reply_that_finds_no_slot() -> None:
    """An answer that queues for the group of the run that waits for it never comes."""
    reply = QueueView("q", "reply add", "/node", ("g",), ("add",), 1)

    assert deadlocked(picture(run("tick", call("add"), holds="g"), group("g"), reply)) == {"tick"}


@pytest.mark.parametrize(
    "wait",
    [
        FREE,
        call("unheard_of"),
        Slot("unheard_of", 1),
        Join("unheard_of"),
        SetBy("it", ("unheard_of",)),
        SetBy("it", ("needs_g", "unheard_of")),
        SetBy("it", ("needs_g",), ("unheard_of",)),
        call("queued_for_an_unknown_group"),
    ],
)
def test_what_the_picture_does_not_show(wait: Condition) -> None:
    """Calls, groups, handlers and runs outside of the picture may do anything: whoever waits for them is not dead."""
    queues = queue("needs_g", "g"), queue("elsewhere", "unheard_of", "queued_for_an_unknown_group")

    assert not deadlocked(picture(run("me", wait, holds="g"), group("g"), *queues))


# Blocked event loops


def test_a_blocked_loop() -> None:
    """Nobody goes on in a process whose loop is blocked for ever; others do, and all do if the loop may come free."""
    waits_in_vain = (*waits_for_itself("blocker"), run("same", process="p"), run("other", process="q"))
    seen = picture(*waits_in_vain, blocked={"p": "blocker"})

    assert deadlocked(seen) == {"blocker", "same"}
    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.victims) == (("blocker",), ("same",))

    assert not deadlocked(picture(run("blocker", process="p"), run("same", call("c"), process="p"), blocked={"p": "b"}))


def test_a_call_that_blocks_its_own_loop() -> None:
    """What waits for an answer and keeps the loop that has to receive it waits for itself, whoever serves."""
    blocker = run("blocker", call("c"), process="p")
    here, there = queue("s", "g", "c", process="p"), queue("s", "g", "c", process="q")

    for server in (here, there, run("server", serves="c", process="q")):
        seen = picture(blocker, group("g"), server, blocked={"p": "blocker"})
        assert deadlocked(seen) == {"blocker"}
        (found,) = explained(seen, {"blocker"})
        assert found.ring == ("blocker",)
        assert found.edges[0].loop


def test_a_loop_blocked_by_somebody_unknown() -> None:
    """Who blocks a loop and is not in the picture may come to an end."""
    seen = picture(run("asks", call("d")), group("g"), queue("s", "g", "d", process="p"), blocked={"p": "unheard_of"})

    assert not deadlocked(seen)


@pytest.mark.parametrize("wait", [call("d"), SetBy("self.arrived", ("s",))])
def test_a_request_for_a_blocked_loop(wait: Condition) -> None:
    """No handler begins where the loop is blocked for ever, whatever slots are free."""
    asks = run("asks", wait, process="q")
    there = (run("blocker", call("c"), process="p"), group("g"), queue("s", "g", "d", process="p"))

    seen = picture(asks, *there, blocked={"p": "blocker"})
    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.victims) == (("blocker",), ("asks",))
    assert deadlocked(picture(asks, *there)) == set()


# Nobody is dead


def test_waits_for_nothing() -> None:
    """A wait for one of nothing, or for what nobody is known to set, is over or unknown: it is no deadlock."""
    assert not deadlocked(picture(run("a", AnyOf(())), run("b", SetBy("self.arrived", ()))))


def test_nobody_is_dead() -> None:
    """There is nothing to explain in an empty picture, nor where everybody goes on."""
    assert deadlocked(WaitGraph()) == set()
    assert explained(picture(run("busy")), set()) == []


# Two pictures


def test_the_same_wait_in_two_pictures() -> None:
    """What was seen twice in the same wait is dead."""
    assert deadlocked(circle(3), circle(3)) == {"tick0", "tick1", "tick2"}


@pytest.mark.parametrize(
    "change",
    [
        lambda tick: replace(tick, wait=call("another")),
        lambda tick: replace(tick, holds=()),
        lambda tick: replace(tick, serves="another"),
        lambda tick: replace(tick, id="another"),
    ],
)
def test_a_wait_that_has_changed(change: Callable[[ActivityView], ActivityView]) -> None:
    """A ring of which one member was elsewhere before is a phantom: it never existed at one moment."""
    now = circle(3)
    others = [tick for name, tick in now.activities.items() if name != "tick1"]
    before = replace(now, activities=picture(*others, change(now.activities["tick1"])).activities)

    assert deadlocked(now, before) == set()
    assert deadlocked(now) == {"tick0", "tick1", "tick2"}


def test_what_only_ages_is_the_same_wait() -> None:
    """Time, place and label do not tell one wait from another."""
    now = circle(2)
    younger = {name: replace(tick, age=9.0, left=1.0, label="x") for name, tick in now.activities.items()}

    assert deadlocked(now, replace(now, activities=younger)) == {"tick0", "tick1"}


# Every future of tiny graphs


ALONE = st.sampled_from([*["ask"] * 6, "both", "either", "rest", "meet"])
TOGETHER = st.sampled_from(["ask", "ask", "rest", "meet"])
MEANWHILE = st.sampled_from([*["keeps"] * 8, "releases", "releases", "blocks"])


@st.composite
def systems(draw: st.DrawFn) -> System:
    """Up to 4 services, 4 timers and 2 tasks in two processes, with up to 7 requests in all.

    Limits of 1 are twice as likely as others, and few handlers share few groups: most of these graphs get stuck.
    """
    limits = tuple(draw(st.lists(st.sampled_from([1, 1, 2, 3]), min_size=1, max_size=3)))
    homes = [Handler(i, draw(st.integers(0, 1))) for i in range(len(limits))]
    alone = [replace(home, alone=True) for home in homes]
    handlers = st.sampled_from([*homes, *homes, *alone, Handler(None, 0), Handler(None, 1)])
    services = tuple(draw(st.lists(handlers, min_size=1, max_size=4)))
    callees, tasks, requests = st.integers(0, len(services) - 1), draw(st.integers(0, 2)), 7

    def work(depth: int, kinds: st.SearchStrategy[str]) -> Work:
        nonlocal requests
        match draw(kinds):
            case "both":
                return Both(several(depth))
            case "either":
                return Either(several(depth))
            case "meet" if tasks:
                return Meet(draw(st.integers(0, tasks - 1)))
            case "ask" if requests:
                requests -= 1
                return Ask(draw(callees), steps(depth + 1))
            case _:
                return Rest()

    def several(depth: int) -> tuple[Work, ...]:
        return tuple(work(depth, TOGETHER) for _ in range(draw(st.integers(2, 3))))

    def steps(depth: int) -> Steps:
        if depth > 3:
            return ()
        return tuple(step(depth) for _ in range(draw(st.integers(0 if depth else 1, 2))))

    def step(depth: int) -> Step:
        what, how = work(depth, ALONE), draw(MEANWHILE)
        return Step(what, how == "releases", how == "blocks" and isinstance(what, (Ask, Rest)))

    timers = tuple((draw(handlers), steps(0)) for _ in range(draw(st.integers(1, 4))))
    return System(limits, services, timers, tuple((draw(st.integers(0, 1)), steps(0)) for _ in range(tasks)))


def life(graph: TinyGraph, schedule: Sequence[int]) -> Iterator[State]:
    """The states of a graph until nothing moves any more; `schedule` chooses among what may happen next."""
    state = graph.start
    yield state
    choices = iter(schedule)
    while moves := list(graph.moves(state)):
        _, state = moves[next(choices, 0) % len(moves)]
        yield state


SCHEDULES = st.lists(st.integers(0, 11), max_size=15)
long = limit(CASES)


@slow
@long
@cases(CASES)
@given(systems(), SCHEDULES)
def test_against_every_future(system: System, schedule: list[int]) -> None:
    """At every moment those are dead, and only those, that take no further step in any future.

    A picture does not show what a run does after its present wait, nor what a request does that has not begun: in the
    futures that are tried either may do as it is written, or end at once. So what is called dead here is dead in the
    graph itself; and where it comes to rest, everybody who is left has been found.
    """
    graph = TinyGraph(system)
    dead: set[str] = set()
    for state in life(graph, schedule):
        seen = graph.picture(state)
        dead = stuck_for_ever(graph, state, dead)
        assert deadlocked(seen) == dead
        check_explained(seen, dead)
    assert dead == {run.id for run in state.runs}
    event("somebody is dead" if dead else "all ended well")


def check_explained(seen: WaitGraph, dead: set[str]) -> None:
    """Rings close, share no member, and have everybody who is dead in them or behind them."""
    found = explained(seen, dead)
    members = [i for deadlock in found for i in deadlock.ring]
    assert len(members) == len(set(members))
    assert {i for deadlock in found for i in (*deadlock.ring, *deadlock.victims)} == dead
    for deadlock in found:
        assert [edge.to for edge in deadlock.edges] == [*deadlock.ring[1:], deadlock.ring[0]]
        assert not set(deadlock.ring) & set(deadlock.victims)


@long
@cases(CASES // 4)
@given(systems(), SCHEDULES)
def test_what_is_said_of_rings(system: System, schedule: list[int]) -> None:
    """What a member waits for is dead by itself; a ring is partial if, and only if, a failure could still end it."""
    graph = TinyGraph(system)
    firm: set[str] = set()
    for state in life(graph, schedule):
        seen = graph.picture(state)
        found = explained(seen, deadlocked(seen))
        firm = stuck_for_ever(graph, state, firm, may_fail=True) if found else set()
        for deadlock in found:
            assert deadlock.is_partial is not firm.issuperset(deadlock.ring)
            for edge in deadlock.edges:
                reason = Slot(edge.group, 0) if edge.group else edge.via
                assert edge.loop or "probe" in deadlocked(joined([seen, picture(run("probe", reason))]))


@long
@cases(CASES // 4)
@given(systems(), SCHEDULES, st.lists(st.integers(0, 25), min_size=4, max_size=4))
def test_pictures_of_different_moments(system: System, schedule: list[int], moments: list[int]) -> None:
    """Two processes, each seen at two moments of its own: nobody is called dead who takes a step after the first two.

    What is at rest before it is looked at is found.
    """
    graph = TinyGraph(system)
    states = list(life(graph, schedule))
    first, second, third, fourth = (min(moment, len(states) - 1) for moment in sorted(moments))

    before = joined([part(graph.picture(states[second]), 0), part(graph.picture(states[first]), 1)])
    now = joined([part(graph.picture(states[third]), 0), part(graph.picture(states[fourth]), 1)])
    dead = deadlocked(now, before)

    assert dead <= stuck_for_ever(graph, states[second])
    if first == len(states) - 1:
        assert dead == {run.id for run in states[-1].runs}
    event("somebody is dead" if dead else "nobody is dead")


def part(seen: WaitGraph, process: int) -> WaitGraph:
    """What one process shows of itself."""
    name = f"process{process}"
    return WaitGraph(
        {i: a for i, a in seen.activities.items() if a.process == name},
        seen.groups,
        {i: q for i, q in seen.queues.items() if q.process == name},
        {p: blocker for p, blocker in seen.blocked.items() if p == name},
    )


# A large graph


@pytest.mark.parametrize("each", [20, pytest.param(1000, marks=slow)])
def test_a_ring_hidden_in_traffic(each: int) -> None:
    """A ring of 5 is all that is dead among 50 nodes of 20 runs, and of 1,000 runs, which wait for each other."""
    seen = traffic(50, each, Random(27))

    dead = deadlocked(seen)

    assert dead == {f"/n{n}:hidden" for n in range(0, 50, 10)}
    (found,) = explained(seen, dead)
    assert set(found.ring) == dead
    assert found.victims == ()


def traffic(nodes: int, each: int, random: Random) -> WaitGraph:
    """Runs that wait for earlier ones of whichever nodes; every tenth node's timer calls the next such node."""
    things: list[ActivityView | GroupView | QueueView] = []
    for n in range(nodes):
        things += [group(f"/n{n}:many", None), group(f"/n{n}:default"), queue(f"/n{n}:busy", f"/n{n}:many")]
        for i in range(each):
            me, earlier = f"/n{n}:{i}", [f"/n{random.randrange(nodes)}:{random.randrange(i)}" for _ in range(2) if i]
            wait = All(tuple(call(e) for e in earlier)) if earlier else FREE
            things.append(run(me, wait, holds=f"/n{n}:many", serves=me, process=f"p{n}"))
        if n % 10 == 0:
            things.append(queue(f"/n{n}:service", f"/n{n}:default", f"/n{(n - 10) % nodes}:asks"))
            things.append(run(f"/n{n}:hidden", call(f"/n{n}:asks"), holds=f"/n{n}:default", process=f"p{n}"))
    random.shuffle(things)
    return picture(*things)

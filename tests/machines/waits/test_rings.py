"""Which ring a dead activity is in, through which waits, and who is behind it; by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, Edge, explained, is_ring
from graphflow.machines.waits.wait_graph import (
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
from tests.machines.pictures import BACKGROUND, DEAD, LIVE, call, circle, group, picture, queue, run, waits_for_itself


def told(seen: WaitGraph) -> list[Deadlock]:
    """What there is to tell of a picture."""
    return explained(seen, deadlocked(seen))


def why(wait: Condition, *things: ActivityView | GroupView | QueueView, blocked: str = "") -> Edge:
    """Why an activity `me` with that wait, from the group `g`, waits for the next of its ring."""
    me = run("me", wait, holds="g", age=9.0, process="p")
    seen = picture(me, group("g"), *things, blocked={"p": blocked} if blocked else {})
    (found,) = [deadlock for deadlock in told(seen) if "me" in deadlock.ring]
    assert found.ring[0] == "me"
    return found.edges[0]


# Why one waits for the next


def test_a_request_in_a_queue() -> None:
    """The edge has the queue in which the call stands and the group whose slot is missing."""
    assert why(call("c"), queue("s", "g", "c")) == Edge("me", call("c"), "s", "g")


def test_a_request_that_is_served() -> None:
    """The edge leads to who serves it."""
    server = run("server", call("d"), serves="c")

    assert why(call("c"), server, queue("s", "g", "d")) == Edge("server", call("c"))


def test_the_way_back_to_a_group() -> None:
    """The edge leads to who holds the group now."""
    holder = run("holder", call("c"), holds="h"), group("h"), queue("s", "g", "c")

    assert why(Slot("h", 3), *holder) == Edge("holder", Slot("h", 3), "", "h")


def test_a_service_that_is_not_there_yet() -> None:
    """The edge leads to the `on_start` that keeps it from opening."""
    opening = replace(queue("s", "start"), opens=("/add",))

    assert why(
        Opening("/add"), run("on_start", call("c"), holds="start"), group("start"), opening, queue("r", "g", "c")
    ) == Edge("on_start", Opening("/add"), "s", "start")


def test_the_end_of_a_task() -> None:
    """The edge leads to the task."""
    assert why(Join("task"), run("task", Join("me"))) == Edge("task", Join("task"))


@pytest.mark.parametrize(
    ("wait", "edge"),
    [
        (SetBy("self.arrived", ("on_scan",)), Edge("me", SetBy("self.arrived", ("on_scan",)), "on_scan", "g")),
        (SetBy("self.arrived", (), ("task",)), Edge("task", SetBy("self.arrived", (), ("task",)))),
    ],
)
def test_something_that_others_set(wait: SetBy, edge: Edge) -> None:
    """The edge leads to who holds the group of a handler that sets it, or to the task that does."""
    assert why(wait, queue("on_scan", "g"), run("task", Join("me"))) == edge


def test_a_blocked_loop() -> None:
    """Who waits and blocks the loop by which the answer has to come waits for itself."""
    elsewhere = group("h"), queue("s", "h", "c", process="q")

    assert why(call("c"), *elsewhere, blocked="me") == Edge("me", call("c"), loop=True)


# Which ring


@pytest.mark.parametrize("oldest", [0, 1, 2])
def test_a_ring_begins_with_who_has_waited_longest(oldest: int) -> None:
    """The others follow in the order in which they wait for each other."""
    seen = circle(3)
    name = f"tick{oldest}"
    seen = replace(seen, activities={**seen.activities, name: replace(seen.activities[name], age=5.0)})

    (found,) = told(seen)
    assert found.ring == tuple(f"tick{(oldest + i) % 3}" for i in range(3))
    assert [edge.to for edge in found.edges] == [*found.ring[1:], name]


def test_the_oldest_deadlock_is_told_first() -> None:
    """Of several, the order is that of the longest wait in each."""
    things = [thing for name in "abc" for thing in waits_for_itself(name)]
    ages = {"a": 2.0, "b": 3.0, "c": 1.0}
    seen = picture(*(replace(t, age=ages[t.id]) if isinstance(t, ActivityView) else t for t in things))

    assert [deadlock.ring for deadlock in told(seen)] == [("b",), ("a",), ("c",)]


def test_a_ring_within_one_process_comes_first() -> None:
    """That process sees it by itself; a ring through others is taken only if there is no such."""
    a = run("a", AnyOf((Join("b"), Join("c"))), process="p")
    b = run("b", Join("a"), process="q")
    c = run("c", AnyOf((Join("a"), Join("b"))), process="p")

    (found,) = told(picture(a, b, c))
    assert set(found.ring) == {"a", "c"}


def test_what_is_a_ring() -> None:
    """Each waits for the next, and the last for the first, in this order; all of them are dead."""
    seen = circle(3)
    dead = deadlocked(seen)

    assert is_ring(["tick0", "tick1", "tick2"], seen, dead)
    assert is_ring(["tick1", "tick2", "tick0"], seen, dead)
    assert not is_ring(["tick0", "tick2", "tick1"], seen, dead)
    assert not is_ring(["tick0", "tick1"], seen, dead)
    assert not is_ring(["tick0", "tick1", "tick2"], seen, dead - {"tick1"})
    assert not is_ring(["somebody", "else"], seen, dead)


# Who is in it, and who is behind


def test_victims_are_no_members() -> None:
    """Who only waits for a ring is behind it; who is alive is in neither."""
    behind = run("behind", call("tick0_answer"), age=9.0), run("further", Join("behind"), age=8.0)
    ticks = {**circle(2).activities, "tick0": replace(circle(2).activities["tick0"], serves="tick0_answer")}
    seen = joined([replace(circle(2), activities=ticks), picture(*behind, run("busy"))])

    (found,) = explained(seen, deadlocked(seen))
    assert set(found.ring) == {"tick0", "tick1"}
    assert found.victims == ("behind", "further")


def test_the_shortest_ring() -> None:
    """Of several ways back, the ring takes the one that needs nobody else."""
    seen = picture(run("a", All((Join("b"), call("c"))), holds="g", age=9.0), run("b", Join("a")), group("g"))
    seen = joined([seen, picture(queue("s", "g", "c"))])

    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.victims) == (("a",), ("b",))


def test_a_way_out_that_another_ring_bars() -> None:
    """Who would go on if another ring was mended waits behind that one, and is in no ring, whatever waits for him."""
    me = run("me", AnyOf((call("c"), DEAD)), holds="g", age=9.0)
    seen = picture(*BACKGROUND, me, group("g"), queue("s", "g", "c"))

    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.victims) == (("stuck",), ("me", "waits_on_stuck"))


@pytest.mark.parametrize("ages", [(1.0, 9.0), (9.0, 1.0)])
def test_a_ring_behind_another(ages: tuple[float, float]) -> None:
    """What stays a ring when the one it waits for is mended is told too, whichever is older."""
    behind = run("behind", All((call("c"), DEAD)), holds="g", age=ages[0])
    ahead = run("stuck", call("stuck_call"), holds="stuck_group", age=ages[1])
    seen = picture(*BACKGROUND[1:], ahead, behind, group("g"), queue("s", "g", "c"))

    found = {d.ring: d for d in explained(seen, deadlocked(seen))}
    assert {ring: d.victims for ring, d in found.items()} == {("behind",): (), ("stuck",): ("waits_on_stuck",)}
    assert not any(d.beside for d in found.values())


def test_what_one_waits_for_as_well() -> None:
    """Each other part that is dead has an edge to what holds it."""
    me = run("me", All((call("c"), call("d"), LIVE)), holds="g")
    seen = picture(me, group("g"), queue("s", "g", "c"), queue("t", "g", "d"))

    [found] = explained(seen, deadlocked(seen))
    ways = {edge.via: edge for edge in (*found.edges, *found.beside["me"])}
    assert ways == {call("c"): Edge("me", call("c"), "s", "g"), call("d"): Edge("me", call("d"), "t", "g")}


def test_inner_runs_are_no_victims() -> None:
    """What graphflow itself runs may be dead, and lead others to a ring, but is not told among those behind it."""
    inner = replace(run("get_result", Join("tick"), serves="c"), is_inner=True)
    seen = picture(*waits_for_itself("tick"), inner, run("asks", call("c"), age=9.0))

    assert deadlocked(seen) == {"tick", "get_result", "asks"}
    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.victims) == (("tick",), ("asks",))


def test_two_rings() -> None:
    """Rings that have nothing to do with each other are two deadlocks, each with its own victims."""
    a, b = waits_for_itself("a"), waits_for_itself("b")
    seen = picture(*a, *b, run("after_a", Join("a")), run("after_b", Join("b")))

    found = {d.ring: d.victims for d in explained(seen, deadlocked(seen))}
    assert found == {("a",): ("after_a",), ("b",): ("after_b",)}


@pytest.mark.parametrize("part", [call("live"), AnyOf((LIVE, call("dead")))])
def test_a_ring_goes_through_what_is_dead(part: Condition) -> None:
    """Of a wait for several, a ring takes a part that can never be met: the others are no reason."""
    slot_left = group("h", 2), run("b", call("c1"), holds="h"), queue("s", "h", "live")
    served = run("b2", call("c1"), serves="dead"), run("c", call("c2"), serves="reason"), queue("t", "g", "c1", "c2")
    me = run("me", All((part, call("reason"))), holds="g", age=9.0)

    seen = picture(*BACKGROUND, *slot_left, *served, me, group("g"))

    (found,) = [d for d in explained(seen, deadlocked(seen)) if "me" in d.ring]
    assert found.ring == ("me", "c")


def test_a_ring_beside_a_guess() -> None:
    """A ring is only likely if another slot would come free in case somebody else sets what its holder waits for."""
    guess = run("b", SetBy("self.arrived", ("on_scan",)), holds="g")
    queues = queue("s", "g", "c"), queue("on_scan", "g")
    seen = picture(run("a", call("c"), holds="g", age=9.0), guess, group("g", 2), *queues)

    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.victims) == (("a",), ("b",))
    assert found.is_likely


def test_a_ring_beside_a_live_part() -> None:
    """A ring is only partial if another slot would come free in case something live fails."""
    other = run("b", All((call("d"), LIVE)), holds="g")
    seen = picture(
        *BACKGROUND, run("a", call("c"), holds="g", age=9.0), other, group("g", 2), queue("s", "g", "c", "d")
    )

    (found,) = [d for d in explained(seen, deadlocked(seen)) if "a" in d.ring]
    assert (found.ring, found.victims) == (("a",), ("b",))
    assert found.is_partial


def test_the_slot_that_is_missing() -> None:
    """Where two slots are needed and one of them is free, the ring goes through the other."""
    server, own = QueueView("s", "action s", "/node", ("g", "own"), ("c",), 1), GroupView("own", "", "/node", 1)
    holder = ActivityView("holder", "action s", "/node", ("own",), call("answer"))
    seen = picture(run("asks", call("c"), serves="answer", age=9.0), holder, server, group("g", 2), own)
    seen = joined([seen, picture(run("other", call("answer"), holds="g"))])

    (found,) = explained(seen, deadlocked(seen))
    assert (found.ring, found.edges[0].group, found.victims) == (("asks", "holder"), "own", ("other",))


@pytest.mark.parametrize(
    ("wait", "partial"),
    [
        (All((call("c"), LIVE)), True),
        (All((call("c"), call("soon"))), True),
        (All((call("c"), DEAD)), False),
        (All((All((call("c"), LIVE)), DEAD)), True),
    ],
)
def test_a_live_part_of_a_dead_wait(wait: Condition, partial: bool) -> None:
    """A ring says when the failure of something live could still end one of its waits."""
    me = run("me", wait, holds="g", age=1.0)
    server = run("runs", holds="h"), group("h"), queue("t", "h", "soon")
    seen = picture(*BACKGROUND, *server, me, group("g"), queue("s", "g", "c"))

    (found,) = [d for d in explained(seen, deadlocked(seen)) if "me" in d.ring]
    assert found.is_partial is partial

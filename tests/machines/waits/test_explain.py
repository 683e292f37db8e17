"""What a report says, word by word: who holds what and waits for what, where, and what ends it."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from graphflow.errors import Place
from graphflow.interface import GroupChange
from graphflow.machines.regrouping import Regrouping
from graphflow.machines.waits.explain import again, explanation, group_of, hopeless, stall, title, wanted, where
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, Edge, explained
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    GroupView,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
)
from tests.machines.pictures import picture


@pytest.fixture(autouse=True)
def unbroken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each sentence on one line, however long; `test_clauses` has to do with the rest."""
    monkeypatch.setattr("graphflow.machines.waits.wrapping.WIDTH", 10_000)


MOTION = GroupView("g", "motion", "/arm")
TICK = ActivityView(
    "tick",
    "timer tick",
    "/arm",
    ("g",),
    Call("c", "/add"),
    place=Place("/home/me/arm.py", 12),
    function="tick",
    age=0.25,
    left=7.75,
    process="p",
)
ADD = QueueView("q", "service add", "/arm", ("g",), ("c",), 1, process="p")


def the_deadlock(seen: WaitGraph) -> Deadlock:
    (found,) = explained(seen, deadlocked(seen))
    return found


def report(*things: ActivityView | GroupView | QueueView, blocked: str = "") -> list[str]:
    """The lines of what is told of a picture."""
    seen = picture(*things, blocked={"p": blocked} if blocked else {})
    return explanation(the_deadlock(seen), seen).splitlines()


def test_a_whole_report() -> None:
    """A headline, two lines for each member, and every change that would end it."""
    assert report(TICK, MOTION, ADD) == [
        "DEADLOCK: timer tick of /arm waits for itself",
        "  timer tick of /arm holds group 'motion' and waits for the response of service /add"
        "   (arm.py:12 in tick, for 0.25 s, times out in 7.8 s)",
        "    -> service add of /arm waits for group 'motion' of /arm, which timer tick of /arm holds",
        "Any one of these ends it:",
        "  give add a group of its own, in the graph file under nodes:",
        "      /arm: {concurrency: {add_group: [add]}}",
        "    or in the class: add_group = Group(1), and group=add_group where add is declared",
        "  allow more runs, if its handlers share no state, in the graph file under nodes:",
        "      /arm: {concurrency: {motion: {limit: 2}}}",
        "    or in the class: motion = Group(2)",
        "  release the slot while waiting, in arm.py:12: async with self.group.released(): ... "
        "(self.group is the group of the running handler)",
    ]


def test_a_ring_and_who_is_behind_it() -> None:
    """The last line of a ring leads back to the first; each who waits behind it has a line of his own."""
    one, two = replace(TICK, id="a", wait=Join("b"), age=9.0), replace(TICK, id="b", label="task run", wait=Join("a"))
    behind = replace(TICK, id="v", label="timer look", wait=Join("a"), holds=())

    lines = report(one, two, behind, MOTION)

    assert lines[0] == "DEADLOCK: 2 callbacks wait for each other in a ring; 1 more waits for them"
    assert lines[2] == "    -> which task run of /arm must give"
    assert lines[4] == "    -> which timer tick of /arm must give (back to the first)"
    assert lines[5] == "  behind them: timer look of /arm   (arm.py:12 in tick, for 0.25 s, times out in 7.8 s)"


def test_what_one_offers_only_further_on() -> None:
    """Its own code would bring it about, after the wait."""
    tick = replace(TICK, wait=SetBy("service /later", (), ("tick",), verb="offers"), holds=(), left=None)

    assert report(tick) == [
        "LIKELY DEADLOCK: timer tick of /arm waits for service /later, which its own code offers only after that",
        "  timer tick of /arm waits for service /later   (arm.py:12 in tick, for 0.25 s)",
        "    -> which timer tick of /arm itself offers further on",
        "This ends it:",
        "  make service /later before arm.py:12 waits for it",
    ]


@pytest.mark.parametrize(("kind", "word"), [(All, "and"), (AnyOf, "or")])
def test_several_things_that_one_waits_for(kind: type[All | AnyOf], word: str) -> None:
    """All are named, each with what keeps it out, and one change covers them."""
    left, right = SetBy("self.left", ("l",)), SetBy("self.right", ("r",))
    tick = replace(TICK, wait=kind((left, right)), left=None)
    queues = [replace(ADD, id=name[0], label=f"timer on_{name}", calls=()) for name in ("left", "right")]

    lines = report(tick, MOTION, *queues)

    both = f"self.left {word} self.right"
    assert lines[0] == f"LIKELY DEADLOCK: timer tick of /arm waits for {both}, and what could end that is kept out"
    assert f"holds group 'motion' and waits for {both}" in lines[1]
    for line, side in zip(lines[2:4], ("left", "right"), strict=True):
        assert line.startswith(f"    -> timer on_{side} of /arm sets self.{side} and needs group 'motion' of /arm,")
    assert "  give on_left and on_right a group of their own, in the graph file under nodes:" in lines


@pytest.mark.parametrize(
    ("deadlock", "words"),
    [
        (Deadlock(("a",), (), (), is_likely=False), "DEADLOCK: timer tick of /arm waits for itself"),
        (Deadlock(("a",), (), (), is_likely=True), "LIKELY DEADLOCK: timer tick of /arm waits for itself"),
        (
            Deadlock(("a",), (), (), is_likely=False, is_partial=True),
            "DEADLOCK: timer tick of /arm waits for itself (unless something else that they wait for fails)",
        ),
        (
            Deadlock(("a",), (), ("v", "w"), is_likely=False),
            "DEADLOCK: timer tick of /arm waits for itself; 2 more wait for it",
        ),
        (
            Deadlock(("a", "b", "c"), (), ("v",), is_likely=True),
            "LIKELY DEADLOCK: 3 callbacks wait for each other in a ring; 1 more waits for them",
        ),
    ],
)
def test_headlines(deadlock: Deadlock, words: str) -> None:
    """How many wait, how certain that is, and how many more are behind them."""
    seen = picture(*(replace(TICK, id=name) for name in "abcvw"))
    bare = replace(deadlock, edges=tuple(Edge(name, FREE) for name in deadlock.ring))

    assert explanation(bare, seen).splitlines()[0] == words


# The parts


@pytest.mark.parametrize(
    ("via", "words"),
    [
        (Call("c", "/add"), "the response of service /add"),
        (Call("goal:01", "/turn"), "the result of action /turn"),
        (Opening("/arm/add"), "service /arm/add"),
        (Opening("/arm/turn/_action/send_goal"), "action /arm/turn"),
        (Slot("g", 3), "its slot, to return to its group"),
        (SetBy("self.arrived", ()), "self.arrived"),
        (FREE, "its event loop"),
        (Join("b"), "another task"),
        (Join("t"), "thread Thread-1, which works for it"),
        (AnyOf(()), "another task"),
    ],
)
def test_what_is_wanted(via: Condition, words: str) -> None:
    """Each kind of wait has its words."""
    thread = ActivityView("t", "thread Thread-1", "/arm")
    assert wanted(Edge(via.activity if isinstance(via, Join) else "b", via), WaitGraph({"t": thread})) == words


@pytest.mark.parametrize(
    ("activity", "words"),
    [
        (TICK, "(arm.py:12 in tick, for 0.25 s, times out in 7.8 s)"),
        (replace(TICK, left=None), "(arm.py:12 in tick, for 0.25 s)"),
        (replace(TICK, left=-0.1), "(arm.py:12 in tick, for 0.25 s, times out in 0.0 s)"),
        (replace(TICK, place=Place(""), left=None), "(for 0.25 s)"),
    ],
)
def test_where_it_waits(activity: ActivityView, words: str) -> None:
    """The line, if there is one of the user's; since when; and until when, if it ever gives up."""
    assert where(activity) == words


def test_names() -> None:
    """An activity is named by its label and node, its group by the first that has a name."""
    own = GroupView("own", "", "/arm")
    seen = picture(MOTION, own)

    assert title(TICK) == "timer tick of /arm"
    assert group_of(TICK, seen) == group_of(replace(TICK, holds=("own", "g")), seen) == "motion"
    assert group_of(replace(TICK, holds=("own",)), seen) == group_of(replace(TICK, holds=("unknown",)), seen) == ""


@pytest.mark.parametrize(
    ("group", "words"),
    [
        (MOTION, "waits for group 'motion' of /arm, which"),
        (replace(MOTION, limit=2), "waits for one of the 2 slots of group 'motion' of /arm, which"),
        (replace(MOTION, name=""), "waits for its turn, which"),
    ],
)
def test_slots(group: GroupView, words: str) -> None:
    """A group is named; of one with several slots, one is wanted; a handler alone waits for its turn."""
    others = [replace(TICK, id="other")] if group.limit == 2 else []
    seen = picture(TICK, *others, group, ADD)
    edge = Edge("tick", TICK.wait, "q", "g")

    lines = explanation(Deadlock(("tick",), (edge,), (), is_likely=False), seen).splitlines()
    assert words in lines[2]


def test_something_that_a_handler_sets() -> None:
    """What queues at that handler is told, and what it has lost meanwhile; another run is no way out of it."""
    wait = SetBy("self.arrived", ("q",))
    scan = replace(ADD, label="subscription on_scan", calls=(), waiting=3, dropped=2)

    lines = report(replace(TICK, wait=wait), MOTION, scan)

    assert lines[0] == (
        "LIKELY DEADLOCK: timer tick of /arm waits for self.arrived, and on_scan, which sets it, is kept out"
    )
    assert lines[2] == (
        "    -> subscription on_scan of /arm sets it and needs group 'motion' of /arm, "
        "which timer tick of /arm holds; 3 queued, 2 dropped meanwhile"
    )
    assert any(line.startswith("  give on_scan a group of its own") for line in lines)
    assert not any(line.startswith("  allow more runs") for line in lines)


def test_several_that_set_it() -> None:
    """All are named, by what they do to it, and one line moves them all; the waiter itself is left where it is."""
    wait = SetBy("self.items", ("q", "r", "s"), verb="fills")
    names = {"q": "subscription on_scan", "r": "service put", "s": "timer tick"}
    queues = [replace(ADD, id=id_, label=label, calls=(), waiting=1) for id_, label in names.items()]

    lines = report(replace(TICK, wait=wait), MOTION, *queues)

    assert lines[0].endswith("waits for self.items, and on_scan and put, which fill it, are kept out")
    assert "subscription on_scan and service put of /arm fill it and need group 'motion' of /arm, which" in lines[2]
    assert "  give on_scan and put a group of their own, in the graph file under nodes:" in lines
    assert "      /arm: {concurrency: {on_scan_group: [on_scan, put]}}" in lines


def test_what_the_graph_file_says_already_is_kept() -> None:
    """A remedy is pasted over the whole mapping; and the file that it goes into is named."""
    said = {"motion": GroupChange(("tick", "add", "reset")), "io": GroupChange((), 2, sets_limit=True)}
    seen = picture(TICK, MOTION, ADD)
    seen = replace(seen, regroupings={"/arm": Regrouping(said, "lab.yaml", "override")})

    text = explanation(the_deadlock(seen), seen)

    assert (
        "  give add a group of its own, in lab.yaml under override:\n"
        "      /arm: {concurrency: {motion: [tick, reset], io: {limit: 2}, add_group: [add]}}\n"
    ) in text
    assert (
        "  allow more runs, if its handlers share no state, in lab.yaml under override:\n"
        "      /arm: {concurrency: {motion: {handlers: [tick, add, reset], limit: 2}, io: {limit: 2}}}\n"
    ) in text


@pytest.mark.parametrize(
    ("wait", "left", "head"),
    [
        (SetBy("self.pose", ("q",), gives_up=True), 2.0, "WAITS IN VAIN: timer tick of /arm waits for self.pose, and "),
        (SetBy("self.pose", ("q",), gives_up=True), None, "LIKELY DEADLOCK: "),
        (SetBy("self.pose", ("q",)), 2.0, "LIKELY DEADLOCK: "),
    ],
    ids=["a deadline", "it may be that there is one", "it tries again"],
)
def test_a_wait_that_its_own_deadline_ends(wait: SetBy, left: float | None, head: str) -> None:
    """It is no deadlock; when it ends is told."""
    lines = report(replace(TICK, wait=wait, left=left), MOTION, replace(ADD, calls=()))
    assert lines[0].startswith(head)
    assert lines[0].endswith(", until a deadline of its own ends that in 2.0 s") is head.startswith("WAITS")


def test_a_wait_in_a_method_that_the_handler_calls() -> None:
    """Both lines are told."""
    assert where(replace(TICK, function="pause", called="arm.py:9 in tick", left=None)) == (
        "(arm.py:12 in pause, called in arm.py:9 in tick, for 0.25 s)"
    )


def test_a_lock_that_is_held() -> None:
    """Who holds it is told, and where it is to be left."""
    held = SetBy("self.lock", (), ("b",), is_held=True)
    other = replace(TICK, id="b", label="task run", wait=Join("a"), holds=(), place=Place("/x/b.py", 7))

    lines = report(replace(TICK, id="a", wait=held, age=9.0), other, MOTION)

    assert lines[2] == "    -> which task run of /arm holds"
    assert "  move the await in b.py:7 to where it does not hold self.lock" in lines


@pytest.mark.parametrize("is_async", [True, False])
def test_a_lock_of_two(is_async: bool) -> None:
    """Each holds one and waits for the other: the order is at fault. One that holds it itself takes it twice."""
    first = replace(TICK, id="a", wait=SetBy("self.left", (), ("b",), is_held=True), holds=(), is_async=is_async)
    second = replace(first, id="b", label="task run", wait=SetBy("self.right", (), ("a",), is_held=True))
    told = "\n".join(report(first, second, MOTION))
    assert re.search(r"  take self\.(left|right) and self\.(left|right) in the same order everywhere", told)
    alone = replace(first, wait=SetBy("self.left", (), ("a",), is_held=True))
    again = "do not take self.left again in arm.py:12: asyncio's locks cannot be entered twice"
    within = "let self.left be a threading.RLock(), which can be entered again from within"
    assert report(alone, MOTION)[-1] == f"  {again if is_async else within}"


def test_a_blocked_loop() -> None:
    """Nothing arrives; to await, or to have the handler block a thread, ends it."""
    lines = report(replace(TICK, is_async=False), MOTION, ADD, blocked="tick")

    assert lines[1].startswith(
        "  timer tick of /arm holds group 'motion', blocks the event loop and waits for the resp"
    )
    assert lines[2] == "    -> nothing can arrive while the event loop is blocked by timer tick of /arm"
    assert lines[4:] == [
        "  await the call in arm.py:12",
        "  let tick run in a thread, in the graph file under nodes:",
        "      /arm: {concurrency: {blocking: {handlers: [tick], thread: true}}}",
        "    or in the class: thread=True where tick is declared",
    ]


# What ends it


def fixes(activity: ActivityView, group: GroupView, queue: QueueView) -> list[str]:
    lines = report(activity, group, queue)
    _, heading, changes = "\n".join(lines).rpartition("ends it:\n")
    assert heading == "" or ("Any one of these ends it:" in lines) is (
        sum(line[2] != " " for line in changes.split("\n")) > 1
    )
    return changes.split("\n") if heading else []


@pytest.mark.parametrize(
    ("activity", "group", "queue", "expected"),
    [
        pytest.param(
            replace(TICK, label="service add"),
            MOTION,
            ADD,
            ["  allow more runs, if its handlers share no state", "  release the slot while waiting, in arm.py:12: "],
            id="it calls itself: a group of its own is none",
        ),
        pytest.param(
            TICK,
            MOTION,
            replace(ADD, is_declared=False),
            ["  give add of /arm a group of its own: group=Group(1) where it is made", "  allow more", "  release"],
            id="a handler that is made while the node runs",
        ),
        pytest.param(
            TICK,
            replace(MOTION, is_declared=False, is_threaded=True),
            ADD,
            [
                "  give add a group of its own",
                "  allow more runs, if its handlers share no state: Group(2, thread=True) where /arm makes the "
                "group called motion here",
                "  release",
            ],
            id="a group that is made while the node runs",
        ),
        pytest.param(
            replace(TICK, is_async=False),
            MOTION,
            ADD,
            ["  give add a group of its own", "  allow more"],
            id="a plain function cannot release",
        ),
        pytest.param(
            TICK,
            MOTION,
            replace(ADD, label="reply add"),
            ["  let replies through: declare the client of add without group=", "  allow more", "  release"],
            id="an answer that finds no slot",
        ),
        pytest.param(
            replace(TICK, label="service add"),
            replace(MOTION, name=""),
            ADD,
            ["  let several runs of add overlap: add_group = Group(None), and group=add_group where it is declared"],
            id="a handler alone",
        ),
        pytest.param(
            replace(TICK, label="service add"),
            replace(MOTION, name=""),
            replace(ADD, is_declared=False),
            ["  let several runs of add overlap: group=Group(None) where it is made"],
            id="a handler alone that is made while the node runs",
        ),
        pytest.param(
            replace(TICK, label="subscription add", wait=SetBy("self.stop", ("q",))),
            replace(MOTION, name=""),
            replace(ADD, label="subscription add", calls=()),
            ["  let several runs of add overlap: add_group = Group(None), and group=add_group where it is declared"],
            id="a handler that another run of it ends",
        ),
        pytest.param(
            replace(TICK, label="action add"),
            replace(MOTION, name=""),
            replace(ADD, label="action add"),
            ["  let several goals run at a time: policy='parallel' where add is declared"],
            id="an action alone",
        ),
    ],
)
def test_what_ends_it(activity: ActivityView, group: GroupView, queue: QueueView, expected: list[str]) -> None:
    """Each advice fits the group, the handler and how they were made, and there is no other."""
    found = [line for line in fixes(activity, group, queue) if not line.startswith("    ")]

    assert len(found) == len(expected)
    for line, beginning in zip(found, expected, strict=True):
        assert line.startswith(beginning)


def test_one_advice_for_a_whole_ring() -> None:
    """What helps every member alike is said once."""
    runs = [replace(TICK, id=f"t{i}", node=f"/n{i}", holds=(f"g{i}",), wait=Call(f"c{i}", "/add")) for i in (0, 1)]
    groups = [replace(MOTION, id=f"g{i}", node=f"/n{i}") for i in (0, 1)]
    queues = [replace(ADD, id=f"q{i}", node=f"/n{i}", needs=(f"g{i}",), calls=(f"c{1 - i}",)) for i in (0, 1)]

    lines = report(*runs, *groups, *queues)

    for advice in ("  give add a group", "  allow more runs", "  release the slot"):
        assert sum(line.startswith(advice) for line in lines) == 1


# Calls that cannot succeed, and stalls


def test_a_call_that_cannot_succeed() -> None:
    """The error's text has the server, what it waits for, who holds that and where, and what ends it."""
    seen = picture(TICK, MOTION, ADD)

    lines = hopeless("/add", ADD, [TICK], seen).splitlines()
    assert lines == report(TICK, MOTION, ADD)


def test_a_call_that_comes_back_by_others() -> None:
    """Which they are is told by the process that knows them."""
    seen = picture(TICK, MOTION, ADD)
    lines = hopeless("/last", ADD, [TICK], seen).splitlines()
    assert "waits for the response of service /add" in lines[1]
    assert lines[2].startswith("    -> which calls /last in the end, and service add of /arm waits for group 'motion'")


@pytest.mark.parametrize(
    ("others", "words"),
    [(0, ""), (1, "which calls /last in the end, after 1 more callback, and "), (2, "after 2 more callbacks, and ")],
)
def test_the_way_of_a_call_that_comes_back(others: int, words: str) -> None:
    """What this process knows of it has a line each; the rest is counted."""
    server = replace(TICK, id="s", label="service add", holds=(), wait=Call("d", "/last"), place=Place("/b.py", 7))
    lines = hopeless("/last", ADD, [TICK], picture(TICK, server, MOTION, ADD), [server], others).splitlines()

    assert lines[2:4] == [
        "    -> which service add of /arm must give",
        "  service add of /arm waits for the response of service /last   (b.py:7 in tick, for 0.25 s, "
        "times out in 7.8 s)",
    ]
    assert lines[4].startswith("    -> ")
    assert f"{words}service add of /arm waits for group 'motion'" in lines[4]


def test_a_deadlock_that_comes_again() -> None:
    """One line is enough."""
    assert again("LIKELY DEADLOCK: timer tick waits", 3) == "LIKELY DEADLOCK again (3 times so far): timer tick waits"


def test_a_call_that_cannot_succeed_and_nobody_holds() -> None:
    """Those who held the slots may be gone when it is told: there is nothing to advise."""
    own = GroupView("own", "", "/arm")
    queue = replace(ADD, needs=("own", "g"))

    [line] = hopeless("/add", queue, [], picture(MOTION, own)).splitlines()
    assert "waits for group 'motion' of /arm" in line


def test_a_stall() -> None:
    """Who has held the group, who waits and what it has lost since; and a group for one that is not the holder's."""
    waiting = [replace(ADD, id="own", label="timer tick", waiting=1), replace(ADD, waiting=4, dropped=7)]

    assert stall(MOTION, [TICK], waiting, {"q": 5}, 5.0, picture(MOTION)).splitlines() == [
        "STALL: timer tick of /arm (arm.py:12 in tick) has held group 'motion' of /arm for more than 5.0 s",
        "  timer tick of /arm waits for it: 1 queued, 0 dropped meanwhile",
        "  service add of /arm waits for it: 4 queued, 2 dropped meanwhile",
        "If that is too long:",
        "  give add a group of its own, in the graph file under nodes:",
        "      /arm: {concurrency: {add_group: [add]}}",
        "    or in the class: add_group = Group(1), and group=add_group where add is declared",
    ]


def test_a_stall_of_several_slots() -> None:
    """All who hold one are named; where only their own handlers wait, there is nothing to advise."""
    look = replace(TICK, id="look", label="timer look", place=Place(""))
    waiting = [replace(ADD, label="timer tick")]

    assert stall(replace(MOTION, limit=2), [TICK, look], waiting, {}, 5.0, picture(MOTION)).splitlines() == [
        "STALL: timer tick of /arm (arm.py:12 in tick) and timer look of /arm have held all 2 slots of group 'motion' "
        "of /arm for more than 5.0 s",
        "  timer tick of /arm waits for it: 1 queued, 0 dropped meanwhile",
    ]

"""What pictures of several processes have in common: the names of calls and goals, and one picture of all."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    Free,
    Join,
    Opening,
    WaitGraph,
    call_id,
    calls_of,
    goal_id,
    joined,
    parts_of,
)
from tests.machines.pictures import group, picture, queue, run


def test_one_name_for_both_ends_of_a_call() -> None:
    """A call is named by its client and number, whichever sign that has; no two calls have one name."""
    gid, other = bytes(range(16)), bytes(range(1, 17))

    assert call_id(gid, 7) == call_id(gid, -7) == "000102030405060708090a0b0c0d0e0f:7"
    assert len({call_id(gid, 7), call_id(gid, 8), call_id(other, 7)}) == 3


def test_goals_are_no_calls() -> None:
    """A goal is named by its id, so that reports can tell it from a call."""
    assert goal_id(b"\x01" * 16) == "goal:" + "01" * 16


def test_a_view_by_default() -> None:
    """What is only named holds nothing, waits for nothing that the picture shows, and blocks nobody."""
    view = ActivityView("a", "timer tick", "/node")

    assert (view.holds, view.wait, view.serves, view.left) == ((), FREE, "", None)
    assert Free() == FREE
    assert WaitGraph() == WaitGraph({}, {}, {}, {})


def test_pictures_as_one() -> None:
    """Several processes joined are one picture of everything in them."""
    here = picture(run("a"), group("g"), queue("s", "g"), blocked={"p": "a"})
    there = picture(run("b"), group("h"), queue("t", "h"), blocked={"q": "b"})

    whole = picture(run("a"), run("b"), group("g"), group("h"), queue("s", "g"), queue("t", "h"))
    assert joined([here, there]) == replace(whole, blocked={"p": "a", "q": "b"})
    assert joined([]) == WaitGraph()


LAND = Call("c", "/land")


@pytest.mark.parametrize(
    ("wait", "calls"),
    [
        (LAND, ["c"]),
        (All((LAND, AnyOf((FREE, Call("d", "/start"))))), ["c", "d"]),
        (Join("b"), []),
        (FREE, []),
    ],
)
def test_the_calls_in_a_wait(wait: Condition, calls: list[str]) -> None:
    """They are found however deep they stand."""
    assert [call.id for call in calls_of(wait)] == calls


def test_the_parts_of_a_wait() -> None:
    """A combination is its parts, whatever they are; anything else is its own only part."""
    assert list(parts_of(AnyOf((All((LAND, FREE)), Opening("/land"))))) == [LAND, FREE, Opening("/land")]
    assert list(parts_of(LAND)) == [LAND]

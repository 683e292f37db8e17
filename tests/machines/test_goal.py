"""ROS 2's goal states, and the book that an action's server keeps of its goals."""

from __future__ import annotations

from itertools import product

import pytest

from graphflow.machines.goal import ALL_GOALS, TRANSITIONS, CancelCode, GoalBook, GoalEvent, GoalStatus, step

A, B, C = (bytes([n]) * 16 for n in (1, 2, 3))
LIVE = (GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING)


def test_legal_and_illegal_transitions() -> None:
    """Eight transitions are legal, and every other raises; the table is that of rcl_action."""
    legal = {
        "ACCEPTED": {"execute": "EXECUTING", "cancel_goal": "CANCELING"},
        "EXECUTING": {"cancel_goal": "CANCELING", "succeed": "SUCCEEDED", "abort": "ABORTED"},
        "CANCELING": {"succeed": "SUCCEEDED", "abort": "ABORTED", "canceled": "CANCELED"},
    }
    assert len(TRANSITIONS) == 8
    for status, event in product(GoalStatus, GoalEvent):
        after = legal.get(status.name, {}).get(event.value)
        if after is not None:
            assert step(status, event).name == after
        else:
            with pytest.raises(ValueError, match=f"a goal that is {status.name} cannot {event.value}"):
                step(status, event)


def test_what_is_terminal_and_what_can_be_cancelled() -> None:
    """No transition leads out of a terminal state."""
    assert [s.name for s in GoalStatus if s.is_terminal] == ["SUCCEEDED", "CANCELED", "ABORTED", "LOST"]
    assert [s.name for s in GoalStatus if s.is_cancelable] == ["ACCEPTED", "EXECUTING"]
    assert not any(status.is_terminal for status, _ in TRANSITIONS)


def book() -> GoalBook:
    """A book in which A was accepted at 10 and ended, B runs since 20, and C is being cancelled since 30."""
    made = GoalBook(keep_ns=1000, show_ns=100, keep_most=2)
    for goal_id, when in ((A, 10), (B, 20), (C, 30)):
        made.accept(goal_id, when)
        made.step(goal_id, GoalEvent.EXECUTE, when)
    made.step(A, GoalEvent.SUCCEED, 40)
    made.step(C, GoalEvent.CANCEL_GOAL, 50)
    return made


@pytest.mark.parametrize(
    ("goal_id", "stamp", "code", "meant"),
    [
        (B, 0, CancelCode.NONE, [B]),
        (A, 0, CancelCode.GOAL_TERMINATED, []),
        (C, 0, CancelCode.GOAL_TERMINATED, []),
        (bytes([9]) * 16, 0, CancelCode.UNKNOWN_GOAL_ID, []),
        (ALL_GOALS, 0, CancelCode.NONE, [B]),
        (ALL_GOALS, 19, CancelCode.NONE, []),
        (ALL_GOALS, 20, CancelCode.NONE, [B]),
        (A, 25, CancelCode.NONE, [B]),
        (B, 1, CancelCode.NONE, [B]),
    ],
)
def test_whom_a_cancel_request_means(goal_id: bytes, stamp: int, code: CancelCode, meant: list[bytes]) -> None:
    """One goal, all, those accepted until a time, or both; only goals that can be cancelled."""
    assert book().to_cancel(goal_id, stamp) == (code, meant)


def test_results_are_kept_from_the_end_on() -> None:
    """However long a goal took, its result can be asked for as long as any other's; what runs is never forgotten."""
    kept = book()
    assert kept.expire(1040) == []
    assert kept.expire(1041) == [A]
    assert kept.expire(10**9) == []
    assert set(kept.goals) == {B, C}
    kept.step(B, GoalEvent.ABORT, 10**9)
    assert kept.expire(10**9 + 1000) == []
    assert kept.active() == 1


def test_the_oldest_results_go_when_there_are_many() -> None:
    """Not the oldest goals: those that ended first."""
    kept = book()
    kept.step(C, GoalEvent.CANCELED, 60)
    kept.step(B, GoalEvent.SUCCEED, 70)
    assert kept.expire(70) == [A]
    assert set(kept.goals) == {B, C}


def test_the_list_of_states_tells_of_ends_for_a_while() -> None:
    """It does not grow with everything that ever was."""
    assert [goal_id for goal_id, _ in book().shown(140)] == [A, B, C]
    assert [goal_id for goal_id, _ in book().shown(141)] == [B, C]


def test_an_id_is_good_for_one_goal() -> None:
    """A goal cannot be entered twice."""
    with pytest.raises(ValueError, match="is known already"):
        book().accept(A, 99)

"""The table of a goal's life, and the book that an action's server keeps of its goals."""

from __future__ import annotations

from itertools import product
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow.interface import GoalPolicy, OnClientLoss
from graphflow.machines.goal import (
    ALL_GOALS,
    STEPS,
    CancelCode,
    Do,
    GoalBook,
    GoalEvent,
    GoalRules,
    GoalStatus,
    Phase,
    Step,
    step,
)
from tests.machines.rcl_goals import NEXT

A, B, C = (bytes([n]) * 16 for n in (1, 2, 3))
RULES = [GoalRules(policy, loss) for policy in get_args(GoalPolicy) for loss in get_args(OnClientLoss)]
EVERYTHING = GoalRules("preempt", "cancel")
"""Under which nothing is left out."""
CLEANING = (Phase.CANCELING, Phase.PREEMPTED)


def test_every_step_is_legal_in_ros() -> None:
    """Clients are told of no change that rcl_action does not have, and of all that lie between."""
    for (phase, event), following in STEPS.items():
        states = [s for s in (phase.status, following.through, following.phase.status) if s]
        changes = [(a, b) for a, b in zip(states, states[1:], strict=False) if a is not b]
        assert all(after in NEXT.get(before, ()) for before, after in changes), (phase, event)
        if phase is Phase.DECIDING:
            assert following.phase.status in (GoalStatus.UNKNOWN, GoalStatus.ACCEPTED)


def test_what_is_terminal_and_what_can_be_cancelled() -> None:
    """No state follows a terminal one."""
    assert [s.name for s in GoalStatus if s.is_terminal] == ["SUCCEEDED", "CANCELED", "ABORTED", "LOST"]
    assert [s.name for s in GoalStatus if s.is_cancelable] == ["ACCEPTED", "EXECUTING"]
    assert not any(status.is_terminal for status in NEXT)


def test_the_table_is_complete() -> None:
    """Whoever may go or stop at any time may do so in every phase; every phase is reached, and left to an end."""
    live = [phase for phase in Phase if not phase.is_over]
    for phase, event in product(live, (GoalEvent.CLIENT_LOST, GoalEvent.CLIENT_AWAY, GoalEvent.STOPPING)):
        assert (phase, event) in STEPS
    for phase in live:
        assert phase.status.is_cancelable == (
            phase is not Phase.DECIDING
            and STEPS.get((phase, GoalEvent.CLIENT_AWAY), STEPS[phase, GoalEvent.STOPPING]).phase is not phase
        )
    reached, todo = {Phase.DECIDING}, [Phase.DECIDING]
    while todo:
        found = {following.phase for (phase, _), following in STEPS.items() if phase is todo[-1]} - reached
        todo.pop()
        reached |= found
        todo += found
    assert reached == set(Phase)


def test_a_goal_that_is_over_stays_what_it_is() -> None:
    """Whatever comes late changes nothing, and has nothing done."""
    for phase, event, rules in product([p for p in Phase if p.is_over], GoalEvent, RULES):
        assert step(phase, event, rules).phase is phase
        assert step(phase, event, rules).do == ()


def test_what_cannot_happen_is_an_error() -> None:
    """A server that loses count is told so, and does not go on."""
    with pytest.raises(ValueError, match="a goal that is QUEUED cannot have RETURNED"):
        step(Phase.QUEUED, GoalEvent.RETURNED, RULES[0])
    with pytest.raises(ValueError, match="a goal that is DECIDING cannot have BEGUN"):
        step(Phase.DECIDING, GoalEvent.BEGUN, RULES[0])


def test_a_body_is_cancelled_once() -> None:
    """It gets a limit with it, and from then on only cleans up."""
    for (phase, event), following in STEPS.items():
        starts = phase not in CLEANING and following.phase in CLEANING
        assert (Do.CANCEL_BODY in following.do) == (Do.LIMIT_CLEANUP in following.do) == starts, (phase, event)


@pytest.mark.parametrize("rules", RULES)
def test_what_only_some_servers_do(rules: GoalRules) -> None:
    """Others are told of a newer goal under `preempt` only, and clients are waited for where their loss matters."""
    answered = step(Phase.ANSWERING, GoalEvent.ANSWERED, rules)
    assert (Do.PREEMPT_OTHERS in answered.do) == (rules.policy == "preempt")
    assert answered.do[-1] is Do.ENQUEUE
    lost = step(Phase.RUNNING, GoalEvent.CLIENT_LOST, rules)
    assert lost.phase is Phase.RUNNING
    assert (lost.do == (Do.AWAIT_CLIENT,)) == (rules.on_client_loss == "cancel")


@given(st.lists(st.sampled_from(sorted(GoalEvent, key=lambda e: e.name)), max_size=30))
def test_any_life_ends_once_and_as_it_should(events: list[GoalEvent]) -> None:
    """Whatever happens in whatever order: one end, which is that of who has asked for it."""
    kept = GoalBook(EVERYTHING, 10, 10, 10)
    record = kept.ask(A, B)
    path: list[GoalStatus] = []
    queued = running = False
    for now, event in enumerate(events):
        if (record.phase, event) not in STEPS and not record.phase.is_over:
            continue
        before = record.phase
        outcome = kept.step(A, event, now) if A in kept.goals or A in kept.deciding else None
        if outcome is None:  # it was rejected, and is forgotten
            assert record.phase is Phase.REJECTED
            return
        path += outcome.statuses
        queued = (queued or Do.ENQUEUE in outcome.do) and Do.DEQUEUE not in outcome.do
        if event is GoalEvent.BEGUN and not before.is_over:
            assert queued
            queued, running = False, True
        if Do.CANCEL_BODY in outcome.do:
            assert running
        if event is GoalEvent.DROPPED:
            queued = False
    assert not (record.phase.is_over and queued)
    assert all(after in NEXT[before] for before, after in zip(path, path[1:], strict=False))
    if record.phase is Phase.CANCELED:
        assert GoalStatus.CANCELING in path
    if record.phase is Phase.SUCCEEDED:
        assert running
    assert (record.ended_ns is not None) == record.phase.is_over


@pytest.mark.parametrize(
    ("policy", "room"), [("reject", [True, False]), ("queue", [True, True, True, False]), ("parallel", [True] * 9)]
)
def test_for_how_many_goals_there_is_room(policy: GoalPolicy, room: list[bool]) -> None:
    """One, so many as may wait, or any number; goals that are over take none."""
    kept = GoalBook(GoalRules(policy, queue_depth=3), 10, 10, 10)
    found = []
    for n in range(len(room)):
        found.append(kept.has_room())
        kept.ask(bytes([n]) * 16, B)
        kept.step(bytes([n]) * 16, GoalEvent.ACCEPTED, n)
    assert found == room
    for goal_id in list(kept.goals):
        kept.step(goal_id, GoalEvent.STOPPING, 99)
    assert kept.has_room()


def test_the_goals_of_a_client() -> None:
    """Those that are being decided too, and none that is over."""
    kept = book()
    kept.ask(bytes([4]) * 16, B)
    assert kept.of_client(bytes(16)) == [B, C]
    assert kept.of_client(B) == [bytes([4]) * 16]


def book() -> GoalBook:
    """A book in which A was accepted at 10 and ended, B runs since 20, and C is being cancelled since 30."""
    made = GoalBook(GoalRules("parallel"), keep_ns=1000, show_ns=100, keep_most=2)
    for goal_id, when in ((A, 10), (B, 20), (C, 30)):
        made.ask(goal_id, bytes(16))
        for event in (GoalEvent.ACCEPTED, GoalEvent.ANSWERED, GoalEvent.BEGUN):
            made.step(goal_id, event, when)
    made.step(A, GoalEvent.RETURNED, 40)
    made.step(C, GoalEvent.CANCEL, 50)
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
    kept.step(B, GoalEvent.FAILED, 10**9)
    assert kept.expire(10**9 + 1000) == []
    assert kept.active() == 1


def test_the_oldest_results_go_when_there_are_many() -> None:
    """Not the oldest goals: those that ended first."""
    kept = book()
    kept.step(C, GoalEvent.UNWOUND, 60)
    kept.step(B, GoalEvent.RETURNED, 70)
    assert kept.expire(70) == [A]
    assert set(kept.goals) == {B, C}


def test_the_list_of_states_tells_of_ends_for_a_while() -> None:
    """It does not grow with everything that ever was."""
    told = book()
    assert told.hide(140) == []
    assert told.hide(141) == [A]
    assert told.hide(10**9) == []
    told.step(C, GoalEvent.UNWOUND, 10**9)
    told.step(B, GoalEvent.RETURNED, 10**9 + 50)
    assert told.hide(10**9 + 101) == [C]
    assert told.hide(10**9 + 151) == [B]
    both = book()
    both.step(C, GoalEvent.UNWOUND, 60)
    assert both.hide(161) == [A, C]


def test_a_rejected_goal_is_in_no_list() -> None:
    """Its id is good for another goal, and nothing has ended."""
    kept = book()
    kept.ask(bytes([4]) * 16, B)
    assert kept.active() == 2
    kept.step(bytes([4]) * 16, GoalEvent.REFUSED, 41)
    assert (kept.active(), kept.hide(10**9), kept.expire(10**9)) == (2, [A], [A])


def test_a_newer_goal_preempts_what_runs() -> None:
    """What is over has been preempted by none."""
    kept = book()
    for goal_id in (A, B):
        kept.step(goal_id, GoalEvent.NEWER, 60)
    assert [kept.goals[goal_id].is_preempted for goal_id in (A, B)] == [False, True]


def test_a_goal_that_is_forgotten_is_told_of_no_more() -> None:
    """However short the time since its end: as many as end at once must not fill the list."""
    kept = book()
    kept.step(C, GoalEvent.UNWOUND, 41)
    kept.step(B, GoalEvent.RETURNED, 42)
    assert kept.hide(43) == []
    assert kept.expire(43) == [A]
    assert kept.hide(43) == [A]


def test_an_id_is_good_for_one_goal() -> None:
    """A goal cannot be entered twice."""
    with pytest.raises(ValueError, match="is already known"):
        book().ask(A, bytes(16))


def test_what_every_row_of_an_event_does() -> None:
    """In whatever phase it happens: rows that one scenario alone would not reach."""
    ends = {GoalEvent.RETURNED: Phase.SUCCEEDED, GoalEvent.FAILED: Phase.ABORTED, GoalEvent.OUTSTAYED: Phase.ABORTED}
    for (phase, event), row in STEPS.items():
        if event in ends:
            assert row.phase is ends[event], (phase, event)
        if event is GoalEvent.UNWOUND:
            assert row.phase is (Phase.CANCELED if phase is Phase.CANCELING else Phase.ABORTED), phase
        if event is GoalEvent.OUTSTAYED:
            assert row.do == (Do.DEGRADE,), phase
        if event is GoalEvent.CLIENT_LOST and phase is not Phase.CANCELING:
            assert row == Step(phase, (Do.AWAIT_CLIENT,)), phase
        if phase is Phase.QUEUED and row.phase not in (Phase.QUEUED, Phase.RUNNING):
            assert (Do.DEQUEUE in row.do) is (event is not GoalEvent.DROPPED), event  # the queue itself has dropped it
        if phase is Phase.DECIDING and event not in (GoalEvent.ACCEPTED, GoalEvent.CLIENT_LOST):
            assert row.phase is Phase.REJECTED, event
        if phase in (Phase.RUNNING, Phase.PREEMPTED) and event is GoalEvent.CANCEL:
            assert row.phase is Phase.CANCELING, phase

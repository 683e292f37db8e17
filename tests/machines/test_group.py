"""The slots and tickets of a concurrency group."""

from __future__ import annotations

from collections import deque
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from graphflow.machines.group import GroupState
from tests.cases import count, slow


def test_slots_are_given_until_the_limit() -> None:
    """A group of two admits two and gives the third a ticket."""
    group: GroupState[str] = GroupState(2)

    assert [group.admit(m) for m in "abc"] == [True, True, False]
    assert group.running == 2
    assert group.waiting == ("c",)


def test_a_group_without_limit_admits_everybody() -> None:
    """Nobody ever waits in a group whose limit is None."""
    group: GroupState[int] = GroupState(None)

    assert all(group.admit(n % 3) for n in range(100))
    assert group.running == 100
    assert [group.release() for _ in range(100)] == [None] * 100
    assert group.running == 0


def test_a_slot_is_handed_to_the_head_of_the_queue() -> None:
    """The slot given back belongs to whoever waited longest, and a newcomer cannot take it in between."""
    group: GroupState[str] = GroupState(1)
    assert group.admit("a")
    assert not group.admit("b")
    assert not group.admit("c")

    assert group.release() == "b"

    assert group.running == 1
    assert not group.admit("a")
    assert group.waiting == ("c", "a")


def test_a_newcomer_queues_behind_those_who_wait() -> None:
    """A free slot does not let anybody overtake the queue."""
    group: GroupState[str] = GroupState(1)
    group.admit("a")
    group.admit("b")
    group.limit = 2

    assert not group.admit("c")
    assert group.waiting == ("b", "c")


def test_a_member_has_one_ticket() -> None:
    """Asking again while waiting neither adds a ticket nor loses the place."""
    group: GroupState[str] = GroupState(1)
    group.admit("a")
    for _ in range(3):
        assert not group.admit("b")
    assert not group.admit("c")
    assert not group.admit("b")

    assert group.waiting == ("b", "c")


def test_a_withdrawn_ticket_is_not_served() -> None:
    """The slot passes to the next in the queue; to withdraw without a ticket changes nothing."""
    group: GroupState[str] = GroupState(1)
    for member in "abc":
        group.admit(member)

    group.withdraw("b")
    group.withdraw("nobody")

    assert group.release() == "c"
    assert group.release() is None
    assert group.running == 0


def test_a_lowered_limit_is_reached_by_attrition() -> None:
    """While more run than the new limit allows, a slot given back is not passed on."""
    group: GroupState[str] = GroupState(2)
    for member in "abc":
        group.admit(member)

    group.limit = 1

    assert group.release() is None
    assert group.running == 1
    assert group.release() == "c"


class Schedules(RuleBasedStateMachine):
    """Any order of asking, giving back and withdrawing, against a model that keeps two lists."""

    group: GroupState[int]

    @initialize(limit=st.one_of(st.none(), st.integers(1, 4)))
    def begin(self, limit: int | None) -> None:
        self.limit = limit
        self.group = GroupState(limit)
        self.holders: list[int] = []
        self.queue: deque[int] = deque()

    def full(self) -> bool:
        return self.limit is not None and len(self.holders) >= self.limit

    @rule(member=st.integers(0, 5))
    def admit(self, member: int) -> None:
        expected = not self.queue and not self.full()
        assert self.group.admit(member) is expected
        if expected:
            self.holders.append(member)
        elif member not in self.queue:
            self.queue.append(member)

    @precondition(lambda self: self.holders)
    @rule(data=st.data())
    def release(self, data: st.DataObject) -> None:
        self.holders.remove(data.draw(st.sampled_from(self.holders)))
        successor = self.queue.popleft() if self.queue and not self.full() else None
        assert self.group.release() == successor
        if successor is not None:
            self.holders.append(successor)

    @rule(member=st.integers(0, 5))
    def withdraw(self, member: int) -> None:
        self.group.withdraw(member)
        if member in self.queue:
            self.queue.remove(member)

    @invariant()
    def agrees(self) -> None:
        if not hasattr(self, "limit"):
            return
        assert self.group.running == len(self.holders)
        assert self.group.waiting == tuple(self.queue)
        assert self.limit is None or self.group.running <= self.limit
        # No slot lies idle while somebody waits.
        assert not self.queue or self.full()


TestSchedules = Schedules.TestCase
TestSchedules.settings = settings(max_examples=count(few=25, full=100), stateful_step_count=30, deadline=None)


@slow
@given(
    work=st.lists(st.integers(1, 6), min_size=2, max_size=6),
    limit=st.integers(1, 3),
    order=st.randoms(use_true_random=False),
)
@settings(deadline=None)
def test_nobody_is_passed_over(work: list[int], limit: int, order: Random) -> None:
    """With n members that re-queue after each run, one with work runs after at most n - 1 other runs."""
    group: GroupState[int] = GroupState(limit)
    left = dict(enumerate(work))
    since = dict.fromkeys(left, 0)
    running: list[int] = []

    def begin(member: int) -> None:
        left[member] -= 1
        running.append(member)
        since[member] = 0
        for other in left:
            if other != member and other in group.waiting:
                since[other] += 1
                assert since[other] <= len(left) - 1

    for member in left:
        if group.admit(member):
            begin(member)
    while running:
        ended = order.choice(running)
        running.remove(ended)
        successor = group.release()
        if left[ended] and group.admit(ended):
            begin(ended)
        if successor is not None:
            assert left[successor]
            begin(successor)

    assert not any(left.values())
    assert group.running == 0


@pytest.mark.parametrize("limit", [1, 2, 3])
def test_members_with_endless_work_take_turns(limit: int) -> None:
    """Members that always have work run equally often."""
    group: GroupState[int] = GroupState(limit)
    runs = [0] * 4
    running: deque[int] = deque()
    for member in range(4):
        if group.admit(member):
            running.append(member)
    for _ in range(100):
        ended = running.popleft()
        runs[ended] += 1
        successor = group.release()
        if group.admit(ended):
            running.append(ended)
        if successor is not None:
            running.append(successor)

    assert runs == [25] * 4

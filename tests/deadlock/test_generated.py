"""Generated systems of real nodes under virtual time: what stands still for ever is reported, and nothing else.

A system is nodes in one or two processes with groups, services, actions, and what starts call trees through them. It
runs until nothing moves. What its handlers write into a `Diary` says who has never ended, who waits for whom, and who
took a step when: the truth that reports are held against, which is not read from graphflow's own account of waits.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from tests.cases import cases, count, limit, slow
from tests.deadlock.system_runs import outcome_of
from tests.deadlock.systems import Ask, Both, Fail, How, Meet, Nap, Place, Server, Starter, Step, System, systems

CASES = count(few=15, full=300)
"""Systems that are tried."""

SEEDS = st.integers(0, 1000)
long = limit(CASES)

SEEN: Counter[str] = Counter()
"""What has come of the systems that were tried."""
SHAPES = {"of one", "of two", "of several", "in two processes", "all of several", "limit above 1", "goal"}


@pytest.fixture(scope="module", autouse=True)
def many_kinds(request: pytest.FixtureRequest) -> Iterator[None]:
    """See that a good part of what is generated stands still, and not always in the same way."""
    SEEN.clear()
    yield
    if SEEN["deadlock"] + SEEN["no deadlock"] >= 100 and not request.session.testsfailed:
        assert 0.2 <= SEEN["deadlock"] / (SEEN["deadlock"] + SEEN["no deadlock"]) <= 0.7
        assert set(SEEN) >= SHAPES


def tell(*happened: str) -> None:
    SEEN.update(happened)
    for what in happened:
        event(what)


@slow
@long
@cases(CASES * 2 // 5)
@given(systems(), SEEDS)
def test_what_never_ends_is_reported(system: System, seed: int) -> None:
    """Every ring of those who wait for ever for each other is reported in time; what ends is never named."""
    outcome = outcome_of(system, seed, "report")

    assert outcome.refused == 0
    tell("deadlock" if outcome.stuck else "no deadlock", *outcome.shapes)


@long
@cases(CASES // 5)
@given(systems(ends=True), SEEDS)
def test_what_is_given_up_or_fails(system: System, seed: int) -> None:
    """A report is true until something is given up, or fails where it says so; what stands then is reported."""
    outcome = outcome_of(system, seed, "report")

    tell("stuck" if outcome.stuck else "not stuck", *outcome.shapes)


@long
@cases(CASES // 5)
@given(systems(replies=False), SEEDS)
def test_hopeless_calls_fail(system: System, seed: int) -> None:
    """Where a call could never be answered, one fails, and none is left; everywhere else, none does."""
    reported, raised = outcome_of(system, seed, "report"), outcome_of(system, seed, "raise")

    assert (raised.refused > 0) is (reported.hopeless > 0)
    assert raised.hopeless == 0
    tell("raised" if raised.refused else "nothing raised", *reported.shapes)


@long
@cases(CASES // 5)
@given(st.one_of(systems(), systems(ends=True)), SEEDS)
def test_rings_are_broken(system: System, seed: int) -> None:
    """With the policy `break` everything ends."""
    outcome = outcome_of(system, seed, "break")

    assert not outcome.stuck
    tell("broken" if outcome.refused else "nothing broken")


# By hand
HOME = Place(0, 0)


def alone(*starters: Starter, replies: int | None = None) -> System:
    """One node with a service, both in one group with one slot."""
    return System((0,), ((0, 1),), (replies,), (Server(HOME, "service"),), starters)


@pytest.mark.parametrize("how", ["wait", "gather errors"])
def test_a_wait_for_all_of_which_one_has_failed(how: How) -> None:
    """It is as dead as the one that is left."""
    both = Both((Ask(0), Fail()), how)

    outcome_of(alone(Starter(HOME, "timer", 0.1, 1, (Step(both),))), 0, "report")


def test_a_hopeless_call_of_a_client_in_a_group() -> None:
    """It fails as any other does."""
    outcome = outcome_of(alone(Starter(HOME, "timer", 0.1, 1, (Step(Ask(0)),)), replies=0), 0, "raise")

    assert outcome.refused == 1


@slow
def test_a_report_that_is_taken_back() -> None:
    """It is taken back half a second after the ring has ended, whatever else there was to be looked at."""
    servers = Server(Place(0, 0), "service"), Server(Place(1, 1), "service"), Server(Place(1, None), "parallel")
    ring = [Starter(Place(i, i), "timer", 0.05, 1, (Step(Ask(1 - i, timeout=0.6)),)) for i in (0, 1)]
    slow = Step(Ask(2, (Step(Nap(0.5)),)))
    others = [Starter(Place(0, None), "task", 0.05 + 0.01 * i, 1, (slow,)) for i in range(8)]
    system = System((0, 1), ((0, 1), (1, 1)), (None, None), servers, (*ring, *others))

    outcome = outcome_of(system, 0, "report")

    assert outcome.told == 1
    assert outcome.seconds < 5.0


@slow
def test_a_report_that_somebody_without_handlers_had_a_part_in() -> None:
    """It is taken back as any other is."""
    asks = Step(Ask(0, (Step(Ask(0, timeout=0.6)),)))
    servers = (Server(Place(0, None), "service"),)
    starters = (Starter(Place(1, None), "task", 0.1, 1, (asks,)),)

    system = System((0, 1), (), (None, None), servers, starters, have_handlers=False)

    assert [outcome_of(system, seed, "report").told for seed in range(20)] == [1] * 20


def test_a_ring_that_becomes_another() -> None:
    """One of three gives up and waits for the first all the same: that is told again, and nothing has cleared."""
    inner = Step(Ask(0, (Step(Nap(0.3), is_released=True),), timeout=0.9), is_released=True)
    first = Starter(HOME, "timer", 0.05, 1, (Step(Ask(0, (inner,))),))
    second = Starter(HOME, "timer", 0.2, 1, (Step(Ask(0)),))

    outcome = outcome_of(System((0,), ((0, 2),), (None,), (Server(HOME, "service"),), (first, second)), 0, "report")

    assert outcome.told == 2


def test_somebody_who_joins_a_deadlock() -> None:
    """He is told of, as others are who come to wait for it."""
    home = Place(0, None)
    late, soon = Ask(0, (Step(Nap(1.0)), Step(Ask(2)))), Ask(1, (Step(Ask(2)),))
    starter = Starter(home, "task", 0.1, 1, (Step(Ask(2, (Step(Both((late, soon))),))),))

    outcome = outcome_of(System((0,), (), (None,), (Server(home, "service"),) * 3, (starter,)), 0, "report")

    assert outcome.told == 1
    assert not outcome.unnamed


@slow
def test_a_deadlock_of_several_rings_in_two_processes() -> None:
    """It is told once."""
    inner = Step(Both((Ask(0), Ask(1))))
    asks = Step(Ask(1, (Step(Ask(0, (inner,))),)))
    servers = Server(Place(1, None), "service"), Server(Place(0, None), "service")
    system = System((0, 1), (), (None, None), servers, (Starter(Place(0, None), "task", 0.1, 1, (asks,)),))

    assert [outcome_of(system, seed, "report").told for seed in range(5)] == [1] * 5


def test_tasks_that_wait_for_each_other() -> None:
    """They are found though nothing else waits."""
    starters = (Starter(HOME, "task", 0.1, 1, (Step(Meet(other)),)) for other in (1, 0))

    assert outcome_of(alone(*starters), 0, "report").told == 1

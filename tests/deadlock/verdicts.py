"""Reports of deadlocks held against the diary of a system."""

from __future__ import annotations

from collections.abc import Iterator

from graphflow.machines.waits.explain import title
from tests.deadlock.diary import Diary, Life, Report, dead
from tests.deadlock.systems import Both, Either
from tests.flat import flat

REPORTED_WITHIN = 1.5
"""Seconds from the last step of anybody in a ring to its report: a quarter of one, and two questions to others.

They are asked anew when one of several things that somebody waits for has come between the questions.
"""
SCATTER = 0.2
"""Seconds between the pictures that two processes take of themselves for one question, at most: some come late."""


def check(diary: Diary) -> None:
    """Who is stuck for ever is dead in a picture, every ring of them is reported in time, and nothing else is."""
    assert diary.stumbled == []
    stuck = {life.id for life in diary.stuck()}
    whole = diary.picture()
    assert dead(whole) == stuck
    standing = diary.standing()
    assert all(ring <= stuck for ring in standing)
    assert len(standing) == len(set(standing)), "told by two processes"
    for members in diary.deadlocks():
        names = {life.id for life in members}
        assert any(ring <= names for ring in standing)
        closed = diary.times[max(map(diary.last_move, members))]
        assert any(r.ring <= names and diary.times[r.when] <= closed + REPORTED_WITHIN for r in diary.reports)
    for report in diary.reports + diary.looks:
        check_true(report, diary)
    assert not diary.cleared or diary.given_up or diary.failed
    # Of those who wait for each other, a report tells one ring.
    assert not unnamed(diary) - {life.id for life in diary.stuck() if life in diary.before(life)}


def unnamed(diary: Diary) -> set[str]:
    """Who is stuck and in no report, neither in a ring nor behind one."""
    said = flat("\n".join([report.text for report in diary.reports] + diary.behind))
    known = diary.picture().activities
    return {life.id for life in diary.stuck() if f"{title(known[life.id])} " not in said}


def check_true(report: Report, diary: Diary) -> None:
    """Nobody in a ring goes on before something is given up; or, if that is said, before something fails."""
    ends = diary.given_up + (diary.failed if report.is_partial else [])
    # Between the pictures and the report something may have ended.
    since = [i for i in ends if diary.times[i] >= diary.times[report.when] - 2 * SCATTER]
    for name in report.ring:
        later = [i for i in diary.lives[name].moves if i > report.when]
        assert not later or (since and min(since) < later[0])


def shapes(diary: Diary) -> Iterator[str]:
    """What kinds of deadlocks there are."""
    for members in diary.deadlocks():
        yield {1: "of one", 2: "of two"}.get(len(members), "of several")
        if len({life.id.partition(":")[0] for life in members}) > 1:
            yield "in two processes"
        for life in members:
            yield from shapes_of(life, diary)
    if any(report.is_partial for report in diary.reports):
        yield "partial"


def shapes_of(life: Life, diary: Diary) -> Iterator[str]:
    if life.does is not None and isinstance(life.does.work, (Both, Either)):
        yield "first of several" if isinstance(life.does.work, Either) else "all of several"
    if any(diary.limit(slot) > 1 for slot in diary.missing(life)):
        yield "limit above 1"
    if any(diary.system.servers[diary.requests[i].ask.server].is_action for i in life.asks):
        yield "goal"
    if any(i in diary.served and diary.served[i].is_over for i in life.asks):
        yield "reply"
    if life.wants:
        yield "on the way back"
    if ":t" in life.id:
        yield "task"

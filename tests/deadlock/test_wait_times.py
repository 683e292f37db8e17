"""The ages of waits, and the time until their deadlines."""

from __future__ import annotations

import asyncio

from graphflow.deadlock.wait_times import WaitTimes
from graphflow.machines.waits.wait_graph import FREE, Call, Condition
from tests.deadlock.stage import Stage

ADD, TURN = Call("a", "/add"), Call("goal", "/turn")
SECOND = 1_000_000_000


async def test_the_age_of_a_wait_that_nobody_wrote_down(graphflow_runner: asyncio.Runner) -> None:
    """It is counted from the first time it was seen; the same wait of another activity is another."""
    times, task = WaitTimes(Stage()), asyncio.current_task()
    assert task is not None

    def age(activity: str, wait: Condition, now_s: int) -> float:
        return times.of(activity, wait, task, now_s * SECOND, None)[0]

    assert [age("a", ADD, now) for now in (1, 3)] == [0.0, 2.0]
    assert age("a", TURN, 3) == age("b", ADD, 3) == age("a", FREE, 9) == 0.0
    times.forget({("b", ADD)})
    assert (age("b", ADD, 4), age("a", ADD, 4)) == (1.0, 0.0)


async def test_a_deadline(graphflow_runner: asyncio.Runner) -> None:
    """The first one counts: the call's, or that of a timeout around it."""
    stage, task = Stage(), asyncio.current_task()
    assert task is not None
    times, future = WaitTimes(stage), stage.loop.create_future()
    with stage.ledger.call(future, b"\1" * 16, 7, "/add", 0, 5 * SECOND):
        [call] = stage.ledger.calls.values()
        wait = Call(call.id, "/add")
        assert times.of("a", wait, task, 2 * SECOND, None) == (2.0, 3.0)
        assert times.of("a", wait, task, 2 * SECOND, 3 * SECOND) == (2.0, 1.0)
    assert times.of("a", FREE, task, 2 * SECOND, 3 * SECOND) == (0.0, None)

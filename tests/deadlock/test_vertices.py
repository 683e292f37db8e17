"""Vertices of a snapshot: their ids, the slots that runs take, and the calls that items stand for."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

from graphflow.deadlock.vertices import Vertices, arrived_calls, call_of
from graphflow.machines.waits.wait_graph import call_id, goal_id
from graphflow.wire import attachment
from tests.deadlock.stage import Stage, begin

GID = b"\1" * 16


async def test_ids(graphflow_runner: asyncio.Runner) -> None:
    """A run, a task and a queue each have one of their own, below the id of the session."""
    stage = Stage()
    actor = stage.actor()

    async def waits(_: object) -> None:
        await stage.loop.create_future()

    tick = stage.handler(actor, "tick", waits, kind="timer")
    await begin(tick, "now")
    [run] = tick.active
    task = asyncio.create_task(asyncio.sleep(0))
    vertices = Vertices("z", lambda other: 7 if other is task else 0)
    assert vertices.run_id(run) == vertices.task_id(run) == f"z:{run.number}"
    assert vertices.task_id(task) == "z:t7"
    assert vertices.queue_id(tick) == f"z:q{tick.number}"
    await task


async def test_slots(graphflow_runner: asyncio.Runner) -> None:
    """A serial handler takes one of its own queue besides that of its group."""
    stage = Stage()
    actor = stage.actor()
    group = actor.groups.named("motion")
    serial = stage.handler(actor, "add", group=group, kind="service", is_serial=True)
    free = stage.handler(actor, "see", is_serial=False)
    vertices = Vertices("z", lambda task: 0)

    assert vertices.slots(actor, serial, group) == ("z:/robot:motion", f"z:own{serial.number}")
    assert vertices.slots(actor, free, None) == ()
    assert [(view.name, view.limit) for view in vertices.groups.values()] == [("motion", 1), ("", 1)]


async def test_a_group_that_cancels_is_never_full(graphflow_runner: asyncio.Runner) -> None:
    """A new run takes the place of the one that holds its slot."""
    actor = Stage().actor()
    group = actor.groups.named("motion")
    assert group is not None
    group.when_full = "cancel_running"
    vertices = Vertices("z", lambda task: 0)
    assert vertices.groups[vertices.group_id(actor, group)].limit is None


async def test_calls(graphflow_runner: asyncio.Runner) -> None:
    """Requests, goals and replies stand for calls; messages do not, nor do requests that cannot be read."""
    stage = Stage()
    actor = stage.actor()
    add = stage.handler(actor, "add", kind="service")
    go = stage.handler(actor, "go", kind="action")
    hear = stage.handler(actor, "hear")
    request = SimpleNamespace(attachment=attachment.pack(5, 0, GID))

    assert call_of(add, request) == call_id(GID, 5)
    assert call_of(add, SimpleNamespace(attachment=None)) == ""
    assert call_of(go, SimpleNamespace(goal_id=GID)) == goal_id(GID)
    assert call_of(hear, "hello") == ""
    stage.requests += [(add, GID, 5), (add, GID, 6)]
    assert arrived_calls(stage) == {add.number: [call_id(GID, 5), call_id(GID, 6)]}

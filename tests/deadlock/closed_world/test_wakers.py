"""Who can end a wait, by what the source of a class tells: short classes, and whom each names."""

from __future__ import annotations

import asyncio
import textwrap
from typing import Any

import pytest

from graphflow.analysis.class_source import Unknown
from graphflow.deadlock.asyncio_frames import frames_of, waiter_of
from graphflow.deadlock.closed_world.object_waits import setters
from graphflow.deadlock.closed_world.wakers import Setters, cancellers, entries_of, method_of
from graphflow.executor.ledger import PendingGoal
from graphflow.testing.clock import settle
from tests.deadlock.stage import Actor, Stage
from tests.written import Written

TEXT = """
import asyncio
import threading
from collections import deque

def keep(thing): ...

class N:
    there = False

    def __init__(self):
        self.arrived = asyncio.Event()
        self.words = asyncio.Queue()
        self.full = asyncio.Queue(1)
        self.full.put_nowait(0)
        self.news = asyncio.Condition()
        self.permits = asyncio.Semaphore(0)
        self.lock = asyncio.Lock()
        self.pair = asyncio.Semaphore(2)
        self.promise = asyncio.get_running_loop().create_future()
        self.several = {"one": asyncio.Event()}
        self.heard = []
        self.level = 0
        self.task = None

{body}
"""


class Scene:
    """A node whose `on_go` waits, with handlers, a timer and a task, all that its source names as one.

    Args:
        body: Methods; and behind two empty lines, what stands beside the class.
    """

    def __init__(self, written: Written, body: str) -> None:
        inside, _, beside = body.partition("\n\n\n")
        self.node: Any = written(TEXT.replace("{body}", textwrap.indent(inside, "    ")) + beside).N()
        self.stage = Stage()
        self.actor: Actor = self.stage.actor(self.node)
        for name in ("on_go", "on_arrive", "on_leave"):
            if hasattr(self.node, name):
                self.stage.handler(self.actor, name)
        if hasattr(self.node, "tick"):
            self.stage.handler(self.actor, "tick", kind="timer")
        if hasattr(self.node, "run"):
            self.actor.tasks.add(asyncio.get_running_loop().create_task(self.node.run(), name="/robot.run"))
        if hasattr(self.node, "check"):
            self.actor.hooks.add("check")

    async def found(self, *, is_bounded: bool = False) -> Setters | None:
        """Who can end the wait of `on_go`."""
        task = asyncio.create_task(self.node.on_go())
        await settle()
        assert not task.done()
        return setters(frames_of(task), waiter_of(task), self.actor, is_bounded=is_bounded)


WAIT = "async def on_go(self): await self.arrived.wait()"
POLL = "async def on_go(self):\n    while not self.there:\n        await asyncio.sleep(60)"
ARRIVE = "def on_arrive(self): self.arrived.set()"

# What is waited for, and who ends that


@pytest.mark.parametrize(
    ("wait", "end", "what"),
    [
        ("await self.arrived.wait()", "self.arrived.set()", "self.arrived"),
        ("await self.words.get()", "self.words.put_nowait(1)", "self.words"),
        ("await self.full.put(1)", "self.full.get_nowait()", "self.full"),
        ("await self.full.join()", "self.full.task_done()", "self.full"),
        ("async with self.news: await self.news.wait()", "self.news.notify_all()", "self.news"),
        ("await self.permits.acquire()", "self.permits.release()", "self.permits"),
        ("await self.promise", "self.promise.set_result(None)", "self.promise"),
        ("await self.several['one'].wait()", "self.several['one'].set()", "a part of self.several"),
        ("while not self.there: await asyncio.sleep(60)", "self.there = True", "self.there"),
        ("while not self.arrived.is_set(): await asyncio.sleep(60)", "self.arrived.set()", "self.arrived"),
        ("while self.words.empty(): await asyncio.sleep(60)", "self.words.put_nowait(1)", "self.words"),
        (
            "while self.level < 3 and not self.heard: await asyncio.sleep(60)",
            "self.level += 1",
            "self.heard and self.level",
        ),
        ("while not self.heard: await asyncio.sleep(60)", "self.heard.append(1)", "self.heard"),
        ("while not self.heard: await asyncio.sleep(60)", "self.heard = [1]", "self.heard"),
    ],
)
async def test_who_ends_a_wait(
    graphflow_runner: asyncio.Runner, written: Written, wait: str, end: str, what: str
) -> None:
    """The handler whose body has what ends it, for each kind of wait that is known."""
    head, colon, tail = wait.rpartition(": ")
    lines = f"    {head}:\n        {tail}" if colon else f"    {wait}"
    found = await Scene(written, f"async def on_go(self):\n{lines}\ndef on_arrive(self): {end}").found()

    assert found is not None
    assert (found.what, set(found.handlers), found.tasks) == (what, {"on_arrive"}, ())


@pytest.mark.parametrize(
    ("body", "handlers"),
    [
        (ARRIVE, {"on_arrive"}),
        (f"{ARRIVE}\ndef on_leave(self): self.arrived.set()", {"on_arrive", "on_leave"}),
        ("def on_arrive(self): self.note()\ndef note(self): self.arrived.set()", {"on_arrive"}),
        ("def tick(self): self.arrived.set()", {"tick"}),
        ("async def run(self):\n    await asyncio.sleep(60)\n    self.arrived.set()", {"run"}),
        (f"{ARRIVE}\ndef on_leave(self): self.arrived.clear()", {"on_arrive"}),
        (f"{ARRIVE}\ndef on_leave(self): print(self.arrived)", {"on_arrive"}),
        (f"{ARRIVE}\ndef on_start(self): self.arrived.set()", {"on_arrive"}),
    ],
)
async def test_who_sets_an_event(
    graphflow_runner: asyncio.Runner, written: Written, body: str, handlers: set[str]
) -> None:
    """All handlers, timers and tasks that do, by themselves or through other methods; what is over does not count."""
    found = await Scene(written, f"{WAIT}\n{body}").found()

    assert found is not None
    assert found.handlers == handlers


@pytest.mark.parametrize(
    "body",
    [
        pytest.param("", id="nobody"),
        pytest.param("def on_arrive(self): keep(self.arrived)", id="given away"),
        pytest.param(f"{ARRIVE}\ndef on_leave(self): keep(self.arrived.set)", id="its method is given away"),
        pytest.param("def on_arrive(self): keep(lambda: self.arrived.set())", id="a function inside"),
        pytest.param(f"{ARRIVE}\ndef on_leave(self): setattr(self, 'x', 1)", id="by name"),
        pytest.param(f"{ARRIVE}\ndef on_leave(self, other): self.arrived = other", id="somebody else's event"),
        pytest.param("def note(self): self.arrived.set()", id="a method that nobody is seen to call"),
        pytest.param("def check(self): self.arrived.set()", id="a hook"),
        pytest.param(f"{ARRIVE}\ndef on_leave(self): keep(self.on_arrive)", id="the handler is given away"),
        pytest.param(f"{ARRIVE}\n\n\ndef outside(n):\n    n.arrived.set()", id="another object's"),
    ],
)
async def test_waits_of_which_nothing_is_known(graphflow_runner: asyncio.Runner, written: Written, body: str) -> None:
    """Nobody ends them, or somebody may who is not seen."""
    assert await Scene(written, f"{WAIT}\n{body}").found() is None


@pytest.mark.parametrize(
    ("body", "is_known"),
    [
        ("def on_arrive(self): self.there = True", True),
        ("def on_arrive(self): self.there = False", False),
        ("def on_arrive(self):\n    self.there = True\n\n\ndef outside(n):\n    n.there = True", False),
        ("def on_arrive(self): keep(lambda: setattr(self, 'there', True))", False),
        ("def on_arrive(self): self.note()\ndef note(self): self.there = True", True),
    ],
)
async def test_flags(graphflow_runner: asyncio.Runner, written: Written, body: str, is_known: bool) -> None:
    """Whoever assigns something else than what it is; nobody is known where others may."""
    found = await Scene(written, f"{POLL}\n{body}").found()

    assert (found is not None) is is_known


@pytest.mark.parametrize(
    "turn",
    [
        "self.there = self.level > 3",
        "self.turn()\ndef turn(self): self.there = self.level > 3",
        "self.turn()\ndef turn(self): assert self.level < 3",
    ],
)
async def test_loops_that_may_end_by_themselves(graphflow_runner: asyncio.Runner, written: Written, turn: str) -> None:
    """One that changes what it looks at, itself or in what it calls, or that an error may leave."""
    head = "async def on_go(self):\n    while not self.there:\n        await asyncio.sleep(60)\n"

    assert await Scene(written, f"{head}        {turn}\ndef on_arrive(self): self.there = True").found() is None


async def test_a_loop_that_ends(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """Nobody need do anything for one that goes over something."""
    body = "async def on_go(self):\n    for _ in range(3):\n        await asyncio.sleep(60)"

    assert await Scene(written, f"{body}\ndef on_arrive(self): self.there = True").found() is None


@pytest.mark.parametrize("value", ["self.heard", "self.heard.append"])
async def test_a_container_that_others_know(graphflow_runner: asyncio.Runner, written: Written, value: str) -> None:
    """They may fill it: nothing is known."""
    poll = "async def on_go(self):\n    while not self.heard:\n        await asyncio.sleep(60)"
    fills = "def on_arrive(self): self.heard.append(1)"

    assert await Scene(written, f"{poll}\n{fills}").found() is not None
    assert await Scene(written, f"{poll}\n{fills}\ndef on_leave(self): keep({value})").found() is None
    elsewhere = f"\n\n\nclass Other:\n    def go(self, n): keep({value.replace('self', 'n')})"
    assert await Scene(written, f"{poll}\n{fills}{elsewhere}").found() is None


@pytest.mark.parametrize(("is_bounded", "what"), [(False, "self.arrived"), (True, "self.there")])
async def test_a_wait_that_is_tried_again(
    graphflow_runner: asyncio.Runner, written: Written, is_bounded: bool, what: str
) -> None:
    """Where each wait is given up after some time, it matters when the loop around it stops."""
    body = "async def on_go(self):\n    while not self.there:\n        await self.arrived.wait()"
    scene = Scene(written, f"{body}\ndef on_arrive(self):\n    self.there = True\n    self.arrived.set()")
    found = await scene.found(is_bounded=is_bounded)

    assert found is not None
    assert found.what == what


# Locks and tasks


@pytest.mark.parametrize(("lock", "places"), [("lock", 1), ("pair", 2)])
async def test_a_lock_that_is_entered(
    graphflow_runner: asyncio.Runner, written: Written, lock: str, places: int
) -> None:
    """It is ended by who leaves it: told with the lock itself, and how many fit into it."""
    enters = f"async def on_arrive(self):\n    async with self.{lock}: ..."
    scene = Scene(written, f"async def on_go(self): await self.{lock}.acquire()\n{enters}")
    thing = getattr(scene.node, lock)
    for _ in range(places):
        await thing.acquire()
    found = await scene.found()

    assert found == Setters(f"self.{lock}", frozenset(), thing, places, verb="releases")


@pytest.mark.parametrize(
    ("more", "line"),
    [("", 2), ("print()\n        ", 3), ("await asyncio.sleep(1)\n        ", None)],
)
async def test_where_a_loop_pauses(
    graphflow_runner: asyncio.Runner, written: Written, more: str, line: int | None
) -> None:
    """In the only line in which it sleeps, so that a thread is not reported where it happened to be seen."""
    polls = POLL.replace("    await", f"    {more}await")
    scene = Scene(written, f"{polls}\ndef on_arrive(self): self.there = True")
    found = await scene.found()
    assert found is not None
    begin = type(scene.node).on_go.__code__.co_firstlineno
    assert (found.pause and found.pause.line) == (line and begin + line)
    assert found.pause is None or found.pause.frame.f_code is type(scene.node).on_go.__code__


async def test_a_lock_that_is_released_by_hand(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """It is ended by whoever calls that."""
    scene = Scene(written, "async def on_go(self): await self.lock.acquire()\ndef on_leave(self): self.lock.release()")
    await scene.node.lock.acquire()
    found = await scene.found()

    assert found is not None
    assert (set(found.handlers), found.lock) == ({"on_leave"}, None)


async def test_a_loop_that_ends_with_a_task(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """The task is told; who else changes what the loop looks at is, too."""
    body = (
        "async def on_go(self):\n"
        "    asking = asyncio.create_task(asyncio.sleep(60))\n"
        "    while not asking.done() and not self.there:\n"
        "        await asyncio.sleep(60)\n"
        "def on_arrive(self): self.there = True"
    )
    found = await Scene(written, body).found()

    assert found is not None
    assert (set(found.handlers), len(found.tasks)) == ({"on_arrive"}, 1)


class Goal(PendingGoal):
    """A goal that has not ended."""

    done = False


@pytest.mark.parametrize(
    ("body", "handlers"),
    [
        ("def tick(self): self.task.cancel()", {"tick"}),
        ("async def run(self):\n    await asyncio.sleep(60)\n    self.task.cancel()", {"run"}),
        ("def tick(self): self.end()\ndef end(self): self.task.cancel()", {"tick"}),
        ("def on_arrive(self): self.task.cancel()", None),
        ("def on_shutdown(self): self.task.cancel()", None),
        ("def tick(self): print(self.task)", None),
    ],
)
@pytest.mark.parametrize("is_goal", [False, True])
async def test_who_cancels(
    graphflow_runner: asyncio.Runner, written: Written, body: str, handlers: set[str] | None, is_goal: bool
) -> None:
    """Timers and tasks do it of themselves; who does it when he is told to is like the world outside."""
    scene = Scene(written, body)
    thing = Goal() if is_goal else asyncio.create_task(asyncio.Event().wait())
    assert cancellers(thing, scene.actor) is None
    scene.node.task = thing
    found = cancellers(thing, scene.actor)

    assert (None if found is None else found.handlers) == handlers
    assert found is None or found.what == "self.task"


@pytest.mark.parametrize(
    "body",
    [
        "def tick(self):\n    keep(self.task)\n    self.other.cancel()",
        "def on_arrive(self, other): other.cancel()",
    ],
)
async def test_somebody_may_cancel(graphflow_runner: asyncio.Runner, written: Written, body: str) -> None:
    """Where the task is given away, or is one of several, whatever is cancelled may be it."""
    scene = Scene(written, body)
    thing = Goal()
    scene.node.task = [thing]

    with pytest.raises(Unknown):
        cancellers(thing, scene.actor)


async def test_a_part_of_a_gather_cancels(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """It may belong to the very run that waits."""
    body = "async def on_arrive(self): await asyncio.gather(self.end())\nasync def end(self): self.task.cancel()"
    scene = Scene(written, body)
    scene.node.task = thing = Goal()

    with pytest.raises(Unknown):
        cancellers(thing, scene.actor)


async def test_what_graphflow_runs(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """The handlers, by name, and the tasks, by that of their functions."""
    scene = Scene(
        written, "async def run(self): await asyncio.sleep(60)\ndef on_arrive(self): ...\ndef note(self): ..."
    )
    [task] = scene.actor.tasks

    assert entries_of(scene.actor) == {"on_arrive", "run"}
    assert method_of(task) == "run"


@pytest.mark.parametrize(("module", "is_found"), [("elsewhere", False), ("graphflow.elsewhere", True)])
async def test_code_of_others(graphflow_runner: asyncio.Runner, written: Written, module: str, is_found: bool) -> None:
    """What a method calls and is not the node's own may do as it likes, unless it is graphflow's or Python's."""
    space: dict[str, Any] = {"__name__": module}
    exec("async def others(): await event.wait()", space)
    scene = Scene(written, f"async def on_go(self): await self.others()\n{ARRIVE}")
    scene.node.others, space["event"] = space["others"], scene.node.arrived
    found = await scene.found()

    assert (found is not None) is is_found


async def test_a_wait_outside_of_all_methods(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """Nothing is known of it."""
    assert setters([], None, Scene(written, ARRIVE).actor) is None

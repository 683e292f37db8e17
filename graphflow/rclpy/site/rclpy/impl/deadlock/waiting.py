"""The waits among the callbacks and threads of one process, for the deadlock detector.

An executor is a group with as many slots as it has threads, and a callback group is one with one slot; a callback that
runs holds slots of both, and a suspended one only that of its callback group. Arrivals wait in queues, one for each
entity, that need both. A node without an executor needs a thread that spins, which may be any of the program's
own. Nothing is recorded while callbacks run: stacks and entities are read on request.
"""

from __future__ import annotations

import threading
import time
from contextlib import suppress
from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from graphflow.analysis.local_messages import know_messages
from graphflow.analysis.user_code import where
from graphflow.deadlock.asyncio_frames import know_futures
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    Call,
    GroupView,
    Join,
    QueueView,
    Slot,
    WaitGraph,
)
from graphflow.rclpy.context_state import LOOP
from graphflow.rclpy.messages.classes import StrictMessage
from graphflow.times import to_ns
from rclpy.action.server import ActionServer
from rclpy.impl.deadlock.blocking import blocked
from rclpy.impl.deadlock.conditions import Conditions, Wait
from rclpy.impl.deadlock.group_rows import group_rows
from rclpy.impl.deadlock.groups import ATTEMPTS, called, executors, is_exclusive, threads_of
from rclpy.impl.deadlock.reading import Reading
from rclpy.impl.deadlock.stacks import Level, Stack, standing
from rclpy.impl.entities import (
    action_of,
    arrived,
    frames_of,
    full_name,
    result_requests,
    served,
)
from rclpy.impl.spinning import Run
from rclpy.impl.watches.watches import Watches
from rclpy.task import Future
from rclpy.timer import Timer

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.context import Context
    from rclpy.callback_groups import CallbackGroup
    from rclpy.impl.spinning import Entity, Spins
    from rclpy.node import Node

LOOK_EVERY = 0.15
"""Seconds between two checks whether a thread or callback is stuck."""
AGAIN_AFTER = 0.5
"""Seconds after which a stuck one is examined again."""

know_futures(Future)
know_messages(StrictMessage)


class Waiting:
    """The waits of one context's rclpy callbacks, read on request."""

    def __init__(self, life: ContextState, context: Context) -> None:
        self.life, self.context = life, context
        self._numbers: WeakKeyDictionary[object, int] = WeakKeyDictionary()
        self._count, self._lock = count(1), threading.RLock()
        self._positions: dict[int, tuple[int, float]] = {}
        """The position of each thread, and the time since which it has been there."""
        self._known: dict[tuple[int, int], float] = {}
        """The time of the last examination of each stuck position: a frame and a line, or a run and its step."""
        self.watches = Watches(life, context, self._is_reported)
        LOOP.soon(self._check)

    def number_of(self, thing: object) -> int:
        """Return a number that no other object ever has."""
        known = self._numbers.get(thing)
        if known is None:
            known = self._numbers[thing] = next(self._count)
        return known

    def stands_since(self, thread: int) -> float:
        """Return the monotonic time since which a thread has been in its innermost user function."""
        return self._positions.get(thread, (0, time.monotonic()))[1]

    def _is_reported(self, thing: object, prefix: str, title: str) -> bool:
        """Whether a run or thread is part of a reported deadlock, or waits behind one."""
        return self.context.search.has_reported(f"{self.context.session.zid}:{prefix}{self.number_of(thing)}", title)

    def stalls(self) -> list[str]:
        """Return the reported callbacks that hold others up, and the nodes that nothing spins."""
        return self.watches.texts

    def waits(self) -> WaitGraph:
        """Return the waits. An activity that a second reading finds changed counts as running."""
        with self._lock:
            first, second = _Builder(Reading(self)).graph(), _Builder(Reading(self)).graph()
        activities = {}
        for name, now in second.activities.items():
            then = first.activities.get(name)
            is_same = then is not None and (then.wait, then.holds, then.serves) == (now.wait, now.holds, now.serves)
            activities[name] = now if is_same else replace(now, wait=FREE)
        return replace(second, activities=activities)

    def groups(self) -> dict[str, list[dict[str, object]]]:
        """Return the context's callback groups and executors, with their content, as plain data."""
        with self._lock:
            for _ in range(ATTEMPTS):
                with suppress(RuntimeError):  # something changed its size meanwhile
                    reading = Reading(self)
                    return group_rows(reading.nodes, reading.roles, list(reading.runs), reading.spun)
        return {}

    def _check(self) -> None:
        """Request a search for deadlocks if something is stuck, and reschedule itself. Runs on the loop."""
        if not self.life.is_ok:
            return
        clock = self.context.clock
        clock.call_at(clock.monotonic_ns() + to_ns(LOOK_EVERY), self._check)
        self.watches.check()
        now, places = time.monotonic(), standing()
        self._positions = {
            thread: known if (known := self._positions.get(thread)) is not None and known[0] == frame else (frame, now)
            for thread, (frame, _) in places.items()
        }
        runs: list[Run] = [run for executor in executors() for run in list(executor.spinning.running)]
        still = {places[thread] for thread, (_, since) in self._positions.items() if now - since >= 0.9 * LOOK_EVERY}
        still |= {(id(run), run.stepped_ns) for run in runs if 0 < run.stepped_ns < (now - LOOK_EVERY) * 1e9}
        lasting = {thing for thing, _ in still}  # a loop that polls has several lines
        self._known = {known: when for known, when in self._known.items() if known[0] in lasting}
        # The same line may wait again, for something else: a loop that calls and calls.
        if any(now - self._known.get(thing, -AGAIN_AFTER) >= AGAIN_AFTER for thing in still):
            self._known |= dict.fromkeys(still, now)
            self.context.ledger.alert()


class _Builder:
    """Builds the wait-for graph of one reading: its activities, groups and queues."""

    def __init__(self, reading: Reading) -> None:
        self._reading, self._conditions = reading, Conditions(reading)
        self._groups: dict[str, GroupView] = {}
        self._queues: dict[str, QueueView] = {}
        self._activities: dict[str, ActivityView] = {}

    def graph(self) -> WaitGraph:
        for entity, node in self._reading.owners.items():
            self._add_queue(entity, node)
            self._add_results(entity, node)
        on_threads = set()
        for stack in self._reading.stacks:
            on_threads |= {level.run for level in stack.levels}
            self._add_stack(stack)
        for run in self._reading.runs:
            if run not in on_threads and not run.ended():
                self._add_suspended(run)
        return WaitGraph(self._activities, self._groups, self._queues)

    # groups

    def _callback_group(self, group: CallbackGroup, node: Node | None) -> tuple[str, ...]:
        """Return the id of a callback group, if it excludes anything."""
        if not is_exclusive(group):
            return ()
        name = self._reading.id_of(group, "g")
        self._groups[name] = GroupView(name, called(group, node), full_name(node), 1, sort="callback")
        return (name,)

    def _executor(self, executor: Spins, node: Node | None) -> tuple[str, ...]:
        """Return the id of an executor as a group of threads."""
        limit = threads_of(executor)
        name = self._reading.id_of(executor, "e")
        self._groups.setdefault(name, GroupView(name, type(executor).__name__, full_name(node), limit, sort="executor"))
        return (name,)

    def _spinner(self, node: Node) -> tuple[str, ...]:
        """Return the id of what a node needs if nothing spins it: one of the program's own threads."""
        threads = [stack for stack in self._reading.stacks if stack.may_spin]
        if not threads:
            return ()
        name = f"{self._reading.zid}:spinner"
        self._groups.setdefault(name, GroupView(name, "spinner", full_name(node), len(threads), sort="spinner"))
        return (name,)

    def _needs(self, group: CallbackGroup, node: Node) -> tuple[str, ...]:
        """Return the slots that the next callback of a group and node takes."""
        own, executor = self._callback_group(group, node), node.executor
        if executor is None or node not in executor.spinning.nodes:
            return (*own, *self._spinner(node))
        if executor not in self._reading.spun and threads_of(executor) is not None:
            return (*own, *self._executor(executor, node), *self._spinner(node))
        return (*own, *self._executor(executor, node))

    # queues

    def _add_queue(self, entity: Entity, node: Node) -> None:
        name, role = self._reading.id_of(entity, "q"), self._reading.roles[entity]
        calls, waiting = arrived(entity)
        if isinstance(entity, Timer):  # a rate waits for its tick like a call for its answer
            calls = (self._reading.tick_of(entity),)
        needs = self._needs(entity.callback_group, node)
        self._queues[name] = QueueView(
            name, role.label, full_name(node), needs, calls, waiting, process=self._reading.zid, is_declared=False
        )

    def _add_results(self, entity: Entity, node: Node) -> None:
        """Add the clients that wait for the result of a goal."""
        for call, goal in result_requests(entity):
            assert isinstance(entity, ActionServer)
            name, label = f"{call}:r", f"service {self._reading.roles[entity].handler} get_result"
            wait = Call(goal, action_of(entity))
            self._activities[name] = ActivityView(
                name, label, full_name(node), (), wait, call, process=self._reading.zid
            )

    # activities

    def _add_stack(self, stack: Stack) -> None:
        """Add a thread's runs, each waiting for the next; below them, the thread itself if it is a user's."""
        runs = [level for level in stack.levels if level.run is not None]
        held = (
            (f"{self._reading.zid}:spinner",)
            if stack.may_spin and f"{self._reading.zid}:spinner" in self._groups
            else ()
        )
        if not runs:
            is_waiting = not stack.is_idle or blocked(stack.levels[0]).future is not None
            if (held and is_waiting) or stack.thread.ident in self._reading.awaited:
                self._add_thread(stack, stack.levels[0], held)
            elif held:
                self._add_idle(stack, held)
            return
        for place, level in enumerate(runs):
            run = level.run
            assert run is not None
            inner = runs[place + 1] if place + 1 < len(runs) else None
            group = self._callback_group(run.group, run.node) if run.group is not None else ()
            spun = level.waiting or (inner.run.executor if inner is not None and inner.run is not None else None)
            holding = [
                *group,
                *(() if spun is run.executor else self._executor(run.executor, self._reading.node_of(run))),
            ]
            wait = self._conditions.of_level(level, self._reading.node_of(run), run)
            if inner is not None:
                wait = Wait(Join(self._reading.id_of(inner.run)))
            self._add_run(run, level, (*holding, *(held if place == 0 else ())), wait, self._reading.age_of(stack))

    def _add_run(self, run: Run, level: Level, holding: tuple[str, ...], wait: Wait, age: float) -> None:
        node, name, role = self._reading.node_of(run), self._reading.id_of(run), self._reading.role_of(run)
        found = where(level.frames, node, wait.pause)
        self._activities[name] = ActivityView(
            name,
            role.label,
            full_name(node),
            holding,
            wait.condition,
            served(run),
            found.place,
            found.function,
            age,
            _left(wait, age),
            self._reading.zid,
            is_inner=role.is_inner,
            is_async=run.thread == 0,
            called=found.called,
        )

    def _add_thread(self, stack: Stack, level: Level, holding: tuple[str, ...]) -> None:
        first = self._reading.nodes[0] if self._reading.nodes else None
        selves = [frame.f_locals.get("self") for frame in level.frames]
        node = next((n for n in self._reading.nodes if any(own is n for own in selves)), first)
        wait = self._conditions.of_level(level, node, None)
        node = node if wait.client_node is None else wait.client_node
        age, name, title = (
            self._reading.age_of(stack),
            self._reading.id_of(stack.thread, "t"),
            f"thread {stack.thread.name}",
        )
        found = where(level.frames, node, wait.pause)
        self._activities[name] = ActivityView(
            name,
            title,
            full_name(node),
            holding,
            wait.condition,
            "",
            found.place,
            found.function,
            age,
            _left(wait, age),
            self._reading.zid,
            is_async=False,
        )

    def _add_idle(self, stack: Stack, holding: tuple[str, ...]) -> None:
        name = self._reading.id_of(stack.thread, "t")
        node = full_name(self._reading.nodes[0] if self._reading.nodes else None)
        self._activities[name] = ActivityView(
            name, f"thread {stack.thread.name}", node, holding, process=self._reading.zid
        )

    def _add_suspended(self, run: Run) -> None:
        """Add a suspended run, which waits for a future or for a thread."""
        level = Level(run, frames_of(run))
        group = self._callback_group(run.group, run.node) if run.group is not None else ()
        future = run.awaits
        if future is None or future.done() or future.cancelled():
            executor = self._executor(run.executor, self._reading.node_of(run))
            wait = Wait(Slot(executor[0], self._reading.number_of(run)))
        else:
            wait = self._conditions.of_future(future, level, self._reading.node_of(run), run)
        age = self._reading.now - run.stepped_ns / 1e9 if run.stepped_ns else 0.0
        self._add_run(run, level, group, wait, age)


def _left(wait: Wait, age: float) -> float | None:
    """Return the seconds that are left of a wait that has lasted for `age` seconds; None without a limit."""
    return None if wait.limit is None else max(0.0, wait.limit - age)


def attend(life: ContextState) -> None:
    """Include a context's callbacks in searches for deadlocks, from its first node on."""
    context = life.network()
    if not context.elsewhere:
        context.elsewhere.append(Waiting(life, context))

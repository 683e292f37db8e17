"""The waits among the callbacks and threads of one process, for the deadlock detector.

An executor is a group with as many slots as it has threads, and a callback group is one with one slot; a callback that
runs holds slots of both, and a suspended one only that of its callback group. Arrivals wait in queues, one for each
entity, that need both. A node without an executor needs a thread that spins, which may be any of the program's
own. Nothing is recorded while callbacks run: stacks and entities are read on request.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from itertools import count
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from graphflow.analysis.local_messages import know_messages
from graphflow.analysis.user_code import Pause, where
from graphflow.deadlock.asyncio_frames import know_futures
from graphflow.deadlock.closed_world.object_waits import setters
from graphflow.deadlock.closed_world.wakers import Setters
from graphflow.errors import ClosedError
from graphflow.machines.waits.explain import offer
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    Call,
    Condition,
    GroupView,
    Join,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
)
from graphflow.rclpy.context_state import LOOP
from graphflow.rclpy.messages.classes import StrictMessage
from graphflow.times import to_ns
from graphflow.wire.liveliness import Kind
from rclpy.action.client import ActionClient
from rclpy.action.server import ActionServer
from rclpy.client import Client
from rclpy.impl.deadlock.blocking import blocked, is_private, limit_of
from rclpy.impl.deadlock.buffers import BufferWait
from rclpy.impl.deadlock.future_setters import may_be_ended, programs_files
from rclpy.impl.deadlock.group_rows import group_rows
from rclpy.impl.deadlock.groups import ATTEMPTS, called, executors, is_exclusive, threads_of
from rclpy.impl.deadlock.later_servers import opening_of, tries_forever
from rclpy.impl.deadlock.locks import Entering, holds, only_holder
from rclpy.impl.deadlock.stacks import Level, Stack, stacks, standing
from rclpy.impl.deadlock.subjects import subject_of
from rclpy.impl.entities import (
    Role,
    action_of,
    after_answers,
    arrived,
    entities_of,
    frames_of,
    full_name,
    goal_of,
    name_of,
    node_of_goal,
    result_requests,
    role_of,
    served,
)
from rclpy.impl.nodes import internals_of, nodes_of
from rclpy.impl.spinning import Run
from rclpy.impl.watches.watches import Watches
from rclpy.task import Future
from rclpy.timer import Timer

if TYPE_CHECKING:
    from graphflow.deadlock.protocols import Subject
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.context import Context
    from graphflow.runtime.endpoints.threaded import ThreadedClient
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
            first, second = _Reading(self).graph(), _Reading(self).graph()
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
                    return _Reading(self).rows()
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


class _Reading:
    """One reading of all activities."""

    def __init__(self, waiting: Waiting) -> None:
        self._waiting, self._context = waiting, waiting.context
        self._zid, self._now = self._context.session.zid, time.monotonic()
        self._nodes = nodes_of(waiting.life)
        self._owners = {entity: node for node in self._nodes for entity in entities_of(node)}
        self._roles = {entity: role_of(entity) for entity in self._owners}
        self._groups: dict[str, GroupView] = {}
        self._queues: dict[str, QueueView] = {}
        self._activities: dict[str, ActivityView] = {}
        self._pause: Pause | None = None
        """The point of the event loop at which the examined run is suspended."""
        self._client_node: Node | None = None
        """The node whose client waits for the answer that the examined activity needs."""
        self._stacks = list(stacks())
        self._spun = {executor for stack in self._stacks for executor in stack.spins}
        self._levels = {level.run: level for stack in self._stacks for level in stack.levels if level.run is not None}
        mine = [executor for executor in executors() if executor.context.life is waiting.life]
        runs = [run for executor in mine for run in list(executor.spinning.running)]
        self._runs: dict[Run, None] = dict.fromkeys([*runs, *self._levels])
        found = [blocked(level) for level in self._levels.values()]
        self._awaited = {one.thread for one in found}
        locks = [one.lock.lock for one in found if one.lock is not None]
        self._awaited |= {s.thread.ident for s in self._stacks for lock in locks if holds(s.levels[0].frames, lock)}

    def _id(self, thing: object, prefix: str = "r") -> str:
        return f"{self._zid}:{prefix}{self._waiting.number_of(thing)}"

    def graph(self) -> WaitGraph:
        for entity, node in self._owners.items():
            self._add_queue(entity, node)
            self._add_results(entity, node)
        on_threads = set()
        for stack in self._stacks:
            on_threads |= {level.run for level in stack.levels}
            self._add_stack(stack)
        for run in self._runs:
            if run not in on_threads and not run.ended():
                self._add_suspended(run)
        return WaitGraph(self._activities, self._groups, self._queues)

    def rows(self) -> dict[str, list[dict[str, Any]]]:
        """Return the callback groups of each node, with their callbacks, for display."""
        return group_rows(self._nodes, self._roles, list(self._runs), self._spun)

    # groups

    def _callback_group(self, group: CallbackGroup, node: Node | None) -> tuple[str, ...]:
        """Return the id of a callback group, if it excludes anything."""
        if not is_exclusive(group):
            return ()
        name = self._id(group, "g")
        self._groups[name] = GroupView(name, called(group, node), full_name(node), 1, sort="callback")
        return (name,)

    def _executor(self, executor: Spins, node: Node | None) -> tuple[str, ...]:
        """Return the id of an executor as a group of threads."""
        limit = threads_of(executor)
        name = self._id(executor, "e")
        self._groups.setdefault(name, GroupView(name, type(executor).__name__, full_name(node), limit, sort="executor"))
        return (name,)

    def _spinner(self, node: Node) -> tuple[str, ...]:
        """Return the id of what a node needs if nothing spins it: one of the program's own threads."""
        threads = [stack for stack in self._stacks if stack.may_spin]
        if not threads:
            return ()
        name = f"{self._zid}:spinner"
        self._groups.setdefault(name, GroupView(name, "spinner", full_name(node), len(threads), sort="spinner"))
        return (name,)

    def _needs(self, group: CallbackGroup, node: Node) -> tuple[str, ...]:
        """Return the slots that the next callback of a group and node takes."""
        own, executor = self._callback_group(group, node), node.executor
        if executor is None or node not in executor.spinning.nodes:
            return (*own, *self._spinner(node))
        if executor not in self._spun and threads_of(executor) is not None:
            return (*own, *self._executor(executor, node), *self._spinner(node))
        return (*own, *self._executor(executor, node))

    # queues

    def _add_queue(self, entity: Entity, node: Node) -> None:
        name, role = self._id(entity, "q"), self._roles[entity]
        calls, waiting = arrived(entity)
        if isinstance(entity, Timer):  # a rate waits for its tick like a call for its answer
            calls = (self._tick(entity),)
        needs = self._needs(entity.callback_group, node)
        self._queues[name] = QueueView(
            name, role.label, full_name(node), needs, calls, waiting, process=self._zid, is_declared=False
        )

    def _add_results(self, entity: Entity, node: Node) -> None:
        """Add the clients that wait for the result of a goal."""
        for call, goal in result_requests(entity):
            assert isinstance(entity, ActionServer)
            name, label = f"{call}:r", f"service {self._roles[entity].handler} get_result"
            wait = Call(goal, action_of(entity))
            self._activities[name] = ActivityView(name, label, full_name(node), (), wait, call, process=self._zid)

    def _tick(self, timer: Timer) -> str:
        return f"tick:{self._id(timer, 'q')}"

    # activities

    def _add_stack(self, stack: Stack) -> None:
        """Add a thread's runs, each waiting for the next; below them, the thread itself if it is a user's."""
        runs = [level for level in stack.levels if level.run is not None]
        held = (f"{self._zid}:spinner",) if stack.may_spin and f"{self._zid}:spinner" in self._groups else ()
        if not runs:
            is_waiting = not stack.is_idle or blocked(stack.levels[0]).future is not None
            if (held and is_waiting) or stack.thread.ident in self._awaited:
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
            holding = [*group, *(() if spun is run.executor else self._executor(run.executor, self._node_of(run)))]
            wait, left = self._wait(level, self._node_of(run), run)
            if inner is not None:
                wait, left, self._pause = Join(self._id(inner.run)), None, None
            self._add_run(run, level, (*holding, *(held if place == 0 else ())), wait, self._age(stack), left)

    def _age(self, stack: Stack) -> float:
        return max(0.0, self._now - self._waiting.stands_since(stack.thread.ident or 0))

    def _add_run(
        self, run: Run, level: Level, holding: tuple[str, ...], wait: Condition, age: float, left: float | None
    ) -> None:
        node, name, role = self._node_of(run), self._id(run), self._role(run)
        found = where(level.frames, node, self._pause)
        self._activities[name] = ActivityView(
            name,
            role.label,
            full_name(node),
            holding,
            wait,
            served(run),
            found.place,
            found.function,
            age,
            left if left is None else max(0.0, left - age),
            self._zid,
            is_inner=role.is_inner,
            is_async=run.thread == 0,
            called=found.called,
        )

    def _add_thread(self, stack: Stack, level: Level, holding: tuple[str, ...]) -> None:
        first = self._nodes[0] if self._nodes else None
        selves = [frame.f_locals.get("self") for frame in level.frames]
        node = next((n for n in self._nodes if any(own is n for own in selves)), first)
        wait, left = self._wait(level, node, None)
        node = node if self._client_node is None else self._client_node
        age, name, title = self._age(stack), self._id(stack.thread, "t"), f"thread {stack.thread.name}"
        found, left = where(level.frames, node, self._pause), left if left is None else max(0.0, left - age)
        place, function = found.place, found.function
        self._activities[name] = ActivityView(
            name, title, full_name(node), holding, wait, "", place, function, age, left, self._zid, is_async=False
        )

    def _add_idle(self, stack: Stack, holding: tuple[str, ...]) -> None:
        name = self._id(stack.thread, "t")
        node = full_name(self._nodes[0] if self._nodes else None)
        self._activities[name] = ActivityView(name, f"thread {stack.thread.name}", node, holding, process=self._zid)

    def _add_suspended(self, run: Run) -> None:
        """Add a suspended run, which waits for a future or for a thread."""
        level = Level(run, frames_of(run))
        self._pause = None
        group = self._callback_group(run.group, run.node) if run.group is not None else ()
        future = run.awaits
        if future is None or future.done() or future.cancelled():
            executor = self._executor(run.executor, self._node_of(run))
            wait: Condition = Slot(executor[0], self._waiting.number_of(run))
        else:
            wait = self._of_future(future, level, self._node_of(run), run)
        age = self._now - run.stepped_ns / 1e9 if run.stepped_ns else 0.0
        self._add_run(run, level, group, wait, age, None)

    def _node_of(self, run: Run) -> Node | None:
        """Return the node of a run's callback; for a task, one of its executor's nodes."""
        goal = goal_of(run)
        if goal is not None:
            return node_of_goal(goal)
        owner = getattr(run.called, "__self__", None)
        if run.node is None and any(node is owner for node in self._nodes):
            return owner  # a callback after its client's answer
        return run.node if run.node is not None else next(iter(run.executor.spinning.nodes), None)

    def _role(self, run: Run) -> Role:
        goal = goal_of(run)
        if goal is not None:
            return Role("action", name_of(run.args[0]) or "execute")
        known = None if run.entity is None else self._roles.get(run.entity)
        if known is None:
            return Role("task", name_of(run.called) or "task")
        return known

    # conditions

    def _wait(self, level: Level, node: Node | None, run: Run | None) -> tuple[Condition, float | None]:
        """Return the wait of a thread's code, and its time limit in seconds."""
        self._pause = self._client_node = None
        found = blocked(level)
        if found.future is not None:
            return self._of_future(found.future, level, node, run), found.timeout
        if found.timer is not None:
            turn = self._closed_world(level, None, node, run)  # a loop that polls at that rate
            executor = None if run is None else run.executor
            is_alone = executor is None or threads_of(executor) == 1  # then no thread is left to run the tick
            return Call(self._tick(found.timer), "rate") if turn == FREE or is_alone else turn, None
        if node is None or (level.waiting is not None and run is None):
            return FREE, None
        if found.thread is not None:
            joined = next((stack for stack in self._stacks if stack.thread.ident == found.thread), None)
            return FREE if joined is None else Join(self._id(joined.thread, "t")), found.timeout
        if found.lock is not None:
            return self._of_lock(found.lock, level, run), None
        if found.buffer is not None:
            return self._of_buffer(found.buffer), found.timeout
        if found.service:
            left = None if level.innermost is None or tries_forever(level.innermost) else found.timeout
            return self._of_opening(found.service, level, node, run, gives_up=left is not None), left
        return self._closed_world(level, None, node, run), limit_of(level)

    def _of_future(self, future: Future, level: Level, node: Node | None, run: Run | None) -> Condition:
        if future.done() or future.cancelled():
            return FREE
        if isinstance(future, Run):
            return Join(self._id(future)) if future in self._runs else FREE
        for entity in self._owners:
            if isinstance(entity, Client):
                sequence = next((n for n, f in list(entity.pending.items()) if f is future), None)
                if sequence is not None:
                    self._client_node = self._owners[entity]
                    return self._of_call(entity.endpoint, sequence, future, level)
            elif isinstance(entity, ActionClient):
                found = next((key for key, (f, _) in list(internals_of(entity).waiting.items()) if f is future), None)
                if found is not None:
                    self._client_node = self._owners[entity]
                    return self._of_call(*found, future, level)
        return self._closed_world(level, future, node, run)

    def _of_call(self, endpoint: ThreadedClient, sequence: int, future: Future, level: Level) -> Condition:
        if not is_private(level) and may_be_ended(future, self._nodes, programs_files()):
            return FREE
        try:
            return Call(endpoint.call_id(sequence), endpoint.name, max(1, self._servers[endpoint.name]))
        except ClosedError:
            return FREE

    @cached_property
    def _servers(self) -> Counter[str]:
        """Return the number of servers by service."""
        return Counter(entity.name for entity in list(self._context.cache) if entity.kind is Kind.SERVICE)

    def _of_lock(self, entering: Entering, level: Level, run: Run | None) -> Condition:
        """Return the wait for a lock that others hold."""
        others = [(self._id(other), there.frames) for other, there in self._levels.items() if other is not run]
        others += [(self._id(s.thread, "t"), s.levels[0].frames) for s in self._stacks if s.levels[0] is not level]
        if run is not None:
            others.append((self._id(run), level.frames[:-1]))  # it may hold the lock itself
        holder = only_holder(entering, level.frames, others)
        return FREE if holder is None else SetBy(entering.text, (), (holder,), True, "releases")

    def _of_buffer(self, wait: BufferWait) -> Condition:
        """Return the wait for a buffer that only blocked listeners would fill."""
        fillers = set(filter(wait.is_filled_by, self._owners))
        if not fillers or wait.may_be_filled_by(programs_files()):
            return FREE
        queues, active = (self._id(e, "q") for e in fillers), (self._id(r) for r in self._runs if r.entity in fillers)
        return SetBy(wait.what, tuple(sorted(queues)), tuple(sorted(active)), verb="hears", gives_up=True)

    def _of_opening(self, service: str, level: Level, node: Node, run: Run | None, *, gives_up: bool) -> Condition:
        """Return the wait for a server that, according to the source, only blocked code creates."""
        (own, tasks, subject), others = self._world(node), [other for other in self._nodes if other is not node]
        found = None if self._servers[service] else opening_of(service, level.frames, subject, others, programs_files())
        if found is None or (found.handlers and any(type(other) is type(node) for other in others)):
            return FREE
        setters_ = Setters(offer(service), found.handlers, verb="offers", gives_up=gives_up)
        condition = self._set_by(setters_, own, tasks, node, run)
        if not found.is_own:
            return condition
        stack = next((stack for stack in self._stacks if level in stack.levels), None)
        mine = self._id(run) if run is not None else self._id(stack.thread, "t") if stack is not None else ""
        return replace(condition, activities=(*condition.activities, mine))

    def _world(self, node: Node) -> tuple[list[tuple[Entity, str]], list[Run], Subject]:
        """Return a node's callbacks by entity, the tasks that run its methods, and the node as a subject."""
        own = [(entity, role.handler) for entity, role in self._roles.items() if self._owners[entity] is node]
        own += [(entity, name) for entity in self._owners for name in after_answers(entity, node)]
        tasks = [task for task in self._runs if getattr(task.called, "__self__", None) is node]
        return (
            own,
            tasks,
            subject_of(node, [*(handler for _, handler in own), *(name_of(task.called) for task in tasks)]),
        )

    def _closed_world(self, level: Level, future: Future | None, node: Node | None, run: Run | None) -> Condition:
        """Return the wait for something that, according to the source, only the node's callbacks bring about."""
        if node is None:
            return FREE
        own, tasks, subject = self._world(node)
        found = setters(level.frames, future, subject)
        others = [subject_of(other) for other in self._nodes if other is not node]
        is_known = found is not None and found.handlers and found.lock is None and not found.parts
        if found is None or not is_known or found.is_shared(subject, others):
            return FREE
        self._pause = found.pause
        return self._set_by(found, own, tasks, node, run)

    def _set_by(
        self, found: Setters, own: list[tuple[Entity, str]], tasks: list[Run], node: Node | None, run: Run | None
    ) -> SetBy:
        queues = {self._id(entity, "q") for entity, handler in own if handler in found.handlers}
        others_runs = [r for r in self._runs if r is not run and (r.node is node or r in tasks)]
        active = sorted(self._id(r) for r in others_runs if self._role(r).handler in found.handlers)
        return SetBy(found.what, tuple(sorted(queues)), tuple(active), verb=found.verb, gives_up=found.gives_up)


def attend(life: ContextState) -> None:
    """Include a context's callbacks in searches for deadlocks, from its first node on."""
    context = life.network()
    if not context.elsewhere:
        context.elsewhere.append(Waiting(life, context))

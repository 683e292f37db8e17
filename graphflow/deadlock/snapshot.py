"""Snapshots: the wait-for graph of this process, built on request from the state of its handlers and tasks.

Nothing is recorded while a handler runs, except the entries of the ledger. A wait is derived backwards, from the future
that a task awaits: the ledger knows the futures of calls, goals, services and threads; a future of asyncio's own is
resolved through the coroutines in between (`asyncio_frames`); and one that neither explains through the source of the
node's class (`closed_world`). Whatever remains unexplained is `FREE`.

A snapshot can be taken on any thread, so also while the event loop is blocked. The loop may then change what is being
read: containers are copied before they are iterated over, and a `RuntimeError` from a change in between starts the
snapshot again.
"""

from __future__ import annotations

import asyncio
import queue
import threading
from collections import Counter
from dataclasses import replace
from functools import cached_property
from weakref import WeakKeyDictionary

from graphflow.analysis.class_source import Unknown
from graphflow.analysis.frames import Frame, stack_of
from graphflow.analysis.user_code import Pause, where
from graphflow.deadlock import asyncio_frames as aio
from graphflow.deadlock.asyncio_frames import AnyFuture, TaskLike, current_task, frames_of, waiter_of
from graphflow.deadlock.closed_world.object_waits import setters
from graphflow.deadlock.closed_world.transform_senders import TransformSenders, sending
from graphflow.deadlock.closed_world.wakers import Setters, cancellers, entries_of, handler_in, handler_of, method_of
from graphflow.deadlock.protocols import ProcessContext, Subject
from graphflow.deadlock.startup_waits import start_of, unopened
from graphflow.deadlock.vertices import Item, Vertices, arrived_calls, call_of
from graphflow.deadlock.wait_paths import Subtask, WaitPath, gathered, limit_of, subtasks
from graphflow.deadlock.wait_times import WaitTimes
from graphflow.deadlock.watchdog import Watchdog
from graphflow.executor.activity import Activity
from graphflow.executor.runner import Run, Runner
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    TransformWait,
    WaitGraph,
    goal_id,
    joined,
)
from graphflow.names import is_hidden
from graphflow.wire.liveliness import Kind

_ATTEMPTS, LOOP_LIMIT = 5, 0.2
"""Attempts at a snapshot while the loop changes what is read, and seconds for the loop to take one of itself."""


class Snapshot:
    """The maker of a process's snapshots, with the state that it keeps between them: task numbers and ages of waits."""

    def __init__(self, process: ProcessContext, watchdog: Watchdog) -> None:
        self._process, self._watchdog = process, watchdog
        self._count = 0
        """Number of tasks that were numbered."""
        self._numbers: WeakKeyDictionary[TaskLike, int] = WeakKeyDictionary()
        self._lock = threading.RLock()
        self.times = WaitTimes(process)
        """Ages and deadlines of waits."""

    def take(self) -> WaitGraph:
        """Take a snapshot, on any thread."""
        with self._lock:
            for _ in range(_ATTEMPTS):
                try:
                    own = _Builder(self._process, self, self._watchdog).graph()
                    others = [other.waits() for other in list(self._process.elsewhere)]
                    return joined([own, *(sending(graph, self._process.cache) for graph in others)])
                except RuntimeError:  # a container changed its size while it was copied
                    continue
        return WaitGraph()

    def take_for_others(self) -> WaitGraph:
        """Take a snapshot for another thread, but on the loop: its coroutines must not be inspected while they run."""
        if threading.get_ident() == self._process.ledger.thread or self._watchdog.is_blocked:
            return self.take()
        taken: queue.SimpleQueue[WaitGraph] = queue.SimpleQueue()
        try:
            self._process.loop.call_soon_threadsafe(lambda: taken.put(self.take()))
            return taken.get(timeout=LOOP_LIMIT)
        except (queue.Empty, RuntimeError):  # the loop is blocked, so its coroutines stand still; or it is closed
            return self.take()

    def number_of(self, task: TaskLike) -> int:
        """Return the number of a task, which no other task ever has, unlike its `id()`."""
        if task not in self._numbers:
            self._count += 1
        return self._numbers.setdefault(task, self._count)


class _Builder:
    """The construction of one wait-for graph."""

    def __init__(self, process: ProcessContext, memory: Snapshot, watchdog: Watchdog) -> None:
        self._process, self._memory, self._watchdog = process, memory, watchdog
        self._ledger = process.ledger
        self._zid = process.session.zid
        self._vertices = Vertices(self._zid, memory.number_of)
        self._now_ns = process.clock.monotonic_ns()
        self._nodes = list(process.nodes)
        self._senders = TransformSenders(process)
        self._runners = [(node, runner) for node in self._nodes for runner in list(node.runners)]
        self._activities: dict[str, ActivityView] = {}
        self._queues: dict[str, QueueView] = {}
        self._seen: set[tuple[str, Condition]] = set()
        self._limit_ns: int | None = None
        """Deadline of the activity that is being read, in nanoseconds of the clock."""
        self._pause: Pause | None = None
        """Line at which it pauses, if it waits in a polling loop."""
        self._inner: dict[str, tuple[Subject, Subtask]] = {}
        """By id: tasks below activities that are vertices of their own, since some condition names them."""

    @cached_property
    def _servers(self) -> Counter[str]:
        """Number of servers, by service."""
        return Counter(entity.name for entity in list(self._process.cache) if entity.kind is Kind.SERVICE)

    @cached_property
    def _processes(self) -> tuple[str, ...]:
        """The processes with nodes; those of graphflow's own tools are left out."""
        return tuple(sorted({self._zid, *(e.zid for e in list(self._process.cache) if not is_hidden(e.node_name))}))

    def graph(self) -> WaitGraph:
        """Build the graph."""
        arrived = arrived_calls(self._process)
        for node, runner in self._runners:
            calls = [c for c in (call_of(runner, item) for item in list(runner.items)) if c]
            calls += arrived.get(runner.number, [])
            id_ = self._vertices.queue_id(runner)
            self._queues[id_] = QueueView(
                id_,
                runner.title,
                node.full_name,
                self._vertices.slots(node, runner, runner.group),
                tuple(calls),
                len(runner.items) + len(arrived.get(runner.number, [])),
                runner.spec.dropped(),
                self._zid,
                runner.spec.handler in node.handlers,
                sends=None if runner.spec.is_inner else self._senders.texts(node, handler_of(runner)),
            )
            for run in sorted(runner.active, key=lambda run: run.number):
                self._add_run(node, runner, run)
        for node in self._nodes:
            for task in list(node.tasks):
                self._add_task(node, task)
            self._add_start(node)
        # Conditions name tasks that no loop above has visited; their own conditions may name further ones.
        while unseen := self._inner.keys() - self._activities.keys():
            self._add_inner(min(unseen))
        blocker = self._blocker()
        blocked = {} if blocker is None else {self._zid: blocker}
        self._memory.times.forget(self._seen)
        regroupings = {node.full_name: node.groups.regrouping for node in self._nodes}
        return WaitGraph(self._activities, self._vertices.groups, self._queues, blocked, regroupings)

    # activities

    def _add_run(self, node: Subject, runner: Runner, run: Run) -> None:
        item = getattr(run, "item", None)  # a run that ends on the loop right now has deleted it
        serves = "" if item is None else call_of(runner, item)
        holds = self._vertices.slots(node, runner, run.group)
        self._add(self._vertices.run_id(run), runner.title, node, run, holds, serves, is_inner=runner.spec.is_inner)

    def _add_start(self, node: Subject) -> None:
        if (task := node.starting) is not None:
            start = start_of(node, self._zid)
            self._vertices.groups[start.id] = start
            for queue in unopened(node, self._zid):
                self._queues[queue.id] = replace(queue, sends=self._senders.texts(node, handler_in(queue.label)))
            self._add(self._vertices.task_id(task), "on_start", node, task, (start.id,), "")

    def _add_task(self, node: Subject, task: asyncio.Task[object]) -> None:
        name = task.get_name().removeprefix(f"{node.full_name}.")
        self._add(self._vertices.task_id(task), f"task {name}", node, task, (), "")

    def _add_inner(self, id_: str) -> None:
        node, inner = self._inner[id_]
        self._add(id_, f"task {method_of(inner.task)}", node, inner.task, (), "", below=inner)

    def _add(
        self,
        id_: str,
        label: str,
        node: Subject,
        task: TaskLike,
        holds: tuple[str, ...],
        serves: str,
        *,
        is_inner: bool = False,
        below: Subtask | None = None,
    ) -> None:
        """Add an activity with its wait.

        Args:
            below: The activity as a task below another one, whose deadlines bound its wait, too.
        """
        self._pause, self._limit_ns = None, below and below.limit_ns
        wait = self._condition(task, WaitPath(node, task, is_bounded=below is not None and below.is_bounded))
        self._seen.add((id_, wait))
        age, left = self._memory.times.of(id_, wait, task, self._now_ns, self._limit_ns)
        found = where(self._frames_of(task), node.instance, self._pause)
        self._activities[id_] = ActivityView(
            id_,
            label,
            node.full_name,
            holds,
            wait,
            serves,
            found.place,
            found.function,
            age,
            left,
            self._zid,
            is_inner,
            found.is_async,
            found.called,
            None if is_inner else self._senders.texts(node, handler_in(label)),
        )

    # conditions

    def _condition(self, task: TaskLike, way: WaitPath) -> Condition:
        """Return the condition of a task or an activity to which `way` leads."""
        if id(task) in way.tasks or task.done():  # tasks that await each other are no handlers' concern
            return FREE
        # Before its future is followed, which is `_Return`'s own and says nothing about the group.
        if isinstance(task, Activity) and task.returning_to is not None:
            for owner in self._nodes:
                if task.returning_to in owner.groups.by_name.values():
                    ticket = task.number if isinstance(task, Run) else 0
                    return Slot(self._vertices.group_id(owner, task.returning_to), ticket)
        waiter = waiter_of(task)
        if waiter is None:
            return FREE
        frames = self._frames_of(task)
        limit_ns = self._limit_of(task)
        is_bounded = way.is_bounded or limit_ns is not None or aio.may_give_up(task)
        way = WaitPath(way.node, way.root, (*way.frames, *frames), way.tasks | {id(task)}, is_bounded)
        if limit_ns is not None:
            self._limit_ns = min(limit_ns, self._limit_ns or limit_ns)
        # The innermost joint wait decides: its waiter is a future of asyncio's own that says nothing by itself.
        for frame in reversed(frames):
            together = aio.joint_wait(frame)
            if together is not None:
                return self._of_joint_wait(together, way)
        return self._of_future(waiter, way)

    def _of_joint_wait(self, wait: aio.JointWait, way: WaitPath) -> Condition:
        ends = [f for f in wait.tasks if f.done() and (wait.wants == "any" or (wait.fails_early and aio.has_failed(f)))]
        if ends:
            return FREE  # the wait is over, and the waiter's next step is due
        conditions = tuple(self._of_future(f, way) for f in wait.tasks if not f.done())
        return All(conditions) if wait.wants == "all" else AnyOf(conditions)

    def _frames_of(self, task: TaskLike) -> list[Frame]:
        """Return the frames of a task, the outermost first, and those of the thread that it waits for, if any."""
        frames = frames_of(task)
        waiter = waiter_of(task)
        awaited = aio.shielded(waiter) or waiter
        thread = None if awaited is None else self._ledger.threads.get(awaited)
        if thread is not None and thread.ident is not None:
            frames += stack_of(thread.ident)
        return frames

    def _limit_of(self, task: TaskLike) -> int | None:
        return limit_of(task, self._now_ns, self._process.loop.time())

    def _of_future(self, future: AnyFuture, way: WaitPath) -> Condition:
        """Return the condition that a future stands for: by the ledger, by asyncio, or by the source."""
        ledger = self._ledger
        if future in ledger.threads:
            return self._of_thread(future, way)
        if future in ledger.calls:
            call = ledger.calls[future]
            return Call(call.id, call.service, max(1, self._servers[call.service]))
        if future in ledger.openings:
            service = ledger.openings[future].service
            return FREE if self._servers[service] else Opening(service)  # a server is known, and is being connected to
        if future in ledger.transforms:
            awaited = ledger.transforms[future]()
            return TransformWait(awaited.what, self._processes, awaited.frames, awaited.node)
        if future in ledger.goals:
            goal = ledger.goals[future]
            servers = max(1, self._servers[f"{goal.action}/_action/send_goal"])  # several may have accepted it
            return self._or_cancelled(Call(goal_id(goal.goal_id), goal.action, servers), goal, way)
        if future in ledger.served:
            return Call(goal_id(ledger.served[future]), "")
        if isinstance(future, Activity) or asyncio.isfuture(future):
            return self._of_asyncio(future, way)
        return FREE

    def _of_thread(self, future: AnyFuture, way: WaitPath) -> Condition:
        """Return the condition of a thread, which may wait for the loop in turn."""
        ledger = self._ledger
        sent = next((task for task in map(aio.sent_to_loop, reversed(way.frames)) if task is not None), None)
        if sent is not None and id(sent) not in way.tasks:
            return self._of_future(sent, way)
        asking = ledger.asking.get(ledger.threads[future].ident or 0)
        return self._closed_world(way, None) if asking is None else self._condition(asking, way)

    def _of_asyncio(self, future: AnyFuture, way: WaitPath) -> Condition:
        """Return the condition of a task, a `gather`, a `shield`, or a future that the node's code must set."""
        if isinstance(future, TaskLike):
            known = self._join(future)
            return known if known is not None else self._or_cancelled(self._condition(future, way), future, way)
        together = aio.gathered(future)
        if together is not None:
            return self._of_joint_wait(together, way)
        inner = aio.shielded(future)
        return self._closed_world(way, future) if inner is None else self._of_future(inner, way)

    def _join(self, task: TaskLike) -> Condition | None:
        """Return the wait for a task that is a vertex of its own; None for any other, whose wait is followed."""
        for node in self._nodes:
            if task in node.tasks or task is node.starting:
                return Join(self._vertices.task_id(task))
        return None

    def _closed_world(self, way: WaitPath, waiter: AnyFuture | None) -> Condition:
        """Return the wait for a change that, by the source code, only handlers of the node make."""
        found = setters(list(way.frames), waiter, way.node, is_bounded=way.is_bounded)
        if found is None or found.is_shared(way.node, self._nodes) or any(task.done() for task in found.tasks):
            return FREE
        self._pause = found.pause
        ends = [self._of_future(task, way) for task in found.tasks]
        if found.handlers or not ends:
            ends.insert(0, self._set_by(found, way))
        return ends[0] if len(ends) == 1 else AnyOf(tuple(ends))

    def _or_cancelled(self, condition: Condition, thing: object, way: WaitPath) -> Condition:
        """Return the wait for a task or goal, or for one of the node's handlers to cancel it."""
        if condition is FREE:
            return FREE
        try:
            found = cancellers(thing, way.node)
        except Unknown:
            return FREE
        return condition if found is None else AnyOf((condition, self._set_by(found, way)))

    def _set_by(self, found: Setters, way: WaitPath) -> Condition:
        """Return the wait for setters: by the queues of their handlers, and by the activities that run them."""
        node = way.node
        runners = [r for n, r in self._runners if n is node and handler_of(r) in found.handlers]
        # Runs under way count too, even those that have released their slot.
        others: list[TaskLike] = [run for r in runners for run in list(r.active) if run is not way.root]
        others += [t for t in list(node.tasks) if t is not way.root and method_of(t) in found.handlers]
        if node.starting not in (None, way.root) and "on_start" in found.handlers:
            others.append(node.starting)
        waiting = [queue for queue in unopened(node, self._zid) if handler_in(queue.label) in found.handlers]
        if not found.handlers <= entries_of(node):  # one of them has no queue yet, so its next run is not in the graph
            return FREE
        if found.parts:
            above = [activity for activity in (way.root, *others) if activity is not None]
            parts = gathered(found.parts, above, self._limit_of, self._process.loop)
            if parts is None:
                return FREE
            self._inner |= {self._vertices.task_id(part.task): (node, part) for part in parts}
            others += [part.task for part in parts if id(part.task) not in way.tasks]
        is_held = False
        if found.lock is not None:
            inside = self._inside(found.lock)
            is_held = len(inside) == found.places
            if not is_held and not found.handlers:  # something else is in it, and no explicit release is seen
                return FREE
            others += inside
        queues = sorted([*(self._vertices.queue_id(r) for r in runners), *(queue.id for queue in waiting)])
        activities = sorted({self._vertices.task_id(other) for other in others})
        return SetBy(found.what, tuple(queues), tuple(activities), is_held, found.verb, found.gives_up)

    def _inside(self, lock: object) -> list[TaskLike]:
        """Return the activities, and tasks below them, that hold a lock by `with`, each once per block."""
        activities: list[tuple[Subject, TaskLike]] = [(n, run) for n, r in self._runners for run in list(r.active)]
        activities += [(node, task) for node in self._nodes for task in list(node.tasks)]
        known = {id(task) for _, task in activities}
        found = [task for _, task in activities for _ in range(aio.times_inside(task, lock))]
        for node, activity in activities:
            for inner in subtasks(activity, self._limit_of):
                if id(inner.task) not in known and (times := aio.times_inside(inner.task, lock)):
                    known.add(id(inner.task))
                    self._inner[self._vertices.task_id(inner.task)] = node, inner
                    found += [inner.task] * times
        return found

    # the loop

    def _blocker(self) -> str | None:
        """Add the activity that blocks the event loop; return its id, or None if it is not blocked.

        A handler called synchronously is no `Run` yet: `ledger.at_work` and `Runner.at_hand` name it.
        """
        if threading.get_ident() == self._ledger.thread or not self._watchdog.is_blocked:
            return None
        task, runner = current_task(self._process.loop), self._ledger.at_work
        run = task if isinstance(task, Run) else None
        if isinstance(runner, Runner):
            item = runner.at_hand
            run = run if run is not None and run.runner is runner else None
        elif run is not None:
            runner, item = run.runner, getattr(run, "item", None)
        else:
            return None
        if item is None:  # the run has ended, and its result is being sent
            return None
        node = next((n for n, r in self._runners if r is runner), None)
        if node is None:
            return None
        return self._add_blocker(node, runner, run, item)

    def _add_blocker(self, node: Subject, runner: Runner, run: Run | None, item: Item) -> str:
        stack = stack_of(self._ledger.thread)
        id_ = self._vertices.run_id(run) if run is not None else f"{self._zid}:d{runner.number}.{runner.runs}"
        way = WaitPath(node, run, tuple(stack))
        self._pause = None
        if self._ledger.blocking is None:
            wait = self._closed_world(way, None)
        else:
            wait = self._of_future(self._ledger.blocking, way)
        self._seen.add((id_, wait))
        found = where(stack, node.instance, self._pause)
        self._activities[id_] = ActivityView(
            id_,
            runner.title,
            node.full_name,
            self._vertices.slots(node, runner, runner.group),
            wait,
            call_of(runner, item),
            found.place,
            found.function,
            self._watchdog.blocked_for,
            None,
            self._zid,
            is_async=run is not None,
            called=found.called,
        )
        return id_

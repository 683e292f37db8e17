"""What the handlers and tasks of this process wait for, read off when somebody asks: a `machines.waits.Picture`.

Nothing is written down while a handler runs, but for one entry per call. What an activity waits for is read from the
future that it awaits; where that tells nothing, from the coroutines between: asyncio's own primitives are known by
their code. A picture can be taken on any thread, so also while the event loop is blocked.
"""

from __future__ import annotations

import asyncio
import gc
import inspect
import queue
import sys
import threading
from asyncio import Future
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from types import FrameType, MethodType
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from graphflow.errors import DecodeError, Place
from graphflow.machines import waits as picture_of
from graphflow.machines.waits import FREE, All, AnyOf, Call, Condition, Join, Picture, SetBy, Slot, call_id, goal_id
from graphflow.runtime import declared
from graphflow.runtime.clock import Clock
from graphflow.runtime.closed_world import Setters, cancellers, setters
from graphflow.runtime.places import is_users
from graphflow.runtime.scheduler import Activity, Run, Runner
from graphflow.runtime.source import Unknown
from graphflow.times import to_ns
from graphflow.wire import attachment, chain
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.runtime.context import Context
    from graphflow.runtime.groups import HandlerGroup
    from graphflow.runtime.node import Node

_ATTEMPTS = 5
LOOP_LIMIT = 0.2
"""Seconds that the loop gets to take a picture of itself."""


OutCall = tuple[bytes, int, str, int, int | None]
"""A call that waits for its answer: GID, sequence number, service, start and deadline in nanoseconds."""


class Waits:
    """The waits of one process. One per `Context`."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self.thread = threading.get_ident()
        """The event loop's."""
        self.calls: dict[Future[Any], OutCall] = {}
        """By the future of the answer."""
        self.goals: dict[Future[Any], Any] = {}
        """Goals that are waited for, by the future of their end."""
        self.served: dict[Future[Any], str] = {}
        """Ids of goals of this process that get_result waits for."""
        self.threads: dict[Future[Any], threading.Thread] = {}
        """Threads that are waited for."""
        self.asking: dict[int, asyncio.Task[Any]] = {}
        """Calls that threads wait for, by the thread's number."""
        self.blocking: Future[Any] | None = None
        """What a call that blocks the event loop waits for."""
        self.nodes: list[Node] = []
        self.process = chain.process_of(context.session.zid)
        self._count = 0
        """Of tasks that have a number."""
        self._numbers: WeakKeyDictionary[Any, int] = WeakKeyDictionary()
        self._lock = threading.RLock()
        self._since: dict[tuple[str, Condition], int] = {}

    def begin(self, future: Future[Any], call: OutCall) -> bytes:
        """A call begins to wait; returns its chain: none unless a handler makes it in its own body."""
        self.calls[future] = call
        run = asyncio.current_task()
        if not isinstance(run, Run):
            return b""
        asked = getattr(run.item, "attachment", None) if run.runner.kind == "service" else None
        hop = chain.Hop(self.process, run.number, call[0], call[1])
        return chain.extended((asked or b"")[attachment.SIZE :], hop)

    def hopeless(self, runner: Runner, asked: bytes) -> list[Run]:
        """The runs that hold every slot which a queued request needs, if all of them wait for that very request."""
        hops = {hop.run: hop for hop in chain.hops(asked[attachment.SIZE :]) if hop.process == self.process}
        if not hops:
            return []
        group = runner.group
        if group is None and runner.is_serial:
            holders, limit = list(runner.active), 1
        elif group is None or group.limit is None or group.when_full == "cancel_running":
            return []
        else:
            members = [m for m in group.members if isinstance(m, Runner)]
            holders, limit = [run for m in members for run in m.active if run.group is group], group.limit
        waits = all(run.number in hops and self._awaits(run, hops[run.number]) for run in holders)
        return holders if waits and len(holders) >= limit else []

    def _awaits(self, run: Run, hop: chain.Hop) -> bool:
        """Whether a run still waits for the call that it is said to wait for: it may have given up."""
        call = self.calls.get(run._fut_waiter)
        return call is not None and (call[0], call[1]) == (hop.gid, hop.sequence)

    def picture(self) -> Picture:
        """The waits of this process, from any thread."""
        with self._lock:
            for _ in range(_ATTEMPTS):
                try:
                    return _Camera(self._context, self).shoot()
                except RuntimeError:  # something changed its size meanwhile
                    continue
        return Picture()

    def picture_for_others(self) -> Picture:
        """The same, for another thread: taken on the loop, whose coroutines must not be looked into while they run."""
        if threading.get_ident() == self.thread or self._context.watchdog.is_blocked:
            return self.picture()
        taken: queue.SimpleQueue[Picture] = queue.SimpleQueue()
        try:
            self._context.loop.call_soon_threadsafe(lambda: taken.put(self.picture()))
            return taken.get(timeout=LOOP_LIMIT)
        except (queue.Empty, RuntimeError):  # the loop is blocked, and they stand still; or it is closed
            return self.picture()

    @staticmethod
    def id_of(call: OutCall) -> str:
        return call_id(call[0], call[1])

    def number_of(self, task: Any) -> int:
        """A number that no other task ever has."""
        if task not in self._numbers:
            self._count += 1
        return self._numbers.setdefault(task, self._count)

    def age(self, activity: str, wait: Condition, now_ns: int) -> float:
        """Seconds since this wait was first seen."""
        return (now_ns - self._since.setdefault((activity, wait), now_ns)) / 1e9

    def forget(self, keep: set[tuple[str, Condition]]) -> None:
        """Keep account of these waits only."""
        self._since = {key: when for key, when in self._since.items() if key in keep}


def place_of(task: Any) -> str:
    """The user's line in which a suspended task waits: `(drive.py:12 in on_start)`; empty if there is none."""
    frame = _users(frame for frame in map(_frame_of, _coroutines(task.get_coro())) if frame is not None)
    if frame is None:
        return ""
    return f"({Place(Path(frame.f_code.co_filename).name, frame.f_lineno)} in {frame.f_code.co_name})"


class _Camera:
    """One picture being taken."""

    def __init__(self, context: Context, waits: Waits) -> None:
        self._context, self._waits = context, waits
        self._zid = context.session.zid
        self._now_ns = context.clock.monotonic_ns()
        self._nodes = list(waits.nodes)
        self._runners = [(node, runner) for node in self._nodes for runner in list(node.runners)]
        self._activities: dict[str, picture_of.Activity] = {}
        self._groups: dict[str, picture_of.Group] = {}
        self._queues: dict[str, picture_of.Queue] = {}
        self._seen: set[tuple[str, Condition]] = set()
        self._limit_ns: int | None = None
        """When the activity that is looked at gives up waiting."""

    @cached_property
    def _servers(self) -> Counter[str]:
        """How many servers there are, by service."""
        return Counter(entity.name for entity in list(self._context.cache) if entity.kind is Kind.SERVICE)

    def shoot(self) -> Picture:
        arrived = self._arrived()
        for node, runner in self._runners:
            calls = [c for c in (self._call_of(runner, item) for item in list(runner.items)) if c]
            calls += arrived.get(id(runner), [])
            waiting = len(runner.items) + len(arrived.get(id(runner), []))
            queue = self.queue_id(runner)
            self._queues[queue] = picture_of.Queue(
                queue,
                runner.label,
                node.full_name,
                self._needs(node, runner),
                tuple(calls),
                waiting,
                runner.dropped(),
                self._zid,
                runner.handler in _declared(type(node)),  # type: ignore[arg-type]  # a class can be hashed
            )
            for run in sorted(runner.active, key=lambda run: run.number):
                self._add_run(node, runner, run)
        for node in self._nodes:
            for task in list(node.tasks):
                self._add_task(node, task)
        blocker = self._blocker()
        blocked = {} if blocker is None else {self._zid: blocker}
        self._waits.forget(self._seen)
        return Picture(self._activities, self._groups, self._queues, blocked)

    # ids

    def run_id(self, run: Run) -> str:
        return f"{self._zid}:{run.number}"

    def task_id(self, task: Any) -> str:
        return self.run_id(task) if isinstance(task, Run) else f"{self._zid}:t{self._waits.number_of(task)}"

    def queue_id(self, runner: Runner) -> str:
        return f"{self._zid}:q{runner.number}"

    def _needs(self, node: Node, runner: Runner) -> tuple[str, ...]:
        """The ids of the groups of which the runner's next run takes a slot; its own queue is as good as one."""
        return self._slots(node, runner, runner.group)

    def _holds(self, node: Node, run: Run) -> tuple[str, ...]:
        """The same of a run under way."""
        return self._slots(node, run.runner, run.group)

    def _slots(self, node: Node, runner: Runner, group: HandlerGroup | None) -> tuple[str, ...]:
        named = () if group is None else (self._named(node, group),)
        if not runner.is_serial:
            return named
        own = f"{self._zid}:own{runner.number}"
        self._groups[own] = picture_of.Group(own, "", node.full_name, 1)
        return (*named, own)

    def _named(self, node: Node, group: HandlerGroup) -> str:
        name = f"{self._zid}:{node.full_name}:{group.name}"
        # A group that cancels what runs is never full for good.
        limit = None if group.when_full == "cancel_running" else group.limit
        known = group.name if group in node.groups.by_name.values() else ""  # it is the runtime's own
        is_declared = known in node.groups.known
        self._groups[name] = picture_of.Group(name, known, node.full_name, limit, is_declared, group.is_threaded)
        return name

    def _call_of(self, runner: Runner, item: Any) -> str:
        """The call or goal that an item of a queue is."""
        if runner.kind == "service":
            try:
                sequence, _, gid = attachment.fields((item.attachment or b"")[: attachment.SIZE])
            except DecodeError:
                return ""
            return call_id(gid, sequence)
        if runner.kind == "reply":
            return str(item.call)
        return goal_id(item.goal_id) if runner.kind == "action" else ""

    def _arrived(self) -> dict[int, list[str]]:
        """Calls that have arrived and that the loop has not seen yet, by the runner that they are for."""
        found: dict[int, list[str]] = {}
        servers: dict[str, Runner] = {}
        for node in self._nodes:
            for endpoint in node.endpoints:
                runner = getattr(endpoint, "runner", None)
                if endpoint.entity is not None and runner is not None:
                    servers[str(endpoint.entity.eid)] = runner
        for eid, gid, sequence in self._context.switchboard.arrived():
            if eid in servers:
                found.setdefault(id(servers[eid]), []).append(call_id(gid, sequence))
        return found

    # activities

    def _add_run(self, node: Node, runner: Runner, run: Run) -> None:
        item = getattr(run, "item", None)
        serves = "" if item is None else self._call_of(runner, item)
        holds = self._holds(node, run)
        self._add(self.run_id(run), runner.label, node, run, holds, serves, is_inner=runner.is_inner)

    def _add_task(self, node: Node, task: Any) -> None:
        name = task.get_name().removeprefix(f"{node.full_name}.")
        self._add(self.task_id(task), f"task {name}", node, task, (), "")

    def _add(
        self,
        id_: str,
        label: str,
        node: Node,
        task: Any,
        holds: tuple[str, ...],
        serves: str,
        *,
        is_inner: bool = False,
    ) -> None:
        self._limit_ns = None
        frames = self._frames_of(task)
        wait = self._condition(task, _Way(node, task))
        self._seen.add((id_, wait))
        frame = _users(frames)
        place = Place("") if frame is None else Place(frame.f_code.co_filename, frame.f_lineno)
        function = "" if frame is None else frame.f_code.co_name
        is_async = frame is not None and bool(frame.f_code.co_flags & inspect.CO_COROUTINE)
        started, deadline = self._bounds(wait)
        if wait is not FREE and self._limit_ns is not None:
            deadline = min(self._limit_ns, deadline or self._limit_ns)
        if started is None:
            age = 0.0 if wait is FREE else self._waits.age(id_, wait, self._now_ns)
        else:
            age = (self._now_ns - started) / 1e9
        left = None if deadline is None else (deadline - self._now_ns) / 1e9
        self._activities[id_] = picture_of.Activity(
            id_, label, node.full_name, holds, wait, serves, place, function, age, left, self._zid, is_inner, is_async
        )

    def _bounds(self, wait: Condition) -> tuple[int | None, int | None]:
        """When the first of the calls that are waited for began, and when the first times out."""
        wanted = set(_call_ids(wait))
        found = [c for c in list(self._waits.calls.values()) if self._waits.id_of(c) in wanted]
        deadlines = [c[4] for c in found if c[4] is not None]
        begun = [c[3] for c in found]
        begun += [g.began_ns for g in list(self._waits.goals.values()) if goal_id(g.goal_id) in wanted]
        return min(begun, default=None), min(deadlines, default=None)

    # conditions

    def _condition(self, task: Any, way: _Way) -> Condition:
        """What a task or an activity waits for, in the end; `way` leads to it."""
        if id(task) in way.tasks or task.done():
            return FREE
        if isinstance(task, Activity) and task.returning_to is not None:
            for owner in self._nodes:
                if task.returning_to in owner.groups.by_name.values():
                    return Slot(self._named(owner, task.returning_to), getattr(task, "number", 0))
        waiter = getattr(task, "_fut_waiter", None)
        if waiter is None:
            return FREE
        frames = self._frames_of(task)
        limit_ns = self._limit_of(task)
        way = _Way(
            way.node, way.root, (*way.frames, *frames), way.tasks | {id(task)}, way.is_bounded or limit_ns is not None
        )
        if limit_ns is not None:
            self._limit_ns = min(limit_ns, self._limit_ns or limit_ns)
        for frame in reversed(frames):
            together = _joint_wait(frame)
            if together is not None:
                futures, kind, fails_early = together
                if any(f.done() and (kind is AnyOf or (fails_early and _has_failed(f))) for f in futures):
                    return FREE  # its next step is due
                conditions = tuple(self._of_future(f, way) for f in futures if not f.done())
                return All(conditions) if kind is All else AnyOf(conditions)
        return self._of_future(waiter, way)

    def _frames_of(self, task: Any) -> list[FrameType]:
        """The frames of a task, the outermost first; of one that waits for a thread, the thread's too."""
        frames = [frame for frame in map(_frame_of, _coroutines(task.get_coro())) if frame is not None]
        waiter = getattr(task, "_fut_waiter", None)
        thread = self._waits.threads.get(_shielded(waiter) or waiter)  # type: ignore[arg-type]
        if thread is not None and thread.ident is not None:
            frames += _stack(thread.ident)
        return frames

    def _limit_of(self, task: Any) -> int | None:
        """When a task gives up waiting, in nanoseconds of the clock; None for never."""
        found: list[float] = []
        for coroutine in _coroutines(task.get_coro()):
            frame = _frame_of(coroutine)
            if frame is not None and frame.f_code in (_WAIT, _WAIT_FOR):
                when = getattr(frame.f_locals.get("timeout_handle"), "when", None)  # uvloop's has one too
                found += [when()] if when is not None else []
            for context in _entered(coroutine):
                if isinstance(context, asyncio.Timeout) and (when := context.when()) is not None:
                    found.append(when)
                within = getattr(getattr(context, "gen", None), "ag_frame", None)
                if within is not None and within.f_code is _CLOCK_TIMEOUT:
                    return int(within.f_locals["until_ns"])
        seconds = min(found, default=None)
        return None if seconds is None else self._now_ns + to_ns(max(0.0, seconds - self._context.loop.time()))

    def _of_future(self, future: Any, way: _Way) -> Condition:
        waits = self._waits
        if future in waits.threads:
            asking = waits.asking.get(waits.threads[future].ident or 0)
            return self._closed_world(way, None) if asking is None else self._condition(asking, way)
        if future in waits.calls:
            gid, sequence, name, _, _ = waits.calls[future]
            return Call(call_id(gid, sequence), name) if self._servers[name] < 2 else FREE  # another may answer
        if future in waits.goals:
            goal = waits.goals[future]
            if self._servers[f"{goal.action}/_action/send_goal"] > 1:
                return FREE
            return self._or_cancelled(Call(goal_id(goal.goal_id), goal.action), goal, way)
        if future in waits.served:
            return Call(waits.served[future], "")
        if isinstance(future, Activity) or asyncio.isfuture(future):
            if hasattr(future, "get_coro"):
                known = self._known(future)
                return known if known is not None else self._or_cancelled(self._condition(future, way), future, way)
            children = getattr(future, "_children", None)
            if children is not None:  # gather
                if any(c.done() and _has_failed(c) for c in children) and not _returns_errors(children):
                    return FREE
                return All(tuple(self._of_future(c, way) for c in children if not c.done()))
            inner = _shielded(future)
            if inner is not None:
                return self._of_future(inner, way)
            return self._closed_world(way, future)
        return FREE

    def _known(self, task: Any) -> Condition | None:
        """An activity of the picture by its own name; any other task is looked into."""
        for node in self._nodes:
            if task in node.tasks:
                return Join(self.task_id(task))
        return None

    def _closed_world(self, way: _Way, waiter: Any) -> Condition:
        """A wait for something that, as far as the source code tells, only handlers of the node bring about."""
        found = setters(list(way.frames), waiter, way.node, is_bounded=way.is_bounded)
        if found is None or any(task.done() for task in found.tasks):
            return FREE
        ends = [self._of_future(task, way) for task in found.tasks]
        if found.handlers or not ends:
            ends.insert(0, self._set_by(found, way))
        return ends[0] if len(ends) == 1 else AnyOf(tuple(ends))

    def _or_cancelled(self, condition: Condition, thing: Any, way: _Way) -> Condition:
        """The wait for a task or goal of the node's, which others of its handlers may cancel."""
        if condition is FREE:
            return FREE
        try:
            found = cancellers(thing, way.node)
        except Unknown:
            return FREE
        return condition if found is None else AnyOf((condition, self._set_by(found, way)))

    def _set_by(self, found: Setters, way: _Way) -> Condition:
        node = way.node
        runners = [r for n, r in self._runners if n is node and r.handler in found.handlers]
        # Runs under way count too, also those that have let go of their slot.
        others: list[Any] = [run for r in runners for run in list(r.active) if run is not way.root]
        others += [t for t in list(node.tasks) if t is not way.root and _method(t) in found.handlers]
        known = {r.handler for r in runners} | {_method(t) for t in list(node.tasks)}
        if not found.handlers <= known:  # one of them is not there to be waited for
            return FREE
        is_held = False
        if found.lock is not None:
            inside = self._inside(found.lock)
            is_held = len(inside) == found.places
            if not is_held and not found.handlers:  # somebody else is in it, and nobody is seen to release it by hand
                return FREE
            others += inside
        queues = sorted(self.queue_id(r) for r in runners)
        activities = sorted({self.task_id(other) for other in others})
        return SetBy(found.what, tuple(queues), tuple(activities), is_held)

    def _inside(self, lock: Any) -> list[Any]:
        """The activities that have entered a lock, or a condition that has it, by `with`, and not left it."""
        found = []
        activities = [run for _, runner in self._runners for run in list(runner.active)]
        for task in activities + [task for node in self._nodes for task in list(node.tasks)]:
            chain = list(_coroutines(task.get_coro()))
            frames = [frame for frame in map(_frame_of, chain) if frame is not None]
            entered = [c for coroutine in chain for c in _entered(coroutine) if lock in (c, getattr(c, "_lock", None))]
            outside = [f.f_locals["self"] for f in frames if f.f_code in (_CONDITION_WAIT, _ENTER)]
            found += [task] * (len(entered) - sum(lock in (o, getattr(o, "_lock", None)) for o in outside))
        return found

    # the loop

    def _blocker(self) -> str | None:
        """The activity that blocks the event loop; None when it is not blocked, or this is its thread."""
        if threading.get_ident() == self._waits.thread or not self._context.watchdog.is_blocked:
            return None
        stack = _stack(self._waits.thread)
        held: tuple[Runner, Any, Any] | None = None
        for frame in reversed(stack):
            if frame.f_code is Runner._begin.__code__:
                held = (frame.f_locals["self"], frame.f_locals.get("run"), frame.f_locals["item"])
                break
            if frame.f_code is Activity.step.__code__ and isinstance(frame.f_locals["self"], Run):
                run = frame.f_locals["self"]
                held = (run.runner, run, getattr(run, "item", None))
                break
        if held is None or held[2] is None:  # nobody's, or a run that has ended and whose result is being sent
            return None
        runner, run, item = held
        node = next((n for n, r in self._runners if r is runner), None)
        if node is None:
            return None
        id_ = self.run_id(run) if run is not None else f"{self._zid}:d{runner.number}.{runner.runs}"
        user = _users(stack)
        place = Place("") if user is None else Place(user.f_code.co_filename, user.f_lineno)
        function = "" if user is None else user.f_code.co_name
        way = _Way(node, run, tuple(stack))
        if self._waits.blocking is None:
            wait = self._closed_world(way, None)
        else:
            wait = self._of_future(self._waits.blocking, way)
        self._seen.add((id_, wait))
        age = self._context.watchdog.blocked_for
        self._activities[id_] = picture_of.Activity(
            id_,
            runner.label,
            node.full_name,
            self._needs(node, runner),
            wait,
            self._call_of(runner, item),
            place,
            function,
            age,
            None,
            self._zid,
            is_async=False,
        )
        return id_


@cache
def _declared(cls: type) -> frozenset[str]:
    """The handlers that stand in a class."""
    return frozenset(declared.handlers(cls))


def _call_ids(condition: Condition) -> Iterator[str]:
    match condition:
        case Call(id=call):
            yield call
        case All(of=conditions) | AnyOf(of=conditions):
            for inner in conditions:
                yield from _call_ids(inner)


@dataclass(frozen=True, slots=True)
class _Way:
    """How a wait was come to: from a run of a handler, through the tasks that it waits for."""

    node: Node
    root: Any
    """The activity."""
    frames: tuple[FrameType, ...] = ()
    """Of all of them, the outermost first."""
    tasks: frozenset[int] = frozenset()
    """Their ids."""
    is_bounded: bool = False
    """Whether one of them gives up after some time."""


def _coroutines(coroutine: Any) -> Iterator[Any]:
    """A suspended coroutine and those that it awaits, the outermost first."""
    while coroutine is not None:
        yield coroutine
        coroutine = (
            getattr(coroutine, "cr_await", None)
            or getattr(coroutine, "gi_yieldfrom", None)
            or getattr(coroutine, "ag_await", None)
        )


def _frame_of(coroutine: Any) -> FrameType | None:
    frame = getattr(coroutine, "cr_frame", None) or getattr(coroutine, "gi_frame", None)
    return frame or getattr(coroutine, "ag_frame", None)


def _entered(coroutine: Any) -> Iterator[Any]:
    """What a suspended coroutine has entered by `with`: CPython keeps the method that leaves it on the stack."""
    for referent in gc.get_referents(coroutine):
        if isinstance(referent, MethodType) and referent.__name__ in ("__aexit__", "__exit__"):
            yield referent.__self__


def _stack(thread: int) -> list[FrameType]:
    """The frames of a running thread, the outermost first."""
    frames: list[FrameType] = []
    frame = sys._current_frames().get(thread)
    while frame is not None:
        frames.append(frame)
        frame = frame.f_back
    return frames[::-1]


def _users(frames: Iterable[FrameType]) -> FrameType | None:
    """The innermost frame that is neither graphflow's nor Python's own."""
    found = None
    for frame in frames:
        if is_users(frame.f_code.co_filename):
            found = frame
    return found


_TASK_GROUP_EXITS = tuple(
    getattr(asyncio.TaskGroup, name).__code__ for name in ("__aexit__", "_aexit") if hasattr(asyncio.TaskGroup, name)
)
_WAIT = asyncio.tasks._wait.__code__  # type: ignore[attr-defined]
_WAIT_FOR = asyncio.wait_for.__code__
_CONDITION_WAIT = asyncio.Condition.wait.__code__
_ENTER = asyncio.Lock.__aenter__.__code__
_CLOCK_TIMEOUT = Clock.timeout.__wrapped__.__code__  # type: ignore[attr-defined]


def _joint_wait(frame: FrameType) -> tuple[list[Any], type[All | AnyOf], bool] | None:
    """The tasks that one of asyncio's primitives waits for, if this is the frame of one.

    Returns:
        The tasks, whether all or any is waited for, and whether an error of one of them ends the wait.
    """
    code, names = frame.f_code, frame.f_locals
    if code in _TASK_GROUP_EXITS:
        return list(names["self"]._tasks), All, True
    if code is _WAIT:
        is_all = names["return_when"] == asyncio.ALL_COMPLETED
        return list(names["fs"]), All if is_all else AnyOf, False
    if code is _WAIT_FOR and asyncio.isfuture(names.get("fut")):
        return [names["fut"]], All, True
    return None


def _returns_errors(children: Iterable[Any]) -> bool:
    """Whether `asyncio.gather` was called with `return_exceptions`, told by the callback that it hangs on its parts."""
    for child in children:
        for entry in getattr(child, "_callbacks", None) or ():
            callback = entry[0] if isinstance(entry, tuple) else entry
            names = getattr(getattr(callback, "__code__", None), "co_freevars", ())
            if "return_exceptions" in names:
                return bool(callback.__closure__[names.index("return_exceptions")].cell_contents)
    return False


def _shielded(outer: Any) -> Any:
    """What `asyncio.shield` protects, told by the callback that it hangs on the outer future."""
    for entry in getattr(outer, "_callbacks", None) or ():
        callback = entry[0] if isinstance(entry, tuple) else entry
        if getattr(callback, "__name__", "") == "_outer_done_callback" and callback.__closure__:
            for cell in callback.__closure__:
                if asyncio.isfuture(cell.cell_contents) and cell.cell_contents is not outer:
                    return cell.cell_contents
    return None


def _has_failed(future: Any) -> bool:
    return bool(future.cancelled() or future.exception() is not None)


def _method(task: Any) -> str:
    return str(getattr(task.get_coro(), "__name__", ""))

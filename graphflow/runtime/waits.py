"""What the handlers and tasks of this process wait for, read off when somebody asks: a `machines.waits.Picture`.

Nothing is written down while a handler runs, but for one entry per call. What an activity waits for is read from the
future that it awaits; where that tells nothing, from the coroutines between: asyncio's own primitives are known by
their code. A picture can be taken on any thread, so also while the event loop is blocked.
"""

from __future__ import annotations

import asyncio
import queue
import sys
import sysconfig
import threading
from asyncio import Future
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any

from graphflow.errors import DecodeError, Place
from graphflow.machines import waits as picture_of
from graphflow.machines.waits import FREE, All, AnyOf, Call, Condition, Join, Picture, SetBy, Slot
from graphflow.runtime.closed_world import setters
from graphflow.runtime.scheduler import Activity, Run, Runner
from graphflow.wire import attachment, chain

if TYPE_CHECKING:
    from graphflow.runtime.context import Context
    from graphflow.runtime.groups import HandlerGroup
    from graphflow.runtime.node import Node

_OURS = str(Path(__file__).parents[1])
_PYTHONS = sysconfig.get_path("stdlib")
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
        if group is None:
            holders, limit = list(runner.active), 1
        elif group.limit is None:
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

    def age(self, activity: str, wait: Condition, now_ns: int) -> float:
        """Seconds since this wait was first seen."""
        return (now_ns - self._since.setdefault((activity, wait), now_ns)) / 1e9

    def forget(self, keep: set[tuple[str, Condition]]) -> None:
        """Keep account of these waits only."""
        self._since = {key: when for key, when in self._since.items() if key in keep}


def call_id(gid: bytes, sequence: int) -> str:
    """How pictures of all processes name a call."""
    return f"{gid.hex()}:{abs(sequence)}"


def goal_id(raw: bytes) -> str:
    """How pictures of all processes name a goal."""
    return f"goal:{raw.hex()}"


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

    def shoot(self) -> Picture:
        arrived = self._arrived()
        for node, runner in self._runners:
            group = self._group_of(node, runner)
            calls = [c for c in (self._call_of(runner, item) for item in list(runner.items)) if c]
            calls += arrived.get(id(runner), [])
            waiting = len(runner.items) + len(arrived.get(id(runner), []))
            queue = self.queue_id(runner)
            self._queues[queue] = picture_of.Queue(
                queue, runner.label, node.full_name, group, tuple(calls), waiting, runner.dropped(), self._zid
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
        return self.run_id(task) if isinstance(task, Run) else f"{self._zid}:t{id(task):x}"

    def queue_id(self, runner: Runner) -> str:
        return f"{self._zid}:q{runner.number}"

    def _group_of(self, node: Node, runner: Runner) -> str:
        """The id of the group whose slot the runner's next run takes."""
        group = runner.group
        if group is None or (runner.one_at_a_time and group.limit != 1):
            own = f"{self._zid}:own{runner.number}"
            self._groups[own] = picture_of.Group(own, "", node.full_name, 1)
            return own
        return self._named(node, group)

    def _named(self, node: Node, group: HandlerGroup) -> str:
        name = f"{self._zid}:{node.full_name}:{group.name}"
        # A group that cancels what runs is never full for good.
        limit = None if group.when_full == "cancel_running" else group.limit
        self._groups[name] = picture_of.Group(name, group.name, node.full_name, limit)
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
        if run.group is None:
            group = self._group_of(node, runner) if runner.group is None else ""
        elif runner.one_at_a_time and run.group.limit != 1:
            group = self._group_of(node, runner)
        else:
            group = self._named(node, run.group)
        self._add(self.run_id(run), runner.label, node, run, group, serves, is_inner=runner.is_inner)

    def _add_task(self, node: Node, task: Any) -> None:
        name = task.get_name().removeprefix(f"{node.full_name}.")
        self._add(self.task_id(task), f"task {name}", node, task, "", "")

    def _add(
        self, id_: str, label: str, node: Node, task: Any, group: str, serves: str, *, is_inner: bool = False
    ) -> None:
        frames = self._frames_of(task)
        wait = self._condition(task, set(), node)
        self._seen.add((id_, wait))
        frame = _users(frames)
        place = Place("") if frame is None else Place(frame.f_code.co_filename, frame.f_lineno)
        function = "" if frame is None else frame.f_code.co_name
        started, deadline = self._bounds(wait)
        if started is None:
            age = 0.0 if wait is FREE else self._waits.age(id_, wait, self._now_ns)
        else:
            age = (self._now_ns - started) / 1e9
        left = None if deadline is None else (deadline - self._now_ns) / 1e9
        self._activities[id_] = picture_of.Activity(
            id_, label, node.full_name, group, wait, serves, place, function, age, left, self._zid, is_inner
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

    def _condition(self, task: Any, seen: set[int], node: Node | None) -> Condition:
        """What a task or an activity waits for."""
        if id(task) in seen or task.done():
            return FREE
        seen = seen | {id(task)}
        if isinstance(task, Activity) and task.returning_to is not None:
            for owner in self._nodes:
                if task.returning_to in owner.groups.by_name.values():
                    return Slot(self._named(owner, task.returning_to), getattr(task, "number", 0))
        waiter = getattr(task, "_fut_waiter", None)
        if waiter is None:
            return FREE
        frames = self._frames_of(task)
        for frame in reversed(frames):
            together = _joint_wait(frame)
            if together is not None:
                futures, kind = together
                if any(f.done() and (kind is AnyOf or _has_failed(f)) for f in futures):
                    return FREE  # its next step is due
                conditions = tuple(self._of_future(f, seen, node) for f in futures if not f.done())
                return All(conditions) if kind is All else AnyOf(conditions)
        condition = self._of_future(waiter, seen, node)
        if condition is FREE and node is not None:
            return self._closed_world(frames, node, task)
        return condition

    def _frames_of(self, task: Any) -> list[FrameType]:
        """The frames of a task, the outermost first; of one that waits for a thread, the thread's too."""
        frames = list(_frames(task.get_coro()))
        waiter = getattr(task, "_fut_waiter", None)
        thread = self._waits.threads.get(_shielded(waiter) or waiter)  # type: ignore[arg-type]
        if thread is not None and thread.ident is not None:
            frames += _stack(thread.ident)
        return frames

    def _of_future(self, future: Any, seen: set[int], node: Node | None) -> Condition:
        waits = self._waits
        if future in waits.threads:
            asking = waits.asking.get(waits.threads[future].ident or 0)
            return FREE if asking is None else self._condition(asking, seen, node)
        if future in waits.calls:
            gid, sequence, name, _, _ = waits.calls[future]
            return Call(call_id(gid, sequence), name)
        if future in waits.goals:
            goal = waits.goals[future]
            return Call(goal_id(goal.goal_id), goal.action)
        if future in waits.served:
            return Call(waits.served[future], "")
        if isinstance(future, Activity) or asyncio.isfuture(future):
            if hasattr(future, "get_coro"):
                known = self._known(future)
                return known if known is not None else self._condition(future, seen, node)
            children = getattr(future, "_children", None)
            if children is not None:  # gather
                if any(c.done() and _has_failed(c) for c in children):
                    return FREE
                return All(tuple(self._of_future(c, seen, node) for c in children if not c.done()))
            inner = _shielded(future)
            if inner is not None:
                return self._of_future(inner, seen, node)
        return FREE

    def _known(self, task: Any) -> Condition | None:
        """An activity of the picture by its own name; any other task is looked into."""
        for node in self._nodes:
            if task in node.tasks:
                return Join(self.task_id(task))
        return None

    def _closed_world(self, frames: list[FrameType], node: Node, task: Any) -> Condition:
        """A wait for something that, as far as the source code tells, only handlers of the node bring about."""
        found = setters(frames, node)
        if found is None:
            return FREE
        what, names = found
        runners = [r for n, r in self._runners if n is node and r.handler in names]
        # Runs under way count too, also those that have let go of their slot.
        others: list[Any] = [run for r in runners for run in list(r.active) if run is not task]
        others += [t for t in list(node.tasks) if t is not task and _method(t) in names]
        known = {r.handler for r in runners} | {_method(t) for t in list(node.tasks)}
        if not names <= known:  # one of them is not there to be waited for
            return FREE
        queues = sorted(self.queue_id(r) for r in runners)
        return SetBy(what, tuple(queues), tuple(sorted(self.task_id(other) for other in others)))

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
                held = (run.runner, run, run.item)
                break
        if held is None:
            return None
        runner, run, item = held
        node = next((n for n, r in self._runners if r is runner), None)
        if node is None:
            return None
        id_ = self.run_id(run) if run is not None else f"{self._zid}:d{runner.number}.{runner.runs}"
        user = _users(stack)
        place = Place("") if user is None else Place(user.f_code.co_filename, user.f_lineno)
        function = "" if user is None else user.f_code.co_name
        if self._waits.blocking is None:
            wait = self._closed_world(stack, node, run)
        else:
            wait = self._of_future(self._waits.blocking, set(), node)
        self._seen.add((id_, wait))
        age = self._context.watchdog.blocked_for
        self._activities[id_] = picture_of.Activity(
            id_,
            runner.label,
            node.full_name,
            self._group_of(node, runner),
            wait,
            self._call_of(runner, item),
            place,
            function,
            age,
            None,
            self._zid,
        )
        return id_


def _call_ids(condition: Condition) -> Iterator[str]:
    match condition:
        case Call(id=call):
            yield call
        case All(of=conditions) | AnyOf(of=conditions):
            for inner in conditions:
                yield from _call_ids(inner)


def _frames(coroutine: Any) -> Iterator[FrameType]:
    """The frames of a suspended coroutine, the outermost first."""
    while coroutine is not None:
        frame = getattr(coroutine, "cr_frame", None) or getattr(coroutine, "gi_frame", None)
        frame = frame or getattr(coroutine, "ag_frame", None)
        if frame is not None:
            yield frame
        coroutine = (
            getattr(coroutine, "cr_await", None)
            or getattr(coroutine, "gi_yieldfrom", None)
            or getattr(coroutine, "ag_await", None)
        )


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
        file = frame.f_code.co_filename
        if not file.startswith((_OURS, _PYTHONS, "<frozen")):
            found = frame
    return found


_TASK_GROUP_EXITS = tuple(
    getattr(asyncio.TaskGroup, name).__code__ for name in ("__aexit__", "_aexit") if hasattr(asyncio.TaskGroup, name)
)
_WAIT = asyncio.tasks._wait.__code__  # type: ignore[attr-defined]
_WAIT_FOR = asyncio.wait_for.__code__


def _joint_wait(frame: FrameType) -> tuple[list[Any], type[All | AnyOf]] | None:
    """The tasks that one of asyncio's primitives waits for, if this is the frame of one."""
    code, names = frame.f_code, frame.f_locals
    if code in _TASK_GROUP_EXITS:
        return list(names["self"]._tasks), All
    if code is _WAIT:
        is_all = names["return_when"] == asyncio.ALL_COMPLETED
        return list(names["fs"]), All if is_all else AnyOf
    if code is _WAIT_FOR and asyncio.isfuture(names.get("fut")):
        return [names["fut"]], All
    return None


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

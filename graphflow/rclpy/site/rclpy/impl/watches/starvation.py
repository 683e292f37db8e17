"""Work that is held up: by callbacks that run for long, or on nodes that nothing spins.

Neither is an error in ROS 2, where a node just falls silent. Each is reported once, with the line.
"""

from __future__ import annotations

import ast
import linecache
import logging
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple
from weakref import WeakSet

from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import loops_at, nodes_in, syntax_of
from graphflow.analysis.user_code import is_ours, is_users, short_place, variable_of, where
from graphflow.errors import Place
from graphflow.rclpy.wake import Wake
from rclpy.action.client import ActionClient
from rclpy.action.server import ActionServer
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.impl.deadlock.groups import executors, is_exclusive, threads_of
from rclpy.impl.deadlock.stacks import Level, Stack, stacks
from rclpy.impl.entities import arrived, entities_of, full_name, goal_of, name_of, node_of_goal, role_of
from rclpy.impl.failing import failure
from rclpy.impl.mistakes import inverted_waits
from rclpy.impl.nodes import internals_of, nodes_of
from rclpy.impl.spinning import Run
from rclpy.timer import Timer

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.impl.spinning import Entity
    from rclpy.node import Node

WARN_AFTER = 3.0
"""Seconds for which work is held up before it is reported."""
SHOWN = 3
"""The number of callbacks that a report names."""
RETURN = "return from it soon (a timer does what a loop with a sleep does)"
_WAIT = Wake.wait.__code__
logger = logging.getLogger("graphflow")


_ONE_EXECUTOR = (
    "spin all nodes together: executor = SingleThreadedExecutor(), executor.add_node(node) for each, executor.spin()"
)


class _Report(NamedTuple):
    text: str
    is_over: str
    """The phrase for its end, before its duration in seconds."""


def own_group(run: Run) -> str:
    """Return how a run lets other callbacks run beside it: in a group of its own, on an executor with threads."""
    if (threads_of(run.executor) or 1) > 1:
        return "give it a callback group of its own: these share one, whose callbacks run one at a time"
    return "give it a callback group of its own and spin with MultiThreadedExecutor()"


class HeldUp:
    """The held-up work of one context.

    Args:
        is_reported: Whether a deadlock report covers a run, `"r"`, or a thread, `"t"`, by identity or by title.
    """

    def __init__(self, life: ContextState, is_reported: Callable[..., bool]) -> None:
        self._life, self._is_reported = life, is_reported
        self._since: dict[object, float] = {}
        """The monotonic time at which each step of a run, and each node without a spin, was first seen."""
        self._reports: dict[object, _Report] = {}
        self._known: set[str] = set()
        """The callbacks and nodes that have been reported: a recurrence is not reported again."""
        self._begun: WeakSet[object] = WeakSet()
        """The nodes that have been checked once they had time to be constructed."""
        life.on_leaving.append(self._leaves)

    @property
    def texts(self) -> list[str]:
        """Return the reports that still hold."""
        return [told.text for told in list(self._reports.values())]

    def check(self) -> None:
        """Report work that has been held up for long, and work that is no longer held up."""
        now = time.monotonic()
        steps = {(run, run.stepped_ns): run for run in self.runs() if run.thread}
        idle = {(node, _turns(node)): node for node in nodes_of(self._life) if not _is_spun(node)}
        fresh = {(node, "made"): node for node in nodes_of(self._life) if node not in self._begun}
        for key in [key for key in self._since if key not in steps and key not in idle and key not in fresh]:
            seconds = now - self._since.pop(key)
            if key in self._reports:
                logger.warning("%s after %.1f s", self._reports.pop(key).is_over, seconds)
        for key in [*steps, *idle]:
            seconds = now - self._since.setdefault(key, now)
            if seconds < WARN_AFTER or key in self._reports:
                continue
            told = self._of_run(steps[key], seconds) if key in steps else self._of_node(key, seconds)
            if told is not None:
                self._reports[key] = told
                logger.warning("%s", told.text)
        for key, node in fresh.items():
            if now - self._since.setdefault(key, now) >= WARN_AFTER:
                self._begun.add(node)
                self._report_init(node)

    def runs(self) -> Iterator[Run]:
        """Return all runs of the context's executors."""
        for executor in executors():
            if executor.context.life is self._life:
                yield from list(executor.spinning.running)

    def was_reported(self, name: str) -> bool:
        """Return whether something has been reported before, and note that it has."""
        was_reported = name in self._known
        self._known.add(name)
        return was_reported

    def is_deadlocked(self, run: Run, title: str) -> bool:
        """Whether a deadlock report covers a run in more detail."""
        return self._is_reported(run, "r", title)

    def _of_run(self, run: Run, seconds: float) -> _Report | None:
        """Return a report on a run; None if nothing waits for it, or a deadlock report covers it."""
        level = next((stack.levels[-1] for stack in stacks() if stack.levels[-1].run is run), None)
        node = node_of(run)
        if level is None or node is None or (level.waiting is not None and not _spins_on(level)):
            return None
        kept = [_due_of(entity, run) for entity in kept_by(run, spins_on=level.waiting is not None)]
        title = f"{label_of(run)} of {full_name(node)}"
        if not kept or self.is_deadlocked(run, title) or self.was_reported(title):
            return None
        others, way = [word for word in kept if word != label_of(run)], RETURN
        keeps = "is due again"
        if others:
            keeps, way = f"keeps {_joined(others)} waiting", f"{RETURN}, or {own_group(run)}"
            way = own_group(run) if title.startswith("action ") else way  # which goes on until its goal has ended
        if level.waiting is not None:
            way = "it spins there; let it return instead, and the spin that called it continues"
        text = f"{title} has been running for {seconds:.1f} s, now in {place_of(level, node)}, and {keeps}: {way}"
        text += empty_group(node)
        return _Report(text, f"{title} has returned")

    def _report_init(self, node: Node) -> None:
        """Report a node that is spun in its own `__init__` before it has any callbacks."""
        if any(_called(entity) for entity in entities_of(node)):
            return  # the spin may be the last thing there
        for stack in stacks():
            level = stack.levels[0]
            if _spins_on(level) and any(_is_init(frame, node) for frame in level.frames):
                text = (
                    "%s.__init__ does not return: it spins in %s, and %s has no callbacks yet: create its timers "
                    "and subscriptions there, and call rclpy.spin(node) after it"
                )
                logger.warning(text, type(node).__name__, place_of(level, node), full_name(node))
                return

    def _of_node(self, key: tuple[Any, Any], seconds: float) -> _Report | None:
        """Return a report on a node that is not spun; None if that holds nothing up, or a deadlock report covers it."""
        node, name = key[0], full_name(key[0])
        found = _program(list(stacks()), node)
        if found is None:
            return None
        stack, level = found
        if not stack.spins and any(frame.f_code is _WAIT for frame in level.frames):
            self._since[key] = (
                time.monotonic()
            )  # it waits on rclpy, which reports that itself or by the deadlock search
            return None
        is_polled = _polls(level, node)
        kept = [word for one in entities_of(node) if (is_polled or _is_ready(one)) and (word := _called(one))]
        is_begun = not any(_is_init(frame, node) for frame in level.frames)
        thread = f"thread {stack.thread.name}"
        if (is_begun and not kept) or self._is_reported(stack.thread, "t", thread) or self.was_reported(name):
            return None
        if any(inverted_waits.is_reported(frame.f_code) for frame in level.frames):
            return None
        for_long, place = f"for {seconds:.1f} s", place_of(level, node)
        if not is_begun:
            text = (
                f"{type(node).__name__}.__init__ has not returned {for_long}, now in {place}, and no callback of "
                f"{name} is called before rclpy.spin(node): make a timer in __init__ in place of a loop or a sleep"
            )
        else:
            who = "the program" if stack.thread is threading.main_thread() else thread
            spun = stack.spins or [executor for other in stacks() for executor in other.spins]
            way = _ONE_EXECUTOR if spun else _way_to_spin(level, node)
            if spun and not internals_of(node).was_spun and not any(executor.get_nodes() for executor in spun):
                way = f"its executor has no node: write executor.add_node({_name_of(level, node)}) before it spins"
            called = f"{_joined(kept)} {'cannot' if is_polled else 'should'} be called"
            text = f"{name} has not been spun {for_long}, and {called}: {who} is in {place}; {way}"
        return _Report(text, f"{name} is spun")

    def _leaves(self, node: Node) -> None:
        """Report a node that leaves without having been spun, unless reported before, or the program is failing."""
        if internals_of(node).was_spun or failure() is not None or full_name(node) in self._known:
            return
        kept = [
            label_with_line(e) for e in entities_of(node) if _called(e) and not isinstance(e, (Client, ActionClient))
        ]
        if not kept:
            return
        place, spin = _shut_down_in(), "executor.spin()" if internals_of(node).times_added else "rclpy.spin(node)"
        if place is None:
            text = "%s ends and was never spun, so %s could not be called: %s calls callbacks"
            logger.warning(text, full_name(node), _joined(kept), spin)
        else:
            text = "rclpy is shut down in %s before %s was spun, so %s could not be called: call %s before it"
            logger.warning(text, place, full_name(node), _joined(kept), spin)


def _way_to_spin(level: Level, node: Node) -> str:
    """Return the advice for a program that does not spin a node, by what the program does instead."""
    name, frame = _name_of(level, node), level.innermost
    if frame is not None and "input(" in linecache.getline(frame.f_code.co_filename, frame.f_lineno):
        return f"spin it in a thread: threading.Thread(target=rclpy.spin, args=({name},), daemon=True).start()"
    if any(_loops(level)):
        return f"call rclpy.spin_once({name}, timeout_sec=0.1) in the loop there, in place of a sleep"
    return f"have it call rclpy.spin({name})"


def _polls(level: Level, node: Node) -> bool:
    """Whether code reads an attribute of a node again and again, to wait for one of its callbacks."""
    name = _name_of(level, node)
    for loop in _loops(level):
        parts = nodes_in(loop.test) if isinstance(loop, ast.While) else []
        called = [inner for part in parts if isinstance(part, ast.Call) for inner in nodes_in(part.func)]
        for part in parts:
            match part:
                case ast.Attribute(value=ast.Name(id=owner)) if owner == name and part not in called:
                    return True
    return False


def _name_of(level: Level, node: Node) -> str:
    """Return the name of the variable that holds a node, as code would use it there."""
    users = [frame for frame in level.frames if is_users(frame.f_code.co_filename)]
    return variable_of(node, reversed(users), "node")


def _loops(level: Level) -> Iterator[ast.For | ast.While]:
    """Yield the loops in which the user's code is, those of a function's callers included."""
    for frame in level.frames:
        code = frame.f_code
        if is_users(code.co_filename):
            with suppress(OSError, SyntaxError, ValueError):  # its source is not available
                yield from loops_at(syntax_of(code.co_filename), code.co_firstlineno, frame.f_lineno)


def _shut_down_in() -> Place | None:
    """Return the line of user code that shuts rclpy down; None if this thread is not doing so."""
    inner, frame = sys._getframe(), sys._getframe().f_back
    while frame is not None and not is_users(frame.f_code.co_filename):
        inner, frame = frame, frame.f_back
    if frame is None or inner.f_code.co_name not in ("shutdown", "try_shutdown", "__exit__"):
        return None
    return short_place(frame.f_code.co_filename, frame.f_lineno)


def _spins_on(level: Level) -> bool:
    """Whether code has called a `spin` that lasts as long as the context."""
    is_spin = any(frame.f_code.co_name == "spin" and is_ours(frame.f_code.co_filename) for frame in level.frames)
    return is_spin and level.waiting is not None


def empty_group(node: Node) -> str:
    """Describe a callback group among a node's attributes that has no callbacks; empty if there is none."""
    for name, group in list(vars(node).items()):
        is_known = type(group) in (MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup)
        if is_known and not group.entities and group is not node.default_callback_group:
            return f"; self.{name} has no callbacks yet: write callback_group=self.{name} where they are made"
    return ""


def kept_by(run: Run, *, spins_on: bool = False) -> Iterator[Entity]:
    """Return the user's entities that have work and cannot run because of a run.

    Args:
        spins_on: Whether the run spins, so that it keeps no thread from others.
    """
    executor = run.executor
    limit = None if spins_on else threads_of(executor)
    is_full = limit is not None and sum(r.thread != 0 for r in list(executor.spinning.running)) >= limit
    for node in list(executor.spinning.nodes):
        for entity in entities_of(node):
            is_grouped = run.group is not None and entity.callback_group is run.group and is_exclusive(run.group)
            if (is_full or is_grouped) and _is_ready(entity) and _due_of(entity, run):
                yield entity


def _due_of(entity: Entity, run: Run) -> str:
    """Return the name of an entity that waits for a run to end; empty for none of the user's.

    A goal's client requests the result at once, and gets it when the run ends: it is not held up.
    """
    goal = goal_of(run)
    own = run.entity if goal is None else goal.action_server
    if entity is not own or not isinstance(entity, ActionServer):
        return _called(entity)
    inner = internals_of(entity)
    if inner.cancels.inbox.items:
        return "a request to cancel"
    return "a new goal" if inner.goals.inbox.items else ""


def _is_ready(entity: Entity) -> bool:
    return entity.has_work() if isinstance(entity, Timer) else arrived(entity)[1] > 0


def _called(entity: Entity) -> str:
    """Return the name of an entity; empty for graphflow's own."""
    role = role_of(entity)
    if isinstance(entity, (Client, ActionClient)):
        return f"the answer of {role.handler}"
    return "" if role.is_inner else role.label


def label_of(run: Run) -> str:
    """Return the label of a run in deadlock reports: `timer tick`."""
    if run.entity is not None:
        return role_of(run.entity).label
    return f"action {name_of(run.args[0]) or 'execute'}" if goal_of(run) is not None else f"task {name_of(run.called)}"


def node_of(run: Run) -> Node | None:
    """Return the node of a run's callback; for a task, one of its executor's nodes."""
    goal = goal_of(run)
    if goal is not None:
        return node_of_goal(goal)
    return run.node if run.node is not None else next(iter(run.executor.spinning.nodes), None)


def place_of(level: Level, node: Node) -> str:
    """Return the position of a thread's user code: `lamp.py:12 in tick`."""
    found = where(level.frames, node)
    return f"{short_place(found.place.file, found.place.line)} in {found.function}"


def _joined(kept: list[str]) -> str:
    """Join the names of callbacks, at most as many as a sentence bears."""
    shown = list(dict.fromkeys(kept))
    rest = len(shown) - SHOWN
    return " and ".join(shown) if rest <= 0 else f"{', '.join(shown[:SHOWN])} and {rest} more"


def _is_init(frame: Frame, node: Node) -> bool:
    """Whether a frame is that of the node's own `__init__`."""
    code = frame.f_code
    return code.co_name == "__init__" and is_users(code.co_filename) and frame.f_locals.get("self") is node


def _program(found: list[Stack], node: Node) -> tuple[Stack, Level] | None:
    """Return the program's thread that constructs a node, or else could spin it, or else spins others."""
    own = [(stack, stack.levels[0]) for stack in found if stack.is_users and stack.levels[0].innermost is not None]
    making = [pair for pair in own if any(_is_init(frame, node) for frame in pair[1].frames)]
    main = [pair for pair in own if pair[0].thread is threading.main_thread()]
    able = [pair for pair in [*main, *own] if not pair[0].spins]
    return next(iter([*making, *able, *main, *own]), None)


def _executor_of(node: Node) -> Executor | None:
    executor: Executor | None = node.executor
    return executor if executor is not None and node in executor.spinning.nodes else None


def _turns(node: Node) -> tuple[int, int]:
    """Return numbers that change when a node is spun."""
    executor = _executor_of(node)
    return internals_of(node).times_added, 0 if executor is None else executor.spinning.turns


def _is_spun(node: Node) -> bool:
    """Whether a thread is spinning a node: it waits for work, or does some."""
    executor = _executor_of(node)
    return executor is not None and executor.spinning.is_spun


def label_with_line(entity: Entity) -> str:
    """`timer tick (lamp.py:12)`."""
    code = getattr(getattr(entity, "callback", None), "__code__", None)
    line = f" ({short_place(code.co_filename, code.co_firstlineno)})" if code is not None else ""
    return f"{_called(entity)}{line}"

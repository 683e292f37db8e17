"""What can end a wait that asyncio knows nothing about: a plain Event, Queue, Lock or Future, or a flag that is polled.

The answer is read from the source of the node's class: which methods set `self.arrived`, assign `self.pose`, and which
handlers call them. That holds as long as nothing else does it, which the source cannot prove: hence *closed world*,
and reports that say LIKELY. Whatever cannot be followed to the end leaves the world open, and nothing is reported: an
object that is passed on, a function inside a method, an attribute that is written from outside, a condition with
anything in it but attributes, constants and arithmetic.
"""

from __future__ import annotations

import ast
import asyncio
import sys
import threading
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from graphflow.analysis.attribute_uses import Use, is_own
from graphflow.analysis.class_source import LAMBDA, Function, Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.local_messages import CONTAINER_MAKERS, is_new, messages
from graphflow.analysis.syntax import FunctionNode, first_line, is_nested, syntax_of, walk
from graphflow.analysis.user_code import Pause
from graphflow.deadlock.asyncio_frames import DEEDS, ENDINGS, awaited_future, is_inside, object_wait
from graphflow.deadlock.closed_world.conditions import (
    CONTAINERS,
    LOOKING,
    PLAIN,
    QUESTIONS,
    TOOLS,
    VIEWLESS,
    Loop,
    LoopConditions,
    arrays,
    makes_task,
)
from graphflow.deadlock.closed_world.module_names import changes
from graphflow.deadlock.protocols import Subject
from graphflow.executor.ledger import PendingGoal
from graphflow.executor.runner import Runner

BEGINNINGS = {"__init__", "on_start", "on_shutdown"}
_MAKERS = {
    *(tool.__name__ for tool in TOOLS),
    "create_future",
    "Lock",
    "Semaphore",
    "BoundedSemaphore",
    "Condition",
    "Barrier",
}
_MAKERS |= {"PriorityQueue", "LifoQueue", "create_task", "ensure_future"}


class Setters(NamedTuple):
    """What ends a wait."""

    what: str
    handlers: frozenset[str]
    """Methods that are called by timers, messages, requests, goals, or run as tasks."""
    lock: Any = None
    """What ends the wait when one of those that have entered it by `with` leaves it."""
    places: int = 1
    """How many can be in it at a time."""
    tasks: tuple[asyncio.Future[Any], ...] = ()
    """Tasks and goals whose end may end the wait too."""
    deed: str = "sets"
    """What the handlers do to it."""
    gives_up: bool = False
    """Whether a deadline ends the wait for good, and not only this attempt."""
    module: str = ""
    """The module that holds what is set, or whose class does, if it is not the node that does."""
    pause: Pause | None = None
    """Where the loop pauses, if one polls."""
    parts: frozenset[str] = frozenset()
    """Methods that end it as parts of an `asyncio.gather` in one of those."""

    def is_shared(self, node: Subject, nodes: Iterable[Subject]) -> bool:
        """Whether other nodes of the process may end the wait too: those whose methods are in that module."""
        others = [cls for other in nodes if other is not node for cls in type(other.instance).__mro__]
        return any(cls.__module__ == self.module for cls in others)


def cancellers(thing: Any, node: Subject) -> Setters | None:
    """What cancels a task or goal that the node keeps without being asked to, as timers and tasks do; None for nothing.

    What cancels only on a message or a request is like the world outside: a ring that needs it does not end.

    Raises:
        Unknown: Something may.
    """
    instance = node.instance
    held = {name for name, value in vars(instance).items() if value is thing or _holds(value, thing)}
    if not held:
        return None
    source, methods, over = source_of(instance), set[str](), beginnings_of(node)
    for name in held:
        uses = source.uses(name)
        if getattr(instance, name) is not thing or source.foreign(name) or any(use.kind == "given" for use in uses):
            if any(use.method not in over for use in (*source.foreign("cancel"), *source.uses("cancel"))):
                raise Unknown
            continue
        methods |= {use.method for use in uses if use.kind == "called" and use.name == "cancel"}
    entries = entries_of(node)
    alone = {runner.spec.handler for runner in node.runners if runner.spec.kind == "timer"}
    alone |= {method_of(task) for task in node.tasks}
    what = " and ".join(f"self.{name}" for name in sorted(held))
    above = source.above(methods - over, entries)
    if above & source.gathered:
        raise Unknown
    found = frozenset(above & alone)
    return Setters(what, found) if found else None


def entries_of(node: Subject) -> set[str]:
    """The methods of a node that graphflow runs: handlers and tasks, and `on_start` with those that wait for it."""
    found = {handler_of(runner) for runner in node.runners} | {method_of(task) for task in node.tasks}
    return found | ({handler_in(part.title) for part in node.unopened} | {"on_start"} if node.starting else set())


def beginnings_of(node: Subject) -> set[str]:
    """The methods whose work is over, or yet to come, whatever waits now."""
    return BEGINNINGS - {"on_start"} if node.starting else BEGINNINGS


def handler_in(title: str) -> str:
    """The method in the title of what a node runs, or the word for any lambda."""
    name = title.rpartition(" ")[2]
    return name if name.isidentifier() else LAMBDA


def handler_of(runner: Runner) -> str:
    """The method that a runner calls, or the word for any lambda."""
    return runner.spec.handler if runner.spec.handler.isidentifier() else LAMBDA


@dataclass(frozen=True)
class _Spot:
    """A frame of one of the node's methods."""

    frame: Frame
    function: Function

    @cached_property
    def loops(self) -> list[Loop]:
        """The loops around the place, the outermost first."""
        around = (ast.While, ast.AsyncFor, ast.For)
        nodes = ast.walk(self.function.syntax)  # by depth
        return [node for node in nodes if isinstance(node, around) and _spans(node, self.frame.f_lineno)]


def _spans(node: ast.stmt, line: int) -> bool:
    return node.lineno <= line <= (node.end_lineno or line)


class Question:
    """What ends one wait."""

    owner = ""
    """The attribute by which the node holds the object in which it waits; empty for the node itself."""

    def __init__(self, frames: list[Frame], node: Subject, instance: object = None) -> None:
        self._node, self._instance = node, node.instance if instance is None else instance
        self._source = source_of(self._instance)
        self._waits = [wait for wait in map(object_wait, frames) if wait is not None]
        self.is_bounded = any(wait.is_bounded for wait in self._waits)
        self._places: list[_Spot] = []
        for frame in frames:
            function = self._source.function(frame.f_code)
            if function is not None and frame.f_locals.get("self") is self._instance:
                self._places.append(_Spot(frame, function))
            elif frame.f_locals.get("self") is self._instance and not is_library(frame):
                raise Unknown  # a method whose source was not found
            elif self._places and not (is_library(frame) or only_pauses(frame)):
                self._places.clear()  # foreign code comes in between and may do as it likes
        if not self._places and instance is None:
            raise Unknown

    @property
    def is_repeated(self) -> bool:
        """Whether the code waits repeatedly, for as long as something holds."""
        return any(isinstance(loop, (ast.While, ast.AsyncFor)) for place in self._places for loop in place.loops)

    # something that is waited for

    def of_object(self, waiter: Any) -> Setters | None:
        """The callers of what ends the wait for an object of the node; None when the wait is for none."""
        waits = self._waits[::-1]
        if not waits and (wait := awaited_future(waiter)) is not None:
            waits = [wait]
            if not any(self._names(waiter)):
                return None
        for thing, methods, _ in waits:  # some are made of others, which the node does not know
            by_name, in_container = self._names(thing)
            if len(by_name) + len(in_container) > 1:
                raise Unknown
            if by_name:
                name = by_name.pop()
                found = self._ended(name, thing, methods)
                return found and found._replace(module=self._class_with(name))
            if in_container:
                return self._ended_in_container(in_container.pop(), methods)
        if waits:
            raise Unknown
        return None

    def _names(self, thing: Any) -> tuple[set[str], set[str]]:
        """The attributes that are a thing, and those that are containers of it."""
        everything = [*(pair for cls in type(self._instance).__mro__ for pair in vars(cls).items())]
        everything += vars(self._instance).items()
        is_it = {name for name, value in everything if is_inside(value, thing)}
        return is_it, {name for name, value in vars(self._instance).items() if _holds(value, thing)}

    def _class_with(self, name: str) -> str:
        """The module of the class that has an attribute which its objects share; empty for one of an object's own."""
        if name in vars(self._instance):
            return ""
        return next((cls.__module__ for cls in type(self._instance).__mro__ if name in vars(cls)), "")

    def _ended(self, name: str, thing: Any, methods: tuple[str, ...]) -> Setters | None:
        uses = list(self._uses(name))
        found = {use.method for use in uses if use.kind == "called" and use.name in methods}
        setters = self._reached(f"self.{name}", found)
        setters = setters and setters._replace(deed=DEEDS[methods])
        if methods != ("release",) or not any(use.kind == "entered" for use in uses):
            return setters
        handlers, parts = (setters.handlers, setters.parts) if setters else (frozenset[str](), frozenset[str]())
        if isinstance(thing, (asyncio.Semaphore, threading.Semaphore)):
            places = {_places(use.value) for use in uses if use.kind == "assigned"}
            if len(places) != 1:
                raise Unknown
            return Setters(f"self.{name}", handlers, thing, places.pop(), deed=DEEDS[methods], parts=parts)
        return Setters(f"self.{name}", handlers, thing, deed=DEEDS[methods], parts=parts)

    def _ended_in_container(self, name: str, methods: tuple[str, ...]) -> Setters | None:
        """Something in a list or dictionary may be ended by any method that ends such a thing."""
        if any(use.kind == "given" for use in self._source.uses(name)) or self._source.foreign(name, self.owner):
            raise Unknown
        if any(not use.method for ending in methods for use in self._source.foreign(ending, self.owner)):
            raise Unknown
        found: set[str] = set()
        for method, functions in self._source.methods.items():
            for syntax, parents in (pair for function in functions for pair in walk(function)):
                if isinstance(syntax, ast.Attribute) and syntax.attr in methods:
                    if is_nested(parents) or not (isinstance(parents[-1], ast.Call) and parents[-1].func is syntax):
                        raise Unknown
                    found.add(method)
        setters = self._reached(f"a part of self.{name}", found)
        return setters and setters._replace(deed=DEEDS[methods])

    def _uses(self, name: str) -> Iterator[Use]:
        """The uses of a tool, such as an event, none of which makes it known to other code."""
        if any(use.kind != "called" or use.name not in QUESTIONS for use in self._source.foreign(name, self.owner)):
            raise Unknown
        for use in self._source.uses(name):
            ends = use.name in ENDINGS or use.kind == "entered"
            if use.kind in ("given", "changed", "invoked") or (ends and (use.kind == "part" or use.is_nested)):
                raise Unknown
            if not is_new(use.value, _MAKERS):
                raise Unknown
            yield use

    # a loop that polls

    def of_loop(self) -> Setters | None:
        """What changes the attributes that a polling loop looks at, one that only waits and looks again."""
        place = next((place for place in reversed(self._places) if place.loops), None)
        if place is None:
            return None
        loop = place.loops[-1]
        endless = isinstance(loop, ast.AsyncFor) and ast.unparse(loop.iter).startswith("self.clock.every(")
        if not (isinstance(loop, ast.While) or endless):
            return None
        called = {use.attr for use in ast.walk(loop) if isinstance(use, ast.Attribute) and is_own(use)}
        below = {method for name in called & set(self._source.methods) for method in self._source.below(name)}
        if self._source.may_fail(loop, below):
            raise Unknown
        conditions = LoopConditions(loop, place.function.syntax, place.frame, self._source, self._instance)
        attributes = conditions.attributes()
        inside = set(ast.walk(loop))
        changing: set[str] = set()
        for name in attributes:
            for use in self._changes(name):
                if use.syntax in inside or use.method in below:  # the loop itself changes what it looks at
                    raise Unknown
                changing.add(use.method)
        for name in conditions.names:
            for use in changes(name, place.frame.f_globals["__name__"], self._source):
                if use.syntax in inside or use.method in below:
                    raise Unknown
                changing.add(use.method)
        for owner, names in conditions.held.items():
            changing |= self._changing_held(owner, names, loop, below)
            attributes |= {f"{owner}.{name}" for name in names}
        what = " and ".join([*(f"self.{name}" for name in sorted(attributes)), *sorted(conditions.names)])
        if conditions.tasks and not changing - beginnings_of(self._node):
            return Setters(what, frozenset(), tasks=tuple(conditions.tasks), pause=_pause(loop, place.frame))
        found = self._reached(what, changing)
        module = place.frame.f_globals["__name__"] if conditions.names else ""
        tasks, pause = tuple(conditions.tasks), _pause(loop, place.frame)
        return found and found._replace(tasks=tasks, module=module, pause=pause)

    def _changing_held(self, owner: str, names: set[str], loop: Loop, below: set[str]) -> set[str]:
        """The methods that change attributes of an object that is held, and that a loop polls.

        Args:
            names: The attributes of the object.
            below: The methods that the loop calls, and those that they call.
        """
        raise Unknown

    def _changes(self, name: str) -> Iterator[Use]:
        """The uses of an attribute that may change it."""
        value = getattr(self._instance, name)
        changes = next((methods for tool, methods in TOOLS.items() if isinstance(value, tool)), None)
        if changes is not None:
            for use in self._uses(name):
                is_begun = isinstance(value, asyncio.Task) and use.value is not None and makes_task(use.value)
                if (use.kind == "assigned" and not is_begun) or (use.kind == "called" and use.name in changes):
                    yield use
            return
        if isinstance(value, PendingGoal):
            yield from self._ends_of_goal(name)
            return
        known = isinstance(value, (*CONTAINERS, *arrays()))
        for use in self._source.foreign(name, self.owner):
            if self._is_of_message(use.syntax):
                continue
            if use.kind in ("assigned", "changed") or (known and use.kind not in ("read", "part")):
                raise Unknown
        for use in (*self._source.foreign(name, self.owner), *self._source.uses(name)):
            if isinstance(value, CONTAINERS) and use.kind == "part" and use.name:  # its `append`, for others to call
                raise Unknown
        for use in self._source.uses(name):
            if known and (use.kind in ("given", "invoked") or not is_new(use.value, CONTAINER_MAKERS)):
                raise Unknown
            if isinstance(value, (*arrays(), *messages())) and _has_second_name(use, value):
                raise Unknown
            if not self._changes_nothing(use, value):
                if use.is_nested:
                    raise Unknown
                yield use

    def _is_of_message(self, syntax: ast.expr) -> bool:
        """Whether something is a field of a message that is an attribute: `self.cmd.linear.x`."""
        while isinstance(syntax, (ast.Attribute, ast.Subscript)):
            if is_own(syntax):
                return isinstance(getattr(self._instance, syntax.attr, None), messages())  # type: ignore[union-attr]
            syntax = syntax.value
        return False

    def _ends_of_goal(self, name: str) -> Iterator[Use]:
        if self._source.foreign(name, self.owner):
            raise Unknown
        for use in self._source.uses(name):
            if use.kind == "given" or use.is_nested:
                raise Unknown
            is_begun = use.value is not None and makes_task(use.value)
            if (use.kind == "assigned" and not is_begun) or (use.kind == "called" and use.name == "cancel"):
                yield use

    def _changes_nothing(self, use: Use, value: Any) -> bool:
        if use.kind == "assigned":
            is_same = isinstance(use.value, ast.Constant) and type(use.value.value) is type(value)
            return is_same and use.value.value == value  # type: ignore[union-attr]
        if use.kind == "called":
            return isinstance(value, PLAIN) or use.name in LOOKING
        if use.kind == "given" and isinstance(value, messages()):  # its fields may be set through the other name
            functions = self._source.methods.get(use.method, [])
            return not any(_sets_fields(function) for function in functions)
        return use.kind != "changed"

    def _reached(self, what: str, methods: Iterable[str]) -> Setters | None:
        """The handlers and tasks that call those methods, if nothing else does."""
        return handlers_above(what, methods, self._node)


def _pause(loop: Loop, frame: Frame) -> Pause | None:
    """Where a loop pauses, if it does so in one line."""
    calls = [node for node in ast.walk(loop) if isinstance(node, ast.Call)]
    lines = {call.lineno for call in calls if ast.unparse(call.func).split(".")[-1] == "sleep"}
    return Pause(frame, lines.pop()) if len(lines) == 1 else None


def handlers_above(what: str, methods: Iterable[str], node: Subject) -> Setters | None:
    """The handlers and tasks of a node that call those methods, if nothing else does."""
    source, entries, over = source_of(node.instance), entries_of(node), beginnings_of(node)
    above = source.above(set(methods) - over, entries)
    if above & node.hooks:
        raise Unknown
    for method in above - entries - over:
        if source.above({method}, entries) == {method}:  # no caller is seen, so some other code calls it
            raise Unknown
    found = frozenset(above & entries)
    return Setters(what, found, parts=frozenset(above & source.gathered)) if found else None


def method_of(task: Any) -> str:
    """The name of the coroutine function that a task runs."""
    return str(getattr(task.get_coro(), "__name__", ""))


_PAUSING = {"sleep", "max", "min", "abs", "round", "float", "int"}
_PAUSING |= {"time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns"}
"""Calls that a function may make which only lets time pass."""


def only_pauses(frame: Frame) -> bool:
    """Whether a frame is of a function, as of a rate made by hand, that only lets time pass and counts it."""
    try:
        functions = syntax_of(frame.f_code.co_filename).functions
    except (OSError, SyntaxError, ValueError):
        return False
    code = frame.f_code
    found = [f for f in functions if (first_line(f), f.name) == (code.co_firstlineno, code.co_name)]
    return len(found) == 1 and all(map(_lets_time_pass, ast.walk(found[0])))


def _lets_time_pass(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=called):
            return _last(called) in _PAUSING
        case ast.Attribute(ctx=ast.Store()):
            return is_own(node)
        case ast.While():  # one that pauses polls, and is what waits
            return not any(isinstance(n, ast.Call) and _last(n.func) == "sleep" for n in ast.walk(node))
        case ast.Subscript(ctx=ast.Store()) | ast.Raise() | ast.Assert() | ast.Global() | ast.Nonlocal():
            return False
        case ast.Yield() | ast.YieldFrom() | ast.Delete() | ast.AsyncFor() | ast.AsyncWith():
            return False
    return True


def _last(called: ast.expr) -> str:
    return ast.unparse(called).rpartition(".")[2]


_LIBRARIES = ("graphflow.", "rclpy.", "asyncio.", "contextlib", "threading", "queue", "concurrent.")


def is_library(frame: Frame) -> bool:
    """Whether a frame is of code that sooner or later yields to the handler's, and does nothing else."""
    name = f"{frame.f_globals.get('__name__', '')}."
    return name.startswith(_LIBRARIES)


def _holds(container: Any, thing: Any) -> bool:
    if isinstance(container, dict):
        container = container.values()
    elif not isinstance(container, (list, set, deque, tuple)):
        return False
    return any(part is thing for part in list(container))


def _places(made: ast.expr | None) -> int:
    """How many a semaphore admits, read from where it is made."""
    match made:
        case ast.Call(args=[ast.Constant(value=int(places))], keywords=[]):
            return places
        case ast.Call(args=[], keywords=[]):
            return 1
    raise Unknown


def _has_second_name(use: Use, value: Any) -> bool:
    """Whether a part of an array or message, through which it can be changed, is passed on."""
    if use.kind == "called" and isinstance(value, arrays()):
        return use.name not in LOOKING | VIEWLESS
    if use.part is None:
        return False
    path: list[ast.expr] = []
    node: ast.expr = use.part
    while isinstance(node, (ast.Attribute, ast.Subscript)) and node is not use.syntax:
        path.append(node)
        node = node.value
    for step in reversed(path):
        if isinstance(step, ast.Attribute):
            value = getattr(value, step.attr, None)
        elif not isinstance(step, ast.Subscript) or isinstance(step.slice, (ast.Slice, ast.Tuple)) or not len(value):
            return True
        else:
            value = value[0]  # any part will do
    numpy = sys.modules.get("numpy")
    return not isinstance(value, (*PLAIN, tuple, *((numpy.generic, numpy.dtype) if numpy else ())))


def _sets_fields(function: FunctionNode) -> bool:
    """Whether a function sets a field of something other than the node."""
    return any(
        isinstance(n, (ast.Attribute, ast.Subscript)) and isinstance(n.ctx, (ast.Store, ast.Del)) and not is_own(n)
        for n in ast.walk(function)
    )

"""The wakers of a wait that asyncio cannot explain: an Event, Queue, Lock or Future of the node's, or a polled flag.

They are derived from the source of the node's class in two steps: the methods that set `self.arrived` or assign
`self.pose`, and the handlers and tasks that call them, directly or through each other. The result holds if nothing else
does the same, which is the closed-world assumption.

Whatever cannot be followed to the end makes the world open (`Unknown`), and nothing is reported: an object that is
passed on, a function inside a method, an attribute that is written from outside, a condition with anything in it but
attributes, constants and arithmetic.
"""

from __future__ import annotations

import ast
import asyncio
import threading
from collections import deque
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from graphflow.analysis.attribute_uses import Use, is_own
from graphflow.analysis.class_source import LAMBDA, Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.local_messages import CONTAINER_MAKERS, is_new, messages
from graphflow.analysis.syntax import is_nested, nodes_in, walk
from graphflow.analysis.user_code import Pause
from graphflow.deadlock.asyncio_frames import (
    ENDINGS,
    VERBS,
    AnyFuture,
    TaskLike,
    awaited_future,
    is_inside,
    object_wait,
)
from graphflow.deadlock.closed_world.conditions import LoopConditions, makes_task
from graphflow.deadlock.closed_world.loops import Loop, Spot, is_library, may_poll, only_pauses, pause_of
from graphflow.deadlock.closed_world.module_names import changes
from graphflow.deadlock.closed_world.values import (
    CONTAINERS,
    LOOKING,
    PLAIN,
    QUESTIONS,
    TOOLS,
    arrays,
    has_second_name,
    sets_fields,
)
from graphflow.deadlock.protocols import Subject
from graphflow.executor.ledger import PendingGoal
from graphflow.executor.runner import Runner

BEGINNINGS = {"__init__", "on_start", "on_shutdown"}
"""Methods that do not run while handlers do."""
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
"""Functions and classes whose results nothing else knows."""


class Setters(NamedTuple):
    """The events that can end a wait."""

    what: str
    """Object or condition of the wait, as the code writes it."""
    handlers: frozenset[str]
    """Methods that end it, and that run as handlers or tasks."""
    lock: object = None
    """Lock that ends it when an activity inside leaves; None for a wait of another kind."""
    places: int = 1
    """Number of activities that can be inside at a time."""
    tasks: tuple[AnyFuture, ...] = ()
    """Tasks and goals whose end may end the wait, too."""
    verb: str = "sets"
    """Verb for what the handlers do to the object."""
    gives_up: bool = False
    """Whether a deadline ends the wait for good, and not only this attempt."""
    module: str = ""
    """Module of the object, if it belongs to a module or a class rather than to the node."""
    pause: Pause | None = None
    """Line at which the loop pauses, if it is a polling loop."""
    parts: frozenset[str] = frozenset()
    """Methods that end it as parts of an `asyncio.gather` in one of the handlers."""

    def is_shared(self, node: Subject, nodes: Iterable[Subject]) -> bool:
        """Whether other nodes of the process may end the wait, too, since their code is in the object's module."""
        others = [cls for other in nodes if other is not node for cls in type(other.instance).__mro__]
        return any(cls.__module__ == self.module for cls in others)


def cancellers(thing: object, node: Subject) -> Setters | None:
    """Return the timers and tasks that cancel a task or goal in an attribute of the node; None if there are none.

    A handler that cancels on a message or a request does not count: it is an event from outside, and a deadlock that
    only such an event can end remains one.

    Raises:
        Unknown: Other code may cancel it.
    """
    instance = node.instance
    names = {name for name, value in vars(instance).items() if value is thing or _contains(value, thing)}
    if not names:
        return None
    source, methods, over = source_of(instance), set[str](), beginnings_of(node)
    for name in names:
        uses = source.uses(name)
        if getattr(instance, name) is not thing or source.foreign(name) or any(use.kind == "given" for use in uses):
            if any(use.method not in over for use in (*source.foreign("cancel"), *source.uses("cancel"))):
                raise Unknown
            continue
        methods |= {use.method for use in uses if use.kind == "called" and use.name == "cancel"}
    entries = entries_of(node)
    alone = {runner.spec.handler for runner in node.runners if runner.spec.kind == "timer"}
    alone |= {method_of(task) for task in node.tasks}
    what = " and ".join(f"self.{name}" for name in sorted(names))
    above = source.above(methods - over, entries)
    if above & source.gathered:
        raise Unknown
    found = frozenset(above & alone)
    return Setters(what, found) if found else None


def entries_of(node: Subject) -> set[str]:
    """Return the methods of a node that graphflow runs: handlers, tasks, and `on_start` with those that wait for it."""
    found = {handler_of(runner) for runner in node.runners} | {method_of(task) for task in node.tasks}
    return found | ({handler_in(part.title) for part in node.unopened} | {"on_start"} if node.starting else set())


def beginnings_of(node: Subject) -> set[str]:
    """Return the methods that cannot end a present wait: they have run, or run only at the end."""
    return BEGINNINGS - {"on_start"} if node.starting else BEGINNINGS


def handler_in(title: str) -> str:
    """Return the method in the title of a handler, or `LAMBDA`."""
    name = title.rpartition(" ")[2]
    return name if name.isidentifier() else LAMBDA


def handler_of(runner: Runner) -> str:
    """Return the method that a runner calls, as `tick`, or `rate.fire` for an object's in `self.rate`; or `LAMBDA`."""
    handler = runner.spec.handler
    return handler if all(name.isidentifier() for name in handler.split(".")) else LAMBDA


class Question:
    """The question which events can end one wait.

    Raises:
        Unknown: Foreign code lies between the node's method and the wait.
    """

    owner = ""
    """Attribute of the node with the object that waits; empty if the node itself does."""

    def __init__(self, frames: list[Frame], node: Subject, instance: object = None) -> None:
        self._node, self._instance = node, node.instance if instance is None else instance
        self._source = source_of(self._instance)
        self._waits = [wait for wait in map(object_wait, frames) if wait is not None]
        self.is_bounded = any(wait.is_bounded for wait in self._waits)
        self._places: list[Spot] = []
        for frame in frames:
            function = self._source.function(frame.f_code)
            if function is not None and frame.f_locals.get("self") is self._instance:
                self._places.append(Spot(frame, function))
            elif frame.f_locals.get("self") is self._instance and not is_library(frame):
                raise Unknown  # a method without source
            elif self._places and not (is_library(frame) or only_pauses(frame)):
                self._places.clear()  # foreign code in between may wait for anything
        if not self._places and instance is None:
            raise Unknown

    @property
    def is_repeated(self) -> bool:
        """Whether the code waits in a loop, for as long as some condition holds."""
        return any(isinstance(loop, (ast.While, ast.AsyncFor)) for place in self._places for loop in place.loops)

    # waits for an object

    def of_object(self, waiter: object) -> Setters | None:
        """Return the setters of a primitive in the node's attributes; None if the wait is for no primitive."""
        waits = self._waits[::-1]
        if not waits and (wait := awaited_future(waiter)) is not None:
            waits = [wait]
            if not any(self._names(waiter)):
                return None
        # From the inside out: primitives are built on others, such as a queue's event, that the node does not know.
        for thing, methods, _ in waits:
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

    def _names(self, thing: object) -> tuple[set[str], set[str]]:
        """Return the attributes that are an object, and those that are containers of it."""
        everything = [*(pair for cls in type(self._instance).__mro__ for pair in vars(cls).items())]
        everything += vars(self._instance).items()
        is_it = {name for name, value in everything if is_inside(value, thing)}
        return is_it, {name for name, value in vars(self._instance).items() if _contains(value, thing)}

    def _class_with(self, name: str) -> str:
        """Return the module of the class that has an attribute; empty if the instance itself has it."""
        if name in vars(self._instance):
            return ""
        return next((cls.__module__ for cls in type(self._instance).__mro__ if name in vars(cls)), "")

    def _ended(self, name: str, thing: object, methods: tuple[str, ...]) -> Setters | None:
        """Return the setters of a primitive in an attribute.

        Args:
            methods: The primitive's methods that end the wait.
        """
        uses = list(self._uses(name))
        found = {use.method for use in uses if use.kind == "called" and use.name in methods}
        setters = self._reached(f"self.{name}", found)
        setters = setters and setters._replace(verb=VERBS[methods])
        if methods != ("release",) or not any(use.kind == "entered" for use in uses):
            return setters
        handlers, parts = (setters.handlers, setters.parts) if setters else (frozenset[str](), frozenset[str]())
        if isinstance(thing, (asyncio.Semaphore, threading.Semaphore)):
            places = {_places(use.value) for use in uses if use.kind == "assigned"}
            if len(places) != 1:
                raise Unknown
            return Setters(f"self.{name}", handlers, thing, places.pop(), verb=VERBS[methods], parts=parts)
        return Setters(f"self.{name}", handlers, thing, verb=VERBS[methods], parts=parts)

    def _ended_in_container(self, name: str, methods: tuple[str, ...]) -> Setters | None:
        """Return the setters of a primitive in a list or dictionary: any call of a method that ends such a wait."""
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
        return setters and setters._replace(verb=VERBS[methods])

    def _uses(self, name: str) -> Iterator[Use]:
        """Yield the uses of an attribute with a primitive.

        Raises:
            Unknown: One of them lets other code reach it.
        """
        if any(use.kind != "called" or use.name not in QUESTIONS for use in self._source.foreign(name, self.owner)):
            raise Unknown
        for use in self._source.uses(name):
            ends = use.name in ENDINGS or use.kind == "entered"
            if use.kind in ("given", "changed", "invoked") or (ends and (use.kind == "part" or use.is_nested)):
                raise Unknown
            if not is_new(use.value, _MAKERS):
                raise Unknown
            yield use

    # polling loops

    def of_loop(self) -> Setters | None:
        """Return the setters of the attributes that a polling loop reads; None if the wait is in no such loop."""
        place = next((place for place in reversed(self._places) if place.loops), None)
        loop = None if place is None else place.loops[-1]
        if place is None or loop is None or not may_poll(loop):
            return None
        called = {use.attr for use in nodes_in(loop) if isinstance(use, ast.Attribute) and is_own(use)}
        below = {method for name in called & set(self._source.methods) for method in self._source.below(name)}
        if self._source.may_fail(loop, below):  # an exception would end the loop
            raise Unknown
        conditions = LoopConditions(loop, place.function.syntax, place.frame, self._source, self._instance)
        attributes, module = conditions.attributes(), str(place.frame.f_globals.get("__name__", ""))
        uses = [use for name in attributes for use in self._changes(name)]
        uses += [use for name in conditions.names for use in changes(name, module, self._source)]
        inside = set(nodes_in(loop))
        if any(use.syntax in inside or use.method in below for use in uses):  # the loop changes its own condition
            raise Unknown
        changing = {use.method for use in uses}
        for owner, names in conditions.owned.items():
            changing |= self._changing_owned(owner, names, loop, below)
            attributes |= {f"{owner}.{name}" for name in names}
        what = " and ".join([*(f"self.{name}" for name in sorted(attributes)), *sorted(conditions.names)])
        tasks, pause = tuple(conditions.tasks), pause_of(loop, place.frame)
        if tasks and not changing - beginnings_of(self._node):
            return Setters(what, frozenset(), tasks=tasks, pause=pause)
        found = self._reached(what, changing)
        return found and found._replace(tasks=tasks, module=module if conditions.names else "", pause=pause)

    def _changing_owned(self, owner: str, names: set[str], loop: Loop, below: set[str]) -> set[str]:
        """Return the methods that change attributes of an owned object which a loop polls.

        Args:
            names: The attributes of the object.
            below: The methods that the loop calls, and those that they call.
        """
        raise Unknown

    def _changes(self, name: str) -> Iterator[Use]:
        """Yield the uses of an attribute that may change its value.

        Raises:
            Unknown: Other code may do so.
        """
        value = getattr(self._instance, name)
        methods = next((methods for tool, methods in TOOLS.items() if isinstance(value, tool)), None)
        if methods is not None:
            for use in self._uses(name):
                is_begun = isinstance(value, asyncio.Task) and use.value is not None and makes_task(use.value)
                if (use.kind == "assigned" and not is_begun) or (use.kind == "called" and use.name in methods):
                    yield use
        elif isinstance(value, PendingGoal):
            yield from self._ends_of_goal(name)
        else:
            self._refuse_foreign_changes(name, value)
            yield from self._own_changes(name, value)

    def _refuse_foreign_changes(self, name: str, value: object) -> None:
        """Raise `Unknown` if code may change a value other than through `self`."""
        known = isinstance(value, (*CONTAINERS, *arrays()))
        for use in self._source.foreign(name, self.owner):
            if self._is_of_message(use.syntax):
                continue
            if use.kind in ("assigned", "changed") or (known and use.kind not in ("read", "part")):
                raise Unknown
        for use in (*self._source.foreign(name, self.owner), *self._source.uses(name)):
            if isinstance(value, CONTAINERS) and use.kind == "part" and use.name:  # its `append`, for others to call
                raise Unknown

    def _own_changes(self, name: str, value: object) -> Iterator[Use]:
        """Yield the uses of an attribute, through `self`, that may change a plain value, a container or an array."""
        known = isinstance(value, (*CONTAINERS, *arrays()))
        for use in self._source.uses(name):
            if known and (use.kind in ("given", "invoked") or not is_new(use.value, CONTAINER_MAKERS)):
                raise Unknown
            if isinstance(value, (*arrays(), *messages())) and has_second_name(use, value):
                raise Unknown
            if not self._changes_nothing(use, value):
                if use.is_nested:
                    raise Unknown
                yield use

    def _is_of_message(self, syntax: ast.expr) -> bool:
        """Whether an expression is a field of a message in an attribute: `self.cmd.linear.x`."""
        while isinstance(syntax, (ast.Attribute, ast.Subscript)):
            if isinstance(syntax, ast.Attribute) and is_own(syntax):
                return isinstance(getattr(self._instance, syntax.attr, None), messages())
            syntax = syntax.value
        return False

    def _ends_of_goal(self, name: str) -> Iterator[Use]:
        """Yield the uses of an attribute with a goal that cancel it, or put another value in its place."""
        if self._source.foreign(name, self.owner):
            raise Unknown
        for use in self._source.uses(name):
            if use.kind == "given" or use.is_nested:
                raise Unknown
            is_begun = use.value is not None and makes_task(use.value)
            if (use.kind == "assigned" and not is_begun) or (use.kind == "called" and use.name == "cancel"):
                yield use

    def _changes_nothing(self, use: Use, value: object) -> bool:
        """Whether a use leaves the present value as it is, by which a setter of the same value is none."""
        if use.kind == "assigned":
            if not isinstance(use.value, ast.Constant):
                return False
            return type(use.value.value) is type(value) and use.value.value == value
        if use.kind == "called":
            return isinstance(value, PLAIN) or use.name in LOOKING
        if use.kind == "given" and isinstance(value, messages()):  # fields may be set through the new name
            functions = self._source.methods.get(use.method, [])
            return not any(sets_fields(function) for function in functions)
        return use.kind != "changed"

    def _reached(self, what: str, methods: Iterable[str]) -> Setters | None:
        """Return the handlers and tasks that call some methods."""
        return handlers_above(what, methods, self._node)


def handlers_above(what: str, methods: Iterable[str], node: Subject) -> Setters | None:
    """Return the handlers and tasks of a node that call some methods; None if there are none.

    Raises:
        Unknown: Other code may call them.
    """
    source, entries, over = source_of(node.instance), entries_of(node), beginnings_of(node)
    above = source.above(set(methods) - over, entries)
    if above & node.hooks:
        raise Unknown
    for method in above - entries - over:
        if source.above({method}, entries) == {method}:  # no caller is seen, so some other code calls it
            raise Unknown
    found = frozenset(above & entries)
    return Setters(what, found, parts=frozenset(above & source.gathered)) if found else None


def method_of(task: TaskLike) -> str:
    """Return the name of the coroutine function that a task runs."""
    return str(getattr(task.get_coro(), "__name__", ""))


def _contains(container: object, thing: object) -> bool:
    if isinstance(container, dict):
        return any(part is thing for part in list(container.values()))
    return isinstance(container, (list, set, deque, tuple)) and any(part is thing for part in list(container))


def _places(made: ast.expr | None) -> int:
    """Return the number of activities that a semaphore admits, from the call that creates it."""
    match made:
        case ast.Call(args=[ast.Constant(value=int(places))], keywords=[]):
            return places
        case ast.Call(args=[], keywords=[]):
            return 1
    raise Unknown

"""Who can end a wait that asyncio knows nothing of: a plain Event, Queue or Future, or a flag that is polled.

The answer is read from the source of the node's class and its parents: which methods set `self.arrived`, assign
`self.pose`, and which handlers reach them. That holds as long as nothing else does it, which the source cannot prove:
hence *closed world*, and reports that say LIKELY. Whatever this cannot follow (a flag that escapes into another
variable, a condition that asks a clock, a parameter that can be set from outside) leaves the world open: no report.
"""

from __future__ import annotations

import ast
import asyncio
import inspect
from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from types import CodeType, FrameType
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef
_FUTURE = ("set_result", "set_exception", "cancel")
_WAITS: dict[CodeType, tuple[str, ...]] = {
    asyncio.Event.wait.__code__: ("set",),
    asyncio.Queue.get.__code__: ("put", "put_nowait"),
    asyncio.Queue.put.__code__: ("get", "get_nowait"),
    asyncio.Queue.join.__code__: ("task_done",),
    asyncio.Condition.wait.__code__: ("notify", "notify_all"),
    asyncio.Semaphore.acquire.__code__: ("release",),
}
"""asyncio's waits, and the methods of the same object that end them."""
_HARMLESS = {"wait", "is_set", "clear", "get", "get_nowait", "empty", "full", "qsize", "done", "result", "wait_for"}
_BEGINNINGS = {"__init__", "on_start", "on_shutdown"}
_OF_TIME = ("time", "clock", "now", "monotonic", "perf_counter", "random", "randint", "uniform", "ok")


class Setters(NamedTuple):
    """Who ends a wait."""

    what: str
    handlers: frozenset[str]
    """Methods that are called by timers, messages, requests, goals, or run as tasks."""
    is_open: bool
    """Others may end it too."""


class _Open(Exception):
    """The source does not tell."""


def setters(frames: list[FrameType], node: Node) -> Setters | None:
    """Who can end the wait in which these frames are, the outermost first; None when it is no wait of that kind."""
    users = [f for f in frames if f.f_locals.get("self") is node]
    if not users:
        return None
    try:
        for frame in reversed(frames):
            if frame.f_code in _WAITS:
                return _of_object(frame.f_locals["self"], _WAITS[frame.f_code], node)
        inner = users[-1]
        waiting = _world(type(node)).function(inner.f_code)
        if waiting is None:
            return None
        held = _awaited_attribute(waiting, inner.f_lineno)
        if held is not None and isinstance(vars(node).get(held), asyncio.Future):
            return _of_object(vars(node)[held], _FUTURE, node)
        return _of_loop(waiting, inner.f_lineno, node)
    except _Open:
        return None
    except (OSError, SyntaxError, TypeError):  # there is no source
        return None


def _of_object(thing: Any, methods: tuple[str, ...], node: Node) -> Setters | None:
    """Who calls one of `methods` of an object that the node holds."""
    names = [name for name, value in vars(node).items() if value is thing]
    names += [name for cls in type(node).__mro__ for name, value in vars(cls).items() if value is thing]
    if len(set(names)) != 1:
        return None
    world = _world(type(node))
    found = world.callers_of(names[0], methods)
    return _reached(world, f"self.{names[0]}", found, node)


def _of_loop(waiting: FunctionNode, line: int, node: Node) -> Setters | None:
    """Who changes what a loop looks at, in which the handler only waits and looks again."""
    world = _world(type(node))
    loop = _loop_at(waiting, line)
    if loop is None:
        return None
    attributes = _Exits(loop, world, node).attributes()
    if not attributes:
        return None
    inside = set(ast.walk(loop))
    changing: set[str] = set()
    for attribute in attributes:
        for name, place in world.changes_of(attribute):
            if place in inside:
                raise _Open
            if name != waiting.name:
                changing.add(name)
    return _reached(world, " and ".join(f"self.{a}" for a in sorted(attributes)), changing, node)


def _reached(world: _World, what: str, methods: Iterable[str], node: Node) -> Setters | None:
    """The handlers and tasks from which those methods are called."""
    entries = {runner.handler for runner in node.runners} | {_method(task) for task in node.tasks}
    handlers: set[str] = set()
    is_open = False
    for method in set(methods) - _BEGINNINGS:
        reached = {entry for entry in entries if method in world.reach(entry)}
        handlers |= reached
        is_open = is_open or not reached
    return Setters(what, frozenset(handlers), is_open) if handlers or is_open else None


def _method(task: Any) -> str:
    return str(getattr(task.get_coro(), "__name__", ""))


@dataclass
class _World:
    """The methods of a class and its parents; a child's stand in place of its parents'."""

    methods: dict[str, FunctionNode] = field(default_factory=dict)
    modules: list[ast.Module] = field(default_factory=list)
    by_place: dict[tuple[str, int], FunctionNode] = field(default_factory=dict)
    _reach: dict[str, frozenset[str]] = field(default_factory=dict)

    def function(self, code: CodeType) -> FunctionNode | None:
        """The source of a method by its code."""
        return self.by_place.get((code.co_filename, code.co_firstlineno))

    def reach(self, method: str) -> frozenset[str]:
        """The methods that a method calls, itself included."""
        if method not in self._reach:
            seen: set[str] = set()
            todo = [method]
            while todo:
                here = todo.pop()
                if here in self.methods and here not in seen:
                    seen.add(here)
                    todo += [
                        n.attr for n in ast.walk(self.methods[here]) if isinstance(n, ast.Attribute) and _is_own(n)
                    ]
            self._reach[method] = frozenset(seen)
        return self._reach[method]

    def callers_of(self, attribute: str, wanted: tuple[str, ...]) -> set[str]:
        """Methods that call `self.attribute.method()` for one of `wanted`.

        Raises:
            _Open: The attribute is used in a way that may hide such a call.
        """
        found: set[str] = set()
        for name, node, parents in self._uses(attribute):
            above = parents[-1]
            if isinstance(above, ast.Attribute) and above.attr in wanted:
                found.add(name)
            elif not (
                (isinstance(above, ast.Attribute) and above.attr in _HARMLESS)
                or isinstance(node.ctx, (ast.Store, ast.Del))
                or isinstance(above, (ast.Await, ast.Compare, ast.BoolOp, ast.UnaryOp, ast.If, ast.While))
            ):
                raise _Open
        return found

    def changes_of(self, attribute: str) -> list[tuple[str, ast.AST]]:
        """Methods that assign `self.attribute` or call a method of what it holds, and where."""
        found: list[tuple[str, ast.AST]] = []
        for name, node, parents in self._uses(attribute):
            called = isinstance(parents[-1], ast.Attribute) and isinstance(parents[-2], ast.Call)
            stored_inside = isinstance(parents[-1], (ast.Attribute, ast.Subscript)) and isinstance(
                parents[-1].ctx, (ast.Store, ast.Del)
            )
            if isinstance(node.ctx, (ast.Store, ast.Del)) or called or stored_inside:
                found.append((name, node))
        return found

    def _uses(self, attribute: str) -> Iterator[tuple[str, ast.Attribute, list[ast.AST]]]:
        """Every `.attribute`, with the method that it is in and what is around it.

        Raises:
            _Open: It is written to outside of the class, or by a name that is made at run time.
        """
        inside: set[ast.AST] = set()
        for name, function in self.methods.items():
            for node, parents in _walk(function):
                inside.add(node)
                if isinstance(node, ast.Attribute) and node.attr == attribute:
                    yield name, node, parents
                if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "setattr":
                    raise _Open
        for module in self.modules:
            for node in ast.walk(module):
                if node in inside or not isinstance(node, ast.Attribute) or node.attr != attribute:
                    continue
                if not _is_own(node):
                    raise _Open


def _walk(top: ast.AST) -> Iterator[tuple[ast.AST, list[ast.AST]]]:
    todo: list[tuple[ast.AST, list[ast.AST]]] = [(top, [top, top])]
    while todo:
        node, parents = todo.pop()
        yield node, parents
        todo += [(child, [*parents, node]) for child in ast.iter_child_nodes(node)]


def _is_own(node: ast.AST) -> bool:
    """Whether it is `self.something`."""
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"


def _world(cls: type) -> _World:
    return _world_of(cls)


@cache
def _world_of(cls: Hashable) -> _World:
    assert isinstance(cls, type)
    world = _World()
    for parent in reversed(cls.__mro__):
        if parent.__module__.partition(".")[0] in ("graphflow", "builtins", "typing", "abc"):
            continue
        file = inspect.getsourcefile(parent)
        module = _module(file or "")
        if module not in world.modules:
            world.modules.append(module)
        for definition in ast.walk(module):
            if isinstance(definition, ast.ClassDef) and definition.name == parent.__name__:
                for item in definition.body:
                    if isinstance(item, FunctionNode) and _is_of(parent, item):
                        world.methods[item.name] = item
                        first = item.decorator_list[0].lineno if item.decorator_list else item.lineno
                        world.by_place[file or "", first] = item
    return world


def _is_of(cls: type, item: FunctionNode) -> bool:
    """Whether it is this class's method, and not that of another class of the same name."""
    code = getattr(inspect.unwrap(vars(cls).get(item.name, item)), "__code__", None)
    if isinstance(vars(cls).get(item.name), property):
        code = vars(cls)[item.name].fget.__code__
    first = item.decorator_list[0].lineno if item.decorator_list else item.lineno
    return code is not None and code.co_firstlineno == first


@cache
def _module(file: str) -> ast.Module:
    with open(file, encoding="utf-8") as source:
        return ast.parse(source.read())


def _awaited_attribute(function: FunctionNode, line: int) -> str | None:
    """`arrived` where the line awaits `self.arrived`."""
    for node in ast.walk(function):
        if isinstance(node, ast.Await) and node.lineno <= line <= (node.end_lineno or line) and _is_own(node.value):
            assert isinstance(node.value, ast.Attribute)
            return node.value.attr
    return None


def _loop_at(function: FunctionNode, line: int) -> ast.While | ast.AsyncFor | None:
    """The innermost loop around a line."""
    found: ast.While | ast.AsyncFor | None = None
    for node in ast.walk(function):
        if isinstance(node, (ast.While, ast.AsyncFor)) and node.lineno <= line <= (node.end_lineno or line):
            found = node
    return found


class _Exits:
    """On what attributes of the node it depends whether a loop ends."""

    def __init__(self, loop: ast.While | ast.AsyncFor, world: _World, node: Node) -> None:
        self._loop, self._world, self._node = loop, world, node
        self._locals: dict[str, list[ast.expr]] = {}
        for inner in ast.walk(loop):
            if isinstance(inner, ast.Assign):
                for target in inner.targets:
                    if isinstance(target, ast.Name):
                        self._locals.setdefault(target.id, []).append(inner.value)
            elif isinstance(inner, ast.AugAssign) and isinstance(inner.target, ast.Name):
                self._locals.setdefault(inner.target.id, []).append(ast.Call(inner.target, [], []))

    def attributes(self) -> set[str]:
        """Raises `_Open` when it depends on something else."""
        tests = []
        if isinstance(self._loop, ast.While) and not isinstance(self._loop.test, ast.Constant):
            tests.append(self._loop.test)
        for node, parents in _walk(self._loop):
            if isinstance(node, (ast.Break, ast.Return, ast.Raise)):
                guards = [p.test for p in parents if isinstance(p, ast.If)]
                if not guards:
                    raise _Open
                tests += guards
        found: set[str] = set()
        for test in tests:
            self._read(test, found, set())
        return found

    def _read(self, expression: ast.AST, found: set[str], seen: set[str]) -> None:
        for node in ast.walk(expression):
            if _is_own(node):
                assert isinstance(node, ast.Attribute)
                self._attribute(node.attr, found, seen)
            elif isinstance(node, (ast.Await, ast.Lambda, ast.Yield)):
                raise _Open
            elif isinstance(node, ast.Name) and node.id in self._locals and node.id not in seen:
                for value in self._locals[node.id]:
                    self._read(value, found, seen | {node.id})
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in self._locals:
                raise _Open  # counts by itself
            elif isinstance(node, (ast.Name, ast.Attribute)):
                word = node.id if isinstance(node, ast.Name) else node.attr
                if word in _OF_TIME:
                    raise _Open

    def _attribute(self, name: str, found: set[str], seen: set[str]) -> None:
        declared = next((vars(c)[name] for c in type(self._node).__mro__ if name in vars(c)), None)
        if name in self._world.methods and (isinstance(declared, property) or inspect.isfunction(declared)):
            if name not in seen:
                self._read(ast.Module(self._world.methods[name].body, []), found, seen | {name})
        elif hasattr(declared, "__set__") or name in ("clock", "is_running", "context"):
            raise _Open
        else:
            found.add(name)

"""Which attributes of a node decide whether a polling loop ends, one that only waits and looks again.

A condition may be made of attributes, constants, local names that stay what they are, tasks and goals that only the
function knows, arithmetic, functions of `math` and `numpy`, and methods of the node that only look and compute. When
anything else changes is not known: `Unknown`.
"""

from __future__ import annotations

import ast
import asyncio
import builtins
import concurrent.futures
import queue
import sys
import threading
from collections import deque
from collections.abc import Mapping, Sequence
from enum import Enum
from types import MappingProxyType, ModuleType, NoneType
from typing import Any, NamedTuple

from graphflow.analysis.attribute_uses import looks
from graphflow.analysis.class_source import ClassSource, Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.local_messages import messages
from graphflow.analysis.syntax import FunctionNode, walk
from graphflow.analysis.user_code import is_users_module, is_users_object
from graphflow.deadlock.asyncio_frames import FUTURE
from graphflow.executor.ledger import PendingGoal

Loop = ast.While | ast.For | ast.AsyncFor
_QUEUE = ("put", "put_nowait", "get", "get_nowait")
TOOLS: dict[type, tuple[str, ...]] = {
    asyncio.Event: ("set", "clear"),
    asyncio.Queue: _QUEUE,
    asyncio.Future: FUTURE,
    threading.Event: ("set", "clear"),
    queue.Queue: _QUEUE,
    concurrent.futures.Future: FUTURE,
}
"""What a loop may query, and the methods that change the answer."""
QUESTIONS = {"is_set", "empty", "full", "qsize", "done", "cancelled"}
PLAIN = (bool, int, float, str, bytes, NoneType, Enum)
"""What changes neither by itself nor through another name."""
CONTAINERS = (list, dict, set, deque)
LOOKING = {"get", "keys", "values", "items", "index", "count", "copy", "startswith", "endswith", "lower", "upper"}
LOOKING |= {"issubset", "issuperset", "isdisjoint", "all", "any", "sum", "min", "max", "mean"}
"""Methods that do not change what they are called on."""
VIEWLESS = {"astype", "tolist", "item", "tobytes", "argmax", "argmin", "std", "nonzero", "round", "cumsum", "dot"}
VIEWLESS |= {"fill", "sort", "put", "partition"}
"""Methods of arrays that return no other view of them."""
_PURE = {"abs", "all", "any", "bool", "dict", "float", "frozenset", "int", "len", "list", "max", "min", "round", "set"}
_PURE |= {"sorted", "str", "sum", "tuple"}
_TASK_MAKERS = ("create_task", "ensure_future")
_MODULES = ("math", "numpy", "numpy.linalg")
"""Modules whose functions look at their arguments and at nothing else."""


class _Scope(NamedTuple):
    """What the names of a function mean."""

    locals: Mapping[str, list[ast.expr | None]]
    """What may be bound to each; None for what cannot be read."""
    constants: frozenset[str]
    """Names that stay what they are while the loop runs."""
    globals: Mapping[str, Any]
    rebound: set[str]
    """Global names that do not stay what they are."""
    tasks: Mapping[str, Sequence[asyncio.Future[Any]]] = MappingProxyType({})
    """Names that stand for, or are lists of, tasks or goals that no other code knows."""

    def is_constant(self, node: ast.AST) -> bool:
        """Whether an expression is a name, or part of something, whose value does not change while the loop runs."""
        path: list[str] = []
        while isinstance(node, ast.Attribute):
            path.append(node.attr)
            node = node.value
        if not isinstance(node, ast.Name):
            return False
        if node.id in self.constants:
            return True
        if node.id in self.locals or node.id in self.rebound or node.id not in self.globals:
            return False
        value = self.globals[node.id]
        if path and not isinstance(value, (ModuleType, type, Enum)):
            return False
        for name in reversed(path):
            value = getattr(value, name, self)
        return value is not self and _is_plain(value)

    def is_of_module(self, name: str) -> bool:
        """Whether a name is one of the module's, for something whose changes can be seen."""
        if name in self.locals or name in self.constants or name not in self.globals:
            return False
        value = self.globals[name]
        return _holds_plain(value) or (name in self.rebound and _is_plain(value))

    def is_mathematics(self, function: ast.expr) -> bool:
        """Whether an expression is a function that looks at its arguments and at nothing else."""
        name, *path = ast.unparse(function).split(".")
        if name in self.locals:
            return False
        value = self.globals.get(name, getattr(builtins, name, None))
        for part in path:
            value = getattr(value, part, None)
        if name in _PURE and not path:
            return value is getattr(builtins, name)
        module = getattr(value, "__module__", None) or type(value).__module__
        return callable(value) and module in _MODULES

    def asks_for_the_end(self, function: ast.expr) -> bool:
        """Whether an expression is `rclpy.ok`: the end of the program ends any wait."""
        name, *path = ast.unparse(function).split(".")
        value = None if name in self.locals else self.globals.get(name)
        for part in path:
            value = getattr(value, part, None)
        return f"{getattr(value, '__module__', '')}.{getattr(value, '__name__', '')}" in (
            "rclpy.ok",
            "rclpy.utilities.ok",
        )


_NOTHING = _Scope({}, frozenset(), {}, set())
"""A place that knows no names."""


class Conditions:
    """Which attributes of an object decide what expressions in its methods come to."""

    def __init__(self, source: ClassSource, instance: object) -> None:
        self._source, self._instance = source, instance
        self._found: set[str] = set()
        self.names: set[str] = set()
        """Names of the module that decide it, too, by values that can change."""
        self.tasks: list[asyncio.Future[Any]] = []
        """Things that decide it and that end by themselves."""

    def _read(self, node: ast.AST, scope: _Scope, seen: frozenset[str] = frozenset()) -> None:
        """Note the attributes that an expression is made of; `seen` are the names and methods that are being read."""
        if scope.is_constant(node):
            return
        if isinstance(node, ast.Attribute) and (held := self._of_held(node)) is not None:
            conditions, part = held
            conditions._read(part, _NOTHING)
            return
        match node:
            case ast.Constant():
                return
            case ast.Compare(left=left, comparators=[ast.Constant(value=None)]) if self._is_goal(left):
                return
            case (
                ast.BoolOp() | ast.UnaryOp() | ast.BinOp() | ast.Compare() | ast.IfExp() | ast.Tuple() | ast.List()
                | ast.Set() | ast.Dict() | ast.JoinedStr() | ast.FormattedValue() | ast.Subscript() | ast.Slice()
                | ast.Starred()
            ):  # fmt: skip
                for child in ast.iter_child_nodes(node):
                    if isinstance(child, ast.expr):
                        self._read(child, scope, seen)
            case ast.NamedExpr(value=value):
                self._read(value, scope, seen)
            case ast.GeneratorExp(elt=element, generators=loops) | ast.ListComp(elt=element, generators=loops):
                self._comprehension(element, loops, scope, seen)
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                self._attribute(name, seen)
            case ast.Attribute(value=ast.Name(id=name), attr="done") if scope.tasks.get(name):
                self.tasks += scope.tasks[name]
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="self"), attr=name), attr="done") if isinstance(
                goal := getattr(self._instance, name, None), PendingGoal
            ):
                self._found.add(name)
                self.tasks.append(goal.ended)
            case ast.Attribute(value=ast.Name(), attr="request" | "is_cancel_requested"):
                return  # a goal's: cancelling it ends any wait
            case ast.Attribute(value=value):
                self._read(value, scope, seen)
            case ast.Call(func=function, args=arguments, keywords=[]):
                for argument in arguments:
                    self._read(argument, scope, seen)
                self._call(function, scope, seen)
            case ast.Name(id=name) if scope.locals.get(name) is not None and name not in seen:
                for bound in scope.locals[name]:
                    if bound is None:
                        raise Unknown
                    self._read(bound, scope, seen | {name})
            case ast.Name(id=name) if scope.is_of_module(name):
                self.names.add(name)
            case _:
                raise Unknown

    def _is_goal(self, node: ast.expr) -> bool:
        """Whether an expression is a goal that is kept, which is noted then; what becomes of it is not asked."""
        if isinstance(node, ast.Attribute) and (held := self._of_held(node)) is not None:
            return held[0]._is_goal(held[1])
        name = node.attr if isinstance(node, ast.Attribute) and _path(node) == [node.attr] else ""
        is_goal = isinstance(getattr(self._instance, name, None), PendingGoal)
        self._found |= {name} if is_goal else set()
        return is_goal

    def _comprehension(
        self, element: ast.expr, loops: list[ast.comprehension], scope: _Scope, seen: frozenset[str]
    ) -> None:
        for loop in loops:
            bound = {node.id for node in ast.walk(loop.target) if isinstance(node, ast.Name)}
            match loop:
                case ast.comprehension(target=ast.Name(id=each), iter=ast.Name(id=name)) if scope.tasks.get(name):
                    scope = scope._replace(tasks={**scope.tasks, each: scope.tasks[name]})
                    continue
            self._read(loop.iter, scope, seen)
            scope = scope._replace(constants=scope.constants | bound)
            for test in loop.ifs:
                self._read(test, scope, seen)
        self._read(element, scope, seen)

    def _call(self, function: ast.expr, scope: _Scope, seen: frozenset[str]) -> None:
        """What the result of a call depends on besides its arguments."""
        if isinstance(function, ast.Attribute) and (held := self._of_held(function)) is not None:
            conditions, part = held
            conditions._call(part, _NOTHING, frozenset())
            return
        match function:
            case ast.Attribute(value=ast.Name(id="self"), attr=name) if name in self._source.methods:
                self._returned(name, seen)
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="self"), attr=name), attr=asked) if (
                asked in QUESTIONS and isinstance(getattr(self._instance, name, None), tuple(TOOLS))
            ):
                self._found.add(name)
                if isinstance(task := getattr(self._instance, name), asyncio.Task):
                    self.tasks.append(task)
            case ast.Attribute(value=ast.Name(id=name), attr=asked) if asked in QUESTIONS and scope.tasks.get(name):
                self.tasks += scope.tasks[name]
            case ast.Attribute(value=value, attr=name) if name in LOOKING and not scope.is_mathematics(function):
                self._read(value, scope, seen)
            case _:
                if not (scope.is_mathematics(function) or scope.asks_for_the_end(function)):
                    raise Unknown

    def _attribute(self, name: str, seen: frozenset[str]) -> None:
        owner = next((c for c in type(self._instance).__mro__ if name in vars(c)), None)
        declared = None if owner is None else vars(owner)[name]
        if name == "is_running" and owner is not None and not is_users_module(owner.__module__):
            return  # the end of the node ends any wait
        if isinstance(declared, property):
            self._returned(name, seen)
            return
        value = getattr(self._instance, name, self)
        if hasattr(declared, "__get__") or not (_is_plain(value) or _holds_plain(value)):
            raise Unknown
        self._found.add(name)

    def _of_held(self, node: ast.Attribute) -> tuple[Conditions, ast.expr] | None:
        """The conditions of an object that this one holds, and the expression as its methods would have it."""
        return None

    def _returned(self, name: str, seen: frozenset[str]) -> None:
        """What a method or property returns, if it only looks and computes; its arguments have been read."""
        functions = self._source.methods.get(name, [])
        if len(functions) != 1 or name in seen or isinstance(functions[0], ast.AsyncFunctionDef):
            raise Unknown
        [function] = functions
        arguments = frozenset(a.arg for a in [*function.args.args, *function.args.kwonlyargs]) - {"self"}
        bound = {name: [value for _, value in pairs] for name, pairs in _bindings(function).items()}
        if arguments & set(bound):
            raise Unknown
        scope = _Scope(bound, arguments, _globals_of(type(self._instance), name), self._source.rebound)
        todo: list[ast.stmt] = list(function.body)
        while todo:
            match todo.pop():
                case ast.Return(value=ast.expr() as value):
                    self._read(value, scope, seen | {name})
                case ast.If(test=test, body=body, orelse=orelse):
                    self._read(test, scope, seen | {name})
                    todo += [*body, *orelse]
                case ast.Assign(targets=targets) if all(isinstance(t, (ast.Name, ast.Tuple)) for t in targets):
                    pass  # it is read where it is used
                case ast.AnnAssign(target=ast.Name()) | ast.Expr(value=ast.Constant()) | ast.Pass():
                    pass
                case _:
                    raise Unknown


class LoopConditions(Conditions):
    """Which attributes of the node decide whether a loop ends."""

    def __init__(self, loop: Loop, function: FunctionNode, frame: Frame, source: ClassSource, node: object) -> None:
        super().__init__(source, node)
        self._loop = loop
        self._held: dict[str, Conditions] = {}
        inside = set(ast.walk(loop))
        code, values = frame.f_code, frame.f_locals
        bound = _bindings(function)
        given = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        own = [name for name in code.co_varnames if name not in code.co_cellvars]  # that no function inside can bind
        condition = set(ast.walk(loop.test)) if isinstance(loop, ast.While) else set()
        changing = {
            name
            for name in own
            if isinstance(value := values.get(name, []), (*CONTAINERS, *arrays(), *messages()))
            if not _is_only_read(name, value, function, condition)
        }
        constants = {
            name
            for name in own
            if not any(target in inside for target, _ in bound.get(name, ())) and _is_plain(values.get(name, self))
            if name not in changing
        }
        # Names of the functions around it may be bound by any of them,
        # and what is given to the function, by whoever has given it.
        locals_: dict[str, list[ast.expr | None]] = {name: [None] for name in values}
        readable = set(own) & set(bound) - set(given) - changing
        locals_ |= {name: [value for _, value in bound[name]] for name in readable}
        locals_ |= {name: [None] for name in changing}
        tasks = {
            name: _futures(values.get(name))
            for name in own
            if name in bound and _is_kept(name, function, inside)
            if not any(target in inside for target, _ in bound[name])
            if isinstance(values.get(name), PendingGoal)
            or all(value is not None and makes_task(value) for _, value in bound[name])
        }
        self._scope = _Scope(locals_, frozenset(constants), frame.f_globals, source.rebound, tasks)

    def attributes(self) -> set[str]:
        """The attributes that decide it. Raises `Unknown` when something else does."""
        if isinstance(self._loop, ast.While):
            self._read(self._loop.test, self._scope)
        nodes = list(walk(self._loop))
        turns = [
            parent.test
            for node, parents in nodes
            if isinstance(node, ast.Continue) and not _is_of_inner_loop(parents)
            for parent in parents
            if isinstance(parent, ast.If)
        ]
        for node, parents in nodes:
            if isinstance(node, ast.Assert):
                self._read(node.test, self._scope)
            if isinstance(node, (ast.Break, ast.Return, ast.Raise)):
                if isinstance(node, ast.Break) and _is_of_inner_loop(parents):
                    continue
                guards = [p.test for p in parents if isinstance(p, ast.If)] or turns
                odd = (ast.Match, ast.ExceptHandler, ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
                if not guards or any(isinstance(p, odd) for p in parents):
                    raise Unknown
                for guard in guards:
                    self._read(guard, self._scope)
        return self._found

    @property
    def held(self) -> dict[str, set[str]]:
        """By the attributes that hold them, the objects that decide it, too, and their attributes that do."""
        return {owner: conditions._found for owner, conditions in self._held.items()}

    def _of_held(self, node: ast.Attribute) -> tuple[Conditions, ast.expr] | None:
        owner, *path = _path(node) or [""]
        held = getattr(self._instance, "__dict__", {}).get(owner)
        if not path or _is_plain(held) or _holds_plain(held) or isinstance(held, (PendingGoal, *TOOLS)):
            return None
        if not is_users_object(held):
            return None
        conditions = self._held.setdefault(owner, Conditions(source_of(held), held))
        conditions.tasks = self.tasks
        return conditions, ast.parse(".".join(["self", *path]), mode="eval").body


def _path(node: ast.expr) -> list[str]:
    """The attributes by which an expression leads on from `self`; none where it is anything else."""
    path: list[str] = []
    while isinstance(node, ast.Attribute):
        path.append(node.attr)
        node = node.value
    return path[::-1] if isinstance(node, ast.Name) and node.id == "self" else []


def _globals_of(cls: type, name: str) -> dict[str, Any]:
    held = next((vars(c)[name] for c in cls.__mro__ if name in vars(c)), None)
    found: dict[str, Any] = getattr(held.fget if isinstance(held, property) else held, "__globals__", {})
    return found


def _bindings(function: FunctionNode) -> dict[str, list[tuple[ast.AST, ast.expr | None]]]:
    """What a function binds to its local names, and where; None for what is not an expression of its own."""
    found: dict[str, list[tuple[ast.AST, ast.expr | None]]] = {}

    def bind(target: ast.AST, value: ast.expr | None) -> None:
        if isinstance(target, ast.Name):
            found.setdefault(target.id, []).append((target, value))
        elif isinstance(target, (ast.Tuple, ast.List)):
            values = value.elts if isinstance(value, ast.Tuple) and len(value.elts) == len(target.elts) else None
            for i, part in enumerate(target.elts):
                bind(part, None if values is None else values[i])
        elif isinstance(target, ast.Starred):
            bind(target.value, None)

    for node in ast.walk(function):
        match node:
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    bind(target, value)
            case ast.AnnAssign(target=target, value=value):
                bind(target, value)
            case ast.NamedExpr(target=target, value=value):
                bind(target, value)
            case ast.AugAssign(target=target) | ast.For(target=target) | ast.AsyncFor(target=target):
                bind(target, None)
            case ast.withitem(optional_vars=ast.expr() as target):
                bind(target, None)
            case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                found.setdefault(name, []).append((node, None))
    return found


def makes_task(value: ast.expr) -> bool:
    """Whether an expression makes a task, or several, or a goal."""
    match value:
        case ast.Await(value=ast.Call(func=ast.Attribute(attr="send_goal"))):
            return True
        case ast.Call(func=function):
            return ast.unparse(function).split(".")[-1] in _TASK_MAKERS
        case ast.ListComp(elt=element):
            return makes_task(element)
        case ast.List(elts=parts) | ast.Tuple(elts=parts):
            return all(map(makes_task, parts))
    return False


def _futures(value: Any) -> list[asyncio.Future[Any]]:
    if isinstance(value, PendingGoal):
        return [value.ended]
    parts = list(value) if isinstance(value, (list, tuple)) else [value]
    return parts if all(asyncio.isfuture(part) for part in parts) else []


def _is_kept(name: str, function: FunctionNode, loop: set[ast.AST]) -> bool:
    """Whether no other code learns what a local name stands for, and the loop only queries it."""
    for node, parents in walk(function):
        if isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Load):
            match parents[-1]:
                case ast.Attribute(attr=asked) if asked in QUESTIONS or node not in loop:
                    pass
                case ast.comprehension():
                    pass
                case _ if not looks(node, parents):
                    return False
    return True


def _is_only_read(name: str, value: Any, function: FunctionNode, condition: set[ast.AST]) -> bool:
    """Whether a function neither changes what a local name stands for, nor makes it known to somebody who could.

    Args:
        condition: What is read anyway, with all that it calls.
    """
    for node, parents in walk(function):
        if not (isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Load)):
            continue
        whole: ast.AST = node
        around = list(parents)
        while isinstance(around[-1], (ast.Attribute, ast.Subscript)) and around[-1].value is whole:
            whole = around.pop()
        is_called = isinstance(around[-1], ast.Call) and around[-1].func is whole
        match whole:
            case ast.Attribute(ctx=ast.Load(), attr=asked) if is_called:
                is_read = asked in LOOKING
            case ast.Attribute(ctx=ast.Load()):  # a field, or a method that is handed on
                is_read = isinstance(value, messages()) or looks(whole, around)
            case ast.Subscript(ctx=ast.Load()):
                is_read = not is_called
            case _:
                is_read = whole is node and (node in condition or looks(node, parents))
        if not is_read:
            return False
    return True


def _is_of_inner_loop(parents: list[ast.AST]) -> bool:
    return any(isinstance(p, (ast.While, ast.For, ast.AsyncFor)) for p in parents[1:])


def arrays() -> tuple[type, ...]:
    """The classes of arrays, Python's and numpy's; not of modules that are not loaded, since none exist there."""
    known = (("array", "array"), ("numpy", "ndarray"))
    return tuple(getattr(sys.modules[module], name) for module, name in known if module in sys.modules)


def _is_plain(value: Any) -> bool:
    if isinstance(value, (tuple, frozenset)):
        return all(_is_plain(part) for part in value)
    return isinstance(value, (*PLAIN, *messages()))


def _holds_plain(container: Any) -> bool:
    if isinstance(container, arrays()):
        dtype = getattr(container, "dtype", None)
        return dtype is None or bool(dtype.kind != "O")  # of objects
    if not isinstance(container, CONTAINERS):
        return False
    return all(_is_plain(part) for part in list(container.values() if isinstance(container, dict) else container))

"""The values that names stand for, and whether the source shows all their changes.

A value is *plain* if it cannot change, or is a message, whose fields only its owner sets. Containers and arrays of
plain values change by operations that the source shows. Everything else may change behind the source's back.
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
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from types import MappingProxyType, ModuleType, NoneType
from typing import Any, NamedTuple

from graphflow.analysis.attribute_uses import Use, is_own
from graphflow.analysis.local_messages import messages
from graphflow.analysis.syntax import FunctionNode, nodes_in
from graphflow.deadlock.asyncio_frames import FUTURE, AnyFuture

_QUEUE = ("put", "put_nowait", "get", "get_nowait")
TOOLS: dict[type, tuple[str, ...]] = {
    asyncio.Event: ("set", "clear"),
    asyncio.Queue: _QUEUE,
    asyncio.Future: FUTURE,
    threading.Event: ("set", "clear"),
    queue.Queue: _QUEUE,
    concurrent.futures.Future: FUTURE,
}
"""Primitives that a loop may query, and the methods that change the answer."""
QUESTIONS = {"is_set", "empty", "full", "qsize", "done", "cancelled"}
"""Methods that query them."""
PLAIN = (bool, int, float, str, bytes, NoneType, Enum)
"""Types of immutable values, which change neither by themselves nor through another name."""
CONTAINERS = (list, dict, set, deque)
"""Types of containers whose changes are method calls or item assignments."""
LOOKING = {"get", "keys", "values", "items", "index", "count", "copy", "startswith", "endswith", "lower", "upper"}
LOOKING |= {"issubset", "issuperset", "isdisjoint", "all", "any", "sum", "min", "max", "mean"}
"""Methods that do not change their object."""
VIEWLESS = {"astype", "tolist", "item", "tobytes", "argmax", "argmin", "std", "nonzero", "round", "cumsum", "dot"}
VIEWLESS |= {"fill", "sort", "put", "partition"}
"""Methods of arrays that return no other view of their data."""
_PURE = {"abs", "all", "any", "bool", "dict", "float", "frozenset", "int", "len", "list", "max", "min", "round", "set"}
_PURE |= {"sorted", "str", "sum", "tuple"}
"""Built-in functions whose results depend on their arguments only."""
_MODULES = ("math", "numpy", "numpy.linalg")
"""Modules whose functions depend on their arguments only."""


class Scope(NamedTuple):
    """The meaning of the names in a function."""

    locals: Mapping[str, list[ast.expr | None]]
    """By local name: expressions that may be bound to it; None for a binding that cannot be read."""
    constants: frozenset[str]
    """Names that keep their value while the loop runs."""
    globals: Mapping[str, object]
    rebound: set[str]
    """Global names that some function rebinds."""
    tasks: Mapping[str, Sequence[AnyFuture]] = MappingProxyType({})
    """Names of tasks and goals, or of lists of them, that no other code knows."""

    def is_constant(self, node: ast.AST) -> bool:
        """Whether an expression is a name, or an attribute of one, that keeps its value while the loop runs."""
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
        return value is not self and is_plain(value)

    def is_of_module(self, name: str) -> bool:
        """Whether a name is a module-level one for a value whose changes the source shows."""
        if name in self.locals or name in self.constants or name not in self.globals:
            return False
        value = self.globals[name]
        return holds_plain(value) or (name in self.rebound and is_plain(value))

    def is_mathematics(self, function: ast.expr) -> bool:
        """Whether an expression names a function that depends on its arguments only."""
        name, *path = ast.unparse(function).split(".")
        if name in self.locals:
            return False
        value: object = self.globals.get(name, getattr(builtins, name, None))
        for part in path:
            value = getattr(value, part, None)
        if name in _PURE and not path:
            return value is getattr(builtins, name)
        module = getattr(value, "__module__", None) or type(value).__module__
        return callable(value) and module in _MODULES

    def asks_for_the_end(self, function: ast.expr) -> bool:
        """Whether an expression is `rclpy.ok`, which needs no setter: the end of the program ends any wait."""
        name, *path = ast.unparse(function).split(".")
        value: object = None if name in self.locals else self.globals.get(name)
        for part in path:
            value = getattr(value, part, None)
        return f"{getattr(value, '__module__', '')}.{getattr(value, '__name__', '')}" in (
            "rclpy.ok",
            "rclpy.utilities.ok",
        )


NO_NAMES = Scope({}, frozenset(), {}, set())
"""The scope of an expression without local or global names."""


def bindings(function: FunctionNode) -> dict[str, list[tuple[ast.AST, ast.expr | None]]]:
    """Return the bindings of a function's local names: the place of each, and the expression, if it has one."""
    found: dict[str, list[tuple[ast.AST, ast.expr | None]]] = {}
    for node in nodes_in(function):
        for name, place, value in _bindings_at(node):
            found.setdefault(name, []).append((place, value))
    return found


def _bindings_at(node: ast.AST) -> Iterator[tuple[str, ast.AST, ast.expr | None]]:
    match node:
        case ast.Assign(targets=targets, value=value):
            for target in targets:
                yield from _unpacked(target, value)
        case ast.AnnAssign(target=target, value=value) | ast.NamedExpr(target=target, value=value):
            yield from _unpacked(target, value)
        case ast.AugAssign(target=target) | ast.For(target=target) | ast.AsyncFor(target=target):
            yield from _unpacked(target, None)
        case ast.withitem(optional_vars=ast.expr() as target):
            yield from _unpacked(target, None)
        case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
            yield name, node, None


def _unpacked(target: ast.expr, value: ast.expr | None) -> Iterator[tuple[str, ast.AST, ast.expr | None]]:
    """Yield the bindings of one target, element by element where both sides are tuples."""
    match target:
        case ast.Name(id=name):
            yield name, target, value
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            values: list[ast.expr | None] = [None] * len(parts)
            if isinstance(value, ast.Tuple) and len(value.elts) == len(parts):
                values = [*value.elts]
            for part, each in zip(parts, values, strict=True):
                yield from _unpacked(part, each)
        case ast.Starred(value=inner):
            yield from _unpacked(inner, None)


def arrays() -> tuple[type, ...]:
    """Return the classes of arrays, Python's and numpy's; without importing either, since none exist before that."""
    known = (("array", "array"), ("numpy", "ndarray"))
    return tuple(getattr(sys.modules[module], name) for module, name in known if module in sys.modules)


def is_plain(value: object) -> bool:
    """Whether a value is immutable, or a message."""
    if isinstance(value, (tuple, frozenset)):
        return all(is_plain(part) for part in value)
    return isinstance(value, (*PLAIN, *messages()))


def holds_plain(container: object) -> bool:
    """Whether a container or array has only such values."""
    if isinstance(container, arrays()):
        dtype = getattr(container, "dtype", None)
        return dtype is None or bool(dtype.kind != "O")  # an array of objects
    if not isinstance(container, CONTAINERS):
        return False
    return all(is_plain(part) for part in list(container.values() if isinstance(container, dict) else container))


def has_second_name(use: Use, value: object) -> bool:
    """Whether a mutable part of an array or message is passed on, through which it can be changed."""
    if use.kind == "called" and isinstance(value, arrays()):
        return use.name not in LOOKING | VIEWLESS
    if use.part is None:
        return False
    part: Any = value
    path: list[ast.expr] = []
    node: ast.expr = use.part
    while isinstance(node, (ast.Attribute, ast.Subscript)) and node is not use.syntax:
        path.append(node)
        node = node.value
    for step in reversed(path):
        if isinstance(step, ast.Attribute):
            part = getattr(part, step.attr, None)
        elif not isinstance(step, ast.Subscript) or isinstance(step.slice, (ast.Slice, ast.Tuple)) or not len(part):
            return True
        else:
            part = part[0]  # the parts are of one type, so any will do
    numpy = sys.modules.get("numpy")
    return not isinstance(part, (*PLAIN, tuple, *((numpy.generic, numpy.dtype) if numpy else ())))


def sets_fields(function: FunctionNode) -> bool:
    """Whether a function sets a field of something other than the node."""
    return any(
        isinstance(n, (ast.Attribute, ast.Subscript)) and isinstance(n.ctx, (ast.Store, ast.Del)) and not is_own(n)
        for n in nodes_in(function)
    )

"""The attributes that decide whether a polling loop ends.

A polling loop only pauses and tests its condition again. The condition is evaluated abstractly: it may consist of
attributes, constants, local names that keep their value, tasks and goals that only the function knows, arithmetic,
functions of `math` and `numpy`, and methods of the node without side effects. Anything else may change in ways that the
source does not show: `Unknown`.
"""

from __future__ import annotations

import ast
import asyncio
from collections.abc import Mapping, Sequence

from graphflow.analysis.attribute_uses import looks
from graphflow.analysis.class_source import ClassSource, Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.local_messages import messages
from graphflow.analysis.syntax import FunctionNode, children_of, nodes_in, walk
from graphflow.analysis.user_code import is_users_module, is_users_object
from graphflow.deadlock.asyncio_frames import AnyFuture
from graphflow.deadlock.closed_world.loops import Loop
from graphflow.deadlock.closed_world.values import (
    CONTAINERS,
    LOOKING,
    NO_NAMES,
    QUESTIONS,
    TOOLS,
    Scope,
    arrays,
    bindings,
    holds_plain,
    is_plain,
)
from graphflow.executor.ledger import PendingGoal

_TASK_MAKERS = ("create_task", "ensure_future")
_COMPOUND = (
    *(ast.BoolOp, ast.UnaryOp, ast.BinOp, ast.Compare, ast.IfExp, ast.Tuple, ast.List, ast.Set, ast.Dict),
    *(ast.JoinedStr, ast.FormattedValue, ast.Subscript, ast.Slice, ast.Starred),
)
"""Expressions whose values depend on their parts only."""


class Conditions:
    """The attributes of one object that decide the values of expressions in its methods."""

    def __init__(self, source: ClassSource, instance: object) -> None:
        self._source, self._instance = source, instance
        self.found: set[str] = set()
        """Deciding attributes so far."""
        self.names: set[str] = set()
        """Deciding names of the module, whose values can change."""
        self.tasks: list[AnyFuture] = []
        """Deciding tasks and goals, which end by themselves."""

    def read(self, node: ast.AST, scope: Scope, seen: frozenset[str] = frozenset()) -> None:
        """Note the attributes that decide the value of an expression.

        Args:
            seen: Names and methods that are being read, so that recursion ends.

        Raises:
            Unknown: Something else decides it, too.
        """
        if scope.is_constant(node) or isinstance(node, ast.Constant):
            return
        match node:
            case ast.Attribute():
                self._read_attribute(node, scope, seen)
            case ast.Name(id=name):
                self._read_name(name, scope, seen)
            case ast.Call(func=function, args=arguments, keywords=[]):
                self._read_parts(ast.Tuple(arguments), scope, seen)
                self.call(function, scope, seen)
            case ast.GeneratorExp(elt=element, generators=loops) | ast.ListComp(elt=element, generators=loops):
                self._comprehension(element, loops, scope, seen)
            case ast.NamedExpr(value=value):
                self.read(value, scope, seen)
            case ast.Compare(left=left, comparators=[ast.Constant(value=None)]) if self.is_goal(left):
                return
            case _ if isinstance(node, _COMPOUND):
                self._read_parts(node, scope, seen)
            case _:
                raise Unknown

    def _read_parts(self, node: ast.AST, scope: Scope, seen: frozenset[str]) -> None:
        for child in children_of(node):
            if isinstance(child, ast.expr):  # others are operators and contexts
                self.read(child, scope, seen)

    def _read_attribute(self, node: ast.Attribute, scope: Scope, seen: frozenset[str]) -> None:
        if (owned := self._of_owned(node)) is not None:
            conditions, part = owned
            conditions.read(part, NO_NAMES)
            return
        match node:
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                self._attribute(name, seen)
            case ast.Attribute(value=ast.Name(id=name), attr="done") if scope.tasks.get(name):
                self.tasks += scope.tasks[name]
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="self"), attr=name), attr="done") if isinstance(
                goal := getattr(self._instance, name, None), PendingGoal
            ):
                self.found.add(name)
                self.tasks.append(goal.ended)
            case ast.Attribute(value=ast.Name(), attr="request" | "is_cancel_requested"):
                return  # attributes of a goal, whose cancellation ends any wait
            case ast.Attribute(value=value):
                self.read(value, scope, seen)

    def _read_name(self, name: str, scope: Scope, seen: frozenset[str]) -> None:
        if scope.locals.get(name) is not None and name not in seen:
            for bound in scope.locals[name]:
                if bound is None:
                    raise Unknown
                self.read(bound, scope, seen | {name})
        elif scope.is_of_module(name):
            self.names.add(name)
        else:
            raise Unknown

    def is_goal(self, node: ast.expr) -> bool:
        """Whether an expression is an attribute with a goal; if so, note it, but not the goal's end as an event."""
        if isinstance(node, ast.Attribute) and (owned := self._of_owned(node)) is not None:
            return owned[0].is_goal(owned[1])
        name = node.attr if isinstance(node, ast.Attribute) and _path(node) == [node.attr] else ""
        is_goal = isinstance(getattr(self._instance, name, None), PendingGoal)
        self.found |= {name} if is_goal else set()
        return is_goal

    def _comprehension(
        self, element: ast.expr, loops: list[ast.comprehension], scope: Scope, seen: frozenset[str]
    ) -> None:
        for loop in loops:
            bound = {node.id for node in nodes_in(loop.target) if isinstance(node, ast.Name)}
            match loop:
                case ast.comprehension(target=ast.Name(id=each), iter=ast.Name(id=name)) if scope.tasks.get(name):
                    scope = scope._replace(tasks={**scope.tasks, each: scope.tasks[name]})
                    continue
            self.read(loop.iter, scope, seen)
            scope = scope._replace(constants=scope.constants | bound)
            for test in loop.ifs:
                self.read(test, scope, seen)
        self.read(element, scope, seen)

    def call(self, function: ast.expr, scope: Scope, seen: frozenset[str]) -> None:
        """Note the attributes that decide the result of a call, besides its arguments."""
        if isinstance(function, ast.Attribute) and (owned := self._of_owned(function)) is not None:
            conditions, part = owned
            conditions.call(part, NO_NAMES, frozenset())
            return
        match function:
            case ast.Attribute(value=ast.Name(id="self"), attr=name) if name in self._source.methods:
                self._returned(name, seen)
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="self"), attr=name), attr=asked) if (
                asked in QUESTIONS and isinstance(getattr(self._instance, name, None), tuple(TOOLS))
            ):
                self.found.add(name)
                if isinstance(task := getattr(self._instance, name), asyncio.Task):
                    self.tasks.append(task)
            case ast.Attribute(value=ast.Name(id=name), attr=asked) if asked in QUESTIONS and scope.tasks.get(name):
                self.tasks += scope.tasks[name]
            case ast.Attribute(value=value, attr=name) if name in LOOKING and not scope.is_mathematics(function):
                self.read(value, scope, seen)
            case _:
                if not (scope.is_mathematics(function) or scope.asks_for_the_end(function)):
                    raise Unknown

    def _attribute(self, name: str, seen: frozenset[str]) -> None:
        owner = next((c for c in type(self._instance).__mro__ if name in vars(c)), None)
        declared = None if owner is None else vars(owner)[name]
        if name == "is_running" and owner is not None and not is_users_module(owner.__module__):
            return  # the node's own property: its end ends any wait
        if isinstance(declared, property):
            self._returned(name, seen)
            return
        value = getattr(self._instance, name, self)
        if hasattr(declared, "__get__") or not (is_plain(value) or holds_plain(value)):
            raise Unknown
        self.found.add(name)

    def _of_owned(self, node: ast.Attribute) -> tuple[Conditions, ast.expr] | None:
        """Return the conditions of an object that this one owns, and the expression as seen from its methods."""
        return None

    def _returned(self, name: str, seen: frozenset[str]) -> None:
        """Note the attributes that decide the result of a method or property without side effects.

        The arguments of the call have been read, so the parameters count as constants.
        """
        functions = self._source.methods.get(name, [])
        if len(functions) != 1 or name in seen or isinstance(functions[0], ast.AsyncFunctionDef):
            raise Unknown
        [function] = functions
        arguments = frozenset(a.arg for a in [*function.args.args, *function.args.kwonlyargs]) - {"self"}
        bound = {name: [value for _, value in pairs] for name, pairs in bindings(function).items()}
        if arguments & set(bound):
            raise Unknown
        scope = Scope(bound, arguments, _globals_of(type(self._instance), name), self._source.rebound)
        todo: list[ast.stmt] = list(function.body)
        while todo:
            match todo.pop():
                case ast.Return(value=ast.expr() as value):
                    self.read(value, scope, seen | {name})
                case ast.If(test=test, body=body, orelse=orelse):
                    self.read(test, scope, seen | {name})
                    todo += [*body, *orelse]
                case ast.Assign(targets=targets) if all(isinstance(t, (ast.Name, ast.Tuple)) for t in targets):
                    pass  # read at its use, through the scope
                case ast.AnnAssign(target=ast.Name()) | ast.Expr(value=ast.Constant()) | ast.Pass():
                    pass
                case _:
                    raise Unknown


class LoopConditions(Conditions):
    """The attributes of an object that decide whether a loop in one of its methods ends."""

    def __init__(self, loop: Loop, function: FunctionNode, frame: Frame, source: ClassSource, node: object) -> None:
        super().__init__(source, node)
        self._loop = loop
        self._owned: dict[str, Conditions] = {}
        """By attribute: the conditions of the object in it."""
        inside = set(nodes_in(loop))
        code, values = frame.f_code, frame.f_locals
        bound = bindings(function)
        given = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        own = [name for name in code.co_varnames if name not in code.co_cellvars]  # no inner function can bind these
        condition = set(nodes_in(loop.test)) if isinstance(loop, ast.While) else set()
        changing = {
            name
            for name in own
            if isinstance(value := values.get(name, []), (*CONTAINERS, *arrays(), *messages()))
            if not _is_only_read(name, value, function, condition)
        }
        constants = {
            name
            for name in own
            if not any(target in inside for target, _ in bound.get(name, ())) and is_plain(values.get(name, self))
            if name not in changing
        }
        # Any function around this one may bind its names; and the caller may change the objects that it passed.
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
        self._scope = Scope(locals_, frozenset(constants), frame.f_globals, source.rebound, tasks)

    def attributes(self) -> set[str]:
        """Return the attributes that decide it.

        Raises:
            Unknown: Something else decides it, too.
        """
        if isinstance(self._loop, ast.While):
            self.read(self._loop.test, self._scope)
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
                self.read(node.test, self._scope)
            if isinstance(node, (ast.Break, ast.Return, ast.Raise)):
                if isinstance(node, ast.Break) and _is_of_inner_loop(parents):
                    continue
                # Without an `if` around it, it is reached whenever no `continue` is, so their tests decide.
                guards = [p.test for p in parents if isinstance(p, ast.If)] or turns
                odd = (ast.Match, ast.ExceptHandler, ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
                if not guards or any(isinstance(p, odd) for p in parents):
                    raise Unknown
                for guard in guards:
                    self.read(guard, self._scope)
        return self.found

    @property
    def owned(self) -> dict[str, set[str]]:
        """Deciding attributes of other objects, by the attribute with the object."""
        return {owner: conditions.found for owner, conditions in self._owned.items()}

    def _of_owned(self, node: ast.Attribute) -> tuple[Conditions, ast.expr] | None:
        owner, *path = _path(node) or [""]
        held = getattr(self._instance, "__dict__", {}).get(owner)
        if not path or is_plain(held) or holds_plain(held) or isinstance(held, (PendingGoal, *TOOLS)):
            return None
        if not is_users_object(held):
            return None
        conditions = self._owned.setdefault(owner, Conditions(source_of(held), held))
        # One list for all: any of these tasks may end the loop.
        conditions.tasks = self.tasks
        return conditions, ast.parse(".".join(["self", *path]), mode="eval").body


def _path(node: ast.expr) -> list[str]:
    """Return the attributes of `self.a.b` in order; an empty list for any other expression."""
    path: list[str] = []
    while isinstance(node, ast.Attribute):
        path.append(node.attr)
        node = node.value
    return path[::-1] if isinstance(node, ast.Name) and node.id == "self" else []


def _globals_of(cls: type, name: str) -> Mapping[str, object]:
    """Return the global names that a method or property sees."""
    member = next((vars(c)[name] for c in cls.__mro__ if name in vars(c)), None)
    found: Mapping[str, object] = getattr(member.fget if isinstance(member, property) else member, "__globals__", {})
    return found


def makes_task(value: ast.expr) -> bool:
    """Whether an expression creates a task, several tasks, or a goal."""
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


def _futures(value: object) -> list[AnyFuture]:
    """Return the futures of a goal, a future, or a list of futures; an empty list for anything else."""
    if isinstance(value, PendingGoal):
        return [value.ended]
    parts: Sequence[object] = value if isinstance(value, (list, tuple)) else [value]
    futures: list[AnyFuture] = [part for part in parts if asyncio.isfuture(part)]
    return futures if len(futures) == len(parts) else []


def _is_kept(name: str, function: FunctionNode, loop: set[ast.AST]) -> bool:
    """Whether the object of a local name reaches no other code, and the loop only queries it."""
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


def _is_only_read(name: str, value: object, function: FunctionNode, condition: set[ast.AST]) -> bool:
    """Whether a function neither changes the object of a local name, nor passes it to code that could.

    Args:
        condition: Nodes of the loop's condition, which is read with everything that it calls.
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
            case ast.Attribute(ctx=ast.Load()):  # a field, or a method that is passed on
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

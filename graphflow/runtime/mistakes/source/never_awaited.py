"""Calls of coroutine functions as statements without `await`, which do nothing: `self.clock.sleep(1.0)`.

A running node reports each when its coroutine ends. Only functions that the class or its module shows are judged.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator, Mapping

from graphflow.analysis.attribute_uses import is_own, is_super
from graphflow.analysis.syntax import FunctionNode, nodes_in, walk
from graphflow.executor.clock import Clock
from graphflow.runtime.actions.client import GoalClient
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import ActionClient, Client, Publisher, Subscription
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.mistakes.source.wrong_fields import resolved

_AT_WORK: Mapping[type, type] = {
    Client: ServiceClient,
    ActionClient: GoalClient,
    Publisher: TopicPublisher,
    Subscription: TopicSubscription,
}
"""The runtime class of each kind of declaration."""


def never_awaited(
    cls: type, parent: type, definition: ast.ClassDef, space: dict[str, object]
) -> Iterator[tuple[int, str]]:
    """Find the lines of such calls; each comes with a sentence.

    Args:
        cls: The class of the node.
        parent: The class of the definition: `cls`, or one that it derives from.
        definition: The class statement.
        space: The names of its module.
    """
    replaced = {n.attr for n in nodes_in(definition) if isinstance(n, ast.Attribute) and isinstance(n.ctx, ast.Store)}
    for method in definition.body:
        own = _local(method) if isinstance(method, FunctionNode) else set()
        for node in nodes_in(method):
            if (call := _unused(node, definition)) is None:
                continue
            called = _called(call.func, cls, parent, {k: v for k, v in space.items() if k not in own})
            if inspect.iscoroutinefunction(called) and not (is_own(call.func) and call.func.attr in replaced):
                text = f"`{ast.unparse(call)}` does nothing, since {called.__qualname__} is a coroutine function"
                yield call.lineno, f"{text}; write await before it, in an async def"


def _unused(node: ast.AST, definition: ast.ClassDef) -> ast.Call | None:
    """Return a call that is a whole statement, or of which only attributes are read, as if it gave a future."""
    match node:
        case ast.Expr(value=ast.Call() as call):
            return call
        case ast.Assign(targets=[ast.Name() | ast.Attribute() as target], value=ast.Call() as call):
            is_kept = isinstance(target, ast.Name) or is_own(target)
            return call if is_kept and not _is_used(target, definition) else None
    return None


def _is_used(target: ast.Name | ast.Attribute, definition: ast.ClassDef) -> bool:
    """Whether a class uses what is kept under a name, other than by reading an attribute of it."""
    kept = ast.unparse(target)
    return any(
        isinstance(node, (ast.Name, ast.Attribute))
        and isinstance(node.ctx, ast.Load)
        and not isinstance(parents[-1], ast.Attribute)
        and ast.unparse(node) == kept
        for node, parents in walk(definition)
    )


def _called(function: ast.expr, cls: type, parent: type, space: dict[str, object]) -> object:
    """Return the function that a call reaches; None if that is not known."""
    match function:
        case ast.Attribute(value=ast.Name("self"), attr=name):
            return inspect.getattr_static(cls, name, None)
        case ast.Attribute(value=ast.Attribute(value=ast.Name("self"), attr="clock"), attr=name):
            return inspect.getattr_static(Clock, name, None)
        case ast.Attribute(value=ast.Attribute(value=ast.Name("self"), attr=owner), attr=name):
            return inspect.getattr_static(_AT_WORK.get(type(declared.declarations(cls).get(owner)), object), name, None)
        case ast.Attribute(value=owner, attr=name) if is_super(owner):
            after = cls.__mro__[cls.__mro__.index(parent) + 1 :]
            return next((vars(one)[name] for one in after if name in vars(one)), None)
    return resolved(function, space)


def _local(method: FunctionNode) -> set[str]:
    """Return the names that a method binds itself."""
    found = {node.arg for node in nodes_in(method) if isinstance(node, ast.arg)}
    found |= {node.id for node in nodes_in(method) if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)}
    found |= {
        alias.asname or alias.name
        for node in nodes_in(method)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    }
    return found | {node.name for node in nodes_in(method) if isinstance(node, FunctionNode | ast.ClassDef)}

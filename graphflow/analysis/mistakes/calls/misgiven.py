"""Callbacks that do not do what they were written for, found in the source.

An `async def` passed to a thread; `lambda message: self.heard`, which returns the method instead of calling it; and
`lambda: self.show(i)` in a loop, where every callback sees the loop's last `i`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeAlias

from graphflow.analysis.syntax import NESTED, FunctionNode, nodes_in, walk

_TAKERS = {
    *("create_subscription", "create_timer", "create_service", "create_action_server", "create_guard_condition"),
    *("ActionServer", "add_done_callback", "registerCallback", "add_on_set_parameters_callback", "call_soon"),
    "call_soon_threadsafe",
}
"""Functions and methods that take a callback and call it later."""
_LATER = ("spin", "sleep", "wait", "result", "close", "cancel", "destroy", "remove", "join")
"""Prefixes of calls after which a loop's earlier callbacks may no longer be needed."""
_LASTING = ("close", "cancel", "destroy", "remove")
"""The same for callbacks of timers and subscriptions, which are called until they are ended."""

_Made: TypeAlias = ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef


class _Given(NamedTuple):
    """A function that is defined where it is passed, or in the loop around that."""

    made: _Made
    parents: list[ast.AST]
    """The nodes that enclose the call that it is passed to."""
    taker: str
    """The name of what is called."""


def misgiven(code: ast.AST, starts: str = "self.spawn({})") -> Iterator[tuple[int, str]]:
    """Find the lines of such callbacks; each comes with its correction.

    Args:
        starts: The call that starts a coroutine, as a format string.
    """
    methods = _methods(code)
    yield from _in_threads(code, methods, starts)
    for given in sorted(_all_given(code), key=lambda given: given.made.lineno):
        made = given.made
        if isinstance(made, ast.Lambda) and (text := _given_back(made, methods)):
            yield made.lineno, text
        elif name := _of_loop(given):
            if isinstance(made, ast.Lambda):
                written = f"lambda {ast.unparse(_with_default(made.args, name))}: ..."
                yield made.lineno, f"each lambda on this line sees the last {name} of the loop; write {written}"
            else:
                written = f"def {made.name}({ast.unparse(_with_default(made.args, name))}):"
                yield made.lineno, f"each {made.name} in this loop sees the last {name}; write {written}"


_THREADS = {"to_thread": 0, "run_in_executor": 1, "submit": 0, "Timer": 1, "Thread": None}
"""Calls that run a function in a thread, with the position of the function among their arguments."""


def _in_threads(code: ast.AST, methods: dict[str, FunctionNode], starts: str) -> Iterator[tuple[int, str]]:
    for node in nodes_in(code):
        if not isinstance(node, ast.Call) or (word := _last_name(node.func)) not in _THREADS:
            continue
        at = _THREADS[word]
        given = [*(node.args[at : at + 1] if at is not None else ())]
        given += [keyword.value for keyword in node.keywords if keyword.arg in ("target", "function")]
        for value in given:
            name = value.attr if isinstance(value, ast.Attribute) and isinstance(value.value, ast.Name) else ""
            if isinstance(methods.get(name), ast.AsyncFunctionDef):
                shown = ast.unparse(value)
                awaited = f"await {shown}(...)" if word in ("to_thread", "run_in_executor") else starts.format(shown)
                yield node.lineno, f"{name} is an `async def`, which a thread cannot run; write {awaited}"


def _all_given(code: ast.AST) -> Iterator[_Given]:
    for node, parents in walk(code):
        if not (isinstance(node, ast.Call) and (taker := _last_name(node.func)) in _TAKERS):
            continue
        for value in (*node.args, *(keyword.value for keyword in node.keywords)):
            if isinstance(value, ast.Lambda):
                yield _Given(value, parents, taker)
            elif isinstance(value, ast.Name):
                yield from (_Given(made, parents, taker) for made in _defined_in_loop(value.id, parents))


def _defined_in_loop(name: str, parents: Sequence[ast.AST]) -> list[FunctionNode]:
    loop = _loop_around(parents)
    body = loop.body if isinstance(loop, (ast.For, ast.While)) else []
    return [item for item in body if isinstance(item, FunctionNode) and item.name == name]


def _last_name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def _methods(code: ast.AST) -> dict[str, FunctionNode]:
    """Return the methods of the classes, except those whose names have other meanings, too."""
    found: dict[str, FunctionNode] = {}
    others: set[str] = set()
    for node in nodes_in(code):
        if isinstance(node, ast.ClassDef):
            for item in node.body:
                if isinstance(item, FunctionNode):
                    found[item.name] = item
                    others |= {item.name} if any("property" in ast.unparse(d) for d in item.decorator_list) else set()
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            others.add(node.attr)
    return {name: method for name, method in found.items() if name not in others}


def _given_back(made: ast.Lambda, methods: dict[str, FunctionNode]) -> str:
    """Return the reason why a lambda has no effect: it returns a method; "" if it has one."""
    match made.body:
        case ast.Attribute(value=ast.Name(), attr=name) as method if name in methods:
            shown = ast.unparse(method)
            arguments = made.args
            if len(arguments.args) == len(methods[name].args.args) - 1 and not arguments.defaults:
                way = f"{shown} in place of the lambda"
            else:
                way = f"{ast.unparse(made)}(...)"
            return f"the lambda returns the method {shown} instead of calling it; write {way}"
    return ""


def _loop_around(parents: Sequence[ast.AST]) -> ast.AST | None:
    """Return the innermost loop or comprehension around a function, in the same scope."""
    for parent in reversed(parents):
        if isinstance(parent, NESTED):
            return None
        if isinstance(parent, (ast.For, ast.While, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)):
            return parent
    return None


def _of_loop(given: _Given) -> str:
    """Return the loop variable that a callback reads too late; "" if there is none."""
    loop = _loop_around(given.parents)
    if loop is None or _may_be_over(loop, is_lasting=given.taker.startswith("create_")):
        return ""
    own = {name.id for name in nodes_in(given.made) if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)}
    own |= {argument.arg for argument in nodes_in(given.made) if isinstance(argument, ast.arg)}
    body = given.made.body if isinstance(given.made.body, list) else [given.made.body]
    read = [n.id for part in body for n in nodes_in(part) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)]
    changing = _changing(loop, given.parents)
    return next((name for name in read if name in changing and name not in own), "")


def _may_be_over(loop: ast.AST, *, is_lasting: bool) -> bool:
    """Whether an iteration of a loop may be the last one, or may wait until its callback has been called.

    Args:
        is_lasting: Whether the callback is called again and again, so that no wait is enough.
    """
    ends = (ast.Break, ast.Return, ast.Raise, ast.Yield, ast.YieldFrom, *(() if is_lasting else (ast.Await,)))
    for node, parents in walk(loop):
        if any(isinstance(parent, NESTED) for parent in parents):
            continue
        if isinstance(node, ends):
            return True
        if isinstance(node, ast.Call) and _last_name(node.func).startswith(_LASTING if is_lasting else _LATER):
            return True
    items = loop.iter if isinstance(loop, ast.For) else None
    return isinstance(items, (ast.Tuple, ast.List)) and len(items.elts) < 2


def _changing(loop: ast.AST, parents: Sequence[ast.AST]) -> set[str]:
    """Return the variables that change with each iteration: the loop's own, and those computed from them."""
    if isinstance(loop, (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)):
        return {name for part in loop.generators for name in _names(part.target)}
    if not isinstance(loop, (ast.For, ast.While)):
        return set()
    found = set(_names(loop.target)) if isinstance(loop, ast.For) else set()
    for node in (n for statement in loop.body for n in nodes_in(statement)):
        if isinstance(node, ast.Assign) and found & set(_names(node.value)):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    for node in nodes_in(parents[0]):
        if isinstance(node, (ast.Global, ast.Nonlocal)):
            found -= set(node.names)
        elif isinstance(node, ast.AugAssign):
            found -= set(_names(node.target))
    return found


def _names(node: ast.AST) -> list[str]:
    return [name.id for name in nodes_in(node) if isinstance(name, ast.Name)]


def _with_default(arguments: ast.arguments, name: str) -> ast.arguments:
    """Return the arguments with a default appended that keeps the value of the current iteration."""
    positional = [*arguments.args, ast.arg(name)] if not arguments.vararg else arguments.args
    defaults = [*arguments.defaults, ast.Name(name)] if not arguments.vararg else arguments.defaults
    only = [*arguments.kwonlyargs, ast.arg(name)] if arguments.vararg else arguments.kwonlyargs
    only_defaults = [*arguments.kw_defaults, ast.Name(name)] if arguments.vararg else arguments.kw_defaults
    return ast.arguments(
        arguments.posonlyargs, positional, arguments.vararg, only, only_defaults, arguments.kwarg, defaults
    )

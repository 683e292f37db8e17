"""Values that nothing receives: `state = "BACK"` for `self.state`, and messages that are returned, or only filled.

Only names that nothing reads are told, and only messages that their handler does not pass on itself.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk

_CALLED_BACK = {"create_timer": "timer", "create_subscription": "subscription"}
_LEVELS = ("debug", "info", "warn", "warning", "error")
_LOGGERS = ("get_logger", "log", "logger")
_KINDS = {**_CALLED_BACK, "timer": "timer", "subscription": "subscription"}


@cache
def lost_values(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines of a file that lose such a value; each comes with its correction."""
    classes = [node for node in nodes_in(module) if isinstance(node, ast.ClassDef)]
    messages = _messages(module)
    found = [slip for cls in classes for slip in (*_locals(cls), *_returned(module, cls, messages))]
    for method in (node for cls in classes for node in cls.body if isinstance(node, FunctionNode)):
        found += _only_made(method, messages) if messages else ()
    return tuple(sorted(found))


def _locals(cls: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find local variables that nothing reads, named as an attribute that other lines set and read."""
    own = [node for node in nodes_in(cls) if is_own(node)]
    read = {node.attr for node in own if isinstance(node.ctx, ast.Load)}
    set_ = {node.attr for node in own if isinstance(node.ctx, ast.Store)}
    targets = [target for s in cls.body if isinstance(s, ast.Assign) for target in s.targets]
    set_ |= {target.id for target in targets if isinstance(target, ast.Name)}
    methods = [item for item in cls.body if isinstance(item, FunctionNode)]
    later = {n.attr for m in methods if m.name != "__init__" for n in nodes_in(m) if is_own(n) and _is_set(n)}
    for method in methods:
        yield from _unread(method, read & set_, later) if read & set_ else ()


def _is_set(attribute: ast.Attribute) -> bool:
    return not isinstance(attribute.ctx, ast.Load)


def _unread(method: FunctionNode, attributes: set[str], later: set[str]) -> Iterator[tuple[int, str]]:
    """Find such variables in a method.

    Args:
        later: The attributes that are set after the constructor. Without that a log or a print does not count as a
            reader of the local variable.
    """
    known = {argument.arg for argument in nodes_in(method.args) if isinstance(argument, ast.arg)}
    shown: set[str] = set()
    for node, parents in walk(method):
        match node:
            case ast.Name(id="locals" | "vars" | "eval" | "exec"):
                return
            case ast.Name(id=name, ctx=ast.Load()) if name not in later and any(map(_is_shown, parents)):
                shown.add(name)
            case ast.Name(id=name, ctx=ast.Load() | ast.Del()):
                known.add(name)
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                known.update(names)
            case ast.Attribute(attr=name, ctx=ast.Store()) if is_own(node):
                known.add(name)  # the method tells the two apart
    for node, parents in walk(method, into_functions=False):
        if any(isinstance(parent, ast.ClassDef) for parent in parents):
            continue
        match node:
            case (
                ast.Assign(targets=[ast.Name(id=name)], value=value)
                | ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value)
            ) if name in attributes - known and _is_pure(value) and ast.unparse(value) != f"self.{name}":
                text = f"{name} = {ast.unparse(value)}"
                reader = "only a log reads" if name in shown else "nothing reads"
                yield node.lineno, f"{text} sets a local variable, which {reader}; write self.{text}"


def _is_shown(parent: ast.AST) -> bool:
    """Whether a part of the source shows what is inside it, to people only."""
    match parent:
        case ast.Call(func=ast.Name(id="print"), keywords=[]):
            return True
        case ast.Call(func=ast.Attribute(value=owner, attr=name)) if name in _LEVELS:
            return last_name(owner.func if isinstance(owner, ast.Call) else owner) in _LOGGERS
    return False


def _is_pure(value: ast.expr) -> bool:
    """Whether an expression only computes, so that there is no other reason to write it."""
    doing = (ast.Call, ast.Await, ast.Yield, ast.YieldFrom, ast.NamedExpr)
    return not any(isinstance(node, doing) for node in nodes_in(value))


def _messages(module: ast.Module) -> set[str]:
    """Return the names of message classes that a file imports."""
    imports = [node for node in nodes_in(module) if isinstance(node, ast.ImportFrom)]
    return {alias.asname or alias.name for node in imports if str(node.module).endswith(".msg") for alias in node.names}


def _only_made(method: FunctionNode, messages: set[str]) -> Iterator[tuple[int, str]]:
    """Find messages that a method makes and fills, and nothing reads."""
    used: set[str] = set()
    for node, parents in walk(method):
        match node:
            case ast.Name(id="locals" | "vars" | "eval" | "exec"):
                return
            case ast.Name(id=name, ctx=ast.Load() | ast.Del()) if not _is_filled(node, parents):
                used.add(name)
            case ast.Name(id=name, ctx=ast.Store()) if not _is_made(parents[-1], messages):
                used.add(name)  # it also stands for something else
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                used.update(names)
    for node, parents in walk(method):
        match node:
            case ast.Expr(value=ast.Call(func=function)) if last_name(function) in messages:
                if not any(isinstance(parent, ast.With | ast.AsyncWith | ast.Try) for parent in parents):
                    yield node.lineno, f"{ast.unparse(node)} makes a message that nothing uses; publish it"
            case ast.Assign(targets=[ast.Name(id=name)]) if name not in used:  # hence a message
                yield node.lineno, f"{name} is a message that nothing reads; publish it, as in .publish({name})"


def _is_made(node: ast.AST, messages: set[str]) -> bool:
    """Whether a statement assigns a new message to a name."""
    match node:
        case ast.Assign(targets=[ast.Name()], value=ast.Call(func=function)):
            return last_name(function) in messages
    return False


def _is_filled(name: ast.AST, parents: Sequence[ast.AST]) -> bool:
    """Whether a name begins the left side of an assignment to one of its fields."""
    below = name
    for parent in reversed(parents):
        if not isinstance(parent, ast.Attribute | ast.Subscript) or parent.value is not below:
            return False
        if isinstance(parent.ctx, ast.Store):
            return True
        below = parent
    return False


def _returned(module: ast.Module, cls: ast.ClassDef, messages: set[str]) -> Iterator[tuple[int, str]]:
    """Find messages that the handlers of timers and subscriptions return."""
    handlers = _handlers(module, cls) if messages else []
    for method, kind in handlers:
        for node, _ in walk(method, into_functions=False):
            if not isinstance(node, ast.Return) or node.value is None:
                continue
            type_ = _only_returned(node.value, method, messages)
            if type_:
                publisher = _publisher(cls, type_) or "publisher"
                text = f"{method.name} is called by a {kind}, which drops the {type_} that it returns"
                yield node.lineno, f"{text}; write self.{publisher}.publish({ast.unparse(node.value)})"


def _handlers(module: ast.Module, cls: ast.ClassDef) -> Iterator[tuple[FunctionNode, str]]:
    """Yield the methods that a timer or a subscription calls, and nothing else in the file; each with which it is."""
    given: dict[str, str] = {}
    others: set[str] = set()
    for node, parents in walk(module):
        match node:
            case ast.Attribute(attr=name, ctx=ast.Load()):
                call = parents[-1]
                kind = _CALLED_BACK.get(last_name(call.func), "") if isinstance(call, ast.Call) else ""
                if kind and is_own(node):
                    given[name] = kind
                else:
                    others.add(name)
    for method in cls.body:
        if isinstance(method, FunctionNode) and method.name not in others:
            called = [d.func for d in method.decorator_list if isinstance(d, ast.Call)]
            kinds = [_KINDS[last_name(function)] for function in called if last_name(function) in _KINDS]
            kind = kinds[0] if len(method.decorator_list) == len(kinds) == 1 else ""
            kind = kind or ("" if method.decorator_list else given.get(method.name, ""))
            yield from [(method, kind)] if kind else []


def _only_returned(value: ast.expr, method: FunctionNode, messages: set[str]) -> str:
    """Return the class of a message that a method makes, returns, and does not use in another way; else ""."""
    if isinstance(value, ast.Call):
        calls = [n.func for n in nodes_in(method) if isinstance(n, ast.Call)]
        publishes = any(last_name(function) == "publish" for function in calls)
        return last_name(value.func) if _makes(value, messages) and not publishes else ""
    if not isinstance(value, ast.Name):
        return ""
    made: list[ast.expr] = []
    for node, parents in walk(method):
        match node:
            case ast.Name(id=name, ctx=ast.Store()) if name == value.id:
                made.append(parents[-1].value if isinstance(parents[-1], ast.Assign) else node)
            case ast.Name(id=name) if name == value.id and not isinstance(parents[-1], (ast.Return, ast.Attribute)):
                return ""
    types = {last_name(call.func) if isinstance(call, ast.Call) and _makes(call, messages) else "" for call in made}
    return types.pop() if len(types) == 1 else ""


def _makes(call: ast.Call, messages: set[str]) -> bool:
    return isinstance(call.func, ast.Name) and call.func.id in messages


def _publisher(cls: ast.ClassDef, type_: str) -> str:
    """Return the attribute with the publisher of a message class; empty if there is not exactly one."""
    found: set[str] = set()
    for node in nodes_in(cls):
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name) | ast.Attribute(attr=name)], value=ast.Call(func=made, args=[first, *_])
            ) if last_name(made) in ("Publisher", "create_publisher") and last_name(first) == type_:
                found.add(name)
    return found.pop() if len(found) == 1 else ""

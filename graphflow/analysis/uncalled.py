"""Functions and methods that a program names without calling them, detected in its source."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.reading import parsed

_RUNNERS = ("run", "running", "init", "spin")
"""Names of functions by which a program runs nodes."""
_METHODS = (
    *("cancel", "reset", "destroy", "destroy_node", "shutdown", "try_shutdown"),
    *("succeed", "abort", "canceled", "execute", "stop", "close", "spin", "spin_once"),
    *("set", "clear", "acquire", "release", "notify", "notify_all", "start", "join", "wait", "popleft", "task_done"),
)
"""Methods of nodes, of their parts, and of events, locks, threads and queues that are called without arguments."""
_FUNCTIONS = {"rclpy.init": "", "rclpy.spin": "node", "rclpy.spin_once": "node"}
"""Functions of rclpy, with their argument."""
_ALSO_VALUES = ("start", "stop")
"""Methods whose names slices and ranges have for values, which a script may look at."""
_HANDLERS = {"subscription", "service", "timer", "action", "task"}
"""Decorators that leave a method as it is."""
_COUNTS = ("get_subscription_count", "get_publisher_count")
"""Methods that return a number."""
_QUESTIONS = (
    *("service_is_ready", "server_is_ready", "wait_for_service", "wait_for_server", "is_canceled"),
    *_COUNTS,
)
"""Methods whose answer decides a condition."""
_LAUNCH = "generate_launch_description"
"""Function that makes a file a launch file."""


def uncalled(source: str, file: str) -> str:
    """Return a message why a program has run no node: nothing calls its `main()`, or another function that would.

    Args:
        source: The program's text.
        file: The program's name for the message.

    Returns:
        Empty if something calls it, or if that is not known.
    """
    try:
        module = parsed(source)
    except (SyntaxError, ValueError):
        return ""
    for line, text in misspelt_main(module):
        return f"{file}:{line}: {text}"
    statements = {id(node.value): node.lineno for node in nodes_in(module) if isinstance(node, ast.Expr)}
    names = [node for node in nodes_in(module) if isinstance(node, ast.Name)]
    used = {name.id for name in names if id(name) not in statements}
    used |= {node.value for node in nodes_in(module) if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    functions = [node for node in module.body if isinstance(node, FunctionNode) and not node.decorator_list]
    idle = [function for function in functions if function.name not in used]  # a decorator may keep and call it
    for function in idle:
        if function.name == _LAUNCH:
            return f"{file}:{function.lineno}: {_LAUNCH}() makes it a launch file; write: graphflow launch {file}"
    for function in sorted(idle, key=lambda f: f.name != "main"):
        if function.name != "main" and not _runs_nodes(function):
            continue
        call = f"{function.name}()"
        call = f"asyncio.run({call})" if isinstance(function, ast.AsyncFunctionDef) else call
        for name in names:
            if name.id == function.name:
                return f"{file}:{name.lineno}: {name.id} without parentheses calls nothing; write: {call}"
        way = f"add as the last line: if __name__ == '__main__': {call}"
        return f"{file}:{function.lineno}: {function.name}() is defined and never called; {way}"
    return ""


def named_only(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the lines that consist of the name of one of the file's functions, such as `main`, each with a message."""
    functions = {node.name for node in module.body if isinstance(node, FunctionNode)}
    for node in nodes_in(module):
        match node:
            case ast.Expr(value=ast.Name(id=name)) if name in functions:
                yield node.lineno, f"{name} without parentheses calls nothing; write: {name}()"


def uncalled_methods(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the lines that name a method without calling it, such as `self.timer.cancel`, each with a message."""
    own = _own_attributes(code)
    for node, parents in walk(code):
        match node:
            case ast.Expr(value=ast.Attribute(attr=name) as method):
                function, shown = _method(method, parents), ast.unparse(method)
                is_known = shown in _FUNCTIONS or (name in _METHODS and not (is_own(method) and name in own))
                is_known &= name not in _ALSO_VALUES or any(isinstance(parent, FunctionNode) for parent in parents)
                if (is_known or function is not None) and not _is_tried(parents):
                    yield node.lineno, f"{shown} without parentheses calls nothing; {_call(method, function)}"
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test) | ast.Assert(test=test):
                for method in _conditions(test):
                    if _asks(method) and method.attr not in own:
                        shown = ast.unparse(method)
                        yield method.lineno, f"{shown} without parentheses is always true; write: {shown}()"
            case ast.Compare(left=ast.Attribute(attr=name) as method) if name in _COUNTS and name not in own:
                shown = ast.unparse(method)
                yield method.lineno, f"{shown} without parentheses is a method, and no number; write: {shown}()"


def _method(named: ast.Attribute, parents: Sequence[ast.AST]) -> FunctionNode | None:
    """Return the method of the enclosing class that `self.name` is; None for a property or any other attribute."""
    owner = next((node for node in reversed(parents) if isinstance(node, ast.ClassDef)), None)
    if owner is None or not is_own(named):
        return None
    found = [item for item in owner.body if isinstance(item, FunctionNode) and item.name == named.attr]
    words = {last_name(d.func if isinstance(d, ast.Call) else d) for item in found for d in item.decorator_list}
    return found[0] if len(found) == 1 and words <= _HANDLERS else None


def _call(method: ast.Attribute, function: FunctionNode | None) -> str:
    """Return the call that was meant, with the names of its arguments."""
    arguments = [argument.arg for argument in function.args.args[1:]] if function is not None else []
    shown = ast.unparse(method)
    call = f"{shown}({_FUNCTIONS.get(shown, ', '.join(arguments))})"
    return f"write: await {call}" if isinstance(function, ast.AsyncFunctionDef) else f"write: {call}"


def _is_tried(parents: Sequence[ast.AST]) -> bool:
    """Whether a statement may be there for its error, in a `try` or a `with` that expects one."""
    match parents[-1]:
        case ast.Try(handlers=handlers):
            return any(
                handler.type is not None and "AttributeError" in ast.unparse(handler.type) for handler in handlers
            )
        case ast.With(items=items):
            calls = [item.context_expr.func for item in items if isinstance(item.context_expr, ast.Call)]
            return any(last_name(call) in ("raises", "suppress") for call in calls)
    return False


def _conditions(test: ast.expr) -> Iterator[ast.Attribute]:
    """Yield the attributes whose truth decides a condition."""
    match test:
        case ast.Attribute():
            yield test
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            yield from _conditions(inner)
        case ast.BoolOp(values=values):
            for value in values:
                yield from _conditions(value)


def _asks(method: ast.Attribute) -> bool:
    """Whether an attribute is a method that returns a truth value: of rclpy, of a client, or of a future."""
    owner = ast.unparse(method.value).rpartition(".")[2]
    if method.attr == "ok":
        return owner == "rclpy"
    if method.attr in ("done", "cancelled"):
        return "future" in owner.lower()
    return method.attr in _QUESTIONS


def _own_attributes(code: ast.AST) -> set[str]:
    """Return the attributes that a program sets, or defines as properties."""
    found = {
        node.attr for node in nodes_in(code) if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)
    }
    for node in nodes_in(code):
        if isinstance(node, FunctionNode) and node.decorator_list:
            found.add(node.name)
    return found


def misspelt_main(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the lines that compare `__name__` with another string than `__main__`, each with a message."""
    for node in module.body:
        match node:
            case ast.If(
                test=ast.Compare(left=ast.Name("__name__"), ops=[ast.Eq()], comparators=[ast.Constant(value=str(name))])
            ) if name not in ("__main__", "__mp_main__"):  # the second is its name in a process of multiprocessing
                text = f"__name__ is never {name!r}, so nothing runs; write: if __name__ == '__main__':"
                yield node.lineno, text


def _runs_nodes(function: ast.AST) -> bool:
    called = [node.func for node in nodes_in(function) if isinstance(node, ast.Call)]
    return any(last_name(f) in _RUNNERS for f in called)

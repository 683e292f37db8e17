"""Tests in launch files whose outcome is fixed: `if LaunchConfiguration('sim'):` is true whatever `sim` is.

A substitution has no value while the description is made. ROS 2 says nothing; the test is true as of any object, and a
comparison with a text is false.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.supervisor.launch_names import NAMES

_CONDITIONS = NAMES["launch.conditions"].split()
_SUBSTITUTIONS = (NAMES["launch.substitutions"] + " " + NAMES["launch_ros.substitutions"]).split()
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)


def fixed_tests(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """The lines of such tests, each with what to write."""
    yield from _of_scope(tree, {})


def _of_scope(scope: ast.AST, outer: dict[str, ast.Call]) -> Iterator[tuple[int, str]]:
    """Those of a module or function, and of the functions in it.

    Args:
        outer: Names of the scope around it that are substitutions, with the calls that make them.
    """
    nodes = list(_own(scope))
    known = {name: call for name, call in outer.items() if name not in _bound(scope, nodes)} | _made(scope, nodes)
    for node in nodes:
        if isinstance(node, (ast.If, ast.IfExp, ast.While)):
            for part, is_compared in _parts(node.test):
                call = known.get(part.id) if isinstance(part, ast.Name) else _substitution(part)
                if call is not None:
                    yield part.lineno, _text(call, is_compared)
        elif isinstance(node, _SCOPES):
            yield from _of_scope(node, known)


def _own(scope: ast.AST) -> Iterator[ast.AST]:
    """What is in a scope; of functions in it, only themselves."""
    todo = list(ast.iter_child_nodes(scope))
    while todo:
        node = todo.pop(0)
        yield node
        if not isinstance(node, _SCOPES):
            todo += ast.iter_child_nodes(node)


def _bound(scope: ast.AST, nodes: list[ast.AST]) -> set[str]:
    """The names that a scope binds."""
    arguments = scope.args if isinstance(scope, _SCOPES) else None
    taken = {arg.arg for arg in ast.walk(arguments) if isinstance(arg, ast.arg)} if arguments is not None else set()
    return taken | {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}


def _made(scope: ast.AST, nodes: list[ast.AST]) -> dict[str, ast.Call]:
    """The names that are bound once in a scope, and to a substitution."""
    stores = [node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
    found: dict[str, ast.Call] = {}
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if stores.count(name) == 1:
                if (call := _substitution(value)) is not None:
                    found[name] = call
    arguments = _bound(scope, [])
    return {name: call for name, call in found.items() if name not in arguments}


def _substitution(value: ast.expr) -> ast.Call | None:
    """A call that makes a substitution or a condition."""
    if not isinstance(value, ast.Call) or not isinstance(value.func, (ast.Name, ast.Attribute)):
        return None
    name = value.func.id if isinstance(value.func, ast.Name) else value.func.attr
    return value if name in (*_SUBSTITUTIONS, *_CONDITIONS) else None


def _parts(test: ast.expr) -> Iterator[tuple[ast.expr, bool]]:
    """What a test asks, and whether it is compared with a literal."""
    match test:
        case ast.BoolOp(values=values):
            for value in values:
                yield from _parts(value)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield from _parts(operand)
        case ast.Compare(
            left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[ast.Constant(value=str() | bool() | int())]
        ):
            yield left, True
        case _:
            yield test, False


def _text(call: ast.Call, is_compared: bool) -> str:
    shown = ast.unparse(call)
    if ast.unparse(call.func).rpartition(".")[2] in _CONDITIONS:
        return f"{shown} has no value yet and is true in any test: write condition={shown} at the action"
    if is_compared:
        way = f"condition=IfCondition(EqualsSubstitution({shown}, ...))"
        return f"{shown} has no value yet and equals no literal: write {way} at the action"
    return f"{shown} has no value yet and is true in any test: write condition=IfCondition({shown}) at the action"

"""Uses of substitutions in launch files before they have a value: `if LaunchConfiguration('sim'):` is always true.

They have none while the description is made, and ROS 2 says nothing: a test is true as of any object, a comparison with
a text false, and `str` makes the name of an object.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.supervisor.launch_names import NAMES

_CONDITIONS = NAMES["launch.conditions"].split()
_SUBSTITUTIONS = (NAMES["launch.substitutions"] + " " + NAMES["launch_ros.substitutions"]).split()
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)


def early_uses(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """The lines of such uses, each with what to write."""
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
            for part in _parts(node.test):
                if (call := _meant(part, known)) is not None:
                    yield part.lineno, _of_test(call)
        elif (compared := _compared(node)) is not None and (call := _meant(compared[0], known)) is not None:
            shown = ast.unparse(call)
            way = f"EqualsSubstitution({shown}, {compared[1]!r})"
            yield compared[0].lineno, f"{shown} has no value yet and equals no text: write {way}"
        elif (given := _given_to_str(node)) is not None and (call := _meant(given, known)) is not None:
            shown = ast.unparse(call)
            yield given.lineno, f"{shown} has no value yet, and str() makes the name of an object: write {shown} alone"
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


def _meant(part: ast.expr, known: dict[str, ast.Call]) -> ast.Call | None:
    """The substitution that an expression is, or names."""
    return known.get(part.id) if isinstance(part, ast.Name) else _substitution(part)


def _parts(test: ast.expr) -> Iterator[ast.expr]:
    """What a test asks whether it is true."""
    match test:
        case ast.BoolOp(values=values):
            for value in values:
                yield from _parts(value)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield from _parts(operand)
        case _:
            yield test


def _compared(node: ast.AST) -> tuple[ast.expr, object] | None:
    """What is compared with a literal, and that."""
    match node:
        case ast.Compare(
            left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[ast.Constant(value=str() | int() as value)]
        ):
            return left, value
    return None


def _given_to_str(node: ast.AST) -> ast.expr | None:
    match node:
        case ast.Call(func=ast.Name("str"), args=[given], keywords=[]):
            return given
    return None


def _of_test(call: ast.Call) -> str:
    shown = ast.unparse(call)
    condition = shown if ast.unparse(call.func).rpartition(".")[2] in _CONDITIONS else f"IfCondition({shown})"
    return f"{shown} has no value yet and is true in any test: write condition={condition} at the action"

"""Uses of substitutions before they have a value: `if LaunchConfiguration('sim'):` is always true.

A substitution has no value while the description is made, and ROS 2 does not report its use: like any object it is true
in a test, unequal to any text, and `str` returns its `repr`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from graphflow.launchfiles.python.names import NAMES

_CONDITIONS = NAMES["launch.conditions"].split()
_SUBSTITUTIONS = (NAMES["launch.substitutions"] + " " + NAMES["launch_ros.substitutions"]).split()
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)


def early_uses(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the lines of such uses, each with a correction."""
    yield from _uses_in(tree, {})


def _uses_in(scope: ast.AST, outer: dict[str, ast.Call]) -> Iterator[tuple[int, str]]:
    """Yield the early uses in a module or function, and in the functions within it.

    Args:
        outer: Substitutions of the enclosing scopes, by name.
    """
    nodes = list(_nodes_in(scope))
    known = {name: call for name, call in outer.items() if name not in _bound(scope, nodes)} | _bound_once(scope, nodes)
    performs = isinstance(scope, _SCOPES) and any(arg.arg == "context" for arg in scope.args.args)
    seen: set[ast.AST] = set()  # already reported as part of a larger expression
    for node in nodes:
        match node:
            case ast.If(test=test) | ast.IfExp(test=test) | ast.While(test=test):
                for part in _operands(test):
                    seen |= {*ast.walk(part)}
                    if text := _test_fault(part, known, performs):
                        yield part.lineno, text
            case (
                ast.Call(args=[argument], keywords=[])
                | ast.Call(args=[], keywords=[ast.keyword(arg="predicate_expression", value=argument)])
            ) if _name(node) in ("IfCondition", "UnlessCondition"):
                fix = None if _value(argument, known) else _equivalent(argument, known)
                if fix is not None:
                    seen |= {*ast.walk(argument)}
                    shown = ast.unparse(argument)
                    yield node.lineno, f"{shown} is decided before the launch has values: write {_name(node)}({fix})"
            case ast.Compare() if node not in seen and (fix := _equivalent(node, known)) is not None:
                seen |= {*ast.walk(node)}
                yield node.lineno, _comparison_fault(node, known, performs, fix)
            case ast.Call(func=ast.Name(id="str"), args=[argument], keywords=[]) if node not in seen and (
                call := _value(argument, known)
            ):
                shown = ast.unparse(call)
                fix = f"{shown}.perform(context)" if performs else f"{shown} alone"
                yield node.lineno, f"{shown} has no value yet, and str() makes the name of an object: write {fix}"
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.Lambda():
                yield from _uses_in(node, known)


def _nodes_in(scope: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a scope, without the bodies of functions within it."""
    todo = list(ast.iter_child_nodes(scope))
    while todo:
        # Breadth first: an expression comes before its parts, which `seen` then leaves out.
        node = todo.pop(0)
        yield node
        if not isinstance(node, _SCOPES):
            todo += ast.iter_child_nodes(node)


def _bound(scope: ast.AST, nodes: list[ast.AST]) -> set[str]:
    """Return the names that a scope binds."""
    arguments = scope.args if isinstance(scope, _SCOPES) else None
    taken = {arg.arg for arg in ast.walk(arguments) if isinstance(arg, ast.arg)} if arguments is not None else set()
    return taken | {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}


def _bound_once(scope: ast.AST, nodes: list[ast.AST]) -> dict[str, ast.Call]:
    """Return the names that a scope binds once, and to a substitution."""
    stores = [node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
    found: dict[str, ast.Call] = {}
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if stores.count(name) == 1:
                if (call := _substitution(value)) is not None:
                    found[name] = call
    arguments = _bound(scope, [])
    return {name: call for name, call in found.items() if name not in arguments}


def _name(call: ast.Call) -> str:
    """Return the name of the called function or class, without its module."""
    match call.func:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


def _substitution(value: ast.expr) -> ast.Call | None:
    """Return the expression if it calls a substitution or condition class."""
    return value if isinstance(value, ast.Call) and _name(value) in (*_SUBSTITUTIONS, *_CONDITIONS) else None


def _value(value: ast.expr, known: Mapping[str, ast.Call]) -> ast.Call | None:
    """Return the call that makes the substitution or condition to which an expression evaluates, if it is one."""
    return known.get(value.id) if isinstance(value, ast.Name) else _substitution(value)


def _as_text(value: ast.expr) -> ast.expr:
    """Return the expression within `str(...)` or an f-string; any other unchanged."""
    match value:
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            return inner
        case ast.JoinedStr(values=[ast.FormattedValue(value=inner)]):
            return inner
    return value


def _operands(test: ast.expr) -> Iterator[ast.expr]:
    """Yield the operands of the boolean operators of a test."""
    match test:
        case ast.BoolOp(values=values):
            for value in values:
                yield from _operands(value)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield from _operands(operand)
        case _:
            yield test


def _equivalent(value: ast.expr, known: Mapping[str, ast.Call]) -> str | None:
    """Return the substitution equivalent to an expression of substitutions; None for other expressions."""
    match value:
        case ast.BoolOp(op=op, values=values):
            fixes = [_equivalent(part, known) for part in values]
            kind = "And" if isinstance(op, ast.And) else "Or"
            kind = (
                f"{kind}Substitution" if len(fixes) == 2 else {"And": "AllSubstitution", "Or": "AnySubstitution"}[kind]
            )
            return None if None in fixes else f"{kind}({', '.join(map(str, fixes))})"
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            fix = _equivalent(operand, known)
            return None if fix is None else f"NotSubstitution({fix})"
        case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as op], comparators=[right]):
            sides = [_operand(_as_text(side), known) for side in (left, right)]
            is_of_one = any(_value(_as_text(side), known) for side in (left, right))
            kind = "Equals" if isinstance(op, ast.Eq) else "NotEquals"
            return f"{kind}Substitution({', '.join(map(str, sides))})" if is_of_one and None not in sides else None
        case ast.Compare(
            left=left, ops=[ast.In() | ast.NotIn() as op], comparators=[ast.Tuple() | ast.List() as among]
        ):
            shown, sides = _value(_as_text(left), known), [_operand(side, known) for side in among.elts]
            if shown is None or None in sides or not sides:
                return None
            fix = f"AnySubstitution({', '.join(f'EqualsSubstitution({ast.unparse(shown)}, {side})' for side in sides)})"
            return fix if isinstance(op, ast.In) else f"NotSubstitution({fix})"
    return _operand(value, known) if _value(value, known) is not None else None


def _operand(value: ast.expr, known: Mapping[str, ast.Call]) -> str | None:
    """Return a substitution or literal as an argument of another substitution."""
    if isinstance(value, ast.Constant) and isinstance(value.value, (str, int, float)):
        return repr(str(value.value).lower() if isinstance(value.value, bool) else str(value.value))
    call = _value(value, known)
    return None if call is None else ast.unparse(call)


def _test_fault(part: ast.expr, known: Mapping[str, ast.Call], performs: bool) -> str:
    """Return the problem of an operand of a test; empty if its outcome is not fixed."""
    if isinstance(part, ast.Compare):
        fix = _equivalent(part, known)
        return (
            ""
            if fix is None
            else _comparison_fault(part, known, performs, f"condition=IfCondition({fix}) at the action")
        )
    call = _value(part, known)
    if call is None:
        return ""
    shown = ast.unparse(call)
    fix = f"condition={shown}" if _name(call) in _CONDITIONS else f"condition=IfCondition({shown})"
    return f"{shown} has no value yet and is true in any test: write {fix} at the action"


def _comparison_fault(comparison: ast.Compare, known: Mapping[str, ast.Call], performs: bool, fix: str) -> str:
    """Return the problem of a comparison with a substitution.

    Args:
        performs: Whether the function around it has the launch context.
    """
    sides = [_as_text(side) for side in (comparison.left, comparison.comparators[0])]
    call = next(call for side in sides if (call := _value(side, known)) is not None)
    shown = ast.unparse(call)
    if performs:
        return f"{shown} is an object and equals no text: write {shown}.perform(context)"
    return f"{shown} has no value yet and equals no text: write {fix}"

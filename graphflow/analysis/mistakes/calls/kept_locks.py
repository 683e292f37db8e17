"""Locks that a `return` keeps: it stands between `acquire()` and `release()` of one block."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import blocks, is_nested, nodes_in, walk


def kept_locks(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines with such a `return`; each comes with the `with` that releases the lock in any case."""
    for block in (block for node in nodes_in(code) for block in blocks(node)):
        for number, statement in enumerate(block):
            owner, is_awaited = _owner(statement, "acquire")
            way = f"write {'async ' * is_awaited}with {owner}: in place of acquire() and release()"
            for between in _until_release(block[number + 1 :], owner) if owner else ():
                if not _releases(between, owner):
                    yield from ((line, f"this return keeps {owner}: {way}") for line in _returns(between))


def _until_release(rest: list[ast.stmt], owner: str) -> list[ast.stmt]:
    """Return the statements before the one that releases a lock; none if the block does not release it."""
    ends = (number for number, statement in enumerate(rest) if _owner(statement, "release")[0] == owner)
    return rest[: next(ends, 0)]


def _owner(statement: ast.stmt, method: str) -> tuple[str, bool]:
    """Return the object of which a statement calls a method, and whether it awaits that; "" for any other."""
    match statement:
        case ast.Expr(value=ast.Await(value=ast.Call(func=ast.Attribute(value=owner, attr=name)))) if name == method:
            return ast.unparse(owner), True
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner, attr=name))) if name == method:
            return ast.unparse(owner), False
    return "", False


def _releases(statement: ast.stmt, owner: str) -> bool:
    return any(
        isinstance(node, ast.Attribute) and node.attr == "release" and ast.unparse(node.value) == owner
        for node in nodes_in(statement)
    )


def _returns(statement: ast.stmt) -> Iterator[int]:
    for node, parents in walk(statement):
        if isinstance(node, ast.Return) and not is_nested([statement, *parents]):
            yield node.lineno

"""Work in the background that is taken for something else.

`asyncio.gather(...)` without `await` starts what it is given, and the next line does not wait for it. `self.spawn`
returns nothing that could be kept, awaited or cancelled.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import last_name, nodes_in, walk


def background_work(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find such lines; each comes with its correction."""
    for node in nodes_in(code):
        match node:
            case ast.AsyncFunctionDef():
                yield from _gathers(node)
            case ast.Assign(targets=[target], value=ast.Call(func=called, args=args)) if _is_spawn(called):
                yield node.lineno, _of_spawn(f"{ast.unparse(target)} = ", args)
            case ast.Await(value=ast.Call(func=called, args=args)) if _is_spawn(called):
                yield node.lineno, _of_spawn("await ", args)


def _gathers(function: ast.AsyncFunctionDef) -> Iterator[tuple[int, str]]:
    for node, _ in walk(function, into_functions=False):
        match node:
            case ast.Expr(value=ast.Call(func=called)) if last_name(called) == "gather":
                text = f"{ast.unparse(called)}(...) is not awaited, so that the next line does not wait for it"
                yield node.lineno, f"{text}; write await {ast.unparse(called)}(...)"


def _is_spawn(called: ast.expr) -> bool:
    return is_own(called) and last_name(called) == "spawn"


def _of_spawn(use: str, args: list[ast.expr]) -> str:
    work, *given = map(ast.unparse, args) if args else ("self.work",)
    call = f"{work}({', '.join(given)})"
    made = call if use == "await " else f"asyncio.create_task({call})"
    return f"self.spawn returns nothing; write {use}{made}"

"""Nodes that a program makes and neither runs nor keeps: `Circle()` as its last line, detected in its source."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.analysis.uncalled import uncalled
from graphflow.reading import parsed


def discarded(source: str, file: str, classes: Collection[str]) -> str:
    """Return a message about a node that is made and discarded, of a program in which no node has run.

    Args:
        source: The program's text.
        file: The program's name for the message.
        classes: The names of the classes whose nodes it has made.

    Returns:
        Empty if all of them are used, if only to be looked at.
    """
    try:
        module = parsed(source)
    except (SyntaxError, ValueError):
        return ""
    has_main = any(isinstance(item, FunctionNode) and item.name == "main" for item in module.body)
    for made in _unused(module):
        if (name := last_name(made.func)) in classes:
            call = ast.unparse(made)
            way = "main()" if has_main and uncalled(source, file) else f"graphflow.run({name})"
            return f"{file}:{made.lineno}: {call} makes a node and does not run it; write: {way}"
    return ""


def _unused(module: ast.Module) -> Iterator[ast.Call]:
    """Yield the calls whose result nothing uses: the last statement of a block, or the value of a name never read."""
    read = {node.id for node in nodes_in(module) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    for node, parents in walk(module):
        if any(isinstance(parent, ast.ClassDef) for parent in parents):
            continue
        match node:
            case ast.Module(body=[*_, ast.Expr(value=ast.Call() as made)]):
                yield made
            case ast.If(body=[*_, ast.Expr(value=ast.Call() as made)]) if node is module.body[-1]:
                yield made
            case ast.FunctionDef(name="main", body=[*_, ast.Expr(value=ast.Call() as made)]):
                yield made
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as made) if name not in read:
                if not _goes_on(module, node.lineno):
                    yield made


def _goes_on(module: ast.Module, line: int) -> bool:
    """Whether a program prints or asserts something after a line: it may only have tried whether a node can be made."""
    return any(
        isinstance(node, ast.Assert) or (isinstance(node, ast.Call) and last_name(node.func) == "print")
        for node in nodes_in(module)
        if isinstance(node, (ast.Assert, ast.Call)) and node.lineno > line
    )

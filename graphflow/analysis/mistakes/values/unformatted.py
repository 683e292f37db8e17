"""Texts without the `f` that they need: `self.log.info("at {self.pose.x:.1f}")`."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk

_SAYING = ("print", "debug", "info", "warn", "warning", "error", "fatal", "critical")
"""Functions that show a text to people."""
_FIELD = re.compile(r"\{([A-Za-z_]\w*)(?:\.\w+|\[[^\][{}]*\]|\([^(){}]*\))*(?:![rsa])?(?::[^{}]*)?\}")
"""A replacement field, which begins with a name."""


def unformatted(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find texts that are logged, printed or published with a variable's name in braces; each comes with a sentence."""
    for node, parents in walk(code):
        for text in _shown(node):
            for found in _FIELD.finditer(str(text.value)):
                if found[1] in _names_of(parents):
                    yield text.lineno, f"{found[0]} stays as it is written: put an f in front of the text, f'...'"
                    break


def _shown(node: ast.AST) -> Iterator[ast.Constant]:
    """Yield the texts that a statement shows: an argument, or the data of a message."""
    match node:
        case ast.Call(func=called, args=[ast.Constant(value=str()) as text, *_]) if last_name(called) in _SAYING:
            yield text
        case ast.Assign(targets=[ast.Attribute(attr="data")], value=ast.Constant(value=str()) as text):
            yield text
        case ast.keyword(arg="data", value=ast.Constant(value=str()) as text):
            yield text


def _names_of(parents: Sequence[ast.AST]) -> set[str]:
    """Return the variables of the enclosing function."""
    function = next((parent for parent in reversed(parents) if isinstance(parent, FunctionNode)), None)
    if function is None:
        return set()
    names = {argument.arg for argument in nodes_in(function.args) if isinstance(argument, ast.arg)}
    return names | {n.id for n in nodes_in(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}

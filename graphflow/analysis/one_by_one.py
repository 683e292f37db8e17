"""Programs that run nodes one after the other instead of together, detected in their source.

`graphflow.run(A)` returns when the program is to end, so that a `graphflow.run(B)` after it comes too late.
"""

from __future__ import annotations

import ast
import linecache
import re
from collections.abc import Iterator
from pathlib import PurePath
from types import FrameType

from graphflow.analysis.syntax import nodes_in
from graphflow.errors import Place
from graphflow.reading import parsed

_CALL = re.compile(r"\brun\(")
_ENDS = re.compile(r"\b(shutdown|exit|SystemExit|kill|raise_signal)\b")
"""Names of functions by which a program may end a node itself, so that running another one afterwards makes sense."""


def one_by_one(frame: FrameType | None) -> str:
    """Return a warning for a program whose call of `run` delays another one; empty for any other program.

    Args:
        frame: The program's frame, in the call of `run`.
    """
    if frame is None:
        return ""
    file, line = frame.f_code.co_filename, frame.f_lineno
    # With the globals, linecache also asks the module's loader.
    source = "".join(linecache.getlines(file, frame.f_globals))
    if _ENDS.search(source) or not (len(_CALL.findall(source)) > 1 or re.search(r"\bfor\b", source)):
        return ""
    try:
        module = parsed(source)
    except (SyntaxError, ValueError):
        return ""
    place = Place(PurePath(file).name, line)
    for parent, block in _blocks(module):
        for i, statement in enumerate(block):
            call = _run(statement)
            if call is not None and call.lineno <= line <= (call.end_lineno or 0):
                later = [other for other in map(_run, block[i + 1 :]) if other is not None]
                return _of_calls(place, call, later) if later else _of_loop(place, call, parent)
    return ""


def _blocks(module: ast.Module) -> Iterator[tuple[ast.AST, list[ast.stmt]]]:
    """Yield the lists of statements of a module, each with the node that it belongs to."""
    for node in nodes_in(module):
        for _, block in ast.iter_fields(node):
            if isinstance(block, list) and any(isinstance(item, ast.stmt) for item in block):
                yield node, block


def _run(statement: ast.stmt) -> ast.Call | None:
    """Return the call of `run` if a statement consists of one."""
    match statement:
        case ast.Expr(
            value=ast.Call(func=ast.Name("run") | ast.Attribute(value=ast.Name("graphflow"), attr="run")) as call
        ):
            return call
    return None


def _of_calls(place: Place, call: ast.Call, later: list[ast.Call]) -> str:
    nodes = ", ".join(ast.unparse(node) for one in (call, *later) for node in one.args)
    way = f"{ast.unparse(call.func)}({nodes})"
    return f"{place}: {ast.unparse(later[0])} begins only when this has ended; to run them together write {way}"


def _of_loop(place: Place, call: ast.Call, loop: ast.AST) -> str:
    if not isinstance(loop, ast.For) or [ast.unparse(node) for node in call.args] != [ast.unparse(loop.target)]:
        return ""
    way = f"{ast.unparse(call.func)}(*{ast.unparse(loop.iter)})"
    return f"{place}: the next one begins only when this has ended; to run them together write {way}"

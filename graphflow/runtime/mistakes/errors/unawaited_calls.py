"""The line that lacks its `await`, for an error of a later line that uses the result of the call."""

from __future__ import annotations

import ast
import inspect
import re
from types import FrameType

from graphflow.analysis.syntax import first_line, nodes_in, syntax_of
from graphflow.analysis.user_code import short_place


def line_without_await(frame: FrameType, line: str) -> str:
    """Return the correction of the assignment that made a coroutine; empty if the line has no such variable.

    Args:
        frame: The function in which the error was raised.
        line: The line that raised it.
    """
    file = frame.f_code.co_filename
    made = [name for name, value in frame.f_locals.items() if inspect.iscoroutine(value)]
    used = [name for name in made if re.search(rf"\b{name}\b", line)]
    own = [f for f in syntax_of(file).functions if first_line(f) == frame.f_code.co_firstlineno]
    for node in reversed(nodes_in(own[0]) if own and used else []):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call()) if name in used:
                if node.lineno < frame.f_lineno:
                    return f"write {name} = await {ast.unparse(node.value)}, in {short_place(file, node.lineno)}"
    return ""

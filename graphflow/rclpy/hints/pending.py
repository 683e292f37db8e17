"""The next step where a result was read before its future was done: `response = future.result(); response.sum`."""

from __future__ import annotations

import ast
from types import FrameType

from graphflow.analysis.syntax import first_line, nodes_in, syntax_of
from graphflow.analysis.user_code import short_place
from graphflow.rclpy.hints.frames import PATH, is_defined_by_user, lacking, line_of, named, own

_FUTURES = ("Future", "Task", "Run")


def early_result(error: BaseException, frames: list[FrameType]) -> str:
    """Name the line that read the result of a future that is still not done."""
    found, users = lacking(error, frames), own(frames)
    if found is None or found[0] is not None or not users:
        return ""
    frame = users[-1]
    owners = [path.rpartition(".")[0] for path in PATH.findall(line_of(frames)) if path.endswith(f".{found[1]}")]
    for node in nodes_in(_function_of(frame)):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=ast.Attribute(value=future, attr="result"))):
                path = ast.unparse(future)
                if ast.unparse(target) in owners and node.lineno <= frame.f_lineno and _is_pending(named(path, frame)):
                    place = short_place(frame.f_code.co_filename, node.lineno)
                    return (
                        f"{path}.result() ({place}) is None until the future is done: {path}.add_done_callback(...), "
                        "or await it"
                    )
    return ""


def _function_of(frame: FrameType) -> ast.AST:
    syntax = syntax_of(frame.f_code.co_filename)
    own_line = frame.f_code.co_firstlineno
    return next((f for f in syntax.functions if first_line(f) == own_line), syntax.module)


def _is_pending(future: object) -> bool:
    is_future = type(future).__name__ in _FUTURES and not is_defined_by_user(type(future))
    return is_future and not future.done()  # type: ignore[attr-defined]

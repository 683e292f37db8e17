"""The next step where a result was read before its future was done: `response = future.result(); response.sum`."""

from __future__ import annotations

import ast
from types import FrameType

from graphflow.analysis.rclpy_futures import early_returns
from graphflow.analysis.syntax import first_line, last_name, nodes_in, syntax_of
from graphflow.analysis.user_code import short_place
from graphflow.rclpy.hints.frames import PATH, is_defined_by_user, lacking, line_of, named, own
from graphflow.system import SITE

_FUTURES = ("Future", "Task", "Run")


def early_result(error: BaseException, frames: list[FrameType]) -> str:
    """Name the line that read the result of a future that is still not done."""
    found, users = lacking(error, frames), own(frames)
    if found is None or found[0] is not None or not users:
        return ""
    frame = users[-1]
    owners = [path.rpartition(".")[0] for path in PATH.findall(line_of(frames)) if path.endswith(f".{found[1]}")]
    for node in nodes_in(_function_of(frame)):
        if (
            not isinstance(node, ast.Assign)
            or node.lineno > frame.f_lineno
            or ast.unparse(node.targets[0]) not in owners
        ):
            continue
        match node.value:
            case ast.Call(func=ast.Attribute(value=future, attr="result")) if _is_pending(
                named(ast.unparse(future), frame)
            ):
                path = ast.unparse(future)
                place = short_place(frame.f_code.co_filename, node.lineno)
                return f"{path}.result() ({place}) is None until the future is done: {_way(path, frames)}"
            case ast.Call(func=called):
                for early in early_returns(syntax_of(frame.f_code.co_filename).module):
                    if early.function == last_name(called):
                        return f"{short_place(frame.f_code.co_filename, early.line)}: {early.text}"
    return _spun_for_result(frame.f_code.co_filename)


def _spun_for_result(file: str) -> str:
    """Return the correction of a line that takes a spin's result for its future's; empty if there is none."""
    for node in syntax_of(file).nodes:
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=called, args=[_, future, *_])):
                if last_name(called) == "spin_until_future_complete":
                    way = f"write it alone, and then {ast.unparse(target)} = {ast.unparse(future)}.result()"
                    return f"{ast.unparse(called)} ({short_place(file, node.lineno)}) returns None: {way}"
    return ""


def _way(future: str, frames: list[FrameType]) -> str:
    """Return how to wait for a future: by spinning, unless that is what has called this code."""
    if any(frame.f_code.co_filename.startswith(SITE) for frame in frames):
        return f"{future}.add_done_callback(...), or await it"
    node = "self" if "self" in own(frames)[-1].f_locals else "node"
    return f"write before it: rclpy.spin_until_future_complete({node}, {future})"


def _function_of(frame: FrameType) -> ast.AST:
    syntax = syntax_of(frame.f_code.co_filename)
    own_line = frame.f_code.co_firstlineno
    return next((f for f in syntax.functions if first_line(f) == own_line), syntax.module)


def _is_pending(future: object) -> bool:
    is_future = type(future).__name__ in _FUTURES and not is_defined_by_user(type(future))
    return is_future and not future.done()  # type: ignore[attr-defined]

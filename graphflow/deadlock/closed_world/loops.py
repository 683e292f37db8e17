"""Frames and loops of waiting code: which frame of a stack waits, and whether its loop polls."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import cached_property

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.class_source import Function
from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import first_line, nodes_in, syntax_of
from graphflow.analysis.user_code import Pause

Loop = ast.While | ast.For | ast.AsyncFor


@dataclass(frozen=True)
class Spot:
    """A frame of one of the node's methods, with its source."""

    frame: Frame
    function: Function

    @cached_property
    def loops(self) -> list[Loop]:
        """Loops around the frame's line, the outermost first."""
        around = (ast.While, ast.AsyncFor, ast.For)
        nodes = nodes_in(self.function.syntax)  # breadth first, hence the outer before the inner
        return [node for node in nodes if isinstance(node, around) and _spans(node, self.frame.f_lineno)]


def _spans(node: ast.stmt, line: int) -> bool:
    return node.lineno <= line <= (node.end_lineno or line)


def may_poll(loop: Loop) -> bool:
    """Whether a loop ends by its condition alone: `while`, or `async for` over an endless clock."""
    if isinstance(loop, ast.AsyncFor):
        return ast.unparse(loop.iter).startswith("self.clock.every(")
    return isinstance(loop, ast.While)


def pause_of(loop: Loop, frame: Frame) -> Pause | None:
    """Return the line at which a loop pauses; None if there are several."""
    calls = [node for node in nodes_in(loop) if isinstance(node, ast.Call)]
    lines = {call.lineno for call in calls if ast.unparse(call.func).split(".")[-1] == "sleep"}
    return Pause(frame, lines.pop()) if len(lines) == 1 else None


_PAUSING = {"sleep", "max", "min", "abs", "round", "float", "int"}
_PAUSING |= {"time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns"}
"""Calls of a function that only lets time pass."""


def only_pauses(frame: Frame) -> bool:
    """Whether a frame's function, such as a handwritten rate, only lets time pass and counts it."""
    try:
        functions = syntax_of(frame.f_code.co_filename).functions
    except (OSError, SyntaxError, ValueError):
        return False
    code = frame.f_code
    found = [f for f in functions if (first_line(f), f.name) == (code.co_firstlineno, code.co_name)]
    return len(found) == 1 and all(map(_lets_time_pass, nodes_in(found[0])))


def _lets_time_pass(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=called):
            return _last(called) in _PAUSING
        case ast.Attribute(ctx=ast.Store()):
            return is_own(node)
        case ast.While():  # a loop that pauses is a polling loop, the very thing that waits
            return not any(isinstance(n, ast.Call) and _last(n.func) == "sleep" for n in nodes_in(node))
        case ast.Subscript(ctx=ast.Store()) | ast.Raise() | ast.Assert() | ast.Global() | ast.Nonlocal():
            return False
        case ast.Yield() | ast.YieldFrom() | ast.Delete() | ast.AsyncFor() | ast.AsyncWith():
            return False
    return True


def _last(called: ast.expr) -> str:
    return ast.unparse(called).rpartition(".")[2]


_LIBRARIES = ("graphflow.", "rclpy.", "asyncio.", "contextlib", "threading", "queue", "concurrent.")


def is_library(frame: Frame) -> bool:
    """Whether a frame's code belongs to a library that only carries out a wait, and changes nothing of the user's."""
    name = f"{frame.f_globals.get('__name__', '')}."
    return name.startswith(_LIBRARIES)

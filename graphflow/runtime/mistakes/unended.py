"""Handlers and tasks that go on although they were cancelled, with the line that catches the cancellation."""

from __future__ import annotations

import ast
from asyncio import Future
from collections.abc import Iterable, Iterator, Mapping
from types import CodeType
from typing import Any

from graphflow.analysis.swallowed import catching
from graphflow.analysis.syntax import first_line, nodes_in, syntax_of
from graphflow.analysis.user_code import innermost, is_users, short_place
from graphflow.deadlock.asyncio_frames import TaskLike, frames_of
from graphflow.executor.runner import Runner

_LOOPS = (ast.While, ast.For, ast.AsyncFor)


def unended(stuck: Iterable[Future[Any]], names: Mapping[Future[Any], str], runners: Iterable[Runner]) -> str:
    """Return the names of what has not ended, and the lines that keep it from ending.

    Args:
        names: The handlers and tasks that were cancelled: the future that is done at the end of each, with its name.
    """
    left = list(stuck)
    tasks: list[Any] = [future for future in left if hasattr(future, "get_coro")]
    tasks += [run for runner in runners for run in runner.active]
    lines = " and ".join(dict.fromkeys(line for task in tasks for line in _caught_in(task)))
    way = f"; CancelledError is caught in {lines}: write except Exception, or raise it again" if lines else ""
    return ", ".join(names[future] for future in left) + way


def left_over(tasks: Iterable[TaskLike]) -> str:
    """Return the tasks that go on although they were cancelled: each with its function, its line and what catches."""
    return ", ".join(filter(None, map(_described, tasks)))


def _described(task: Any) -> str:
    frame = innermost(frames_of(task))
    if frame is None:
        return ""
    lines = catching_lines([frame.f_code])
    way = f"; CancelledError is caught in {lines}: write except Exception, or raise it again" if lines else ""
    return f"{frame.f_code.co_name} in {frame.f_code.co_filename}:{frame.f_lineno}{way}"


def catching_lines(codes: Iterable[CodeType]) -> str:
    """Return the lines of functions that catch CancelledError in a loop; empty if there are none."""
    lines = (str(short_place(code.co_filename, line)) for code in codes for line in _in_loops(code))
    return " and ".join(dict.fromkeys(lines))


def _caught_in(task: TaskLike) -> Iterator[str]:
    for frame in frames_of(task):
        if is_users(frame.f_code.co_filename):
            yield from (str(short_place(frame.f_code.co_filename, line)) for line in _in_loops(frame.f_code))


def _in_loops(code: CodeType) -> Iterator[int]:
    """Find the lines in the loops of a function that catch CancelledError, so that the loop goes on."""
    try:
        functions = syntax_of(code.co_filename).functions
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return
    for function in functions:
        if (function.name, first_line(function)) == (code.co_name, code.co_firstlineno):
            loops = (node for node in nodes_in(function) if isinstance(node, _LOOPS))
            handlers = {node for loop in loops for node in nodes_in(loop) if isinstance(node, ast.ExceptHandler)}
            yield from sorted(handler.lineno for handler in handlers if catching(handler) and not _leaves(handler))


def _leaves(handler: ast.ExceptHandler) -> bool:
    """Whether a handler may leave the loop."""
    return any(isinstance(node, (ast.Raise, ast.Break, ast.Return)) for node in nodes_in(handler))

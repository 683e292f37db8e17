"""Programs that log with `debug` alone, so that they seem to do nothing: the usual level, INFO, hides it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import last_name, nodes_in

HIDDEN = "debug() prints nothing at the usual level: write info(), or give --ros-args --log-level debug"
_LOGGERS = ("log", "logger", "get_logger")
_SHOWN = ("info", "warn", "warning", "error", "fatal", "critical", "exception", "log")
_RUNS = ("spin", "spin_once", "run", "running")
"""Calls of a program, as opposed to a module of one."""
_OTHERS = ("print", "write", "set_level", "setLevel", "set_logger_level", "basicConfig", "dictConfig")
"""Calls that show something in another way, or change the level."""


def hidden_logs(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the first call of `debug` in a program that shows nothing else; it comes with a sentence."""
    calls = [node for node in nodes_in(module) if isinstance(node, ast.Call)]
    called = {last_name(call.func) for call in calls}
    if called.isdisjoint(_RUNS) or not called.isdisjoint(_OTHERS):
        return
    logged = [call for call in calls if isinstance(call.func, ast.Attribute) and _is_logger(call.func.value)]
    if any(last_name(call.func) in _SHOWN for call in logged):
        return
    for call in logged[:1]:
        if last_name(call.func) == "debug":
            yield call.lineno, HIDDEN


def _is_logger(value: ast.expr) -> bool:
    return last_name(value.func if isinstance(value, ast.Call) else value) in _LOGGERS
